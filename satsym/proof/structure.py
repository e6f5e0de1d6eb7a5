"""The point at which a proof looks for the extremal; nothing here is part of the proof.

The arcs of a solver's answer are recognised, nodes are placed on them, and Newton's method finds a zero of the
equations of shooting near these nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Any

import numpy as np
from flint import arb, arb_series, ctx

from satsym.proof import walls
from satsym.proof.balls.arithmetic import Ball, BeyondProof, NotProved, balls
from satsym.proof.balls.taylor import column, expand, expand_flow, inverse, polynomial, rates, unit
from satsym.proof.ends import End
from satsym.proof.laws import AtLevels, Law, Regular, Throttled
from satsym.proof.shooting import Arc, Box, Junction, Rows, Segment, Shooting
from satsym.proof.statement import Statement, walled
from satsym.solution import Solution

GROWTH = 20.0
"""Largest growth factor of errors along a segment, relative to the magnitudes of components.

A segment with a larger growth is divided.
"""
FINEST = 2.0**-24
"""The fractions of an arc at which nodes are placed are multiples of this number."""
TERMS, REMAINDER = 16, 1e-15
NEAR_LEVEL = 1e-6
"""Largest distance of a control from a constant level that it is taken to have, relative to the distance of levels."""
TOGETHER = 1e-9
"""Distance from a switching time, as a fraction of the duration, within which the solver's nodes are ignored."""
NEAR_ANSWER = 1e-3
"""Largest distance between the proved extremal and the numerical solution, relative to the magnitudes.

It is measured in initial costates and duration; a larger distance makes the proof fail.
"""
TRIES = 12
"""Largest number of Newton corrections of the midpoint."""

SETTLED_CORRECTION = 1e-8
"""Relative size of a correction below which only one further correction, with all digits, follows."""


class Path:
    """A solver's answer as a function of time: states and costates between its nodes."""

    def __init__(self, found: Solution, timed: bool) -> None:
        if not (np.isfinite(found.x).all() and np.isfinite(found.lam).all()):
            raise NotProved("the solution contains no costates")
        keep = np.append(np.diff(found.times) > 0.0, True)
        self.times = np.asarray(found.times)[keep]
        rows = [np.asarray(found.x)[:, keep], np.asarray(found.lam)[:, keep]]
        self.values = np.vstack([*rows, self.times]) if timed else np.vstack(rows)
        self.controls = np.asarray(found.u)

    def __call__(self, t: float) -> list[Ball]:
        return [arb(float(np.interp(t, self.times, row))) for row in self.values]


@dataclass(frozen=True)
class Place:
    """Nodes near an extremal, with lengths of arcs, multiples and multipliers."""

    nodes: list[list[Ball]]
    lengths: list[Ball]


def begun(statement: Statement, found: Solution, digits: int) -> tuple[Shooting, Place]:
    """Return the equations of the arcs that were found, and a point at which they nearly hold."""
    path = Path(found, not statement.spec.autonomous)
    jumps: list[float] = []
    if walled(statement):
        laws, junctions, times, jumps = walls.structured(statement, found)
    elif statement.spec.path_constraints:
        laws, junctions, times = walls.structured_mixed(statement, found)
    else:
        laws, times = arcs(statement, found, path)
        junctions = [Junction.between(a, b) for a, b in pairwise(laws)]
    sizes = sizes_of(statement, found, path)
    chain, nodes, lengths = placed(laws, times, path, sizes)
    nu, of_multipliers = multipliers(statement, laws[-1], nodes[-1], arb(times[-1]), sizes)
    shooting = Shooting(statement, tuple(chain), tuple(junctions), tuple(sizes), of_multipliers)
    n = laws[0].n
    nodes[0] = started(statement, nodes[0], n)
    if laws[0].timed:
        nodes[0][-1] = statement.t0
    if not shooting.lengths_unknown:
        lengths = [statement.tf - statement.t0]
    place = _settled(shooting, nodes, [*lengths, *map(arb, jumps), *nu], digits)
    moved = [abs(float((a - b).mid())) / s for a, b, s in zip(place.nodes[0], nodes[0], sizes, strict=False)]
    moved = moved[: n + statement.own]  # what an answer says nothing of is left out
    horizon = sum(place.lengths[: len(chain)], arb(0)) / sum(lengths, arb(0)) - 1
    if max(*moved, abs(float(horizon.mid()))) > NEAR_ANSWER:
        raise NotProved("the solution is not an extremal: the nearest extremal has different costates")
    return shooting, place


