"""Solutions from a list of starts on a coarse mesh, and costs of motions of given durations on this mesh."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp
from satsym.solvers.search.arriving import arrived, arriving
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.mesh import graded
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import planning
from satsym.solvers.search.starts.planning import Plan
from satsym.solvers.search.starts.sampling import GROUPS, Sample, begun_from, sampled
from satsym.solvers.search.transcription import LONGEST_DURATION, SHORTEST_DURATION

STARTS = 48
"""Maximum number of starts of the direct search."""

ITERATIONS, BESIDE, ASTRAY = 200, 120, 50
"""Maximum number of iterations of the interior-point code for a start; for a competitor, if its duration is given; and
for a competitor from a curved path to a random final state, which is found soon or hardly ever."""

WEAK, NEARLY_WITHIN = 7, 1.5
"""``WEAK`` is the number of starts before those that ignore the bounds of controls. ``NEARLY_WITHIN`` is the largest
control of a motion from such a start, relative to its bound, for which a motion within the bounds is searched for."""

PRICED = 3
"""Maximum number of starts that are tried to find the cost of a given duration. If the final state can be reached in
it, the first ones usually suffice."""

EDGE = 1e-2
"""Relative distance of a free duration from the longest or shortest allowed one, within which it counts as being at
this limit."""

INTERVALS, FEWEST = 40, 8
"""Number of intervals of the coarse mesh, and minimum number in a phase."""

FIRST_SMOOTHINGS = (1e-1, 1e-2, 1e-3)
"""Successive smoothing parameters of norms on the coarse mesh, largest first: fuel cost alone determines little between
bounds, and a quadratic term determines much."""

SIMILAR = 1e-4
"""Relative difference of costs on a coarse mesh below which two motions count as the same."""


def started(
    instance: Instance,
    limits: Limits,
    loose: str,
    way: tuple[Array, Array] | None = None,
    weak: bool = False,
    beside: bool = False,
    first: int = 0,
    skipped: Callable[[Plan], bool] = lambda _: False,
) -> Iterator[tuple[int, Plan, Found]]:
    """Yield indices and plans of starts, and the solutions on a coarse mesh; a known motion may grade the mesh.

    Parameters
    ----------
    weak
        Whether some starts ignore the bounds of controls at first.
    beside
        Whether the solutions are competitors of an answer, which need not all be found.
    first
        Index of the first start; earlier ones are left out.
    skipped
        Tells of each of the others, when its turn comes, whether it is left out.
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
        plans = planning.plans(instance, controls, duration)[:STARTS]
        plans[WEAK:WEAK] = planning.weak(instance, controls) if weak else []
    normed = any(norm.spot is not None for norm in controls.norms)
    smoothings = FIRST_SMOOTHINGS if normed else FIRST_SMOOTHINGS[-1:]
    programmes = [Programme(instance, controls, meshes, sizes, by, loose) for by in smoothings]
    groups = dict[int, list[Sample]]()
    known = list[tuple[float, Found]]()
    for number, plan in enumerate(plans[first:], first):
        if limits.expired:
            return
        if skipped(plan):
            continue
        with np.errstate(all="ignore"):
            most = BESIDE if beside and number and instance.tf is not None else ITERATIONS
            iterations = ASTRAY if beside and plan.drawn and plan.noise else most
            if plan.sampled:
                sample = _sample(programmes[0], plan.sampled, groups)
                if sample is None:
                    continue
                found = _from_sample(programmes, sample, limits, iterations, known)
            else:
                found = _less_smoothed(programmes, plan, limits, iterations, known)
        yield number, plan, found


