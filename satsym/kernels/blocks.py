"""Steps for many motions at once, compiled: ``advance(t, h, steps, y, u, p)`` moves every column of y, in place.

A motion is a column of arrays, so that neighbours in memory are the same component of different motions. The inner loop
goes over the columns, and in it every component is a variable of its own and the generated scalar form stands in line:
that is what the compiler turns into vector instructions. The text of a loop depends on numbers of states, controls and
parameters only, and on which states are which.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.kernels.composition import weights
from satsym.spec import ProblemSpec


def rk4(dynamics: Any, spec: ProblemSpec) -> Any:
    """RK4 under constant controls; ``dynamics`` is the compiled scalar form."""
    n = range(len(spec.states))
    body = [
        "a = dynamics(now, ({y}), u_now, p_now)",
        *(f"z{i} = y{i} + half * a{i}" for i in n),
        "b = dynamics(middle, ({z}), u_now, p_now)",
        *(f"z{i} = y{i} + half * b{i}" for i in n),
        "c = dynamics(middle, ({z}), u_now, p_now)",
        *(f"z{i} = y{i} + h * c{i}" for i in n),
        "d = dynamics(end, ({z}), u_now, p_now)",
        *(f"y[{i}, j] = y{i} + sixth * (a{i} + 2.0 * (b{i} + c{i}) + d{i})" for i in n),
    ]
    lines = [
        "half, sixth = 0.5 * h, h / 6.0",
        "for i in range(steps):",
        "    now = t + i * h",
        "    middle, end = now + half, now + h",
        *(f"    {line}" for line in _over_columns(spec, body)),
    ]
    return _compiled(lines, {"dynamics": dynamics})


def kicks_and_drifts(dynamics: Any, spec: ProblemSpec) -> Any:
    """The symplectic composition of a separable motion, without control."""
    body = ["a = dynamics(t, ({y}), u_now, p_now)"]
    for q, v in pairs(spec):
        body += [f"z{v} = y{v} + kick * a{v}", f"y[{v}, j] = z{v}", f"y[{q}, j] = y{q} + drift * z{v}"]
    lines = [
        "for i in range(steps):",
        "    for k in range(len(kicks)):",
        "        kick, drift = h * kicks[k], h * drifts[k]",
        *(f"        {line}" for line in _over_columns(spec, body)),
    ]
    kicks, drifts = weights()
    return _compiled(lines, {"dynamics": dynamics, "kicks": np.array(kicks), "drifts": np.array([*drifts, 0.0])})


def pairs(spec: ProblemSpec) -> list[tuple[int, int]]:
    """Numbers of each coordinate and of its velocity among the states of a separable motion."""
    place = {name: k for k, name in enumerate(spec.state_names)}
    return [(place[q], place[v]) for q, v in zip(spec.coordinates, spec.velocities, strict=True)]


def _over_columns(spec: ProblemSpec, body: Sequence[str]) -> list[str]:
    """A loop over the columns. In its body ``{y}`` lists all states, and ``a = ...`` assigns to as many names."""
    n, m, k = (len(group) for group in (spec.states, spec.controls, spec.parameters))

    def listed(form: str, count: int) -> str:
        return "".join(form.format(i) + ", " for i in range(count))

    lists = {name: listed(name + "{}", n) for name in "yz"}
    opening = [
        *(f"y{i} = y[{i}, j]" for i in range(n)),
        f"u_now = ({listed('u[{}, j]', m)})",
        f"p_now = ({listed('p[{}, j]', k)})",
    ]
    filled = [line.format(**lists) for line in body]
    filled = [listed(line[0] + "{}", n) + line[1:] if line[1:4] == " = " else line for line in filled]
    return ["for j in range(y.shape[1]):", *(f"    {line}" for line in (*opening, *filled))]


def _compiled(lines: Sequence[str], scope: dict[str, Any]) -> Any:
    import numba

    text = "\n".join(["def advance(t, h, steps, y, u, p):", *(f"    {line}" for line in lines)])
    exec(text, scope)  # noqa: S102 - the lines above, nothing of a file
    return numba.njit(scope["advance"], error_model="numpy")
