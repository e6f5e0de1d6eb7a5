"""An extremal arc by arc, from initial costates and switching times, and how it changes with them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.simulation.extrapolation import integrate
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import Event, Structure
from satsym.solvers.switching.throttled import equations

TOLERANCE = 3e-14
"""Error of a step, relative to the size of each component."""

ROUNDING = 1e-14
"""Relative length of a piece in which nothing happens."""

WHOLE = 1.0
"""First step that is tried, as a share of a piece."""

ROUGHLY = 1e6
"""So many times larger may errors of the derivatives be: Newton's method corrects itself."""


MOST = 2000
"""Evaluations of a piece with a singular control: off its manifold such a motion may leave for infinity, and steps
become ever smaller."""


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
    """Of terminal constraints."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A piece between two switches of any control."""

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
    """Derivatives of ``after`` by the initial costates, the switching times and the final time, the piece's end moving
    with these: shape (2n, n + K + 1). Meaningless where they were not asked for."""


@dataclass(frozen=True, eq=False)
class Accuracy:
    """How arcs are integrated."""

    sizes: Array
    """Typical sizes of states and costates, shape (2n,)."""
    slopes: bool = True
    """Whether derivatives are needed."""
    tolerance: float = TOLERANCE
    """Error of a step, relative to the size of each component."""


def extremal(instance: Instance, structure: Structure, at: Unknowns, accuracy: Accuracy) -> list[Arc]:
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

    Raises
    ------
    ArithmeticError, ValueError, satsym.solvers.simulation.extrapolation.NotFinite
        If it is not finite.
    """
    n, switches = len(instance.initial), structure.switches
    z = np.concatenate([instance.initial, at.costates])
    total = np.zeros((2 * n, n + switches + 1))
    total[n:, :n] = np.eye(n)
    number, begin, begun = [0] * len(structure.levels), instance.t0, -1
    arcs: list[Arc] = []
    for event in (*structure.events(at.times), None):
        levels = tuple(row[k] for row, k in zip(structure.levels, number, strict=True))
        field = equations(instance, levels)
        end = at.end if event is None else event.time
        after, matrix = _piece(field, begin, end, z, accuracy)
        if accuracy.slopes:
            total = total.copy()
            if begun >= 0:
                total[:, begun] -= field.rates(begin, z.tolist())
            total = matrix @ total
            begun = n + switches if event is None else n + event.column
            total[:, begun] += field.rates(end, after.tolist())
        arcs.append(Arc(field, begin, end, z, after, event, total))
        z, begin = after, end
        if event is not None:
            number[event.control] += 1
    return arcs


def _piece(field: Field, start: float, end: float, z: Array, accuracy: Accuracy) -> tuple[Array, Array]:
    """States and costates at the end of a piece, and their derivatives by those at its start."""
    rows, sizes, tolerance = len(z), accuracy.sizes, accuracy.tolerance
    if abs(end - start) <= ROUNDING * max(abs(start), abs(end)):
        return z + (end - start) * np.array(field.rates(start, z.tolist())), np.eye(rows)
    evaluations = count()

    def counted() -> None:
        if next(evaluations) > MOST and field.singular is not None:
            raise ArithmeticError("the motion under singular control diverges")

    if not accuracy.slopes:

        def rates(t: float, y: Array) -> Array:
            counted()
            return np.array(field.rates(t, y.tolist()))

        return integrate(rates, np.array([start, end]), z, tolerance, sizes, WHOLE)[0].end, np.zeros(0)

    def both(t: float, y: Array) -> Array:
        counted()
        now, slopes = field.linearised(t, y[:rows].tolist())
        return np.concatenate([now, (slopes @ y[rows:].reshape(rows, rows)).ravel()])

    values = np.concatenate([z, np.eye(rows).ravel()])
    scale = np.concatenate([sizes, ROUGHLY * np.outer(sizes, 1.0 / sizes).ravel()])
    found = integrate(both, np.array([start, end]), values, tolerance, scale, WHOLE)[0].end
    return found[:rows], found[rows:].reshape(rows, rows)
