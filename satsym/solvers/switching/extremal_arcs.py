"""Integration of an extremal arc by arc, from initial costates and switching times, and its derivatives by these."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import count, pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import integrate
from satsym.solvers.switching.boundary import BoundaryField, pushed
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import Event, Structure
from satsym.solvers.switching.throttled import equations

TOLERANCE = 3e-14
"""Error tolerance of a step, relative to the scale of each component."""

ROUGH = 1e-7
"""Error tolerance of a step if only rough accuracy is needed, relative to the scale of each component."""

ROUNDING = 1e-14
"""Length of a piece, relative to the time, below which it is not integrated."""

WHOLE = 1.0
"""First step that is tried, as a fraction of a piece."""

ROUGHLY = 1e6
"""Factor by which errors of derivatives may exceed those of values, since Newton's method corrects itself."""


CORNERS, LOOKED = 1e-9, 64
"""Relative error of the times of corners, and number of intervals of a piece in which they are searched for."""

MOST_ON_ARC, MOST_EVALUATIONS = 2000, 30_000
"""Maximum number of evaluations on a piece with a singular control, and on any other piece. Off its manifold a singular
motion may diverge, and close to a centre of attraction steps become ever smaller. Of the other pieces, 999 in 1,000
need fewer than 4,000 evaluations."""


@dataclass(frozen=True)
class Stop:
    """A restart of an arc from values of its own, used if errors grow too much along one flow."""

    piece: int
    fraction: float
    """Index of the piece between switches of any control, and the fraction of the piece after which the restart
    follows."""


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns that determine an extremal of a structure."""

    costates: Array
    """Initial costates, shape (n,)."""
    times: Array
    """Switching times, one control after the other."""
    end: float
    """The final time."""
    multipliers: Array
    """Multipliers of terminal constraints."""
    stops: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """States and costates at the restarts, shape (M, 2n)."""
    jumps: Array = field(default_factory=lambda: np.zeros(0))
    """Multipliers of the jumps in :attr:`Structure.jumps`."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A piece between two switches of any control, or a part of one between restarts."""

    field: Field
    """Equations of motion on the piece, with the levels of the controls."""
    start: float
    end: float
    """Start and end of the piece."""
    before: Array
    after: Array
    """States and costates at the start and at the end, shape (2n,)."""
    event: Event | None
    """The switch that ends the piece; ``None`` for the last piece."""
    slopes: Array
    """Derivatives of ``after`` with respect to the initial costates, the switching times, the final time, the values at
    restarts and the multipliers of J jumps, including the shift of the end: shape (2n, n + K + 1 + 2nM + J). Undefined
    if derivatives were not requested."""
    stop: int | None = None
    """Index of the restart that ends the piece; ``None`` if a switch or the final time does."""


@dataclass(frozen=True, eq=False)
class Accuracy:
    """Accuracy of the integration of arcs."""

    sizes: Array
    """Typical magnitudes of states and costates, shape (2n,)."""
    slopes: bool = True
    """Whether derivatives are computed."""
    tolerance: float = TOLERANCE
    """Error tolerance of a step, relative to the scale of each component."""


def extremal(
    instance: Instance, structure: Structure, at: Unknowns, accuracy: Accuracy, stops: Sequence[Stop] = ()
) -> list[Arc]:
    """Integrate the extremal arc by arc.

    Parameters
    ----------
    instance
        Model, parameters, bounds and initial state.
    structure
        Levels of the controls on successive arcs.
    at
        Initial costates, switching times and other unknowns.
    accuracy
        Accuracy of the integration.
    stops
        Restarts, in order of time.

    Raises
    ------
    ArithmeticError, ValueError, satsym.solvers.simulation.extrapolation.NotFinite
        If the integration is not finite.
    """
    n, end_column = len(instance.initial), len(instance.initial) + structure.switches
    z = np.concatenate([instance.initial, at.costates])
    known, own = structure.jumps, end_column + 1 + 2 * n * len(stops)
    jumps = {(control, number): (k, constraint) for k, (control, number, constraint) in enumerate(known)}
    total: Array = np.zeros((2 * n, own + len(known)))
    total[n:, :n] = np.eye(n)
    unit = np.eye(total.shape[1])
    number, begin, moving = [0] * len(structure.levels), instance.t0, np.zeros(len(unit))
    arcs: list[Arc] = []
    for piece, event in enumerate((*structure.events(at.times), None)):
        equations_here = equations(instance, tuple(row[k] for row, k in zip(structure.levels, number, strict=True)))
        first, first_moving = begin, moving
        end, end_moving = (at.end, unit[end_column]) if event is None else (event.time, unit[n + event.column])
        for stop in (*(k for k, one in enumerate(stops) if one.piece == piece), None):
            until, until_moving = end, end_moving
            if stop is not None:
                fraction = stops[stop].fraction
                until, until_moving = (
                    first + fraction * (end - first),
                    (1.0 - fraction) * first_moving + fraction * end_moving,
                )
            after, matrix = _piece(equations_here, begin, until, z, accuracy)
            if accuracy.slopes:
                total = matrix @ (total - np.outer(equations_here.rates(begin, z.tolist()), moving))
                total += np.outer(equations_here.rates(until, after.tolist()), until_moving)
            arcs.append(Arc(equations_here, begin, until, z, after, event if stop is None else None, total, stop))
            z, begin, moving = after, until, until_moving
            if stop is not None:
                own = end_column + 1 + 2 * n * stop
                z, total = at.stops[stop], unit[own : own + 2 * n]
        if event is not None:
            number[event.control] += 1
            if (event.control, event.number) in jumps:
                k, constraint = jumps[event.control, event.number]
                total = jumped(instance, constraint, arcs[-1], at.jumps[k], moving, own + k)
                z = pushed(instance, constraint, begin, z, at.jumps[k])[0]
    return arcs


