"""Multiple shooting on balls: the conditions for arcs to be an extremal, and Krawczyk's operator of them.

The unknowns are the costates and free states at the start, all components at the later nodes, the lengths of arcs where
these are not given, and the multipliers of constraints at the end. The equations are: costates of free initial states
vanish; each segment leads from a node to the next; where one arc ends and another begins a condition of the former
vanishes; the conditions at the end; and, with unknown lengths and a given final time, their sum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, Key, NotProved, Series
from satsym.proof.balls.taylor import Field, Matrix, Order, Step, column, rates, step, unit
from satsym.proof.ends import End
from satsym.proof.laws import Law, derivatives
from satsym.proof.statement import Statement

MOST_STEPS = 3000
"""Largest number of integration steps in one pass over the extremal."""


@dataclass(frozen=True)
class Arc:
    """An arc: its law, and the fractions of the arc, from 0 to 1, at which nodes are; all are binary fractions."""

    law: Law
    fractions: tuple[float, ...]

    @property
    def segments(self) -> int:
        """Return the number of segments of the arc."""
        return len(self.fractions) - 1


@dataclass(frozen=True)
class Junction:
    """The junction of two arcs.

    Attributes
    ----------
    leaving, entering
        The condition of the former arc that vanishes at its end, and that of the latter at its beginning.
    order
        Order of the zero of these conditions: one with a slope, two where a boundary is touched, three where it is
        entered or left.
    vanishing
        Function from series at the node of the junction to quantities that vanish there.
    slope
        Vector of which an unknown multiple is subtracted from the costates; empty where they do not jump.
    """

    leaving: Key
    entering: Key
    order: int
    vanishing: Callable[[Sequence[Series]], list[Series]]
    slope: tuple[Ball, ...] = ()

    @classmethod
    def between(cls, law: Law, following: Law) -> Junction:
        """Return a junction at which a condition of one law vanishes with a slope."""
        key = law.leaving(following)
        return cls(key, following.leaving(law), 1, lambda z: [dict(law.conditions(z))[key]])


@dataclass(frozen=True)
class Box:
    """A box of unknowns: midpoints, and balls about zero for the distances from them.

    Attributes
    ----------
    nodes, around
        All components of each node; given components of the first node have their own radius in `nodes`.
    lengths, lengths_around
        Lengths of the arcs, after them the multiples of junctions at which costates jump, then the multipliers of
        constraints at the end.
    """

    nodes: list[list[Ball]]
    around: list[list[Ball]]
    lengths: list[Ball]
    lengths_around: list[Ball]


@dataclass(frozen=True)
class Segment:
    """The result of integration over a segment.

    Attributes
    ----------
    point
        End of the motion from the midpoint of the box.
    derivative
        Derivatives of the final components by those at the node, over the box.
    rates
        Rates of the components at the end, over the box.
    steps
        The steps of the integration.
    deviations, errors
        At the start of each step, distances of the motions from the box from the motion of its midpoint, and of this
        motion from the midpoint of the step.
    """

    point: list[Ball]
    derivative: Matrix
    rates: list[Ball]
    steps: list[Step]
    deviations: list[list[Ball]]
    errors: list[list[Ball]]


@dataclass(frozen=True)
class Pass:
    """Residuals at the midpoint of a box, their derivatives over it, and the segments of each arc."""

    residuals: Matrix
    jacobian: Matrix
    segments: list[list[Segment]]
    end: End


@dataclass(frozen=True)
class Shooting:
    """The equations of multiple shooting for a chain of arcs."""

    statement: Statement
    arcs: tuple[Arc, ...]
    junctions: tuple[Junction, ...]
    sizes: tuple[float, ...]
    """Typical magnitudes of the components, and of the cost."""
    multiplier_sizes: tuple[float, ...] = ()
    """Typical magnitudes of the multipliers of terminal constraints."""

    @property
    def lengths_given(self) -> int:
        """Return how many of the lengths are given."""
        return 0 if self.lengths_unknown else len(self.arcs)

    def multipliers(self, lengths: Sequence[Any]) -> list[Any]:
        """Return the multipliers of constraints at the end, which follow the lengths in the list."""
        return list(lengths[len(lengths) - len(self.statement.active) :])

    def scales_of_lengths(self, lengths: Sequence[Ball]) -> list[float]:
        """Return the sizes of unknown lengths, multiples and multipliers."""
        found = [abs(float(v.mid())) for v in lengths]
        least = [0.0] * (len(found) - len(self.multiplier_sizes)) + list(self.multiplier_sizes)
        return [max(v, w) for v, w in zip(found, least, strict=True)][self.lengths_given :]

    @property
    def lengths_unknown(self) -> bool:
        """Tell whether the lengths of arcs are unknown."""
        return self.statement.tf is None or len(self.arcs) > 1

    @property
    def first(self) -> list[int]:
        """Return the places of the unknown components at the start: free states and costates."""
        n = self.arcs[0].law.n
        return [*self.statement.free, *range(n, 2 * n)]

    @property
    def scales(self) -> list[float]:
        """Return the sizes of all unknowns, in order."""
        count = sum(arc.segments for arc in self.arcs)
        return [*(self.sizes[i] for i in self.first), *(list(self.sizes[:-1]) * count)]

    def unknowns(self, nodes: Sequence[Sequence[Any]], lengths: Sequence[Any]) -> list[Any]:
        """Return the unknown numbers among nodes and lengths, in order."""
        found = [*(nodes[0][i] for i in self.first), *(v for node in nodes[1:] for v in node)]
        return [*found, *lengths[self.lengths_given :]]

    def placed(self, values: Sequence[Any], nodes: list[list[Any]], lengths: list[Any]) -> tuple[Any, Any]:
        """Return nodes and lengths with new values of the unknowns."""
        m, left, first = self.arcs[0].law.m, list(values), list(nodes[0])
        for i in self.first:
            first[i] = left.pop(0)
        moved = [first]
        for _ in nodes[1:]:
            moved.append(left[:m])
            del left[:m]
        return moved, [*lengths[: self.lengths_given], *left]

    def final_time(self, lengths: Sequence[Ball]) -> Ball:
        """Return the time at which the last arc ends."""
        lengths = lengths[: len(self.arcs)]
        return self.statement.t0 + sum(lengths, arb(0)) if self.lengths_unknown else self.statement.tf

    def run(self, box: Box, order: Order) -> Pass:
        """Integrate all segments and assemble the equations.

        Raises
        ------
        NotProved
            If a segment has no enclosure.
        """
        rows = Rows(self, box)
        found, k, steps = [], 0, 0
        for j, arc in enumerate(self.arcs):
            segments = []
            for a, b in zip(arc.fractions[:-1], arc.fractions[1:], strict=True):
                share = arb(b) - arb(a)
                span, around = box.lengths[j] * share, box.lengths_around[j] * share
                one = integrated(arc.law, box.nodes[k], box.around[k], span, around, order, self.sizes)
                rows.matched(one, k, j, share, last=b == 1.0)
                segments.append(one)
                k, steps = k + 1, steps + len(one.steps)
                if steps > MOST_STEPS:
                    raise NotProved(f"more than {MOST_STEPS} steps of integration; the horizon is too long")
            found.append(segments)
            if j + 1 < len(self.arcs):
                rows.met(j, k)
        end = rows.ended(k)
        return Pass(column(rows.residuals), rows.jacobian(), found, end)


def integrated(
    law: Field,
    node: list[Ball],
    around: list[Ball],
    span: Ball,
    slack: Ball,
    order: Order,
    sizes: Sequence[float],
) -> Segment:
    """Integrate over a segment, whose length is a span plus a slack about zero.

    Raises
    ------
    NotProved
        If it has no enclosure.
    """
    middle, carried = [v.mid() for v in node], Carried.of(node)
    left, h, start = span, span, column(around)
    steps, deviations, errors = [], [], []
    while True:
        h = min(h, left, key=lambda v: float(v.mid()))
        last = not h < left
        errors.append(carried.error())
        deviations.append((carried.frame * (carried.flow * start)).entries())
        z = [a + b + c for a, b, c in zip(middle, errors[-1], deviations[-1], strict=True)]
        one, following = step(law, middle, z, left + slack if last else h, order, sizes)
        last = last and one.h.contains(left)
        steps.append(one)
        there = one.from_middle(left if last else one.h)
        middle, carried = [v.mid() for v in there], carried.after(one.derivative(), there)
        if last:
            point = [a + b for a, b in zip(middle, carried.error(), strict=True)]
            derivative = carried.frame * carried.flow
            return Segment(point, derivative, rates(law, one.reached(one.h)), steps, deviations, errors)
        left, h = left - one.h, following
        if len(steps) > MOST_STEPS:
            raise NotProved(f"more than {MOST_STEPS} steps in a segment")


@dataclass(frozen=True)
class Carried:
    """The enclosure that a motion carries along from the start of a segment, in a frame that moves with it.

    Balls about components would grow at each turn of the motion if they were in fixed axes.

    Attributes
    ----------
    frame
        An exact matrix, near the derivatives by the start.
    offset
        A ball vector: how far the motion is from the midpoints that are followed is the frame times it.
    flow
        A ball matrix near the identity: the derivatives by the start are the frame times it.
    """

    frame: Matrix
    offset: Matrix
    flow: Matrix

    @classmethod
    def of(cls, values: Sequence[Ball]) -> Carried:
        """Return the enclosure at the start of a segment, where components have these radii."""
        one = unit(len(values))
        return cls(one, column([v - v.mid() for v in values]), one)

    def error(self) -> list[Ball]:
        """Return the distance of the motion from the followed midpoints, component by component."""
        found: list[Ball] = (self.frame * self.offset).entries()
        return found

    def after(self, derivative: Matrix, there: Sequence[Ball]) -> Carried:
        """Return the enclosure after a step with these derivatives, which leads the midpoint to these balls."""
        moved, fresh = derivative * self.frame, column([v - v.mid() for v in there])
        frame = moved.mid()
        try:
            back = frame.inv()
        except ZeroDivisionError:
            return Carried(unit(len(there)), moved * self.offset + fresh, moved * self.flow)
        turned = back * moved
        return Carried(frame, turned * self.offset + back * fresh, turned * self.flow)


class Rows:
    """The equations of multiple shooting, assembled segment by segment."""

    def __init__(self, shooting: Shooting, box: Box) -> None:
        self.shooting, self.box = shooting, box
        law = shooting.arcs[0].law
        self.n, self.m = law.n, law.m
        self.residuals: list[Ball] = []
        self.rows: list[dict[int, Ball]] = []
        self.first = shooting.first
        self.lengths = len(self.first) + self.m * (len(box.nodes) - 1) - shooting.lengths_given
        """Column of the first length of an arc in the equations, counted as if all lengths were unknown."""
        for i in shooting.statement.free:  # costates of states that are free at the start vanish there
            self._add(box.nodes[0][self.n + i], {self._place(0, self.n + i): arb(1)})

    def matched(self, one: Segment, k: int, j: int, share: Ball, last: bool) -> None:
        """Add the equations that a segment leads from node k to the next; costates may jump after an arc."""
        place, jump = self._jump(j) if last else (0, ())
        for i in range(self.m):
            row = self._of_node(k, [one.derivative[i, c] for c in range(self.m)])
            row[self._place(k + 1, i)] = arb(-1)
            if self.shooting.lengths_unknown:
                row[self.lengths + j] = one.rates[i] * share
            jumped = arb(0)
            if jump and self.n <= i < 2 * self.n:
                jumped = self.box.lengths[place] * jump[i - self.n]
                row[self.lengths + place] = -jump[i - self.n]
            self._add(one.point[i] - jumped - self.box.nodes[k + 1][i], row)

    def _jump(self, j: int) -> tuple[int, tuple[Ball, ...]]:
        """Return the place of the multiple at the end of an arc, and what it multiplies."""
        junctions = self.shooting.junctions
        if j >= len(junctions) or not junctions[j].slope:
            return 0, ()
        return len(self.shooting.arcs) + sum(bool(one.slope) for one in junctions[:j]), junctions[j].slope

    def met(self, j: int, k: int) -> None:
        """Add the conditions of the junction after an arc, which vanish at its node."""
        vanishing = self.shooting.junctions[j].vanishing
        ctx.cap = 1
        there = vanishing([arb_series([v]) for v in self.box.nodes[k]])
        for v, row in zip(there, derivatives(vanishing, self._around(k)), strict=True):
            self._add(v[0], self._of_node(k, row))

    def ended(self, k: int) -> End:
        """Add the conditions at the end; return the end over the box."""
        shooting, box, m = self.shooting, self.box, self.m
        law = shooting.arcs[-1].law
        around = [v + d for v, d in zip(box.lengths, box.lengths_around, strict=True)]
        node, wide = box.nodes[k], self._around(k)
        time, times = (
            (node[-1], wide[-1]) if law.timed else (shooting.final_time(box.lengths), shooting.final_time(around))
        )
        found, _ = End.at(shooting.statement, law, node, time, shooting.multipliers(box.lengths)).residuals()
        end = End.at(shooting.statement, law, wide, times, shooting.multipliers(around))
        _, jac = end.residuals()
        for i, v in enumerate(found):
            entries = [jac[i, c] for c in range(m)]
            if law.timed:
                entries[m - 1] += jac[i, m]
            row = self._of_node(k, entries)
            if shooting.lengths_unknown and not law.timed:
                row |= {self.lengths + j: jac[i, m] for j in range(len(shooting.arcs))}
            first = self.lengths + len(box.lengths) - len(end.nu)
            row |= {first + c: jac[i, m + 1 + c] for c in range(len(end.nu))}
            self._add(v, row)
        if shooting.lengths_unknown and shooting.statement.tf is not None:
            given = shooting.statement.tf - shooting.statement.t0
            row = {self.lengths + j: arb(1) for j in range(len(shooting.arcs))}
            self._add(sum(box.lengths[: len(shooting.arcs)], arb(0)) - given, row)
        return end

    def jacobian(self) -> Matrix:
        """Return the derivatives of all residuals by all unknowns."""
        count = self.lengths + len(self.box.lengths)
        found = arb_mat(len(self.rows), count)
        for i, row in enumerate(self.rows):
            for j, v in row.items():
                found[i, j] = v
        return found

    def _around(self, k: int) -> list[Ball]:
        return [v + d for v, d in zip(self.box.nodes[k], self.box.around[k], strict=True)]

    def _place(self, k: int, i: int) -> int:
        """Return the place of component i of node k among the unknowns."""
        return self.first.index(i) if k == 0 else len(self.first) + self.m * (k - 1) + i

    def _of_node(self, k: int, entries: Sequence[Ball]) -> dict[int, Ball]:
        """Return entries by components of a node, without those that are given."""
        unknown = self.first if k == 0 else range(self.m)
        return {self._place(k, i): entries[i] for i in unknown}

    def _add(self, residual: Ball, row: dict[int, Ball]) -> None:
        self.residuals.append(residual)
        self.rows.append(row)
