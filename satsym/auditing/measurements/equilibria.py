"""Equilibria of nonlinear systems with known stability, and motions that begin near them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array, kept
from satsym.auditing.measurements import linear, linear_motions
from satsym.auditing.propositions.values import Family, Record
from satsym.formula import reading

_SEED = 53
_NEAR_BY = 0.02
"""Distance from an equilibrium at which motions begin."""
_FAR_AWAY = 10.0
"""Distance from an equilibrium at which a motion is stopped."""
_FAST_RATE = 100.0
"""Largest speed in the state space.

A faster motion follows its trajectory at this speed, so that an explosion takes a measurable time.
"""
_UNTIL, _NODES = 400.0, 2001
_WHILE = 60.0
"""Duration for which motions of linear systems are followed."""
_ATTRACTIVE, _STABLE, _UNSTABLE = "asymptotically stable", "stable", "unstable"

CATALOGUE: Mapping[str, tuple[tuple[str, str], tuple[int, int], str]] = {
    "pendulum with friction, hanging": (("x2", "-sin(x1) - x2/5"), (0, 0), _ATTRACTIVE),
    "pendulum, hanging": (("x2", "-sin(x1)"), (0, 0), _STABLE),
    "pendulum, upright": (("x2", "sin(x1)"), (0, 0), _UNSTABLE),
    "oscillator with cubic damping": (("x2", "-x1 - 10000*x2**3"), (0, 0), _ATTRACTIVE),
    "oscillator with cubic driving": (("x2", "-x1 + 10000*x2**3"), (0, 0), _UNSTABLE),
    "oscillator of van der Pol": (("x2", "x2*(1 - x1**2) - x1"), (0, 0), _UNSTABLE),
    "Duffing's equation, at the saddle": (("x2", "x1 - x1**3"), (0, 0), _UNSTABLE),
    "Duffing's equation with friction, in a well": (("x2", "x1 - x1**3 - x2/5"), (1, 0), _ATTRACTIVE),
    "cubic decay": (("-10000*x1**3", "-x2"), (0, 0), _ATTRACTIVE),
    "cubic growth": (("10000*x1**3", "-x2"), (0, 0), _UNSTABLE),
    "a circle of which one point stands still": (
        ("(1 - sqrt(x1**2 + x2**2))*x1 - 10*(1 - x1/sqrt(x1**2 + x2**2))*x2",
         "(1 - sqrt(x1**2 + x2**2))*x2 + 10*(1 - x1/sqrt(x1**2 + x2**2))*x1"), (1, 0), _UNSTABLE,
    ),
}  # fmt: skip
"""Name -> rates of x1 and x2, equilibrium, and stability as known from energy or a distance as Lyapunov function.

On the circle (r' = r (1 - r), angle' = 10 (1 - cos angle)) all motions tend to the equilibrium, but those that begin on
one side of it first go once round the circle.
"""


def equilibria() -> Family:
    """Return a family of planar equilibria: textbook examples, and random ones with hyperbolic linearisation."""
    rng = np.random.default_rng(_SEED)
    members = [_member(name, *entry) for name, entry in CATALOGUE.items()]
    for k in range(6):
        p, q = int(rng.integers(1, 5)), int(rng.integers(1, 5))
        sign, known = (1, _UNSTABLE) if k % 3 == 0 else (-1, _ATTRACTIVE)
        a, b, c = (int(n) for n in rng.integers(-2, 3, 3))
        # x1'' + ... = 0 with the characteristic polynomial s^2 - sign*p*s/4 + q/2
        rates = ("x2", f"{sign * p}/4*x2 - {q}/2*x1 + ({a})*x1**2 + ({b})*x1*x2 + ({c})*x2**2")
        members.append(_member(f"random system {k + 1}", rates, (0, 0), known))
    return Family("EQUILIBRIA", "equilibria of nonlinear systems", tuple(members))


@kept
def followed(of: Any, start: ArrayLike | None = None) -> Record:
    """Return the motion of a member of a family from a state, or from a point near its equilibrium.

    Its parts are ``t``, ``x1``, ``x2``, ..., the distance ``size`` from the equilibrium, and the distance ``gone`` from
    the initial state. A motion that goes far away is stopped there.
    """
    whole = linear.system(of)
    n = linear.dimension(whole)
    rest = np.asarray(whole.parts.get("rest", np.zeros(n)))
    begin = rest + _NEAR_BY * _way(n) if start is None else np.asarray(start, dtype=float)
    if "formulas" in whole.parts:
        t, x = _nonlinear(whole, begin, rest)
    else:
        path = linear_motions.trajectory(whole, begin, _WHILE)
        t, x = path.part("t"), np.array(path.part("curves"))
    curves = {f"x{i + 1}": row for i, row in enumerate(x)}
    sizes = {"size": np.linalg.norm(x.T - rest, axis=1), "gone": np.linalg.norm(x.T - begin, axis=1)}
    return Record(f"a motion of {whole.name}", {"t": t, **sizes, **curves})


def _member(name: str, texts: tuple[str, str], rest: tuple[int, int], stability: str) -> Record:
    from satsym.symbolic.lookup import formulas

    x = [formulas.symbol("x1"), formulas.symbol("x2")]
    f = [formulas.from_tree(reading.expression(text), formulas.symbol) for text in texts]
    slopes = [entry.diff(letter) for entry in f for letter in x]
    place = dict(zip(x, rest, strict=True))
    a = formulas.matrix_of([[e.subs(place) for e in slopes[:2]], [e.subs(place) for e in slopes[2:]]])
    ways = {"formulas": formulas.compiled(f, x), "slopes": formulas.compiled(slopes, x)}
    at = np.array(rest, dtype=float)
    return Record(
        name,
        {"called": name, "A": a, "rest": at, "elsewhere": at + np.array([0.3, 0.2]), "stability": stability, **ways},
    )


def _way(n: int) -> Array:
    way = np.arange(1.0, n + 1.0)[::-1]
    return way / np.linalg.norm(way)


def _nonlinear(of: Record, begin: Array, rest: Array) -> tuple[Array, Array]:
    from scipy.integrate import odeint

    field: Callable[..., list[float]] = of.part("formulas")

    def moved(x: Array, _: float) -> list[float]:
        f = field(*x)
        slow = min(1.0, _FAST_RATE / max(math.hypot(*f), _FAST_RATE), max(0.0, _FAR_AWAY - math.hypot(*(x - rest))))
        return [slow * entry for entry in f]

    t = np.linspace(0.0, _UNTIL, _NODES)
    return t, np.asarray(odeint(moved, begin, t, rtol=1e-9, atol=1e-12, mxstep=10_000)).T
