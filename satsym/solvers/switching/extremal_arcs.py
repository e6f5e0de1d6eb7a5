"""An extremal arc by arc, from initial costates and switching times, and how it changes with them."""

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
from satsym.solvers.switching.boundary import pushed
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import Event, Structure
from satsym.solvers.switching.throttled import equations

TOLERANCE = 3e-14
"""Error of a step, relative to the size of each component."""

ROUGH = 1e-7
"""Error of a step where no more is asked for, relative to the size of each component."""

ROUNDING = 1e-14
"""Relative length of a piece in which nothing happens."""

WHOLE = 1.0
"""First step that is tried, as a share of a piece."""

ROUGHLY = 1e6
"""So many times larger may errors of the derivatives be: Newton's method corrects itself."""


CORNERS, LOOKED = 1e-9, 64
"""Relative error of the times of corners, and how many stretches of a piece are looked at."""

MOST_ON_ARC, MOST_EVALUATIONS = 2000, 30_000
"""Evaluations of a piece with a singular control, and of any other one. Off its manifold a singular motion may leave
for infinity, and next to a centre of attraction steps become ever smaller. Of other pieces 999 in 1,000 need fewer than
4,000."""


@dataclass(frozen=True)
class Stop:
    """Where an arc begins anew from values of its own, as the flow grows too much for one to the end."""

    piece: int
    fraction: float
    """Which of the pieces between any switches, and after which fraction of it."""


@dataclass(frozen=True, eq=False)
class Unknowns:
    """What an extremal of a structure is found by."""

    costates: Array
    """At the start, shape (n,)."""
    times: Array
    """Switching times, one control after the other."""
    end: float
    """The final time."""
    multipliers: Array
    """Multipliers of terminal constraints."""
    stops: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """States and costates at the stops, shape (M, 2n)."""
    jumps: Array = field(default_factory=lambda: np.zeros(0))
    """Multipliers of :attr:`Structure.jumps`."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A piece between two switches of any control, or the part of one between stops."""

    field: Field
    """Its equations."""
    start: float
    end: float
    """Times."""
    before: Array
    after: Array
    """States and costates there, shape (2n,)."""
    event: Event | None
    """The switch that ends it; ``None`` for the last."""
    slopes: Array
    """Derivatives of ``after`` by the initial costates, the switching times, the final time, the values at stops and
    the multipliers of J jumps, the piece's end moving with these: shape (2n, n + K + 1 + 2nM + J). Meaningless where
    they were not asked for."""
    stop: int | None = None
    """The number of the stop that ends it, if one does."""


@dataclass(frozen=True, eq=False)
class Accuracy:
    """How arcs are integrated."""

    sizes: Array
    """Typical sizes of states and costates, shape (2n,)."""
    slopes: bool = True
    """Whether derivatives are needed."""
    tolerance: float = TOLERANCE
    """Error of a step, relative to the size of each component."""


def extremal(
    instance: Instance, structure: Structure, at: Unknowns, accuracy: Accuracy, stops: Sequence[Stop] = ()
) -> list[Arc]:
    """Follow the extremal from arc to arc.

    Parameters
    ----------
    instance
        Model, parameters, bounds and initial state.
    structure
        Levels of the controls.
    at
        Costates and times.
    accuracy
        How arcs are integrated.
    stops
        Where they begin anew, in order of time.

    Raises
    ------
    ArithmeticError, ValueError, satsym.solvers.simulation.extrapolation.NotFinite
        If it is not finite.
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
    """Derivatives of the values after a jump that ends an arc.

    Parameters
    ----------
    by
        Its multiplier, the unknown of this column.
    moving
        Derivatives of its time.
    """
    n, (slope, by_state, by_time) = len(instance.initial), pushed(instance, constraint, arc.end, arc.after, by)[1]
    found = arc.slopes.copy()
    found[n:] -= by * (by_state @ found[:n] + np.outer(by_time, moving))
    found[n:, column] -= slope
    return found


def growth(field: Field, start: float, end: float, z: Array, sizes: Array) -> float:
    """By how much the flow of an arc enlarges deviations in units of ``sizes``; infinite where it goes nowhere."""
    try:
        _, matrix = _piece(field, start, end, z, Accuracy(sizes, tolerance=ROUGH))
    except FAILURES:
        return math.inf
    found = float(np.abs(matrix * (sizes / sizes[:, None])).max())
    return found if math.isfinite(found) else math.inf


def _piece(field: Field, start: float, end: float, z: Array, accuracy: Accuracy) -> tuple[Array, Array]:
    """States and costates at the end of a piece, and their derivatives by those at its start."""
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
    found = integrate(both, through, values, tolerance, scale, WHOLE)[-1].end
    return found[:rows], found[rows:].reshape(rows, rows)


def _corners(field: Field, start: float, end: float, z: Array, sizes: Array) -> list[float]:
    """Times within a piece at which controls that do not switch meet or leave bounds.

    Rates are continuous there, so that an error in such a time counts by its square.
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
