"""Solution of the rows of a chunk together, as columns of arrays; rows without a minimum go to the single solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from satsym import methods
from satsym.instance import Instance
from satsym.instance.numbers import Table
from satsym.solvers.batch.corners import positive
from satsym.solvers.cold_start.origin import Origin
from satsym.solvers.redundant_ends import redundant
from satsym.status import Status, Verdict
from satsym.studies import rows
from satsym.studies.asked import Checked, Command, Task
from satsym.studies.rows import Cases, Found, Row

if TYPE_CHECKING:
    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.newton import Nodes

NEIGHBOUR, LINE, CLOSED, REACHABLE = "nearest answer", Origin.STRAIGHT_LINE.value, "closed form", "reachable set"
UNBOUNDED = "answer without bounds"
"""The recorded origins of solutions: the nearest solution, a straight line between the boundary states, a closed form,
a faster motion, or the same row's solution without bounds."""

WIDEST = 1e9
"""The number that replaces infinite bounds."""

SHOOTING, LINEAR, SWITCHING = "shooting", "linear", "bang-bang"
"""The names of the methods by which rows are solved together."""


Together = Callable[[Task, Sequence[Instance]], Found]


def together(task: Task) -> Together | None:
    """Return how rows are solved as columns of arrays; ``None`` where they are not, as with saved trajectories."""
    stays = all(key.table is not Table.TIME for key in task.keys)
    wanted = task.command is Command.SOLVE and task.checked is not Checked.FULL and not task.trajectories
    if not (wanted and stays):
        return None
    if _smooth_with_given_ends(task):
        return _shot
    return _first_arrivals if _least_time(task) else None


def rows_together(task: Task, solve: Together, single: Callable[[str, Instance], Row], cases: Cases) -> list[Row]:
    """Solve all rows at once, and one by one those that do not clearly end in a minimum."""
    if not cases:
        return []
    found = solve(task, [instance for _, instance in cases])
    verdict = Verdict.LOCAL_MINIMUM.value if task.checked is Checked.LOCAL else None

    def row(k: int, key: str, instance: Instance) -> Row | None:
        if found.minimum[k]:
            return rows.of_extremal(key, instance.model.spec, found, k, verdict)
        return rows.infeasible(key, found.unreachable[k]) if k in found.unreachable else None

    done = [row(k, *case) for k, case in enumerate(cases)]
    answered = [instance for (_, instance), minimum in zip(cases, found.minimum, strict=True) if minimum]
    left = iter(_alone(single, [case for case, one in zip(cases, done, strict=True) if one is None], answered))
    return [next(left) if one is None else one for one in done]


def _alone(single: Callable[[str, Instance], Row], cases: Cases, answered: Sequence[Instance]) -> list[Row]:
    """Solve rows one by one, those with the widest bounds first.

    An end that these do not reach is not reached within narrower bounds. An end that is reached within narrower bounds
    is known to be reachable.
    """
    found: dict[int, Row] = {}
    beyond: list[tuple[Instance, str]] = []
    for k in sorted(range(len(cases)), key=lambda k: -_width(cases[k][1])):
        key, instance = cases[k]
        wider = next((message for other, message in beyond if _narrower(instance, other)), None)
        if wider is not None:
            found[k] = rows.infeasible(key, f"the final state is not reached even with wider bounds: {wider}")
            continue
        found[k] = rows.tried(single, key, instance)
        if found[k].status == Status.INFEASIBLE.value and not any(_narrower(one, instance) for one in answered):
            beyond.append((instance, found[k].message))
    return [found[k] for k in range(len(cases))]


def _width(instance: Instance) -> float:
    """Return a number that is no larger where bounds are narrower."""
    ends = (instance.max_norm, *instance.upper, *(-low for low in instance.lower))
    return sum(min(end, WIDEST) for end in ends)


def _narrower(instance: Instance, other: Instance) -> bool:
    """Tell whether all controls of one instance are admissible in the other, between the same ends."""
    same = all(getattr(instance, name) == getattr(other, name) for name in ("initial", "final", "parameters"))
    lower, upper = zip(instance.lower, other.lower, strict=True), zip(instance.upper, other.upper, strict=True)
    within = all(own >= far for own, far in lower) and all(own <= far for own, far in upper)
    return same and within and instance.max_norm <= other.max_norm


def plain(task: Task) -> bool:
    """Tell whether the problem is smooth, and without options that ask more of solvers."""
    spec = task.instance.model.spec
    smooth = not (spec.switching or spec.throttled or spec.stationary or spec.directional or spec.in_arcs)
    return smooth and _bare(task.instance) and redundant(task.instance) is None


