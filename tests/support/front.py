"""Problems that users of the front door bring, in plain Python."""

from __future__ import annotations

import sympy

import satsym

q, v, a, k = sympy.symbols("q v a k", real=True)

SLED = satsym.FirstOrder(
    name="sled_motion",
    title="A sled with drag",
    states=(satsym.Variable("q", "q", "m"), satsym.Variable("v", "v", "m/s")),
    controls=(satsym.Variable("a", "a", "m/s**2"),),
    parameters=(satsym.Variable("k", "k", "1/m", default=0.1),),
    rates={q: v, v: a - k * v**2},
)
PUSH = satsym.Problem(name="sled", title="Pushing a sled", model=SLED, running_cost=a**2 / 2, control_set="box")
TOML = """model = "./sled"
[initial]
q = 0
v = 0
[final]
q = "1000 mm"
v = 0
[control]
a = [-1.2, 1.2]
[time]
tf = 2.2
"""


def pushed() -> satsym.Instance:
    """From rest to rest, a metre, along both bounds."""
    ends = {"initial": {q: 0, v: 0}, "final": {q: "1000 mm", v: 0}}
    return satsym.Instance.of(PUSH, **ends, tf=2.2, control={a: (-1.2, 1.2)})
