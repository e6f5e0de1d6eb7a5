"""Test whether motions can become unbounded within their time while the cost falls without limit.

If there are no final conditions, every control is admissible. Constant controls are increased until the motion becomes
infinite before the final time; just below this magnitude, the final state grows without limit.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.simulation.together import costs_together

SIZES = np.geomspace(1e-2, 1e4, 13)
"""Magnitudes of constant controls that are tried."""

DRAWN, STEPS = 8, 400
"""Number of random directions in addition to those of single controls, and number of Runge-Kutta steps of the
simultaneous simulations."""

LIKELY = 3
"""Maximum number of directions in which motions are simulated more accurately."""

INFINITE = 1e14
"""Magnitude of a state above which it counts as infinite."""

HALVINGS, DECADES = 24, 4
"""Number of bisections for the magnitude at which motions become infinite, and number of smaller magnitudes at which
costs are compared, each ten times closer to it than the previous one."""

TENFOLD, LAST = 10.0, 3
"""Minimum factor by which the decrease of the cost grows from one magnitude of the control to the next one that is ten
times closer to the critical one, and number of the last magnitudes for which this is required."""

TOLERANCE = 1e-9
"""Relative and absolute tolerance of the integration."""

REMEDY = "constrain the final state, or bound the control"
"""Advice that is given if motions become unbounded."""


def escape(instance: Instance) -> str:
    """Return why there is no optimum if motions become unbounded at ever lower cost; otherwise an empty string."""
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
    """Return whether initial state and duration are given, and final states, controls and path unconstrained."""
    spec = instance.model.spec
    asked = instance.final or instance.ranges or spec.multipliers or spec.terminal_inequalities or spec.in_arcs
    chosen = any(one.place is not Place.PARAMETER for one in instance.free)
    return instance.tf is not None and not (asked or chosen or instance.control_set.bounded)


def _likely(instance: Instance) -> list[tuple[Array, float, float]]:
    """Return directions of constant controls, and the magnitudes between which motions become infinite.

    Each direction has two magnitudes: the last of ``SIZES`` with a finite motion, and the next one.
    """
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
    """Return magnitudes of a control and their costs if these fall without limit, otherwise ``None``.

    The magnitudes approach the critical one, at which the motion becomes infinite within its time.
    """
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
    """Return the cost of a constant control; NaN if the motion becomes infinite before the final time."""
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
