"""Solutions of optimal control problems and simulated motions in Python, and their export to other programs."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from satsym import solution, solvers
from satsym.arrays import Array, distinct
from satsym.front import between, html
from satsym.front.calls import in_one_line, single_threaded
from satsym.front.curves import Curve
from satsym.front.instance import Instance, as_case
from satsym.front.result import Result
from satsym.report.results.files import write_text
from satsym.report.results.objects import simulation_object, solution_object
from satsym.report.terminal.certificate import condition_rows, verdict_text
from satsym.report.terminal.solution import boundary, simulation_text, solution_text, state_rows
from satsym.solution import Certificate, Event, Invariant, Progress, Simulation
from satsym.solvers.constrained.structure import stated_arcs

if TYPE_CHECKING:
    from satsym.front.proving import Proof


class Solution(Result[solution.Solution]):
    """A solution with its certificate, or the reason why there is none."""

    _command: ClassVar[str] = "solve"

    @property
    def objective(self) -> float:
        """Return the objective J as the model states it: the cost, or what is maximised; NaN without a solution."""
        return float(self._spec.objective(self.found.objective))

    @property
    def method(self) -> str:
        """Return the name of the method that solved the instance."""
        return self.found.method

    @property
    def certificate(self) -> Certificate | None:
        """Return the certificate of the solution, or ``None`` if there is none."""
        return self.found.certificate

    @property
    def switching_times(self) -> dict[str, tuple[float, ...]]:
        """Return, for each control, the times at which it reaches or leaves a bound."""
        return dict(zip(self._spec.control_names, self.found.switching_times, strict=True))

    @property
    def events(self) -> tuple[Event, ...]:
        """Return the entries, exits and touch points of path constraints, and waypoints, in order of time."""
        return self.found.events

    @property
    def iterations(self) -> int:
        """Return the number of iterations of the method."""
        return self.found.iterations

    @property
    def wall_s(self) -> float:
        """Return the time that solving took, in seconds."""
        return self.found.wall_s

    @cached_property
    def lam(self) -> Curve:
        """Return the costates over time, by the names of their states."""
        n = len(self.found.x)
        return self._curve("lam", self.found.lam, self._spec.state_names, lambda t: self._motion[0](t)[n:])

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym solve --json`` prints."""
        return solution_object(self.found)

    def prove(self, digits: int = 20) -> Proof:
        """Prove that this solution is a minimum, as :func:`satsym.prove` does."""
        from satsym.front.proving import proved

        return proved(self.instance.case, lambda: self.found, digits)

    @property
    def _lam(self) -> Array:
        return self.found.lam

    @cached_property
    def _motion(self) -> tuple[between.Motion, between.Pieces | None]:
        found, case = self.found, self.found.instance
        if case.model.spec.switching:  # the law of the kernels is that of the regularised problem
            return between.controlled(case, found.times, found.x, found.u, found.lam)
        if found.events:
            return between.bounded(case, found.times, found.x, found.lam, stated_arcs(found))
        corners = distinct([t for times in found.switching_times for t in times])
        return between.extremal(case, found.times, found.x, found.lam, corners)

    @np.errstate(all="ignore")
    def _law(self, t: Array, z: Array) -> Array:
        case, n = self.found.instance, len(self.found.x)
        bounds = case.control_set.arguments
        return np.asarray(case.model.control_law_batch(t, z[:n], z[n:], case.parameters, bounds))

    def __repr__(self) -> str:
        return solution_text(self.found)

    def _repr_html_(self) -> str:
        said, found, instance = self.to_dict(), self.certificate, self.found.instance
        # as the command line has them: a final state that is nothing but rounding is zero
        rows = state_rows(instance, self.found.times, self.found.x, self.found.lam) if len(self.times) else []
        names, *states = rows or [()]
        facts = {
            "objective": said["objective"],
            "final time": said["t_final"],
            "method": said["method"],
            "boundary type": boundary(instance),
            **{f"switching times of {name}": times for name, times in self.switching_times.items() if times},
            "certificate": verdict_text(found, self._spec.maximise) if found else None,
        }
        header, *checks = condition_rows(found) if found else [()]
        return self._html(facts, html.table(names, states), html.table(header, checks))