def started(statement: Statement, node: list[Any], n: int) -> list[Any]:
    """Return a first node with the given initial states."""
    return [statement.initial[i] if i < n and i not in statement.free else v for i, v in enumerate(node)]


def arcs(statement: Statement, found: Solution, path: Path) -> tuple[list[Law], list[float]]:
    """Return the laws in order, and the times at which arcs begin and end.

    Raises
    ------
    BeyondProof
        If controls are neither at a bound nor given by the law.
    """
    spec = statement.spec
    if spec.switching:
        return _held(statement, found)
    kind = Throttled if any(part.branch == "throttled" for part in spec.control_parts) else Regular
    return _regular(statement, found, path, kind)


def _regular(statement: Statement, found: Solution, path: Path, kind: type[Regular]) -> tuple[list[Law], list[float]]:
    ctx.cap = 1
    seen: list[tuple[float, Regular]] = []
    known: dict[Any, Regular] = {}
    near = TOGETHER * float(path.times[-1] - path.times[0])
    ends = np.array(sorted(t for times in found.switching_times for t in times))
    for k, t in enumerate(path.times):
        if ends.size and np.abs(ends - t).min() < near:
            continue
        law = kind(statement.kernel, statement.p, statement.bounds)
        z = [arb_series([arb(float(v))]) for v in path.values[:, k]]
        law.rates(z), law.jacobian(z), law.cost(z), kind.control(law, z)  # each learns how its comparisons come out
        seen.append((float(t), known.setdefault(law.state(), law)))
    if not seen:
        raise NotProved("the solution contains no nodes")
    laws: list[Law] = []
    times = [float(path.times[0])]
    previous = times[0]
    for law, group in groupby(seen, key=lambda item: item[1]):
        members = list(group)
        if laws:
            between = ends[(ends >= previous) & (ends <= members[0][0])] if ends.size else ends
            times.append(float(between[0]) if len(between) == 1 else (previous + members[0][0]) / 2)
        fresh = kind(statement.kernel, statement.p, statement.bounds)
        fresh.answers.given.update(law.answers.given)
        laws.append(fresh)
        previous = members[-1][0]
    return laws, [*times, float(path.times[-1])]


def _held(statement: Statement, found: Solution) -> tuple[list[Law], list[float]]:
    """Return the arcs of controls that switch between levels."""
    levels = []
    ctx.cap = 1
    weighed = _weighed(statement, found)
    for low, high, costs in zip(statement.lower, statement.upper, weighed, strict=True):
        if isinstance(low, float) or isinstance(high, float):
            raise BeyondProof("a control without bounds whose square does not enter the cost")
        levels.append([low, arb(0), high] if costs and low < 0 and high > 0 else [low, high])
    times, controls = np.asarray(found.times), np.asarray(found.u)
    kept: list[tuple[float, float, tuple[int, ...]]] = []
    for t, after, u, then in zip(times[:-1], times[1:], controls.T[:-1], controls.T[1:], strict=True):
        if after > t:
            kept.append((float(t), float(after), tuple(map(_level, u, then, levels))))
    laws: list[Law] = []
    ends = [float(times[0])]
    for held, group in groupby(kept, key=lambda item: item[2]):
        members = list(group)
        if -1 in held:
            if members[-1][1] - members[0][0] > 0.01 * float(times[-1] - times[0]):
                raise BeyondProof("an arc on which a control is at none of its bounds (singular)")
            continue
        if laws and isinstance(laws[-1], AtLevels) and laws[-1].held == held:
            ends[-1] = members[-1][1]
            continue
        if laws:
            ends[-1] = (ends[-1] + members[0][0]) / 2
        laws.append(AtLevels(statement.kernel, statement.p, levels, held))
        ends.append(members[-1][1])
    if not laws:
        raise NotProved("no arc of the controls is known")
    ends[-1] = float(times[-1])
    return laws, ends


def _weighed(statement: Statement, found: Solution) -> list[bool]:
    """Tell whether the magnitude of each control has a weight in the cost."""
    z = [arb_series([arb(float(v[0]))]) for v in (*found.x, *found.lam)]
    t, n = arb_series([arb(float(found.times[0]))]), len(found.x)
    weights = statement.kernel.magnitude_weight(t, z[:n], z[n:], statement.p)
    return [not v.contains(0) for v in balls(weights)]


def _level(u: float, then: float, levels: Sequence[Ball]) -> int:
    values = [float(v.mid()) for v in levels]
    width = values[-1] - values[0]
    for k, v in enumerate(values):
        if abs(u - v) < NEAR_LEVEL * width and abs(then - v) < NEAR_LEVEL * width:
            return k
    return -1


