"""Newton's method on the equations of shooting, without enclosures: the midpoint about which a proof is tried."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flint import arb

from satsym.proof.balls.arithmetic import Ball, NotProved
from satsym.proof.balls.taylor import column, rates, unit
from satsym.proof.inclusion import inverse
from satsym.proof.laws import Law
from satsym.proof.shooting import Box, Rows, Segment, Shooting
from satsym.proof.structure import REMAINDER, TERMS, leap

TRIES = 12
SETTLED_CORRECTION = 1e-8
"""A correction smaller than this, relative to the sizes, is followed by one to all digits; a second such ends."""


@dataclass(frozen=True)
class Place:
    """Nodes near an extremal, and lengths with what is listed with them."""

    nodes: list[list[Ball]]
    lengths: list[Ball]


def located(shooting: Shooting, nodes: list[list[Ball]], lengths: list[Ball], digits: int) -> Place:
    """The zero of the equations near by, to some digits more than asked for.

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
            return Place(nodes, lengths)
        if not size < 1e6 or (before < SETTLED_CORRECTION and not fine and size > 0.5 * before):
            break
        fine = fine or size < SETTLED_CORRECTION
    raise NotProved("Newton's method finds no extremal near the answer; the extremal might have another structure")


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
