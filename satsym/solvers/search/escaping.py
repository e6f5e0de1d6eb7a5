"""Whether motions escape to infinity within their time, and the cost falls without end on the way.

Where nothing is asked of the end every control is admissible. Constant controls are made larger until the motion is
infinite before its time is up; from just below that size on, the state at the end grows beyond all bounds.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.simulation.together import costs_together

SIZES = np.geomspace(1e-2, 1e4, 13)
"""Sizes of constant controls that are tried."""

DRAWN, STEPS = 8, 400
"""Directions that are drawn, besides those of single controls, and Runge-Kutta steps with which all are tried at once.
"""

LIKELY = 3
"""Directions along which motions are followed more accurately, at most."""

INFINITE = 1e14
"""Size of a state that counts as infinite."""

HALVINGS, DECADES = 24, 4
"""Halvings that find the size from which on motions escape, and distances to it, each a tenth of the one before."""

TENFOLD, LAST = 10.0, 3
"""Factor by which the fall of the cost grows from one of these to the next, at least, for the last ones."""

TOLERANCE = 1e-9
"""Error that the integration allows, relative and absolute."""

REMEDY = "constrain the final state, or bound the control"
"""What keeps motions from escaping."""


def escape(instance: Instance) -> str:
    """Why no control is the best one, where motions escape and cost ever less; empty where none is seen to."""
    if not _admissible(instance):
        return ""
    for direction, finite, infinite in _likely(instance)[:LIKELY]:
        found = _along(instance, direction, finite, infinite)
        if found is not None:
            sizes, costs = (", ".join(f"{value:.4g}" for value in row[-LAST:]) for row in found)
            return (
                "some motions become unbounded before the final time: "
                f"constant controls up to {sizes} have the costs {costs}"
            )
    return ""


def _admissible(instance: Instance) -> bool:
    """Whether the start and the duration are given, and nothing is asked of the end, of the way or of controls."""
    spec = instance.model.spec
    asked = instance.final or instance.ranges or spec.multipliers or spec.terminal_inequalities or spec.in_arcs
    chosen = any(one.place is not Place.PARAMETER for one in instance.free)
    return instance.tf is not None and not (asked or chosen or instance.control_set.bounded)


def _likely(instance: Instance) -> list[tuple[Array, float, float]]:
    """Directions of constant controls, a size with which motions are finite, and the next, with which they are not."""
    m = len(instance.model.spec.controls)
    drawn = np.random.default_rng(0).normal(size=(DRAWN, m))
    directions = np.concatenate([drawn / np.linalg.norm(drawn, axis=1)[:, None], np.eye(m), -np.eye(m)])
    sizes = np.append(0.0, SIZES)
    controls = np.einsum("s,dm->mds", sizes, directions).reshape(m, -1)
    assert instance.tf is not None
    lasting = np.full(controls.shape[1], instance.tf - instance.t0)
    held = np.broadcast_to(controls[:, None], (m, 2 * STEPS + 1, len(lasting)))
    finite = np.isfinite(costs_together(instance, held, lasting)).reshape(len(directions), -1)
    first = (~finite).argmax(axis=1)  # 0 as well where all are finite
    return [(one, float(sizes[k - 1]), float(sizes[k])) for one, k in zip(directions, first, strict=True) if k]


def _along(
    instance: Instance, direction: Array, finite: float, infinite: float
) -> tuple[list[float], list[float]] | None:
    """Sizes of a control and costs that fall ever faster as it comes near to where motions escape, else ``None``."""
    low, high, still = finite, infinite, _cost(instance, finite * direction)
    if np.isnan(still) or not np.isnan(_cost(instance, infinite * direction)):
        return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if np.isnan(_cost(instance, middle * direction)) else (middle, high)
    sizes = [low - (infinite - finite) * 10.0**-k for k in range(1, DECADES + 1)]
    costs = [_cost(instance, size * direction) for size in sizes]
    falls = still - np.array(costs[-LAST:])
    endless = np.isfinite(falls).all() and (falls > 0.0).all() and (falls[1:] >= TENFOLD * falls[:-1]).all()
    return (sizes, costs) if endless else None


def _cost(instance: Instance, control: Array) -> float:
    """The cost of a constant control; NaN where the motion is infinite before its time is up."""
    from scipy.integrate import solve_ivp

    model, p, u = instance.model, instance.parameters, tuple(control.tolist())
    assert instance.tf is not None

    def rates(t: float, y: Array) -> list[float]:
        x = tuple(y[:-1].tolist())
        return [*model.dynamics(t, x, u, p), model.running_cost(t, x, u, p)]

    def near(_: float, y: Array) -> float:
        return INFINITE - float(np.abs(y[:-1]).max())

    near.terminal = True  # type: ignore[attr-defined]
    start, span = np.append(np.array(instance.initial, float), 0.0), (instance.t0, instance.tf)
    with np.errstate(all="ignore"):
        try:
            found = solve_ivp(rates, span, start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE, events=near)
        except (OverflowError, ZeroDivisionError, ValueError):
            return float("nan")
    if found.status != 0:
        return float("nan")
    return float(found.y[-1, -1] + model.terminal_cost(instance.tf, tuple(found.y[:-1, -1].tolist()), p))
