"""Repeated solution of one instance for different initial states and parameters."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import Protocol

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.resolve import value_of
from satsym.solution import Solution
from satsym.solvers import two_point
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.accuracy.refinement import NEAR_CORRECTION
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System
from satsym.solvers.extremal import solved, without_numbers
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits, watched
from satsym.solvers.search.solving import guessed
from satsym.spec import Variable
from satsym.status import BadInput, Status


@dataclass(frozen=True, eq=False)
class Answer:
    """Result of solving an instance once more."""

    status: Status
    message: str
    """Outcome, and one sentence that describes it."""
    objective: float
    """The cost J; NaN if there is no solution."""
    times: Array
    x: Array
    lam: Array
    """Nodes, shape (N+1,), with states and costates at the nodes, shapes (n, N+1), in the units of the model."""
    origin: Origin
    """Initial guess from which the solution was found: the last solution, a straight line, or a cold start."""
    extremal: Extremal
    """The extremal in scaled variables."""


class Repeated:
    """An instance to be solved many times, with other initial states or parameters.

    When the object is made, the instance is solved once, from a cold start. Later solutions start from the previous
    one; if that fails, from a straight line; and if that fails as well, from a cold start. With numba (extra
    ``fast``), the method is shooting with compiled functions, and compilation takes some seconds; without numba, it is
    collocation, which keeps scales and mesh.

    Parameters
    ----------
    instance
        The instance. Its final conditions, final time and bounds stay fixed.
    compiled
        Whether to compile functions; by default they are compiled if numba is installed.

    Attributes
    ----------
    answer
        The result of the last call of :meth:`solve`.

    Raises
    ------
    BadInput
        If the model has no cost or controls that switch, if angles count modulo a full turn or final states have
        ranges, or if numba is requested but not installed.

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
                f"{instance.called}: model {instance.model.spec.name} has no cost, so there is nothing to solve"
            )
        instance.require_numbers()
        if instance.model.spec.switching:
            raise BadInput(
                f"{instance.called}: the controls of {instance.model.spec.name} switch, but repeated solving does "
                f"not support switching controls; solve each instance separately"
            )
        if instance.end_limits:
            name = next(iter(instance.end_limits))
            raise BadInput(
                f"{instance.called}: repeated solving does not determine whether {name} is active at the final time"
            )
        if instance.solver.free_angles:
            raise BadInput(
                f"{instance.called}: [solver] free_angles: repeated solving does not search for the number of "
                "turns; remove it"
            )
        compiled = find_spec("numba") is not None if compiled is None else compiled
        self._means = _shooting() if compiled else _ByCollocation()
        self._case = replace(instance, model=instance.model.compiled()) if compiled else instance
        self.answer = self.solve(cold=True)

    def solve(
        self, initial: Sequence[float] | None = None, parameters: Sequence[float] | None = None, cold: bool = False
    ) -> Answer:
        """Solve the instance with other initial states or parameters.

        Parameters
        ----------
        initial, parameters
            Values in the order and the units of the model; by default those of the instance.
        cold
            Whether to use a cold start instead of the last solution.

        Returns
        -------
        Answer
            The extremal near the last solution or, from a straight line or a cold start, near a strict local minimum of
            the problem without bounds. Only :func:`certify` determines whether it is a minimum of the bounded problem.

        Raises
        ------
        ValueError
            If the number of values is not that of the states or parameters.
        BadInput
            If a value is not finite or lies outside its domain.
        """
        spec = self._case.model.spec
        case = replace(
            self._case,
            initial=_numbers(initial, self._case.initial, spec.states, "initial"),
            parameters=_numbers(parameters, self._case.parameters, spec.parameters, "parameters"),
        )
        limits, _ = watched(case, None)
        with np.errstate(all="ignore"):
            self.answer = _answer(*self._found(case, limits, cold))
        return self.answer

    def branched(self) -> Repeated:
        """Return an independent copy, which starts from the last solution of this object."""
        other = copy(self)
        other._means = copy(self._means)
        return other

    def _found(self, case: Instance, limits: Limits, cold: bool) -> tuple[Extremal, Origin]:
        """Return an extremal, or the reason why there is none, and the initial guess from which it was found."""
        quick = {Origin.LAST_ANSWER: self._means.near, Origin.STRAIGHT_LINE: self._means.straight}
        for origin, attempt in quick.items():
            if cold and origin is Origin.LAST_ANSWER:
                continue
            try:
                found = attempt(case, limits)
            except FAILURES:
                continue
            if found:
                return found, origin
        try:
            return self._means.cold(case, limits), Origin.COLD_START
        except FAILURES as error:
            return without_numbers(case, error), Origin.COLD_START

    def solution(self, answer: Answer) -> Solution:
        """Return a complete solution with switching times; this takes as long as solving the instance once.

        Parameters
        ----------
        answer
            A result of :meth:`solve`.

        Raises
        ------
        ValueError
            If the result is no solution.
        """
        if not answer.status.answered:
            raise ValueError(f"no solution: {answer.message}")

        def method(instance: Instance, limits: Limits) -> Extremal:
            return self._means.full(answer.extremal, limits)

        return solved(answer.extremal.problem.instance, None, self._means.name, method)


