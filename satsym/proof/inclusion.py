"""Krawczyk's method: a box in which the equations of shooting have exactly one solution.

The balls of that solution are then entered in the record of the proof, with those at the nodes and at the end.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Any

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof import claims
from satsym.proof.balls.arithmetic import Ball, NotProved, constant, value
from satsym.proof.balls.jets import derivatives, variables
from satsym.proof.balls.taylor import Order, column, from_zero, inverse, unit
from satsym.proof.laws import Law
from satsym.proof.record import Enclosure, Hypothesis, Node, Outcome, Proof
from satsym.proof.shooting import Box, Pass, Segment, Shooting
from satsym.proof.statement import Statement
from satsym.proof.structure import Place, started

RADII = (1e-6, 1e-8, 1e-10, 1e-12)
"""Radii of boxes about the midpoint that are tried in turn, relative to the magnitudes of the unknowns."""
COARSE = Order(18, 1e-16)
SPARE = 8
"""Number of digits that are added to the requested ones in the computation of steps and boxes."""


@dataclass(frozen=True)
class Inclusion:
    """The result of Krawczyk's operator: whether the image lies inside the box, and the image about the midpoint."""

    inside: bool
    image: list[Ball]
    passed: Pass


def krawczyk(shooting: Shooting, box: Box, order: Order) -> Inclusion:
    """Apply Krawczyk's operator; an image inside the box contains the only extremal in the box.

    Raises
    ------
    NotProved
        If the equations are singular.
    """
    passed = shooting.run(box, order)
    around = shooting.unknowns(box.around, box.lengths_around)
    c = inverse(passed.jacobian)
    image = (-(c * passed.residuals) + (unit(len(around)) - c * passed.jacobian) * column(around)).entries()
    inside = all(o.contains_interior(v) for o, v in zip(around, image, strict=True))
    return Inclusion(inside, image, passed)


@dataclass(frozen=True)
class Located:
    """The one extremal in a box, with balls that contain it."""

    box: Box
    last: Inclusion
    radius: float


def enclosed(shooting: Shooting, place: Place, digits: int) -> Located:
    """Show that an extremal exists and is the only one nearby, and enclose it to the wanted digits."""
    inclusion: Inclusion | None = None
    for radius in RADII:
        box = _box(shooting, place, radius)
        try:
            inclusion = krawczyk(shooting, box, COARSE)
        except (NotProved, ArithmeticError, ValueError):
            continue
        if inclusion.inside:
            break
    if inclusion is None or not inclusion.inside:
        raise NotProved(
            "existence: no box around the solution is mapped into itself; more digits or a more accurate solution "
            "may help"
        )
    for spare in (SPARE, 2 * SPARE):
        order = Order(max(18, int(1.1 * (digits + spare))), 10.0 ** -(digits + spare))
        box = _box(shooting, place, min(radius / 2, 10.0 ** -(digits / 2 + SPARE)))  # it lies in the former one
        last = krawczyk(shooting, box, order)
        if last.inside:
            break
    else:
        raise NotProved("the extremal could not be enclosed to all requested digits; request fewer digits")
    lengths = zip(box.lengths, box.lengths_around, strict=True)
    if not all(a + b > 0 for a, b in list(lengths)[: len(shooting.arcs)]):
        raise NotProved("an arc has no positive length")
    return Located(box, last, radius)


def _box(shooting: Shooting, place: Place, radius: float) -> Box:
    """Return the box of a radius, relative to the sizes of the unknowns, about the midpoint of a proof."""
    nodes = _exact(shooting, place.nodes)
    zero, none = [[arb(0)] * len(node) for node in nodes], [arb(0)] * len(place.lengths)
    values = [arb(0, radius * s) for s in (*shooting.scales, *shooting.scales_of_lengths(place.lengths))]
    around, lengths = shooting.placed(values, zero, none)
    return Box(nodes, around, place.lengths, lengths)


def _exact(shooting: Shooting, nodes: list[list[Any]]) -> list[list[Any]]:
    """Return nodes whose given initial components have the problem's exact values."""
    n, law = shooting.arcs[0].law.n, shooting.arcs[0].law
    first = started(shooting.statement, nodes[0], n)
    return [[*first[: 2 * n], *([shooting.statement.t0] if law.timed else [])], *nodes[1:]]


MOST_NODES = 9
"""Largest number of nodes in the record of a proof."""