@single_threaded()
@in_one_line
def solve(instance: Instance | str | Path, progress: Progress | None = None, **options: Any) -> Solution:
    """Solve an instance and certify the solution.

    Parameters
    ----------
    instance
        An instance, or the name or path of one, which is then loaded.
    progress
        Function that is called after each iteration.
    options
        Options of the table [solver], which override those of the instance: ``method``, ``steps``, ``tolerance``,
        ``max_seconds``, ...

    Returns
    -------
    Solution
        The solution; if there is none, ``status`` and ``message`` give the reason.

    Raises
    ------
    BadInput
        If the instance cannot be used, with a one-line message that says what is wrong, where, and what to do.

    Examples
    --------
    ::

        solution = satsym.solve("soft-return", steps=200)
        solution.objective, solution.x["r"](1.5), solution.certificate.verdict
    """
    case = as_case(instance)
    case = case.with_(solver=options) if options else case
    found = solvers.solve(case.case, progress)
    if case.case.limits:
        from satsym.analysis.comparison import limits_noted

        found = limits_noted(found)
    found_there = case.case.free or case.case.end_limits  # which the instance of what was found says
    return Solution(case, found if found_there else replace(found, instance=case.case))


class Trajectory(Result[Simulation]):
    """A simulated motion; between nodes, the controls are interpolated, as the control law itself is not stored."""

    _command: ClassVar[str] = "simulate"

    @property
    def feedback(self) -> str:
        """Return the name of the control law."""
        return self.found.feedback

    @property
    def invariants(self) -> dict[str, Invariant]:
        """Return the conserved quantities by name: their initial values and their drift."""
        return self.found.invariants

    @property
    def metrics(self) -> dict[str, float]:
        """Return the quantities that describe the motion, by name."""
        return self.found.metrics

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym simulate --json`` prints."""
        return simulation_object(self.found)

    def __repr__(self) -> str:
        return simulation_text(self.found)

    def _repr_html_(self) -> str:
        said = self.to_dict()
        kept = [(name, one["initial"], one["drift"]) for name, one in said["invariants"].items()]
        return self._html(
            {name: said[name] for name in ("feedback", "t_final")},
            html.table(("state", "final"), said["x_final"].items()),
            html.table(("invariant", "initial", "drift"), kept),
            html.table(("metric", "value"), said["metrics"].items()),
        )


@single_threaded()
@in_one_line
def simulate(instance: Instance | str | Path, feedback: str | None = None) -> Trajectory:
    """Simulate the motion of an instance under a control law.

    Parameters
    ----------
    instance
        An instance, or the name or path of one, which is then loaded.
    feedback
        ``"none"``, ``"lqr"``, ``"classical"``, ``"switching"`` or ``"pulses"``; by default classical if the instance
        specifies such a law, otherwise none.

    Returns
    -------
    Trajectory
        The simulated motion with its conserved quantities and metrics.

    Raises
    ------
    BadInput
        If the instance cannot be used, or not with this feedback.
    """
    from satsym.analysis.regulator.feedback import simulate as simulated

    case = as_case(instance)
    return Trajectory(case, simulated(case.case, feedback))


@in_one_line
def export(result: Solution | Trajectory, kind: str, path: str | Path | None = None) -> str:
    """Export a motion about a central body for other programs.

    Parameters
    ----------
    result
        Solution or simulated motion of an instance with a table [orbit].
    kind
        ``"oem"`` (CCSDS Orbit Ephemeris Message), ``"czml"`` (Cesium), ``"stk"`` (STK ephemeris) or ``"csv"``.
    path
        File to which the text is also written; an existing file is replaced.

    Returns
    -------
    str
        The text of the file.

    Raises
    ------
    BadInput
        If the instance has no usable table [orbit], or if the library that writes the format is not installed, with a
        one-line message that says what is wrong, where, and what to do.

    Examples
    --------
    ::

        satsym.export(satsym.solve("return-to-geo"), "oem", "geo.oem")
    """
    from satsym.report.exchange import exported

    text = exported(result.found, kind)
    if path is not None:
        write_text(Path(path), text)
    return text
