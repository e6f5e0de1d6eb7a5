"""The proof, on one page, that an extremal near a solver's answer is a strict local minimum."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

from flint import arb, ctx

from satsym.instance import Instance
from satsym.proof import claims, inclusion, structure, walls
from satsym.proof.balls.arithmetic import Ball, BeyondProof, NotProved
from satsym.proof.balls.taylor import Order, column, rates, unit
from satsym.proof.field import regular_field
from satsym.proof.global_minimum import convex, costs_nothing, final_state, waiting
from satsym.proof.identities import verify
from satsym.proof.inclusion import Inclusion, inverse, krawczyk
from satsym.proof.laws import Law
from satsym.proof.lifting import Lifted, with_more_states
from satsym.proof.record import Hypothesis, Outcome, Proof
from satsym.proof.shooting import Box, Junction, Rows, Segment, Shooting
from satsym.proof.signs import hold, unique
from satsym.proof.statement import Statement, refuse, stated, walled
from satsym.proof.structure import REMAINDER, TERMS, leap
from satsym.solution import Solution

RADII = (1e-6, 1e-8, 1e-10, 1e-12)
"""Radii of boxes about the midpoint that are tried in turn, relative to the magnitudes of the unknowns."""
NEAR_ANSWER = 1e-3
"""Largest distance between the proved extremal and the numerical solution, relative to the magnitudes.

It is measured in initial costates and duration; a larger distance makes the proof fail.
"""

COARSE = Order(18, 1e-16)
SPARE = 8
"""Number of digits that are added to the requested ones in the computation of steps and boxes."""

TRIES = 12
"""Largest number of Newton corrections of the midpoint."""

SETTLED_CORRECTION = 1e-8
"""Relative size of a correction below which only one further correction, with all digits, follows."""


def prove(case: Instance, find: Callable[[], Solution], digits: int = 20) -> Proof:
    """Prove that near an answer there is one extremal, and that it is a strict strong local minimum.

    Parameters
    ----------
    case
        The problem as it was stated.
    find
        Function that solves the problem, so that the proof knows where to look; no claim of the solution is used. It
        is called only if a theorem covers the problem.
    digits
        Significant digits of the enclosures.

    Returns
    -------
    Proof
        The record of the proof; if nothing is proved, ``status`` and ``reason`` say why.
    """
    begun = time.perf_counter()
    record = _tried(Proof(case.model.spec.name, case.called, Outcome.NOT_PROVED, digits=digits), partial(_first, case))
    if not record.reason and record.status is Outcome.NOT_PROVED:
        found = find()
        begun = time.perf_counter()
        record = _tried(record, partial(_proved, case, found))
    return replace(record, wall_s=time.perf_counter() - begun)


def _tried(record: Proof, attempt: Callable[[Proof], Proof]) -> Proof:
    """Return the record after an attempt, with the reason if the attempt ends without a proof."""
    try:
        with _precision(record.digits):
            return attempt(record)
    except BeyondProof as error:
        return replace(record, status=Outcome.BEYOND, reason=str(error))
    except NotProved as error:
        return replace(record, reason=str(error))
    except _Stopped as stopped:
        return replace(stopped.record, reason=stopped.reason)
    except (ArithmeticError, ValueError) as error:
        return replace(record, reason=f"the motion is singular near the solution ({error})")


def _first(case: Instance, record: Proof) -> Proof:
    """Return what is known before solving: that a theorem covers the problem, or that zero control is optimal."""
    refuse(case)
    statement = stated(case)
    record = replace(record, numbers=dict(statement.source.stated))
    if walled(statement) and not convex(statement):
        raise BeyondProof("path constraints of a problem that is not convex")
    return _at_rest(statement, record) if costs_nothing(statement) else record


def _at_rest(statement: Statement, record: Proof) -> Proof:
    """Prove a problem for which zero control is optimal."""
    sizes = [max(abs(float(v.mid())), 1e-3) for v in statement.initial]
    order = Order(max(18, int(1.1 * (record.digits + SPARE))), 10.0 ** -(record.digits + SPARE))
    end, steps = final_state(statement, order, [*sizes, 1.0])
    return inclusion.at_rest(record, statement, end, steps)


class _Stopped(Exception):
    """The proof ended after some hypotheses were shown."""

    def __init__(self, record: Proof, reason: str) -> None:
        super().__init__(reason)
        self.record, self.reason = record, reason


@contextmanager
def _precision(digits: int) -> Iterator[None]:
    """Set arithmetic to enough bits; the setting is flint's own, for the whole process."""
    before = ctx.prec, ctx.cap
    ctx.prec = 90 + int(3.6 * digits)
    try:
        yield
    finally:
        ctx.prec, ctx.cap = before