def entered(record: Proof, shooting: Shooting, there: Located) -> Proof:
    """Enter the enclosures of an extremal that exists in the record of its proof."""
    box, last, radius = there.box, there.last, there.radius
    here = shooting.unknowns(box.nodes, box.lengths)
    nodes, lengths = shooting.placed([a + v for a, v in zip(here, last.image, strict=True)], box.nodes, box.lengths)
    statement, law = shooting.statement, shooting.arcs[0].law
    states, n, digits = statement.spec.state_names, law.n, record.digits
    begun = statement.t0 if statement.clock is None else nodes[0][statement.clock]

    def row(values: list[Ball]) -> dict[str, Enclosure]:
        return {name: Enclosure.of(v, digits) for name, v in zip(states[: statement.own], values, strict=False)}

    times, fractions = _times(shooting, lengths, begun), sum(arc.segments for arc in shooting.arcs)
    kept = sorted({round(k * fractions / (MOST_NODES - 1)) for k in range(MOST_NODES)})
    final = shooting.final_time(lengths) if statement.clock is None else nodes[-1][statement.clock]
    ends = [sum(lengths[: j + 1], begun) for j in range(len(shooting.arcs) - 1)]
    cost = _cost(shooting, box, last, _share(shooting, box, last))
    last_state = [constant(v) for v in nodes[-1][:n]]
    objective = cost + value(statement.kernel.terminal_cost(constant(final), last_state, statement.p))
    shown = Hypothesis(
        "an extremal exists and is unique in a neighbourhood",
        f"Krawczyk's operator maps a box of {len(here)} unknowns into itself ({fractions} segments, "
        f"{sum(len(s.steps) for arc in last.passed.segments for s in arc)} steps)",
        f"radius {radius:.0e} relative to the sizes of the unknowns",
    )
    return replace(
        record,
        hypotheses=(*record.hypotheses, shown),
        costate_initial=row(nodes[0][n : 2 * n]),
        nodes=tuple(Node(Enclosure.of(times[k], digits), row(nodes[k][:n]), row(nodes[k][n : 2 * n])) for k in kept),
        x_final=row(nodes[-1][:n]),
        t_final=Enclosure.of(final, digits),
        objective=Enclosure.of(-objective if statement.spec.maximise else objective, digits),
        switching_times=tuple(Enclosure.of(v, digits) for v in ends),
        numbers={**record.numbers, **_found(statement, nodes[0], digits)},
        unique_within=radius,
    )


def _found(statement: Statement, start: list[Ball], digits: int) -> dict[str, str]:
    """Return free parameters and a free initial time, named as the record's numbers are."""
    more = [i for i in statement.free if i >= statement.own]
    called = {i: "time.t0" if i == statement.clock else f"parameters.{statement.spec.states[i].symbol}" for i in more}
    return {name: f"free; {Enclosure.of(start[i], digits).text} is best" for i, name in called.items()}


def jumps(shooting: Shooting, there: Located) -> list[Ball]:
    """Return, by junction, the multiples of path constraints' gradients by which costates fall."""
    box = there.box
    here = shooting.unknowns(box.nodes, box.lengths)
    _, found = shooting.placed([a + v for a, v in zip(here, there.last.image, strict=True)], box.nodes, box.lengths)
    return list(found[len(shooting.arcs) : len(found) - len(shooting.statement.active)])


def at_rest(record: Proof, statement: Statement, end: list[Ball], steps: int) -> Proof:
    """Return the record of a problem in which zero control is optimal."""
    names, digits = statement.spec.state_names, record.digits
    zero = Enclosure("0", "0")
    return replace(
        record,
        status=Outcome.PROVED,
        hypotheses=claims.of_rest(steps),
        theorem=claims.REST,
        scope=claims.scope(statement),
        costate_initial=dict.fromkeys(names, zero),
        x_final={name: Enclosure.of(v, digits) for name, v in zip(names, end, strict=True)},
        t_final=Enclosure.of(statement.tf, digits),
        objective=zero,
    )


def _times(shooting: Shooting, lengths: list[Ball], begun: Ball) -> list[Ball]:
    """Return the times of the nodes."""
    found = [begun]
    begins = accumulate(lengths, initial=begun)
    for arc, begin, length in zip(shooting.arcs, begins, lengths, strict=False):
        found += [begin + length * arb(f) for f in arc.fractions[1:]]
    return found


def _share(shooting: Shooting, box: Box, last: Inclusion) -> Ball:
    """Return a factor that, times the box, covers the image of the box."""
    around = shooting.unknowns(box.around, box.lengths_around)
    parts = [(v.abs_upper() / w.rad()).abs_upper() for v, w in zip(last.image, around, strict=True) if w.rad() > 0]
    return max(parts, key=lambda v: float(v.mid()), default=arb(0))


def _cost(shooting: Shooting, box: Box, last: Inclusion, share: Ball) -> Ball:
    """Return the running cost of the extremal: that of the midpoint's motion, with a bound for the rest of the box."""
    total = arb(0)
    for j, (arc, segments) in enumerate(zip(shooting.arcs, last.passed.segments, strict=True)):
        slack = box.lengths_around[j] * share
        for segment, a, b in zip(segments, arc.fractions[:-1], arc.fractions[1:], strict=True):
            total += _along(arc.law, segment, share, box.lengths[j] * (arb(b) - arb(a)), slack)
    return total


def _along(law: Law, segment: Segment, share: Ball, span: Ball, slack: Ball) -> Ball:
    total, left, final = arb(0), span, len(segment.steps) - 1
    for number, step in enumerate(segment.steps):
        total += step.cost(left if number == final else step.h)
        off = [share * d + e for d, e in zip(segment.deviations[number], segment.errors[number], strict=True)]
        moved = (step.derivative(from_zero(step.h)) * arb_mat(len(off), 1, off)).entries()
        slopes = _cost_gradient(law, step.range)
        change = sum((abs(g) * abs(v) for g, v in zip(slopes, moved, strict=True)), arb(0))
        total += arb(0, (change * step.h).abs_upper())
        left = left - step.h
    ctx.cap = 1
    rate = value(law.cost([arb_series([v]) for v in segment.steps[-1].range]))
    return total + arb(0, (rate * slack).abs_upper())


def _cost_gradient(law: Law, z: list[Ball]) -> list[Ball]:
    """Return the derivatives of the running cost under the law, over a ball."""
    given = variables(z)
    return derivatives(lambda: law.cost(given), len(z))[1]
