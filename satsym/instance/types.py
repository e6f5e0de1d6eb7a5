"""The checked data of an instance and of its tables."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from satsym.instance.continuation import Varied
from satsym.instance.ends import Side
from satsym.instance.files import SHIPPED
from satsym.instance.orbit import OrbitOptions
from satsym.instance.schema import SolverOptions
from satsym.instance.unknowns import Unknown
from satsym.status import BadInput
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.control_set import ControlSet
    from satsym.kernels import Kernels

Row = tuple[float, ...]


@dataclass(frozen=True)
class BoundedNorm:
    """A set of controls whose norm is bounded."""

    name: str
    """Name of the set that these controls form; empty where it holds all controls of the model."""
    places: tuple[int, ...]
    """Places of the controls among those of the model."""
    lower: float
    upper: float
    unit: str
    """The common unit of the controls; ``"1"`` where they have none in common."""


@dataclass(frozen=True)
class LqrOptions:
    """The cost of a linear-quadratic regulator: the integral of x'Qx + 2x'Nu + u'Ru, without a factor 1/2.

    Parameters
    ----------
    Q
        State weights, n rows of n; symmetric.
    R
        Weights of the active inputs, one row each; symmetric, positive definite.
    inputs
        Names of the active inputs, in the order of `R`.
    horizon
        Length of time, ``None`` for an infinite one.
    relative
        Whether what is weighed counts relative to allowed deviations, as a plain number.
    N
        Cross weights, n rows with a number for each active input; ``None`` where they are zero.
    """

    Q: tuple[Row, ...]
    R: tuple[Row, ...]
    inputs: tuple[str, ...]
    horizon: float | None = None
    relative: bool = False
    N: tuple[Row, ...] | None = None


@dataclass(frozen=True)
class ClassicalOptions:
    """A linear control law that follows a command from time t0 on.

    Parameters
    ----------
    follows
        Name of the state that follows.
    command
        Commanded value of this state, in the model's unit.
    damping
        Damping d; both poles of the loop are at -d. ``None`` where `gains` are given.
    gains
        Gains of the rate and of the state; ``None`` where they follow from `damping`.
    differentiator
        Time constant of the circuit that measures the rate; 0 for an ideal one.
    """

    follows: str
    command: float
    damping: float | None
    gains: tuple[float, float] | None
    differentiator: float


@dataclass(frozen=True)
class DrivenOptions:
    """A control that other instances compute.

    Parameters
    ----------
    control
        Name of the control, which is also the name of a control or a derived quantity of the models of the others.
    by
        Names of the instances that compute the control; there is one run for each.
    """

    control: str
    by: tuple[str, ...]


@dataclass(frozen=True)
class Guess:
    """Where a solver may start: values evenly spaced from t0 to tf, straight lines between; one value is constant.

    Parameters
    ----------
    state, control
        Guesses of states and controls by name; solvers guess those that are left out.
    costate
        Guesses of costates by the names of their states.
    """

    state: Mapping[str, Row] = field(default_factory=dict)
    costate: Mapping[str, Row] = field(default_factory=dict)
    control: Mapping[str, Row] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.state or self.costate or self.control)


@dataclass(frozen=True)
class Instance:
    """One case of a model, checked; all numbers finite (bounds apart) and in the model's units.

    Parameters
    ----------
    name, path, title
        Name of the file without its ending, path of the file, and one line for people.
    model
        Kernels of the model.
    parameters, initial
        Parameters and initial state, in the model's order.
    final
        Given final states by name, in the model's order: a number, or ``"reference"`` for the value of the model's
        reference at the final time. A state that is not here is free.
    t0, tf, tf_guess
        Initial time; final time, ``None`` where it is free; and an initial guess of a free final time, if stated.
    lower, upper
        Bounds of the controls, in the model's order; infinite where there is none.
    max_norm
        Radius of the ball of controls; infinite where there is none.
    solver, lqr, guess
        Options; `lqr` is ``None`` where the instance has none.
    classical, limits
        A law that follows a command, if there is one; and the largest magnitude that is allowed of states and of
        derived quantities, by name.
    deadband
        Error of the position that a switching feedback allows, if it is stated.
    driven
        A control that other instances have worked out, if there is one.
    norms
        Least and largest norm by the name of the set, for products of control sets.
    free
        Initial states, initial time and parameters that are to be found; their fields hold where to begin.
    continuation
        Numbers that change on the way to this problem, if it is solved by continuation.
    ranges
        Lower and upper limits of final states by name, infinite where there is none.
    met
        The active limits, once they are found: by the name of a state, the end of its range at which the final state
        lies, whose value is then in `final`; and by the name of an active inequality at the end, its upper end. Such
        inequalities are then constraints of `model`; one in time alone determines the final time, which is then given.
    orbit
        Frame, centre and epoch of the motion, if they are stated.
    work
        Largest number of columns at which a search may linearise the motion; finite for trial problems only.
    """

    name: str
    path: Path
    title: str
    model: Kernels
    parameters: Row
    initial: Row
    final: Mapping[str, float | Literal["reference"]]
    t0: float
    tf: float | None
    tf_guess: float | None
    lower: Row
    upper: Row
    max_norm: float
    solver: SolverOptions
    lqr: LqrOptions | None
    guess: Guess
    classical: ClassicalOptions | None = None
    limits: Mapping[str, float] = field(default_factory=dict)
    deadband: float | None = None
    driven: DrivenOptions | None = None
    norms: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    free: tuple[Unknown, ...] = ()
    continuation: tuple[Varied, ...] = ()
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    met: Mapping[str, Side] = field(default_factory=dict)
    work: float = math.inf
    orbit: OrbitOptions | None = None

    def meeting(self, met: Mapping[str, Side]) -> Instance:
        """Return the instance with these end limits active, and no others.

        Raises
        ------
        BadInput
            If a limit in time alone is met at no final time that is left.
        """
        from satsym.instance.end_time import end_time, in_time_alone
        from satsym.kernels.active import with_active

        final = {name: value for name, value in self.final.items() if name not in self.met}
        final |= {name: side.of(self.ranges[name]) for name, side in met.items() if name in self.ranges}
        ordered = {name: final[name] for name in self.model.spec.state_names if name in final}
        timed = in_time_alone(self)
        free = replace(self, tf=None) if timed & self.met.keys() else self
        tf = end_time(free, sorted(timed & met.keys()))
        return replace(self, final=ordered, met=dict(met), model=with_active(self.model, met.keys() - timed), tf=tf)

    @cached_property
    def end_limits(self) -> Mapping[str, tuple[Side, ...]]:
        """Return the limits of the end by name: the limited sides of each range, and of each inequality."""
        from satsym.kernels.active import stated

        found = {name: tuple(s for s in Side if math.isfinite(s.of(ends))) for name, ends in self.ranges.items()}
        return found | dict.fromkeys(stated(self.model).spec.terminal_inequalities, (Side.UPPER,))

    @property
    def called(self) -> str:
        """Return the name in messages: the path of the file, or the name of a shipped or Python instance."""
        own = self.path.parent != SHIPPED and self.path.is_file()
        return printable(str(self.path), 200) if own else self.name

    def require_numbers(self) -> None:
        """Refuse an instance that leaves numbers free, for commands that do not optimise.

        Raises
        ------
        BadInput
            With the first of these.
        """
        if self.free:
            raise BadInput(
                f'{self.called}: {self.free[0].key}: the value of "free" is found only by solving the problem; give '
                "a number"
            )

    @property
    def boundary_type(self) -> int:
        """Return the type of the transversality conditions, 1 to 5; one free state makes the final state free."""
        everything = len(self.final) == len(self.initial)
        if self.tf is not None:
            return 1 if everything else 3
        if not everything:
            return 5
        return 4 if "reference" in self.final.values() else 2

    @cached_property
    def bounded_norms(self) -> tuple[BoundedNorm, ...]:
        """Return the bounded norms of controls, in balls, annuli and angles, alone or beside other sets."""
        spec = self.model.spec
        everything = tuple(range(len(spec.controls)))
        found = {"": (everything, (0.0, self.max_norm))} if spec.control_set == "ball" else {}
        for part, (places, _) in zip(spec.control_parts, self.control_set.parts, strict=True):
            if part.name in self.norms:
                found[part.name] = (places, self.norms[part.name])

        def unit(places: tuple[int, ...]) -> str:
            units = {spec.controls[i].unit for i in places}
            return units.pop() if len(units) == 1 else "1"

        return tuple(
            BoundedNorm(name, places, *limits, unit(places))
            for name, (places, limits) in found.items()
            if limits[1] < math.inf
        )

    @cached_property
    def control_set(self) -> ControlSet:
        """Return the set of admissible controls."""
        from satsym.control_set import ControlSet  # here, for it loads numpy, which listing instances does not need

        return ControlSet.of(self.model.spec, self.lower, self.upper, self.max_norm, self.norms)
