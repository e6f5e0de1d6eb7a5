"""One instance solved again and again, for other initial states and parameters, in a millisecond or two each."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec

import numpy as np

from satsym.instance import Instance
from satsym.solution import Array, Solution
from satsym.solve.collocation import paths
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.second_variation import negative_directions
from satsym.solve.extremal import Extremal, Report, solved
from satsym.solve.iteration import Limits
from satsym.solve.shooting.arcs import Arcs
from satsym.solve.shooting.newton import linearised
from satsym.solve.shooting.quick import quick_newton
from satsym.solve.shooting.solving import ACCURACY, converged, extremal, from_nothing
from satsym.status import BadInput, Status


@dataclass(frozen=True, eq=False)
class Answer:
    """What solving once more came to.

    Attributes
    ----------
    status, message
        Outcome, and one sentence for people.
    objective
        The cost J; NaN where there is none.
    times, x, lam
        Nodes, shape (N+1,), with states and costates there, shapes (n, N+1), in the model's units.
    way
        From where it was found: ``"last answer"``, ``"straight line"`` or ``"cold start"``.
    extremal
        The same in scaled variables.
    """

    status: Status
    message: str
    objective: float
    times: Array
    x: Array
    lam: Array
    way: str
    extremal: Extremal


class Repeated:
    """An instance to be solved many times, with other initial states or parameters.

    Making it solves the instance once, from a cold start, and compiles its functions, which takes seconds. From then
    on it starts from the last answer, or from a straight line, and only if neither leads to an extremal from a
    cold start. Without numba (extra ``fast``) every start is a cold one, and nothing is compiled.

    Parameters
    ----------
    instance
        What is solved, by shooting. Given final states, the final time and bounds stay as they are.
    compiled
        Whether to compile; by default wherever numba is installed.

    Attributes
    ----------
    answer
        The last one.

    Raises
    ------
    BadInput
        If the model has no cost, angles are to count modulo a turn, or numba is asked for and not installed.

    Examples
    --------
    ::

        repeated = Repeated(instance.load("return-to-orbit"))
        answer = repeated.solve(initial=(1.12, 0.0, 0.0, 0.9))
        answer.objective, answer.lam[:, 0]
        certify(repeated.solution(answer))
    """

    def __init__(self, instance: Instance, compiled: bool | None = None) -> None:
        if not instance.model.spec.has_cost:
            raise BadInput(
                f"{instance.name}: model {instance.model.spec.name} has no cost, so there is nothing to solve"
            )
        if instance.solver.free_angles:
            raise BadInput(
                f"{instance.name}: [solver] free_angles: turns are not looked for again and again; remove it"
            )
        self._compiled = find_spec("numba") is not None if compiled is None else compiled
        self._case = replace(instance, model=instance.model.compiled()) if self._compiled else instance
        self._good: Arcs | None = None
        self._steps = 1
        self.answer = self.solve(cold=True)

    def solve(
        self, initial: Sequence[float] | None = None, parameters: Sequence[float] | None = None, cold: bool = False
    ) -> Answer:
        """Solve once more.

        Parameters
        ----------
        initial, parameters
            In the model's order and units; the instance's where they are left out.
        cold
            Whether to leave the last answer aside.

        Returns
        -------
        Answer
            The extremal near the last answer; or, from a straight line or a cold start, near a strict local minimum
            of the problem without bounds.

        Raises
        ------
        ValueError
            If there are not as many numbers as states or parameters.
        """
        case = replace(
            self._case,
            initial=_numbers(initial, self._case.initial, "initial"),
            parameters=_numbers(parameters, self._case.parameters, "parameters"),
        )
        limits = Limits(case.solver.max_iterations or 500, time.perf_counter() + case.solver.max_seconds)
        with np.errstate(all="ignore"):
            found, way = self._found(case, limits, cold)
            self.answer = _answer(found, way)
        if found.status.answered and isinstance(found.path, Arcs):
            self._good = found.path
            if way == "cold start":
                self._steps = max(found.path.steps // 2, 1)
        return self.answer

    def solution(self, answer: Answer) -> Solution:
        """All of an answer, with times of switching, as other solvers give it; takes as long as they do.

        Raises
        ------
        ValueError
            If there was none.
        """
        if not answer.status.answered:
            raise ValueError(f"no answer: {answer.message}")

        def method(instance: Instance, limits: Limits, report: Report, effort: bool) -> Extremal:
            return extremal(answer.extremal.problem, answer.extremal.path, limits, report)

        return solved(answer.extremal.problem.instance, None, "shooting", method)

    def _found(self, case: Instance, limits: Limits, cold: bool) -> tuple[Extremal, str]:
        """An extremal, or why there is none, and from where it was found."""
        if self._compiled and self._good is not None:
            problem = replace(self._good.problem, instance=case)
            near = None if cold else self._near(problem, self._good)
            if near:
                return converged(*near), "last answer"
            straight = None if problem.free_time else self._straight(problem, self._good)
            if straight:
                return converged(*straight), "straight line"
        return from_nothing(case, limits, lambda *_: None, True), "cold start"

    def _near(self, problem: TwoPoint, start: Arcs) -> tuple[Arcs, float, int] | None:
        """The extremal near the arcs of a neighbouring problem, with its error and the iterations."""
        tolerance = min(ACCURACY, problem.instance.solver.tolerance)
        arcs, error, iterations = quick_newton(replace(start, problem=problem, steps=self._steps), tolerance)
        sound = error <= tolerance and (arcs.nodes[list(problem.positive)] > 0.0).all()
        return (arcs, error, iterations) if sound else None

    def _straight(self, problem: TwoPoint, like: Arcs) -> tuple[Arcs, float, int] | None:
        """The extremal to which a straight line leads, if that leads to a minimum without bounds at once."""
        free = problem.widened(float("inf"))
        states = paths.first(free)(like.mesh)
        start = replace(like, nodes=np.append(states, np.zeros_like(states), axis=0), theta=free.theta)
        found = self._near(free, start)
        if found is None or not _minimum(found[0]):
            return None
        return self._near(problem, found[0]) if np.isfinite(problem.bounds).any() else found


def _answer(found: Extremal, way: str) -> Answer:
    problem, path, answered = found.problem, found.path, found.status.answered
    z = path.nodes * problem.scale.both
    return Answer(
        status=found.status,
        message=found.message,
        objective=found.cost if answered else float("nan"),
        times=problem.instance.t0 + problem.elapsed(path.theta) * path.mesh,
        x=z[: problem.states],
        lam=z[problem.states :],
        way=way,
        extremal=found,
    )


def _minimum(arcs: Arcs) -> bool:
    """Whether an extremal is a strict local minimum without bounds."""
    try:
        return negative_directions(arcs.problem, arcs, linearised(arcs)[0]) == 0
    except np.linalg.LinAlgError:
        return False


def _numbers(given: Sequence[float] | None, own: tuple[float, ...], name: str) -> tuple[float, ...]:
    if given is None:
        return own
    if len(given) != len(own):
        raise ValueError(f"{name} must hold {len(own)} numbers, not {len(given)}")
    return tuple(map(float, given))
