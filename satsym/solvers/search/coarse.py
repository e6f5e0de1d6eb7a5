"""Starts, solved on a coarse mesh one after the other, and what motions that last a given time cost there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp, starts
from satsym.solvers.search.arriving import arrived, arriving
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.mesh import graded
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import Plan
from satsym.solvers.search.transcription import LONGEST_DURATION, SHORTEST_DURATION

STARTS = 48
"""Starts that are tried at most."""

ITERATIONS, ASTRAY = 300, 50
"""Iterations of the interior-point code for a start; and for a competitor on a bent way to a drawn end, which need not
lead anywhere: such a motion is found soon or hardly ever."""

WEAK, NEARLY_WITHIN = 7, 1.5
"""Starts after which those come that begin without bounds of controls, and the largest controls of such a motion,
relative to their bounds, from which one within these is looked for."""

PRICED = 3
"""Starts from which what a given duration costs is looked for: hardly any matter where it can be reached at all."""

EDGE = 1e-2
"""By what share a free duration may be off the longest or the shortest that is looked at, to be taken for that."""

INTERVALS, FEWEST = 40, 8
"""Number of intervals of the coarse mesh, and the least number in a phase."""

FIRST_SMOOTHINGS = (1e-1, 1e-2, 1e-3)
"""Smoothings of norms on the coarse mesh: fuel alone decides little between bounds, and effort much."""

SIMILAR = 1e-4
"""Relative difference of costs on a coarse mesh that may be of one motion."""


def started(
    instance: Instance,
    limits: Limits,
    loose: str,
    most: int = ITERATIONS,
    way: tuple[Array, Array] | None = None,
    weak: bool = False,
    first: int = 0,
) -> Iterator[tuple[Plan, Found]]:
    """What starts come to on a coarse mesh, which is even unless the way of a motion is known.

    Parameters
    ----------
    weak
        Whether some begin without bounds of controls.
    first
        Number of the start to begin with; those before it are left out.
    """
    controls = controls_of(instance)
    if controls is None:
        return
    phases = len(instance.model.spec.interior) + 1
    meshes: list[Array] = [np.linspace(0.0, 1.0, max(INTERVALS // phases, FEWEST) + 1)] * phases
    if way is not None and phases == 1:
        meshes = [graded(*way, INTERVALS)]
    with np.errstate(all="ignore"):
        duration = first_duration(instance, controls)
        sizes = sizes_of(instance, controls, duration)
        plans = starts.plans(instance, controls, duration)[:STARTS]
        plans[WEAK:WEAK] = starts.weak(instance, controls) if weak else []
    normed = any(norm.spot is not None for norm in controls.norms)
    smoothings = FIRST_SMOOTHINGS if normed else FIRST_SMOOTHINGS[-1:]
    programmes = [Programme(instance, controls, meshes, sizes, by, loose) for by in smoothings]
    known = list[tuple[float, Found]]()
    for number, plan in enumerate(plans[first:], first):
        if limits.expired:
            return
        with np.errstate(all="ignore"):
            bent = most < ITERATIONS and plan.drawn and plan.noise
            found = _less_smoothed(
                programmes, plan, limits, min(most, ASTRAY) if bent else most if number else ITERATIONS, known
            )
        yield plan, found


def _less_smoothed(
    programmes: Sequence[Programme], plan: Plan, limits: Limits, most: int, known: list[tuple[float, Found]]
) -> Found:
    """The solution of the last of several programmes that differ in smoothing, each begun at that of the one before.

    Of the last that is solved: next to bounds, what is hardly smoothed may take very many iterations.

    Parameters
    ----------
    known
        Costs of the first programme and what they led to; what is found is added.
    """
    start = starts.begun(programmes[0], plan)
    if plan.timed:
        duration = plan.scale * programmes[0].sizes.duration
        given = replace(programmes[0].instance, tf=programmes[0].instance.t0 + duration, tf_guess=None)
        lasting = nlp.solve(replace(programmes[0], instance=given, kinds={}), start, limits, most)
        if not lasting.solved:
            return lasting
        start = lasting.unknown
    if plan.arriving:
        programme = programmes[0]
        found = arriving(programme.instance, programme.controls, programme.meshes, plan, limits)
        if not arrived(found):
            return replace(found, solved=False)
        start = starts.carried(programme, found.programme, found.unknown)
    if plan.loosened and (endless := programmes[0].controls.loosened) is not None:
        free = nlp.solve(replace(programmes[0], controls=endless, kinds={}), start, limits, most)
        _, v, *_ = free.programme.unpacked(free.unknown)
        if not free.solved or programmes[0].controls.excess(v) > NEARLY_WITHIN:
            return replace(free, solved=False)
        start = free.unknown
    first = found = nlp.solve(
        programmes[0], start, limits, most, near=plan.timed or plan.arriving or plan.at_bound is not None
    )
    if len(programmes) > 1 and first.solved:
        before = next((last for cost, last in known if same(cost, first.objective)), None)
        if before is not None:
            return before
    for programme in programmes[1:]:
        one = nlp.solve(programme, found.unknown, limits, most, near=True) if found.solved else found
        if not one.solved:
            break
        found = replace(one, smoother=found)
    known.append((first.objective, found))
    return found


@dataclass(frozen=True)
class Priced:
    """What a motion costs on a coarse mesh that lasts as long as is asked, and the unit in which costs are measured."""

    duration: float
    cost: float
    unit: float


def costs_by_duration(instance: Instance, limits: Limits, shares: Sequence[float]) -> list[Priced]:
    """What motions cost that last so long; none where one of these durations is not solved after a few starts.

    Parameters
    ----------
    shares
        Of the first guess of the duration.
    """
    controls = controls_of(instance)
    if controls is None:
        return []
    with np.errstate(all="ignore"):
        first, found = first_duration(instance, controls), list[Priced]()
    for share in shares:
        given = replace(instance, tf=instance.t0 + share * first, tf_guess=None)
        tries = islice(started(given, limits, ""), PRICED)
        one = next((one for _, one in tries if one.solved), None)
        if one is None:
            return []
        found.append(Priced(share * first, one.objective, one.programme.sizes.cost))
    return found


def first_motion(instance: Instance, limits: Limits, most: int = STARTS) -> Motion | None:
    """What the first of so many starts that is solved comes to, on a coarse mesh."""
    found = next((one for _, one in islice(started(instance, limits, ""), most) if one.solved), None)
    return None if found is None else motion(found)


def at_edge(found: Found) -> bool:
    """Whether a free duration is next to the shortest or the longest that is looked at: then no minimum is there."""
    programme = found.programme
    if programme.instance.tf is not None or programme.phases > 1:
        return False
    share = float(found.unknown[programme.first_duration])
    return share < SHORTEST_DURATION * (1.0 + EDGE) or share > LONGEST_DURATION * (1.0 - EDGE)


def same(one: float, other: float) -> bool:
    """Whether two costs on a coarse mesh may be of one motion."""
    return abs(one - other) <= SIMILAR * max(abs(one), abs(other))
