"""Angles whose final value counts modulo a turn: determination of the number of turns with minimum cost.

A final angle plus a turn is equivalent to an initial angle minus a turn, since the model is periodic in the angle; thus
each number of turns is an ordinary instance. The numbers next to the best one are solved as well.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace

import msgspec
import numpy as np

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start.own_time import time_scale
from satsym.solvers.iteration import deadline_of, hurried
from satsym.status import Status

TURN = 2.0 * math.pi
MOST_MOVES = 6
"""Maximum number of changes to a cheaper neighbouring number of turns. If it is reached, the cost may fall without
limit."""


def with_cheapest_turns(
    solve: Callable[[Instance, Progress | None], Solution], instance: Instance, progress: Progress | None
) -> Solution:
    """Solve an instance with the number of turns that has minimum cost.

    Parameters
    ----------
    solve
        Solver of an instance with fixed final angles.
    instance
        Instance whose ``[solver] free_angles`` count modulo a turn.
    progress
        Function that is called after each iteration of each solution.
    """
    angles = [name for name in instance.solver.free_angles if name in instance.final]
    if not angles:
        return solve(instance, progress)
    began, deadline = time.perf_counter(), deadline_of(instance)
    plain = replace(instance, solver=msgspec.structs.replace(instance.solver, free_angles=()))
    known: dict[tuple[int, ...], Solution] = {}

    def costs(turns: tuple[int, ...]) -> float:
        if turns not in known:
            left = hurried(plain, deadline) if known else plain
            if left is None:
                return math.inf
            known[turns] = solve(shifted(left, dict(zip(angles, turns, strict=True))), progress)
        return known[turns].objective if known[turns].status.answered else math.inf

    at = _natural(instance, angles)
    path = [costs(at)]
    for _ in range(MOST_MOVES):
        best = min(_neighbours(at), key=costs)
        if costs(best) >= costs(at):
            break
        at = best
        path.append(costs(at))
    others = {k: costs(k) for k in _neighbours(at)}
    lost = len(path) > 2 and any(math.isinf(value) for value in others.values())
    status, message = known[at].status, f"{known[at].message}; {_message(angles, at, others)}"
    if instance.tf is None and (lost or len(path) > MOST_MOVES):
        values = ", ".join(f"{value:.4g}" for value in path[-3:])
        message = (
            f"the cost decreases with every further turn: the last three numbers of turns have the costs {values}; "
            "fix the final time"
        )
        status = Status.NO_MINIMISER
    found = _turned(known[at], instance, dict(zip(angles, at, strict=True)))
    return replace(found, status=status, message=message, wall_s=time.perf_counter() - began)


def _turned(solution: Solution, instance: Instance, turns: dict[str, int]) -> Solution:
    """Return the solution of an instance with shifted initial angles as one of the original instance."""
    names = instance.model.spec.state_names
    return replace(
        solution, instance=instance, x=solution.x + TURN * np.array([turns.get(name, 0) for name in names])[:, None]
    )


def shifted(instance: Instance, turns: dict[str, int]) -> Instance:
    """Return the instance with its initial angles reduced by the given numbers of turns."""
    names = instance.model.spec.state_names
    initial = tuple(x - TURN * turns.get(name, 0) for name, x in zip(names, instance.initial, strict=True))
    return replace(instance, initial=initial)


def as_stated(solution: Solution) -> Solution:
    """Return a solution whose angles are reduced by whole turns, such that they end at the stated values."""
    instance, names = solution.instance, solution.instance.model.spec.state_names
    turns: dict[str, int] = {}
    for name in instance.solver.free_angles:
        if name in instance.final:
            row = names.index(name)
            goal = _goal(instance, row, instance.final[name], float(solution.times[-1]))
            turns[name] = round((float(solution.x[row, -1]) - goal) / TURN)
    if not any(turns.values()):
        return solution
    x = solution.x - TURN * np.array([turns.get(name, 0) for name in names])[:, None]
    return replace(solution, instance=shifted(instance, turns), x=x)


def _goal(instance: Instance, row: int, wanted: float | str, tf: float) -> float:
    """Return the stated final value of an angle, from the reference if it is given by that."""
    return float(instance.model.reference(tf, instance.parameters)[row] if isinstance(wanted, str) else wanted)


def _neighbours(at: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Return all numbers of turns that have one turn less or more of a single angle."""
    return [(*at[:i], at[i] + step, *at[i + 1 :]) for i in range(len(at)) for step in (-1, 1)]


def _natural(instance: Instance, angles: list[str]) -> tuple[int, ...]:
    """Return the turns that the uncontrolled motion comes closest to; with a free final time, in a typical one."""
    none = tuple([0] * len(angles))
    if not angles:
        return none
    end = instance.tf if instance.tf is not None else instance.tf_guess
    if end is None:
        end = instance.t0 + TURN * time_scale(instance)
    grid = Grid.uniform(instance.t0, end, 2000)
    idle = np.zeros((len(instance.model.spec.controls), grid.steps + 1))
    x, _, _ = instance.model.forward(grid.nodes, instance.initial, idle, idle[:, 1:], instance.parameters)
    names = instance.model.spec.state_names
    if not np.isfinite(x).all() or not instance.model.in_domain(x):
        return none
    found = []
    for name in angles:
        row = names.index(name)
        goal = _goal(instance, row, instance.final[name], end)
        found.append(round((float(x[row, -1]) - goal) / TURN))
    return tuple(found)


def _message(angles: list[str], at: tuple[int, ...], others: dict[tuple[int, ...], float]) -> str:
    parts = []
    for i, name in enumerate(angles):
        less, more = (others[(*at[:i], at[i] + step, *at[i + 1 :])] for step in (-1, 1))
        parts.append(f"{name} {_turns(at[i])}; a turn less {_costing(less)}, a turn more {_costing(more)}")
    return "; ".join(parts)


def _turns(count: int) -> str:
    if not count:
        return "ends at the given value"
    return f"ends {abs(count)} turn{'s' if abs(count) > 1 else ''} {'above' if count > 0 else 'below'} what is stated"


def _costing(value: float) -> str:
    return f"costs {value:.6g}" if math.isfinite(value) else "has no solution"