def placed(
    laws: Sequence[Law], times: Sequence[float], path: Path, sizes: Sequence[float]
) -> tuple[list[Arc], list[list[Ball]], list[Ball]]:
    """Place nodes between which errors grow little; return arcs with nodes, components there, and lengths of arcs."""
    found, nodes, lengths = [], [path(times[0])], []
    for law, begin, end in zip(laws, times[:-1], times[1:], strict=True):
        length, fractions = end - begin, [0.0]
        while fractions[-1] < 1.0:
            left = length * (1.0 - fractions[-1])
            reached = _far(law, nodes[-1], left, sizes)
            following = fractions[-1] + max(math.floor(reached / length / FINEST), 1) * FINEST
            fractions.append(1.0 if reached >= left else min(following, 1.0))
            nodes.append(path(end if fractions[-1] == 1.0 else begin + length * fractions[-1]))
        found.append(Arc(law, tuple(fractions)))
        lengths.append(arb(length))
    return found, nodes, lengths


def _far(law: Law, start: list[Ball], left: float, sizes: Sequence[float]) -> float:
    """Return the time from a start in which errors grow as much as allowed, up to the time that is left."""
    m, t, z, flow = law.m, 0.0, start, unit(law.m)
    while True:
        z, v, h, whole = leap(law, z, arb(left - t), sizes)
        flow, t = (v * flow).mid(), t + float(h)
        grown = max(abs(float(flow[i, j].mid())) * sizes[j] / sizes[i] for i in range(m) for j in range(m))
        if whole or grown > GROWTH:
            return left if whole else t


def leap(
    law: Law, z: Sequence[Ball], most: Ball, sizes: Sequence[float], terms: int = TERMS, rest: float = REMAINDER
) -> tuple[list[Ball], Any, Ball, bool]:
    """Take a step without enclosures; return its end, derivatives, length, and whether it is as long as requested."""
    series = expand(law, [v.mid() for v in z], terms)
    last = max(abs(float(s[terms].mid())) / size for s, size in zip(series, sizes, strict=False))
    if not math.isfinite(last):
        raise NotProved("the motion from the given costates is not finite")
    longest = 0.8 * (rest / last) ** (1 / terms) if last else math.inf
    whole = float(most.mid()) <= longest
    h = most.mid() if whole else arb(longest)
    flow = polynomial(expand_flow(law, series, unit(law.m), terms // 2), h)
    there = [polynomial([s[k] for k in range(terms + 1)], h).mid() for s in series]
    return there, flow.mid(), h, whole


def multipliers(
    statement: Statement, law: Law, z: Sequence[Ball], time: Ball, sizes: Sequence[float]
) -> tuple[list[Ball], tuple[float, ...]]:
    """Return least-squares multipliers of constraints at the end, with lower bounds of their sizes."""
    if not statement.active:
        return [], ()
    n, zero = law.n, [arb(0)] * len(statement.active)
    end = End.at(statement, law, [v.mid() for v in z], time, zero)
    residuals, jac = end.residuals()
    slopes = np.array([[float(jac[i, law.m + 1 + k].mid()) for k in range(len(zero))] for i in range(len(residuals))])
    wanted = np.array([-float(v.mid()) for v in residuals])
    lines = np.abs(slopes).max(axis=1) > 0.0
    scale = np.where(lines, np.maximum(np.abs(slopes).max(axis=1), 1e-300), 1.0)
    nu = np.linalg.lstsq(slopes[lines] / scale[lines, None], wanted[lines] / scale[lines], rcond=None)[0]
    reach = [max(abs(float(row[j].mid())) * sizes[j] for j in range(n)) for _, row in end.ties]
    return [arb(float(v)) for v in nu], tuple(1e-3 * sizes[-1] / r if r > 0.0 else 0.0 for r in reach)


def sizes_of(statement: Statement, found: Solution, path: Path) -> list[float]:
    """Return the sizes of components and cost: the largest values, at least a fraction of the largest of their kind."""
    n = (len(path.values)) // 2
    largest = [float(v) for v in np.abs(path.values).max(axis=1)]
    groups = (largest[:n], largest[n : 2 * n], largest[2 * n :])
    costs = statement.case.model.running_cost_batch(
        found.times, found.x[: statement.own], found.u, found.instance.parameters
    )
    cost = float(np.trapezoid(np.abs(np.broadcast_to(costs, found.times.shape)), found.times))
    return [*(max(v, 1e-9 * max(group)) or 1.0 for group in groups for v in group), cost or 1.0]


def _settled(shooting: Shooting, nodes: list[list[Ball]], lengths: list[Ball], digits: int) -> Place:
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
            return Place(nodes, lengths)
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