def _shooting() -> Means:
    """Return the shooting method; imported late, because SciPy takes longer to load than most instances to solve."""
    from satsym.solvers.repeated.by_shooting import ByShooting

    return ByShooting()


def _answer(found: Extremal, origin: Origin) -> Answer:
    problem, path, answered = found.problem, found.path, found.status.answered
    z = path.nodes * problem.scale.both
    return Answer(
        status=found.status,
        message=found.message,
        objective=found.cost if answered else float("nan"),
        times=problem.instance.t0 + problem.elapsed(path.theta) * path.mesh,
        x=z[: problem.states],
        lam=z[problem.states :],
        origin=origin,
        extremal=found,
    )


def _numbers(
    given: Sequence[float] | None, own: tuple[float, ...], variables: Sequence[Variable], name: str
) -> tuple[float, ...]:
    if given is None:
        return own
    if len(given) != len(own):
        raise ValueError(f"{name} must hold {len(own)} numbers, not {len(given)}")
    return tuple(_number(float(value), v, f"[{name}] {v.symbol}") for value, v in zip(given, variables, strict=True))


def _number(value: float, variable: Variable, key: str) -> float:
    if not np.isfinite(value):
        raise BadInput(f"{key}: {value} is not finite; give a number")
    return value_of(variable, value, key)


class Means(Protocol):
    """A method for extremals of instances that differ in initial state and parameters; it remembers the last one."""

    name: str

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the extremal near the last successful one; ``None`` if none is found, or none is remembered."""

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the extremal found from a straight line at once, if it is a minimum without bounds.

        Otherwise ``None``.
        """

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """Return the result of a cold start."""

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """Return an extremal completed with everything that a full solution contains."""


class _ByCollocation:
    """Repeated solution by collocation, without compiled functions; see :class:`Means`.

    Scales and mesh are kept, and Newton's method starts from the last curve.
    """

    name = "collocation"

    def __init__(self) -> None:
        self._good: tuple[TwoPoint, Curve] | None = None

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the extremal near the last successful one, with bounds imposed gradually again."""
        if self._good is None:
            return None
        problem, curve = replace(self._good[0], instance=case), self._good[1]
        free = problem.relaxed(float("inf"))
        system = System(free, curve.mesh, STAGES)
        outcome = newton(system, curve, tolerance=NEAR_CORRECTION)
        if outcome is None or not outcome.solved or not outcome.curve.in_domain(free.positive):
            return None
        assert outcome.linearised is not None
        try:
            least = negative_directions(free, outcome.curve, outcome.linearised.matching) == 0
        except np.linalg.LinAlgError:
            return None
        turn = system.largest_turn(outcome.curve, system.jacobian(outcome.curve))
        if not least or turn > meshes.COARSEST:
            return None
        cost = system.cost(outcome.curve)
        found = replace(outcome, reason=Reason.MINIMUM, cost=cost, hard=False)
        return self._sound(problem, found, limits)

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the result of Newton's method from the straight line, on the mesh of the last successful curve."""
        if self._good is None or case.tf is None:
            return None
        problem, mesh = replace(self._good[0], instance=case), self._good[1].mesh
        free = problem.relaxed(float("inf"))
        found = straight_through(free, paths.on(free, paths.first(free), mesh), limits)
        return self._sound(problem, found, limits) if found else None

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """Return the result of a cold start with its own mesh and scales; if it fails, that of a search for a guess."""
        found = two_point.from_cold_start(case, limits, self._within)
        if found.status is not Status.NOT_CONVERGED:
            return found
        return two_point.from_cold_start(guessed(case, limits), limits, self._within)

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """Return the extremal unchanged, since collocation already provides everything."""
        return found

    def _sound(self, problem: TwoPoint, found: Attempt, limits: Limits) -> Extremal | None:
        start = Start(found, Origin.LAST_ANSWER, found.iterations)
        extremal = self._within(problem, start, limits)
        return extremal if extremal.status.answered else None

    def _within(self, problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
        extremal = two_point.accurate(problem, start, limits)
        if extremal.status.answered:
            self._good = problem, start.found.curve
        return extremal