def _less_smoothed(
    programmes: Sequence[Programme], plan: Plan, limits: Limits, most: int, known: list[tuple[float, Found]]
) -> Found:
    """Return the solution of the last of several programmes of decreasing smoothing, each started from the previous.

    If a programme fails, the solution of the one before it is returned: near bounds, little smoothing may need very
    many iterations.

    Parameters
    ----------
    known
        Costs of the first programme and the solutions they led to; the new solution is appended.
    """
    start = planning.begun(programmes[0], plan)
    if plan.timed:
        duration = plan.scale * programmes[0].sizes.duration
        given = replace(programmes[0].instance, tf=programmes[0].instance.t0 + duration, tf_guess=None)
        lasting = nlp.solve(replace(programmes[0], instance=given, kinds={}), start, limits, most)
        if not lasting.solved:
            return lasting
        start = lasting.unknown
    if plan.arriving:
        programme = programmes[0]
        duration = programme.sizes.duration
        found = arriving(programme.instance, programme.controls, programme.meshes, plan, duration, limits)
        if not arrived(found):
            return replace(found, solved=False)
        start = planning.carried(programme, found.programme, found.unknown)
    if plan.loosened and (endless := programmes[0].controls.loosened) is not None:
        free = nlp.solve(replace(programmes[0], controls=endless, kinds={}), start, limits, most)
        _, v, *_ = free.programme.unpacked(free.unknown)
        if not free.solved or programmes[0].controls.excess(v) > NEARLY_WITHIN:
            return replace(free, solved=False)
        start = free.unknown
    near = plan.timed or plan.arriving or plan.at_bound is not None
    return _smoothed_less(programmes, nlp.solve(programmes[0], start, limits, most, near), limits, most, known)


def _sample(programme: Programme, number: int, groups: dict[int, list[Sample]]) -> Sample | None:
    """Return the random motion of a number, counted from 1 through all groups; ``None`` if there are fewer.

    Parameters
    ----------
    groups
        The groups that were drawn, by their index; a new one is added.
    """
    place = number - 1
    for group, (count, _) in enumerate(GROUPS):
        if place < count:
            if group not in groups:
                groups[group] = sampled(programme, group)
            return groups[group][place] if place < len(groups[group]) else None
        place -= count
    return None


def _from_sample(
    programmes: Sequence[Programme], sample: Sample, limits: Limits, most: int, known: list[tuple[float, Found]]
) -> Found:
    """Return the solution that a random motion leads to, on a mesh of its own, as :func:`_less_smoothed` does."""
    meshes = [graded(sample.times, sample.x, INTERVALS)]
    own = [replace(programme, meshes=meshes, kinds={}) for programme in programmes]
    first = nlp.solve(own[0], begun_from(own[0], sample), limits, most)
    return _smoothed_less(own, first, limits, most, known)


def _smoothed_less(
    programmes: Sequence[Programme], first: Found, limits: Limits, most: int, known: list[tuple[float, Found]]
) -> Found:
    """Return the solution with the least smoothing, from that of the first of several programmes."""
    found = first
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
    """Cost of a motion of given duration on a coarse mesh, and the unit of costs."""

    duration: float
    cost: float
    unit: float


def costs_by_duration(instance: Instance, limits: Limits, shares: Sequence[float]) -> list[Priced]:
    """Return costs of motions of given durations; an empty list if one duration is not solved from the first starts.

    Parameters
    ----------
    shares
        Durations relative to the initial guess of the duration.
    """
    controls = controls_of(instance)
    if controls is None:
        return []
    with np.errstate(all="ignore"):
        first, found = first_duration(instance, controls), list[Priced]()
    for share in shares:
        given = replace(instance, tf=instance.t0 + share * first, tf_guess=None)
        tries = islice(started(given, limits, ""), PRICED)
        one = next((one for *_, one in tries if one.solved), None)
        if one is None:
            return []
        found.append(Priced(share * first, one.objective, one.programme.sizes.cost))
    return found


def first_motion(instance: Instance, limits: Limits, most: int = STARTS) -> Motion | None:
    """Return the motion from the first of several starts that is solved on a coarse mesh, or ``None``."""
    found = next((one for *_, one in islice(started(instance, limits, ""), most) if one.solved), None)
    return None if found is None else motion(found)


def at_edge(found: Found) -> bool:
    """Return whether a free duration is at its shortest or longest allowed value, so that no minimum is there."""
    programme = found.programme
    if programme.instance.tf is not None or programme.phases > 1:
        return False
    share = float(found.unknown[programme.first_duration])
    return share < SHORTEST_DURATION * (1.0 + EDGE) or share > LONGEST_DURATION * (1.0 - EDGE)


def same(one: float, other: float) -> bool:
    """Return whether two costs on a coarse mesh may belong to the same motion."""
    return abs(one - other) <= SIMILAR * max(abs(one), abs(other))
