"""Coupling between axes: what the control of one model does to a larger model, and how much reaches other axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from satsym.analysis.classical.signals import Span
from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.status import BadInput

Progress: TypeAlias = Callable[[float], None]

TOLERANCE = 1e-7
SAMPLES = 400
"""Number of values of the control in each smooth part, joined by straight lines."""


@dataclass(frozen=True, eq=False)
class Driver:
    """The source of a driving control: an instance, the smooth parts of its motion, and an initial impulse."""

    instance: Instance
    spans: Sequence[Span]
    impulse: float


@dataclass(frozen=True, eq=False)
class Reached:
    """The driven motion at the nodes, and its differences from the uncontrolled motion."""

    times: Array
    x: Array
    u: Array
    metrics: dict[str, float]
    message: str


def nodes_of(instance: Instance) -> Array:
    """Return the times at which the motions are compared.

    Raises
    ------
    BadInput
        If the final time is free.
    """
    if instance.tf is None:
        raise BadInput(f"{instance.called}: time.tf: a driven motion requires a final time; give a number")
    return Grid.uniform(instance.t0, instance.tf, instance.solver.steps).nodes


def undriven(instance: Instance, progress: Progress = lambda share: None) -> Array:
    """Return the states at the nodes without control, shape (n, N+1), the same for every driving control."""
    start = np.array(instance.initial)
    return _followed(instance.model, instance.parameters, nodes_of(instance), start, [], 0, progress)


def reached(instance: Instance, driver: Driver, still: Array, progress: Progress = lambda share: None) -> Reached:
    """Simulate the motion under the driving control, and compare it with the uncontrolled one from the same start.

    The equations are stiff, as wheels nutate fast: an implicit method of order five (Radau) follows them, with the
    exact Jacobian. An impulse at the start makes the speeds jump by its effect on them.

    Parameters
    ----------
    still
        The latter, see :func:`undriven`.
    progress
        Called with the share of the time that has been followed.

    Returns
    -------
    Reached
        For each state its largest magnitude (``_peak``), and the largest difference from the motion without the control
        (``_driven``); for each in the unit of what the control changes most, ``_share``: the largest difference of its
        rate of change, relative to the largest of all in that unit.
    """
    assert instance.driven is not None
    model, p = instance.model, instance.parameters
    spec, place = model.spec, instance.model.spec.control_names.index(instance.driven.control)
    torques, slope = _signals(driver, instance.driven.control)
    nodes = nodes_of(instance)
    count, start = len(spec.controls), np.array(instance.initial)
    column = np.reshape(model.jacobian_u(instance.t0, start.tolist(), (0.0,) * count, p), (-1, count))[:, place]
    moved = _followed(model, p, nodes, start + column * slope * driver.impulse, torques, place, progress)
    u = np.zeros((count, len(nodes)))
    for a, b, torque in torques:
        within = (nodes >= a) & (nodes <= b)
        u[place, within] = torque(nodes[within])
    rates = [model.dynamics_batch(nodes, x, v, p) for x, v in ((moved, u), (still, 0.0 * u))]
    change, difference = np.abs(rates[0] - rates[1]).max(axis=1), np.abs(moved - still).max(axis=1)
    metrics: dict[str, float] = {}
    if driver.impulse:
        metrics["impulse"] = slope * driver.impulse
    most = spec.states[int(np.abs(column).argmax())].unit
    for k, control in enumerate(spec.control_names):
        sudden = abs(slope * driver.impulse) if k == place else 0.0
        metrics[f"{control}_peak"] = float(np.abs(u[k]).max())
        metrics[f"{control}_total"] = float(np.trapezoid(np.abs(u[k]), nodes)) + sudden
    for k, state in enumerate(spec.states):
        metrics[f"{state.symbol}_peak"] = float(np.abs(moved[k]).max())
        metrics[f"{state.symbol}_driven"] = float(difference[k])
        alike = max(change[i] for i, other in enumerate(spec.states) if other.unit == state.unit)
        if column.any() and state.unit == most and change[k] < alike:
            metrics[f"{state.symbol}_share"] = float(change[k] / alike)
    return Reached(
        nodes, moved, u, metrics, f"followed by Radau to {TOLERANCE:.0e}; {_said(spec.state_names, difference)}"
    )


def _said(names: Sequence[str], difference: Array) -> str:
    untouched = [name for name, value in zip(names, difference, strict=True) if value == 0.0]
    return (
        f"states that the driving control does not affect: {', '.join(untouched)}"
        if untouched
        else "the driving control affects every state"
    )


def _signals(driver: Driver, name: str) -> tuple[list[tuple[float, float, Callable[[Array], Array]]], float]:
    """Return the control on each smooth part, and its slope by the driver's own first control."""
    instance = driver.instance
    model, p = instance.model, instance.parameters
    if name in model.spec.control_names:
        row = model.spec.control_names.index(name)
        value: Callable[[Array, Array, Array], Array] = lambda t, x, u: np.asarray(u[row])  # noqa: E731
    else:
        row = [v.symbol for v in model.spec.quantities].index(name)
        value = lambda t, x, u: np.asarray(model.quantities_batch(t, x, u, p)[row])  # noqa: E731
    found = []
    for span in driver.spans:
        times = np.linspace(span.times[0], span.times[-1], SAMPLES)
        values = value(times, span.x(times), span.u(times))
        found.append((float(times[0]), float(times[-1]), _lines(times, values)))
    at, x = np.array([instance.t0]), np.array(instance.initial)[:, None]
    one = np.zeros((len(model.spec.controls), 1))
    slope = value(at, x, one + 1.0) - value(at, x, one)
    return found, float(slope[0])


def _lines(times: Array, values: Array) -> Callable[[Array], Array]:
    return lambda t: np.interp(t, times, values)


def _followed(
    model: Kernels,
    p: Sequence[float],
    nodes: Array,
    start: Array,
    torques: Sequence[tuple[float, float, Callable[[Array], Array]]],
    place: int,
    progress: Progress,
) -> Array:
    """Integrate the states part by part to the nodes; no control acts after the last part."""
    from scipy.integrate import solve_ivp

    n, x, parts = len(start), start, list(torques)
    end = parts[-1][1] if parts else float(nodes[0])
    if end < nodes[-1]:
        parts.append((end, float(nodes[-1]), lambda t: np.zeros(np.shape(t))))
    found = np.full((n, len(nodes)), np.nan)
    u = [0.0] * len(model.spec.controls)
    sizes = np.maximum(np.abs(start), 1e-6)

    for a, b, torque in parts:

        def controls(t: float, torque: Callable[[Array], Array] = torque) -> list[float]:
            return [*u[:place], float(torque(np.array(t))), *u[place + 1 :]]

        def rates(t: float, y: Array, controls: Any = controls) -> Array:
            progress((t - nodes[0]) / (nodes[-1] - nodes[0]))
            return np.array(model.dynamics(t, y.tolist(), controls(t), p))

        def slopes(t: float, y: Array, controls: Any = controls) -> Array:
            return np.reshape(model.jacobian_x(t, y.tolist(), controls(t), p), (n, n))

        b = min(b, float(nodes[-1]))
        run = solve_ivp(
            rates, (a, b), x, "Radau", dense_output=True, jac=slopes, rtol=TOLERANCE, atol=TOLERANCE * sizes
        )
        within = (nodes >= a) & (nodes <= b)
        if not run.success or not within.any():
            break
        found[:, within] = run.sol(nodes[within])
        x = run.y[:, -1]
    return found
