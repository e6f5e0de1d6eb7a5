"""Exact arcs whose structure is revised until all tests pass, and their conversion into a solution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.control_set import bound_names
from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Event, Solution
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.constrained.active import control, field
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.newton import cost, from_arcs, solved
from satsym.solvers.constrained.revision import ROUNDED, contacts, simpler, wrong
from satsym.solvers.constrained.structure import Contact, Structure, ordered
from satsym.solvers.constrained.structure import Event as Happening
from satsym.solvers.iteration import Limits, history_of
from satsym.solvers.simulation.extrapolation import leap
from satsym.status import Status

REVISED, REPEATED = 12, 2
"""Maximum number of structures that are tried from one motion, and maximum number of times that a structure is tried
with changed junction times."""


@dataclass(frozen=True, eq=False)
class Stopped:
    """The reason why no answer was found."""

    status: Status
    message: str


def revised(first: list[Structure], fresh: Callable[[Structure], Arcs], limits: Limits) -> Arcs | Stopped:
    """Return exact arcs, with their structure revised until all tests pass, or the reason of a failure.

    Parameters
    ----------
    first
        Structures that are tried first.
    fresh
        Function that returns initial unknowns of a structure if no arcs near it are known.
    limits
        Limits of time and work.
    """
    waiting: list[tuple[Structure, Arcs | None]] = [(one, None) for one in first]
    seen: Counter[tuple[object, ...]] = Counter()
    reason = "the equations of the arcs could not be solved"
    while waiting and seen.total() < REVISED and not limits.expired:
        structure, before = waiting.pop(0)
        if seen[structure.key] >= REPEATED:
            continue
        seen[structure.key] += 1
        begun = fresh(structure) if before is None else from_arcs(before, structure)
        instance, found = begun.instance, solved(begun, limits)
        if found is None and before is not None:
            found = solved(fresh(structure), limits)
        if found is None:
            waiting += [(other, before) for other in _variants(instance, structure)]
            continue
        reason, others = wrong(found)
        if not reason:
            return _lean(found, limits)
        waiting = [*((other, found) for other in others), *waiting]
    near = first[0].name(begun.instance)
    return Stopped(Status.NOT_CONVERGED, f"no structure near ({near}) is an extremal: {reason}")


def _lean(arcs: Arcs, limits: Limits) -> Arcs:
    """Return the extremal without superfluous junctions, as far as what remains is an extremal."""
    for structure in simpler(arcs):
        found = solved(from_arcs(arcs, structure), limits)
        if found is not None and not wrong(found)[0]:
            return _lean(found, limits)
    return arcs


def _variants(instance: Instance, structure: Structure) -> list[Structure]:
    """Return structures with one boundary arc replaced by a touch point or, for order one or zero, removed."""
    found = []
    for k, one in enumerate(structure.contacts):
        second = instance.model.spec.path_constraints[one.constraint].order > 1
        if not one.touches:
            touch = Contact(one.constraint, one.middle, one.middle, (sum(one.jumps), 0.0))
            others = [*structure.contacts[:k], *([touch] if second else []), *structure.contacts[k + 1 :]]
            found.append(ordered(others, structure.passages))
    return found


def _events(arcs: Arcs, times: Array) -> tuple[Event, ...]:
    """Return the events at the junction times, including the exit where one boundary follows another."""
    instance, known = arcs.instance, arcs.structure.contacts
    names = [one.name for one in instance.model.spec.path_constraints]
    points = [one.name for one in instance.model.spec.interior]
    found = [Event("entry", names[k], instance.t0) for k in arcs.structure.begun]
    for one, t in zip(arcs.junctions, times[1:-1].tolist(), strict=True):
        if one.event is Happening.INTERIOR:
            found += [Event("exit", names[k], t) for k in one.before if k not in one.after]
            found.append(Event(one.event.value, points[one.constraint], t))
            found += [Event("entry", names[k], t) for k in one.after if k not in one.before]
            continue
        found += [] if one.left is None else [Event("exit", names[known[one.left].constraint], t)]
        found.append(Event(one.event.value, names[one.constraint], t))
    touched = (one.constraint for one in known if one.closes and one.touches)
    return (*found, *(Event("touch", names[k], float(arcs.end)) for k in touched))


def _at_nodes(arcs: Arcs, arc: int, times: Array) -> Array:
    """Return values (2n, N) on an arc, integrated from its nodes, more accurately than by its polynomials."""
    k, (a, b) = arcs.intervals[arc], arcs.times[arc : arc + 2]
    which = np.clip(((times - a) / (b - a) * k).astype(int), 0, k - 1)
    begins, starts = a + (b - a) * which / k, arcs.nodes(arc)[:: STAGES + 1][which].T
    z = leap(partial(field, arcs.instance, arcs.active[arc]), begins, starts, times - begins)
    z[:, 0], z[:, -1] = arcs.node(arc, 0), arcs.node(arc, -1)
    return z


def answered(instance: Instance, arcs: Arcs, wall_s: float, source: str) -> Solution:
    """Return exact arcs as a solution; junctions that coincide get the same time.

    Its history is that of the motion and the arcs that led here, not of the problem without constraints.
    """
    nodes, n = np.linspace(instance.t0, arcs.end, instance.solver.steps + 1), arcs.n
    parts: list[tuple[Array, Array, Array]] = []
    brief = ROUNDED * (arcs.end - instance.t0)
    edges = [instance.t0]
    for a, b in pairwise(arcs.times):
        edges.append(edges[-1] if b - a <= brief else float(b))
    for arc, (a, b) in enumerate(pairwise(edges)):
        if a == b:
            continue
        times = np.concatenate([[a], nodes[(nodes > a) & (nodes < b)], [b]])
        z = _at_nodes(arcs, arc, times)
        parts.append((times, z, control(instance, arcs.active[arc], times, z)))
    times, z, u = (np.concatenate([part[k] for part in parts], axis=-1) for k in range(3))
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    events = _events(arcs, np.array(edges))
    names = [one.name for one in instance.model.spec.path_constraints]
    lasting = ", ".join(f"{names[c.constraint]} {c.end - c.start:.4g} long" for c in contacts(arcs) if not c.touches)
    message = f"structure {arcs.structure.name(instance)}" + (f" ({lasting})" if lasting else "")
    return Solution(
        instance=instance,
        method=BOUNDARY_ARCS,
        status=status,
        message=f"{message}, from {source}",
        objective=cost(arcs),
        times=times,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=tuple(
            tuple(dict.fromkeys(one.t for one in events if one.name in bounds and instance.t0 < one.t))
            for bounds in bound_names(instance.model.spec)
        ),
        iterations=len(arcs.passed),
        history=history_of(arcs.passed),
        wall_s=wall_s,
        events=events,
    )