@dataclass(frozen=True)
class Located:
    """The one extremal in a box, with balls that contain it."""

    shooting: Shooting
    box: Box
    last: Inclusion
    radius: float


def _proved(case: Instance, found: Solution, record: Proof) -> Proof:
    if not found.status.answered:
        raise NotProved(f"there is no solution to start the proof from: {found.message}")
    statement = stated(case, found.instance.met, found.x[:, -1].tolist())
    record = replace(record, numbers=dict(statement.source.stated))
    if isinstance(statement.kernel, Lifted):
        found = with_more_states(statement.kernel, found, statement.p)
    shooting, place = _begun(statement, found, record.digits)
    for arc in shooting.arcs:
        verify(statement, arc.law, place.nodes, shooting.sizes)
    there = _enclosed(shooting, place, record.digits)
    record = inclusion.entered(record, there.shooting, there.box, there.last, there.radius)
    passed, convexity = there.last.passed, convex(statement)
    steps: list[Callable[[], Hypothesis]] = [
        lambda: claims.of_signs(hold(shooting, passed)),
        lambda: claims.of_minimiser(unique(shooting, passed)),
        lambda: claims.of_ends(statement, passed.end),
    ]
    if walled(statement):
        steps.append(lambda: claims.of_jumps(inclusion.jumps(shooting, there.box, there.last)))
    else:
        steps.append(lambda: claims.of_field(regular_field(shooting, passed)))
    for one in steps:
        try:
            record = replace(record, hypotheses=(*record.hypotheses, one()))
        except NotProved as error:
            raise _Stopped(record, str(error)) from None
    laws = [arc.law for arc in shooting.arcs]
    theorem = claims.theorem(statement, laws, there.radius, convexity, waiting(statement))
    return replace(record, status=Outcome.PROVED, theorem=theorem, scope=claims.scope(statement))


def _begun(statement: Statement, found: Solution, digits: int) -> tuple[Shooting, _Place]:
    """Return the equations of the arcs that were found, and a point at which they nearly hold."""
    path = structure.Path(found, not statement.spec.autonomous)
    jumps: list[float] = []
    if walled(statement):
        laws, junctions, times, jumps = walls.structured(statement, found)
    elif statement.spec.path_constraints:
        laws, junctions, times = walls.structured_mixed(statement, found)
    else:
        laws, times = structure.arcs(statement, found, path)
        junctions = [Junction.between(a, b) for a, b in pairwise(laws)]
    sizes = structure.sizes_of(statement, found, path)
    arcs, nodes, lengths = structure.placed(laws, times, path, sizes)
    nu, of_multipliers = structure.multipliers(statement, laws[-1], nodes[-1], arb(times[-1]), sizes)
    shooting = Shooting(statement, tuple(arcs), tuple(junctions), tuple(sizes), of_multipliers)
    n = laws[0].n
    nodes[0] = _started(statement, nodes[0], n)
    if laws[0].timed:
        nodes[0][-1] = statement.t0
    if not shooting.lengths_unknown:
        lengths = [statement.tf - statement.t0]
    place = _located(shooting, nodes, [*lengths, *map(arb, jumps), *nu], digits)
    moved = [abs(float((a - b).mid())) / s for a, b, s in zip(place.nodes[0], nodes[0], sizes, strict=False)]
    moved = moved[: n + statement.own]  # what an answer says nothing of is left out
    horizon = sum(place.lengths[: len(arcs)], arb(0)) / sum(lengths, arb(0)) - 1
    if max(*moved, abs(float(horizon.mid()))) > NEAR_ANSWER:
        raise NotProved("the solution is not an extremal: the nearest extremal has different costates")
    return shooting, place


def _enclosed(shooting: Shooting, place: _Place, digits: int) -> Located:
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
    return Located(shooting, box, last, radius)