def jumped(instance: Instance, constraint: int, arc: Arc, by: float, moving: Array, column: int) -> Array:
    """Return derivatives of the values after a jump that ends an arc.

    Parameters
    ----------
    by
        Multiplier of the jump, the unknown with the index ``column``.
    moving
        Derivatives of the time of the jump.
    """
    n, (slope, by_state, by_time) = len(instance.initial), pushed(instance, constraint, arc.end, arc.after, by)[1]
    found = arc.slopes.copy()
    found[n:] -= by * (by_state @ found[:n] + np.outer(by_time, moving))
    found[n:, column] -= slope
    return found


def growth(field: Field, start: float, end: float, z: Array, sizes: Array) -> float:
    """Return the growth of deviations along an arc in units of ``sizes``; infinite if the integration fails."""
    try:
        _, matrix = _piece(field, start, end, z, Accuracy(sizes, tolerance=ROUGH))
    except FAILURES:
        return math.inf
    found = float(np.abs(matrix * (sizes / sizes[:, None])).max())
    return found if math.isfinite(found) else math.inf


def _piece(field: Field, start: float, end: float, z: Array, accuracy: Accuracy) -> tuple[Array, Array]:
    """Return states and costates at the end of a piece, and their derivatives by states and costates at its start."""
    rows, sizes, tolerance = len(z), accuracy.sizes, accuracy.tolerance
    if abs(end - start) <= ROUNDING * max(abs(start), abs(end)):
        return z + (end - start) * np.array(field.rates(start, z.tolist())), np.eye(rows)
    evaluations = count()
    corners = _corners(field, start, end, z, sizes) if tolerance <= TOLERANCE else []
    through = np.array([start, *corners, end])

    def counted() -> None:
        if next(evaluations) > (MOST_EVALUATIONS if field.singular is None else MOST_ON_ARC):
            raise ArithmeticError("the motion diverges, or comes next to where its rates do")

    if not accuracy.slopes:

        def rates(t: float, y: Array) -> Array:
            counted()
            return np.array(field.rates(t, y.tolist()))

        return integrate(rates, through, z, tolerance, sizes, WHOLE)[-1].end, np.zeros(0)

    def both(t: float, y: Array) -> Array:
        counted()
        now, slopes = field.linearised(t, y[:rows].tolist())
        return np.concatenate([now, (slopes @ y[rows:].reshape(rows, rows)).ravel()])

    values = np.concatenate([z, np.eye(rows).ravel()])
    scale = np.concatenate([sizes, ROUGHLY * np.outer(sizes, 1.0 / sizes).ravel()])
    if isinstance(field, BoundaryField):
        on_boundary = field

        def both_along(t: Array, y: Array) -> Array:
            counted()
            now, slopes = on_boundary.linearised_along(t, y[:rows])
            moved = slopes @ y[rows:].reshape(rows, rows, -1).transpose(2, 0, 1)
            return np.concatenate([now, moved.transpose(1, 2, 0).reshape(rows * rows, -1)])

        found = integrate(both_along, through, values, tolerance, scale, WHOLE, together=True)[-1].end
    else:
        found = integrate(both, through, values, tolerance, scale, WHOLE)[-1].end
    return found[:rows], found[rows:].reshape(rows, rows)


def _corners(field: Field, start: float, end: float, z: Array, sizes: Array) -> list[float]:
    """Return times within a piece at which controls that do not switch reach or leave bounds.

    Rates are continuous there, so that an error of such a time has an effect of second order.
    """
    if not len(field.sides(start, z.tolist())):
        return []
    from scipy.integrate import solve_ivp

    solution = solve_ivp(
        lambda t, y: field.rates(t, y.tolist()),
        (start, end),
        z,
        "DOP853",
        rtol=CORNERS,
        atol=CORNERS * sizes,
        dense_output=True,
    )
    if not solution.success:
        return []

    def sides(t: float) -> list[bool]:
        return list(field.sides(t, solution.sol(t).tolist()))

    times = np.linspace(start, end, LOOKED + 1).tolist()
    found, before = list[float](), sides(start)
    for low, high in pairwise(times):
        after = sides(high)
        if after != before:
            a, b = low, high
            while abs(b - a) > CORNERS * abs(end - start):
                middle = (a + b) / 2.0
                a, b = (middle, b) if sides(middle) == before else (a, middle)
            found.append(b)
        before = after
    return found
