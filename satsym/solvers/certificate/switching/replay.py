"""Repeated integration of a switching extremal from its initial costates, by the exact control law.

Switching times follow from the signs of the switching functions, not from the solver; SciPy's DOP853 integrates, which
the solver does not use. Only the ends of singular arcs, which no sign shows, are taken from the solver.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array, distinct
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.switching.integration import Integration, Span
from satsym.solvers.certificate.switching.next_switch import at_once, best_level, next_switch
from satsym.solvers.certificate.switching.stated_arcs import Stated, arcs, decided_by_none, jump
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.stops import stops
from satsym.solvers.switching.structure import REST, SINGULAR, Course, Guess, Structure
from satsym.solvers.switching.throttled import equations

MOST_SWITCHES = 200

EVALUATIONS = 1_000_000
"""Maximum number of evaluations of the rates."""

ROUNDING = 1e-12
"""Magnitude of a switching function, relative to its typical value, that counts as rounding."""

TOUCHING = 1e-4
"""Largest distance of a change of sign before a singular arc, relative to the length of the arc before it, at which the
change counts as part of the junction with the singular arc."""


@dataclass(frozen=True, eq=False)
class Piece:
    """One arc of the repeated integration."""

    field: Field
    """Equations of motion, with the levels of the controls."""
    start: float
    end: float
    """Start and end of the arc."""
    before: Array
    after: Array
    """States and costates at the start and at the end of the arc, shape (2n,)."""
    switched: int | None
    """Index of the control whose switch ends the arc; ``None`` at the final time."""
    transition: Array
    """Derivatives of ``after`` with respect to ``before``, shape (2n, 2n)."""
    spread: Array
    """Derivatives of ``before`` with respect to the initial values of the flow, shifts of switching times included,
    shape (2n, 2n)."""


@dataclass(frozen=True, eq=False)
class Replay:
    """A switching extremal as integrated again."""

    pieces: list[Piece]
    """Arcs of the extremal."""
    times: Array
    z: Array
    u: Array
    """Times, states and costates, and controls at the solver's nodes and at the ends of arcs, shapes (K,), (2n, K), (m,
    K)."""
    cost: float
    """Total cost of the motion, terminal cost included."""
    gap: float = 0.0
    """Largest relative difference between values at a restart of the integration and the values reached there."""

    def along(self, piece: Piece) -> tuple[Array, Array]:
        """Return times and values on an arc, at its ends and at the nodes between."""
        inside = (self.times > piece.start) & (self.times < piece.end)
        z = np.column_stack([piece.before, self.z[:, inside], piece.after])
        return np.concatenate([[piece.start], self.times[inside], [piece.end]]), z

    def switching_times(self, control: int) -> list[float]:
        """Return the times at which one control switches."""
        return [piece.end for piece in self.pieces if piece.switched == control]


def replay(solution: Solution, within: Limits | None = None, closely: bool = False) -> Replay | None:
    """Integrate an extremal again; ``None`` if the motion is not finite or has too many switches.

    Parameters
    ----------
    closely
        Whether the integration restarts where errors grow, and switching times are taken from the solution where the
        switching function vanishes within rounding: a flat switching function does not determine its zero accurately.

    Raises
    ------
    OutOfTime, TooMuchWork
        If the limits of time or work are exceeded.
    """
    within = within or Limits(MOST_SWITCHES, float("inf"))
    limits = replace(within, work=within.meter.spent + EVALUATIONS)
    controls = range(len(solution.instance.control_set.switching[0]))
    stated = [arcs(solution, control) for control in controls]
    again = _Again(
        solution,
        stated,
        [decided_by_none(solution, control) for control in controls],
        Integration(np.concatenate(typical(solution)), limits),
        _restarts(solution, stated) if closely else [],
        closely,
    )
    try:
        return again.replayed()
    except FAILURES:
        return None


@dataclass(frozen=True, eq=False)
class _Again:
    """Data of a repeated integration."""

    solution: Solution
    """Solution whose initial costates and nodes are used."""
    stated: Stated
    """Arcs of each control as the solution states them."""
    settled: list[bool]
    """Whether the stated arcs of each control are used because no sign shows its switches."""
    by: Integration
    """Integration of the arcs."""
    anew: list[tuple[float, Array]]
    """Times at which the integration restarts, and the values there."""
    closely: bool
    """Whether stated switching times are used where signs are less accurate."""

    @property
    def instance(self) -> Instance:
        return self.solution.instance

    def replayed(self) -> Replay | None:
        """Integrate arc by arc; ``None`` if the number of switches exceeds its maximum."""
        instance, stations = self.instance, distinct(self.solution.times)
        z, t, end = (
            np.concatenate([instance.initial, self.solution.lam[:, 0]]),
            instance.t0,
            float(self.solution.times[-1]),
        )
        levels = self._first_levels(z, t, end)
        pieces: list[Piece] = []
        rows: list[tuple[Array, Array, Array]] = []
        cost = gap = 0.0
        anew: list[tuple[float, Array]] = [*self.anew, (end, z)]
        whole = True
        spread: Array = np.eye(len(z))
        while len(pieces) <= MOST_SWITCHES:
            piece, levels = self._piece(Span(equations(instance, levels), t, anew[0][0], z), spread)
            row, added = self._stations(piece, stations)
            rows.append(row)
            pieces = [*pieces, piece] if whole else [*pieces[:-1], _joined(pieces[-1], piece)]
            t, z, cost, whole = piece.end, piece.after, cost + added, piece.switched is not None
            spread = _spread(piece, equations(instance, levels))
            if any(isinstance(one, BoundaryField) for one in (piece.field, equations(instance, levels))):
                z = z + jump(self.solution, t)
            if t >= anew[0][0] and len(anew) > 1:
                (_, value), *anew = anew
                gap, z = max(gap, float((np.abs(value - z) / self.by.sizes).max())), value
                spread = np.eye(len(z))
            elif piece.switched is None:
                times, values, controls = (np.concatenate(part, axis=-1) for part in zip(*rows, strict=True))
                cost += float(instance.model.terminal_cost(t, z[: len(instance.initial)].tolist(), instance.parameters))
                return Replay(pieces, times, values, controls, cost, gap)
        return None

    def _first_levels(self, z: Array, t: float, end: float) -> tuple[int, ...]:
        """Return the levels of the controls at the start; if a switching function vanishes there, its rate decides."""
        instance, found = self.instance, []
        resting = equations(instance, (REST,) * len(self.stated))
        for i, own in enumerate(self.stated):
            if self.settled[i] or own[0][2] >= SINGULAR:
                found.append(own[0][2])
                continue
            sigma, rate = resting.switching(t, z.tolist(), i)
            weight = resting.weight(t, z.tolist(), i)
            size = max(abs(sigma), abs(weight), abs(rate) * (end - t))
            near = min(abs(abs(sigma) - weight), abs(sigma)) <= 1e-10 * size
            found.append(best_level(resting, t, z.tolist(), i, 1e-6 * (end - t) if near else 0.0))
        return tuple(found)

    def _piece(self, span: Span, spread: Array) -> tuple[Piece, tuple[int, ...]]:
        """Return the arc from a time to the next switch, and the levels after it."""
        field, start = span.field, span.start
        together = at_once(span, self.settled, self.by.sizes)
        if together is not None:
            piece = Piece(field, start, start, span.z, span.z, together[0], np.eye(len(span.z)), spread)
            return piece, _with(field.levels, *together)
        known = [
            (now[1], i, after[2])
            for i, row in enumerate(self.stated)
            for now, after in pairwise(row)
            if (self.settled[i] or max(now[2], after[2]) >= SINGULAR)
            and start + 1e-12 * span.lasting < now[1] <= span.end
        ]
        until, switched, level = min(known, default=(span.end, None, None))
        met = next_switch(span.until(until), self.settled, self.by, spread)
        touching = met is not None and met[1] == switched and until - met[0] < TOUCHING * (until - start)
        if met is not None and not touching:
            until, switched = (self._stated(span, *met) if self.closely else met[0]), met[1]
            level = None
        after, transition = self.by.transition(span.until(until))
        piece = Piece(field, start, until, span.z, after, switched, transition, spread)
        if switched is None:
            return piece, field.levels
        if level is None:
            level = best_level(field, until, after.tolist(), switched, 1e-6 * span.lasting)
        return piece, _with(field.levels, switched, level)

    def _stated(self, span: Span, found: float, control: int) -> float:
        """Return the stated time of a switch if the switching function vanishes there, else the time found."""
        near = min((end for _, end, _ in self.stated[control][:-1]), key=lambda t: abs(t - found), default=found)
        if not span.start < near < span.end:
            return found
        z = self.by.end(span.until(near)).tolist()
        field = span.field
        off = min(abs(field.passing(near, z, control, ratio)[0]) for ratio in field.ratios(control))
        size = float(np.abs(span.field.gradient(near, z, control)) @ self.by.sizes)
        return near if off <= ROUNDING * size else found

    def _stations(self, piece: Piece, nodes: Array) -> tuple[tuple[Array, Array, Array], float]:
        """Return times, values and controls of an arc at its ends and at nodes between, and its running cost."""
        field, rows, sizes = piece.field, len(piece.before), self.by.sizes
        times = np.concatenate([[piece.start], nodes[(nodes > piece.start) & (nodes < piece.end)], [piece.end]])

        def rates(t: float, y: Array) -> list[float]:
            z = y[:rows].tolist()
            return [*field.rates(t, z), field.model.running_cost(t, z[: field.n], field.control(t, z), field.p)]

        z, cost = np.stack([piece.before, piece.after], axis=1)[:, [0] * (len(times) - 1) + [1]], 0.0
        if piece.end > piece.start:
            start, scale = np.append(piece.before, 0.0), np.append(sizes, sizes[: field.n] @ sizes[field.n :])
            span = Span(field, piece.start, piece.end, piece.before)
            found = self.by.solved(rates, span, start, scale, t_eval=times)
            z[:, 1:-1], cost = found.y[:rows, 1:-1], float(found.y[rows, -1])
        return (times, z, field.along(times, z)[0]), cost


def _restarts(solution: Solution, stated: Stated) -> list[tuple[float, Array]]:
    """Return restart times and the values (2n,) there: where errors grow within arcs, and at ends of singular arcs.

    Parameters
    ----------
    stated
        Arcs of each control as the solution states them.
    """
    times, z = solution.times, np.concatenate([solution.x, solution.lam])
    structure = Structure(tuple(tuple(level for *_, level in row) for row in stated))
    switches, end = np.array([end for row in stated for _, end, _ in row[:-1]]), float(times[-1])
    course = Course(times, z)
    inside = stops(
        solution.instance,
        Guess(structure, switches, solution.lam[:, 0], end),
        course,
        np.concatenate(typical(solution)),
    )[1]
    ends = {
        until
        for row in stated
        for start, until, level in row
        if level >= SINGULAR and until < end and any(start < time < until for time in inside)
    }
    near = {int(np.abs(times - time).argmin()) for time in (*inside, *ends)}
    return [(float(times[k]), z[:, k]) for k in sorted(near)]


def _joined(first: Piece, second: Piece) -> Piece:
    """Return two parts of one arc as a single arc."""
    whole = second.transition @ first.transition
    return replace(second, start=first.start, before=first.before, transition=whole, spread=first.spread)


def _spread(piece: Piece, following: Field) -> Array:
    """Return derivatives of the values after an arc and its final switch by the initial values of the flow.

    A deviation shifts the switching time, during which the other field acts; if the rate of the switching function
    vanishes, the shift is not determined to first order, and nothing is added.
    """
    found = piece.transition @ piece.spread
    if piece.switched is None or max(piece.field.kept is not None, following.kept is not None):
        return found
    t, z, control = piece.end, piece.after.tolist(), piece.switched
    ratio = piece.field.ratio(control, (piece.field.levels[control], following.levels[control]))
    _, rate = piece.field.passing(t, z, control, ratio)
    if rate == 0.0:
        return found
    later = -(piece.field.passing_gradient(t, z, control, ratio) @ found) / rate
    jump = np.array(piece.field.rates(t, z)) - np.array(following.rates(t, z))
    return np.asarray(found + np.outer(jump, later))


def _with(levels: tuple[int, ...], control: int, level: int) -> tuple[int, ...]:
    return (*levels[:control], level, *levels[control + 1 :])