def _box(shooting: Shooting, place: _Place, radius: float) -> Box:
    zero = [[arb(0)] * len(node) for node in place.nodes]
    box = Box(_exact(shooting, place.nodes), zero, place.lengths, [arb(0)] * len(place.lengths))
    around = [arb(0, radius * s) for s in (*shooting.scales, *shooting.scales_of_lengths(box.lengths))]
    return _around(shooting, box, around)


def _exact(shooting: Shooting, nodes: list[list[Any]]) -> list[list[Any]]:
    """Return nodes whose given initial components have the problem's exact values."""
    n, law = shooting.arcs[0].law.n, shooting.arcs[0].law
    first = _started(shooting.statement, nodes[0], n)
    return [[*first[: 2 * n], *([shooting.statement.t0] if law.timed else [])], *nodes[1:]]


def _started(statement: Statement, node: list[Any], n: int) -> list[Any]:
    """Return a first node with the given initial states."""
    return [statement.initial[i] if i < n and i not in statement.free else v for i, v in enumerate(node)]


def _around(shooting: Shooting, box: Box, values: list[Any]) -> Box:
    zero = [[arb(0)] * len(node) for node in box.nodes]
    around, lengths = shooting.placed(values, zero, [arb(0)] * len(box.lengths))
    return Box(box.nodes, around, box.lengths, lengths)


@dataclass(frozen=True)
class _Place:
    """Nodes near an extremal, with lengths of arcs, multiples and multipliers."""

    nodes: list[list[Ball]]
    lengths: list[Ball]


def _located(shooting: Shooting, nodes: list[list[Ball]], lengths: list[Ball], digits: int) -> _Place:
    """Return the midpoint of a proof: a zero of the equations of shooting, to more digits than requested.

    Newton's method finds it without enclosures.

    Raises
    ------
    NotProved
        If Newton's method does not settle.
    """
    size, fine = float("inf"), False
    for _ in range(TRIES):
        terms, rest = (int(1.2 * digits) + 12, 10.0 ** -(digits + 12)) if fine else (TERMS, REMAINDER)
        residuals, jacobian = _equations(shooting, nodes, lengths, terms, rest)
        move = [v.mid() for v in (inverse(jacobian) * residuals).entries()]
        scales = [*shooting.scales, *shooting.scales_of_lengths(lengths)]
        before, size = size, max(abs(float(v)) / s for v, s in zip(move, scales, strict=True))
        here = shooting.unknowns(nodes, lengths)
        nodes, lengths = shooting.placed([(a - b).mid() for a, b in zip(here, move, strict=True)], nodes, lengths)
        if fine and size < SETTLED_CORRECTION:
            return _Place(nodes, lengths)
        if not size < 1e6 or (before < SETTLED_CORRECTION and not fine and size > 0.5 * before):
            break
        fine = fine or size < SETTLED_CORRECTION
    raise NotProved("Newton's method finds no extremal near the solution; the extremal might have another structure")


def _equations(
    shooting: Shooting, nodes: list[list[Ball]], lengths: list[Ball], terms: int, rest: float
) -> tuple[Any, Any]:
    m = shooting.arcs[0].law.m
    zero = [[arb(0)] * m for _ in nodes]
    box = Box([[v.mid() for v in node] for node in nodes], zero, lengths, [arb(0)] * len(lengths))
    rows, k = Rows(shooting, box), 0
    for j, arc in enumerate(shooting.arcs):
        for a, b in zip(arc.fractions[:-1], arc.fractions[1:], strict=True):
            span = (box.lengths[j] * (arb(b) - arb(a))).mid()
            one = _led(arc.law, box.nodes[k], span, shooting.sizes, terms, rest)
            rows.matched(one, k, j, arb(b) - arb(a), b == 1.0)
            k += 1
        if j + 1 < len(shooting.arcs):
            rows.met(j, k)
    rows.ended(k)
    return column(rows.residuals).mid(), rows.jacobian().mid()


def _led(law: Law, node: list[Ball], span: Ball, sizes: tuple[float, ...], terms: int, rest: float) -> Segment:
    z, flow, left = node, unit(law.m), span
    while True:
        z, v, h, last = leap(law, z, left, sizes, terms, rest)
        flow = (v * flow).mid()
        if last:
            return Segment(z, flow, [r.mid() for r in rates(law, z)], [], [], [])
        left = (left - h).mid()