def _bare(instance: Instance) -> bool:
    """Tell whether the options ask solvers for nothing but a solution."""
    said = (instance.free, instance.continuation, instance.solver.free_angles, instance.guess, instance.end_limits)
    return not any(said)


def _smooth_with_given_ends(task: Task) -> bool:
    """Tell whether controls are smooth, and both ends and times given."""
    instance = task.instance
    given = instance.tf is not None and len(instance.final) == len(instance.initial)
    fitting = instance.solver.method in (methods.AUTO, SHOOTING, LINEAR) and instance.control_set.kind in (
        "box",
        "ball",
    )
    return given and fitting and not instance.model.spec.multipliers and plain(task)


def _shot(task: Task, instances: Sequence[Instance]) -> Found:
    """Return extremals with smooth controls and given ends, by shooting."""
    from satsym.solvers.batch.bounded import unreachable, within_bounds
    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.newton import Outcome
    from satsym.solvers.batch.solving import Answers, has_closed_form, in_closed_form, solved_together

    many = Many.of(task.instance, instances, task.compiled)
    linear = has_closed_form(many)
    answers = Answers(in_closed_form(many), np.zeros(many.count, dtype=bool)) if linear else solved_together(many)
    nodes, n, tf = answers.nodes, many.states, float(many.times[-1, 0])
    if task.checked is Checked.LOCAL:
        nodes, fine = _confirmed(many, nodes)
    else:
        fine = _second_variation_positive(many, nodes)
    x, costates, costs, switches = (
        nodes.z[:n, -1].copy(),
        nodes.z[n:, 0].copy(),
        nodes.cost.copy(),
        np.zeros(many.count),
    )
    origins = [CLOSED] * many.count if linear else [NEIGHBOUR if k else LINE for k in answers.neighbour]
    met = np.flatnonzero(nodes.outcome == Outcome.BOUNDS)
    if len(met):
        laid, held, switches[met] = within_bounds(many.only(met), nodes.z[:, :, met])
        held, fine[met] = _confirmed(laid, held)
        x[:, met], costates[:, met], costs[met] = held.z[:n, -1], held.z[n:, 0], held.cost
        for k in met:
            origins[k] = UNBOUNDED
    pairs = zip(instances, x.T.tolist(), strict=True)
    return Found(
        minimum=fine,
        method=LINEAR if linear else SHOOTING,
        origins=origins,
        costs=costs + [one.model.terminal_cost(tf, tuple(end), one.parameters) for one, end in pairs],
        t_final=np.full(many.count, tf),
        x_final=x,
        costates=costates,
        switches=switches,
        unreachable=unreachable(many, instances, met[~fine[met]]) if linear else {},
    )


def _second_variation_positive(many: Many, nodes: Nodes) -> NDArray[np.bool_]:
    """Tell which rows are solved and minima by steps of low order, apart from other criteria."""
    from satsym.solvers.batch.newton import transitions

    found, solved = nodes.solved.copy(), np.flatnonzero(nodes.solved)
    with np.errstate(all="ignore"):
        table = transitions(many.only(solved), nodes.z[:, :, solved])
        found[solved] = positive(table * (many.units / many.units[:, None])[:, :, None, None])
    return found


def _confirmed(many: Many, nodes: Nodes) -> tuple[Nodes, NDArray[np.bool_]]:
    """Tell which rows are clearly minima, some after refinement to the limit of rounding."""
    from satsym.solvers.batch.certificate import minima
    from satsym.solvers.batch.solving import to_rounding

    fine = minima(many, nodes)
    unclear = np.flatnonzero(nodes.solved & ~fine)
    nodes = to_rounding(many, nodes, unclear)
    fine[unclear] = minima(many.only(unclear), nodes.only(unclear))
    return nodes, fine


def _least_time(task: Task) -> bool:
    """Tell whether the problem is minimum time to a given state with switching controls."""
    from satsym.solvers.batch.switching.arrivals import applies

    fitting = task.instance.solver.method in (methods.AUTO, SWITCHING)
    return fitting and _bare(task.instance) and applies(task.instance)


def _first_arrivals(task: Task, instances: Sequence[Instance]) -> Found:
    """Solve instances of minimum time together by exact arcs; no motion arrives earlier than these extremals."""
    from satsym.solvers.batch.switching.arrivals import first_arrivals
    from satsym.solvers.batch.switching.certificate import minima

    found = first_arrivals(instances, task.compiled)
    return Found(
        minimum=minima(found) if task.checked is Checked.LOCAL else found.solved,
        method=SWITCHING,
        origins=[REACHABLE] * len(instances),
        costs=found.costs,
        t_final=np.array([one.t0 for one in instances]) + found.durations,
        x_final=found.ends,
        costates=found.costates,
        switches=(found.controls >= 0).sum(axis=0),
    )
