"""Arcs on the boundaries of path constraints, identified in an approximate motion and made exact."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Event, Solution
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.newton import begun
from satsym.solvers.constrained.revision import SLACK
from satsym.solvers.constrained.solving import answered, revised
from satsym.solvers.constrained.structure import Structure
from satsym.solvers.constrained.violation import violation
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits, Meter
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.reading import boundary_levels, collocated, contacts, levels
from satsym.solvers.switching.answers import answered as as_solution
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.structure import BOUNDARY, constraint_of

UNMET = "no path constraint is ever active"
"""Message for answers on which no path constraint is active."""

WORK = 200_000
"""Maximum number of points at which equations may be linearised for one motion."""

SHORTEST = (3, 8)
"""Maximum numbers of points of a singular arc between bounds that is ignored, tried one after the other."""


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """Return the extremal near a motion, with boundary arcs if it has any; ``None`` if none is found."""
    own = replace(limits, meter=Meter(), work=WORK)
    with np.errstate(all="ignore"):
        found = tried(partial(_in_arcs, instance, at, own))
        return found if found or instance.model.spec.interior else _without_contacts(instance, at, own)


def _without_contacts(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """Return the extremal of the problem without path constraints if it satisfies them all, otherwise ``None``."""
    at_rest = levels.exact if instance.model.spec.switching else None
    found = at_rest(instance, at, limits) if at_rest else collocated.exact(instance, at)
    if found is None or violation(found) > SLACK:
        return None
    return replace(found, message=f"{found.message}; {UNMET}")


def _in_arcs(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """Return the extremal in exact arcs with boundary arcs; ``None`` if none is found or no constraint is active."""
    began = time.perf_counter()
    if instance.model.spec.switching:
        level = _levelled(instance, at, limits)
        return None if level is None else _with_events(instance, level, as_solution(instance, level, (), began))
    first = [contacts.read(at, resting=resting) for resting in (False, True)]
    stated = set(stated_constraints(instance.model.spec).values())
    met = any(one.constraint in stated for structure in first for one in structure.contacts)
    if not (met or instance.model.spec.interior):
        return None
    found = revised(first, partial(_begun, at), limits)
    if not isinstance(found, Arcs):
        return None
    return answered(instance, found, time.perf_counter() - began, "the search")


def _begun(at: Motion, structure: Structure) -> Arcs:
    """Return the initial unknowns of a structure of arcs, taken from a motion."""
    near = at.times, np.concatenate([at.x, at.lam]), at.nu
    return begun(at.instance, structure, near, float(at.times[-1]))


def _levelled(instance: Instance, at: Motion, limits: Limits) -> Exact | None:
    """Return the extremal whose controls have the levels that they have in a motion; ``None`` without boundary arcs."""
    for shortest in SHORTEST:
        guess = boundary_levels.read(at, shortest)
        if any(level >= BOUNDARY for row in guess.structure.levels for level in row):
            found = attempt(instance, guess, limits)
            if found is not None:
                return replace(found, origin=Origin.SEARCH)
    return None


def _with_events(instance: Instance, exact: Exact, solution: Solution) -> Solution:
    """Return the solution with events at the entries to and exits from boundaries."""
    names, events = [one.name for one in instance.model.spec.path_constraints], list[Event]()
    structure, at = exact.refined.structure, exact.refined.at
    for row, own in zip(structure.levels, structure.by_control(at.times), strict=True):
        begins, ends = [instance.t0, *own.tolist()], [*own.tolist(), at.end]
        for level, begin, end in zip(row, begins, ends, strict=True):
            if level >= BOUNDARY:
                name = names[constraint_of(level)]
                events += [Event("entry", name, begin)]
                events += [Event("exit", name, end)] if end < at.end else []
    return replace(solution, method=BOUNDARY_ARCS, events=tuple(sorted(events, key=lambda one: one.t)))
