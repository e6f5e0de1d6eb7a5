"""Simulated motions in Python, and their export to other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

from satsym.front import html
from satsym.front.calls import in_one_line, single_threaded
from satsym.front.instance import Instance, as_case
from satsym.front.result import Result
from satsym.front.solution import Solution
from satsym.report.results.files import write_text
from satsym.report.results.objects import simulation_object
from satsym.report.terminal.solution import simulation_text
from satsym.solution import Invariant, Simulation


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
