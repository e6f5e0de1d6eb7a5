"""The order of the search: starts one after the other, each on finer meshes, then its arcs, then Newton's method.

1. A list of starts (:mod:`~satsym.solvers.search.starts.planning`) is gone through. Each is solved on a coarse mesh.
2. The arcs of a solution are read on the coarse mesh, then on finer ones until its cost settles
   (:mod:`~satsym.solvers.search.reading`).
3. The first arcs that Newton's method makes exact are the answer: :func:`searched`. The search ends without one after
   so many starts that fail, or so many costs of which none could be made exact.
4. The same starts give competitors of an answer, whichever method found it, until nothing new shows: :func:`others`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.iteration import Limits
from satsym.solvers.search.coarse import SIMILAR, STARTS, at_edge, same, started
from satsym.solvers.search.following import LOST, finer, followed, part
from satsym.solvers.search.mesh import refined
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.starts import ends
from satsym.solvers.search.starts.planning import Plan
from satsym.solvers.search.tried import Past, Tried

Answer = TypeVar("Answer")

FAILING, ANY_DURATION, CONVEX, DOUBTFUL = 8, 12, 2, 3
"""Number of failing starts that end the search as long as none has led to a motion that a mesh resolves: FAILING,
ANY_DURATION where the duration is free, and CONVEX where the problem is convex, because all starts lead to one motion
then. After DOUBTFUL of them the search asks whether any motion reaches the end."""

QUIET, FURTHER, PATIENCE = 4, 12, 24
"""The list of competitors ends after QUIET of them that are not cheaper than the answer, and FURTHER more for each
further cost that they lead to, but after PATIENCE at most. Those that are not solved count half. Where ends are drawn,
or path constraints separate the ways, it ends after PATIENCE, solved or not."""

FRUITLESS = 4
"""Number of starts of one kind after which the others of this kind are left out if none of them was solved. Random
motions that fail count for nothing else."""

SOON = 25_000
"""Unknowns times iterations that the list of competitors takes at least, because starts of small programmes cost
little, and few of them may lead to the cheapest motion."""

PROBE, AROUND = 160_000, 600_000
"""Unknowns times iterations after which the list ends if at least two starts were solved and all led to one cost, but
for starts with other turns or durations. With path constraints it is AROUND."""

CHEAPER = 1e-9
"""Relative difference from which one exact cost is less than another."""

PARALLELS, SHOWN, ALIKE_RANGE = 3, 41, 0.05
"""At most so many motions at the cost of an answer that take another way are made exact. Ways are compared at SHOWN
times, and differ where a state does by ALIKE_RANGE of its range."""

MOST_COSTS, KEPT_COST, ENDLESS = 3, 0.5, 2
"""The search ends after MOST_COSTS different costs of motions that could not be made exact; after twice as many if
finer meshes change some by more than KEPT_COST, as the coarse mesh stepped over something there; and after ENDLESS
motions with the shortest or the longest duration allowed."""


def searched(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    loose: str = "",
    hopeless: Callable[[], bool] = lambda: False,
) -> Answer | None:
    """The first extremal that a start leads to; ``None`` without one.

    Parameters
    ----------
    limits
        Work is counted in unknowns times iterations.
    exact
        Makes a motion an exact extremal, where it can.
    loose
        A state whose given final value follows from those of the others.
    hopeless
        Tells whether no start will lead to an extremal; it is asked after a few that fail.
    """
    costs: list[float] = []
    patience = FAILING if instance.tf is not None else ANY_DURATION
    failing, failed, endless, stable, reached = CONVEX if convex(instance) else patience, 0, 0, 0, False
    for number, plan, found in started(instance, limits, loose, weak=True):
        if found.solved and at_edge(found):
            endless += 1
            if endless >= ENDLESS:
                break
        elif found.solved and not any(same(found.objective, cost) for cost in costs):
            one, last, lost = part(limits), found, False
            for last in finer(found, one):
                answer = exact(motion(last), one)
                if answer is not None or limits.expired:
                    return answer
                lost = refined(last)[1] > LOST
                if lost and last is not found:
                    break
            costs.append(found.objective)
            stable += abs(motion(last).cost - found.objective) <= KEPT_COST * abs(found.objective)
            reached |= not lost
        failed = 0 if reached else failed + (not plan.loosened and not plan.sampled)
        if stable >= MOST_COSTS or len(costs) >= 2 * MOST_COSTS or failed >= failing or number + 1 >= STARTS:
            break
        if failed == DOUBTFUL and hopeless():
            break
    return None


def others(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    cost: float,
    cost_of: Callable[[Answer], float],
    loose: str = "",
    way: tuple[Array, Array] | None = None,
    hidden: float = 0.0,
    past: Past | None = None,
) -> Iterator[Tried[Answer]]:
    """Competitors of an answer: what each start leads to. Those that seem to cost less are made exact.

    Parameters
    ----------
    cost
        Of the answer.
    cost_of
        That of an extremal.
    way
        Times and states of the answer, for the coarse mesh.
    hidden
        Difference up to which costs count as one, because the interior-point code tells no better.
    past
        What was found beside earlier answers. It comes first, and what is found now is added.
    """
    past = Past() if past is None else past
    past.first = past.first or way
    yield from past.tried
    for one in _further(instance, limits, exact, cost, cost_of, loose, way, hidden, past):
        past.tried.append(replace(one, exact=None))
        yield one


def _further(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    cost: float,
    cost_of: Callable[[Answer], float],
    loose: str,
    way: tuple[Array, Array] | None,
    hidden: float,
    past: Past,
) -> Iterator[Tried[Answer]]:
    """Competitors from the starts that were not tried yet."""
    seen = past.seen
    shapes = [] if way is None else [_shape(*way)]  # of the answer, and of others at its cost
    quiet, solved, begun = 0.0, 0, (spent := limits.meter.spent)
    constrained = bool(instance.model.spec.path_constraints)
    patient, probe = constrained or ends.random(instance), AROUND if constrained else PROBE
    further = started(
        instance,
        limits,
        loose,
        past.first,
        beside=True,
        first=past.begun,
        skipped=lambda plan: _hopeless(plan, past.tried),
    )
    for number, plan, found in further:
        past.begun = number + 1
        if plan.arriving:  # such starts come in addition: they do not count against the others
            begun += limits.meter.spent - spent
        elif found.solved or not plan.sampled:
            quiet, solved = quiet + (1.0 if found.solved or patient else 0.5), solved + found.solved
        if not found.solved:
            yield Tried(plan, float("nan"))
        elif abs(found.objective - cost) <= hidden:
            if not seen:  # so that the cost of the answer is among them
                seen.append((found.objective, cost))
            yield Tried(plan, cost)
        elif _another_way(found, cost, shapes):
            answer = next(filter(None, (exact(motion(at), limits) for at in finer(found, limits))), None)
            came = cost if answer is None else cost_of(answer)
            seen.append((found.objective, came))
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None)
        elif (known := next((came for coarse, came in seen if same(found.objective, coarse)), None)) is not None:
            yield Tried(plan, known)
        else:
            came, answer, unsettled = followed(
                found, limits, cost, lambda at: _costing(exact(at, limits), cost_of), past.moving
            )
            seen.append((found.objective, came))
            unsettled &= not constrained  # with constraints it steps over one, mostly
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None, unsettled)
        spent = limits.meter.spent
        # starts with other turns and durations are tried whatever the first ones lead to
        apart = plan.turns is not None or plan.timed or plan.arriving
        known = _distinct(came for _, came in seen)
        alone = known == 1 and solved > 1 and not apart and limits.meter.spent - begun > probe
        failing = FAILING if patient else FAILING / 2
        fewer = PATIENCE if patient else min(QUIET + FURTHER * (known - 1), PATIENCE)
        enough = fewer if seen else failing
        done = alone or (quiet >= enough and limits.meter.spent - begun > SOON)
        if done or number + 1 >= STARTS or limits.expired:
            break


def _hopeless(plan: Plan, tried: Sequence[Tried[Any]]) -> bool:
    """Return whether enough starts of the kind of a plan were tried and none was solved."""
    alike = [one for one in tried if one.plan.kind == plan.kind]
    return len(alike) >= FRUITLESS and all(np.isnan(one.cost) and not one.unsettled for one in alike)


def _distinct(costs: Iterable[float]) -> int:
    """Return how many costs differ; each that is not known counts as one."""
    different = list[float]()
    for cost in costs:
        if not any(same(cost, other) for other in different):
            different.append(cost)
    return len(different)


def _shape(times: Array, x: Array) -> Array:
    """States (n, M) of a motion at even shares of its time, each as a share of its range."""
    even = np.linspace(times[0], times[-1], SHOWN)
    span = np.ptp(x, axis=1, keepdims=True)
    return np.array([np.interp(even, times, row) for row in x]) / np.where(span > 0.0, span, 1.0)


def _another_way(found: Found, cost: float, shapes: list[Array]) -> bool:
    """Whether a motion costs about as much as an answer but goes another way; its shape is added to those known then.

    On a coarse mesh nobody can tell which of the two is cheaper.
    """
    if not 0 < len(shapes) <= PARALLELS or abs(found.objective - cost) > SIMILAR * abs(cost):
        return False
    at = motion(found)
    shape = _shape(at.times, at.x)
    if any(np.abs(shape - other).max() < ALIKE_RANGE for other in shapes):
        return False
    shapes.append(shape)
    return True


def _costing(answer: Answer | None, cost_of: Callable[[Answer], float]) -> tuple[float, Answer] | None:
    return None if answer is None else (cost_of(answer), answer)
