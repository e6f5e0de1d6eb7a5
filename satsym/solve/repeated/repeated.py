"""One instance solved again and again, for other initial states and parameters, in a millisecond or two each."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec

import numpy as np

from satsym.instance import Instance
from satsym.solution import Array, Solution
from satsym.solve.extremal import Extremal, solved
from satsym.solve.iteration import Limits
from satsym.solve.repeated.by_collocation import ByCollocation
from satsym.solve.repeated.means import Means
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

    Making it solves the instance once, from a cold start. From then on it starts from the last answer, or from a
    straight line, and only if neither leads to an extremal from a cold start. With numba (extra ``fast``) that is
    shooting with compiled functions, and compiling takes seconds; without it collocation, which keeps scales and mesh.

    Parameters
    ----------
    instance
        What is solved. Given final states, the final time and bounds stay as they are.
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
        compiled = find_spec("numba") is not None if compiled is None else compiled
        self._means = _shooting() if compiled else ByCollocation()
        self._case = replace(instance, model=instance.model.compiled()) if compiled else instance
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
            near = None if cold else self._means.near(case, limits)
            straight = None if near else self._means.straight(case, limits)
            found = near or straight or self._means.cold(case, limits)
        self.answer = _answer(found, "last answer" if near else "straight line" if straight else "cold start")
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

        def method(instance: Instance, limits: Limits, effort: bool) -> Extremal:
            return self._means.full(answer.extremal, limits)

        return solved(answer.extremal.problem.instance, None, self._means.name, method)


def _shooting() -> Means:
    """Imported late: it needs SciPy, which takes longer to load than most instances to solve."""
    from satsym.solve.repeated.by_shooting import ByShooting

    return ByShooting()


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


def _numbers(given: Sequence[float] | None, own: tuple[float, ...], name: str) -> tuple[float, ...]:
    if given is None:
        return own
    if len(given) != len(own):
        raise ValueError(f"{name} must hold {len(own)} numbers, not {len(given)}")
    return tuple(map(float, given))
