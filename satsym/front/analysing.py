"""Analyses and regulators in Python."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from satsym.analysis import subject as subjects
from satsym.front import html
from satsym.front.calls import in_one_line, single_threaded
from satsym.front.instance import Instance
from satsym.instance import Instance as Case
from satsym.kernels import Kernels
from satsym.report.results.files import to_json
from satsym.status import Status

if TYPE_CHECKING:
    from satsym import symbolic
    from satsym.analysis.regulator.feedback import Design
    from satsym.analysis.subject import Analysis as Linear
    from satsym.analysis.subject import Survey
    from satsym.arrays import Array
    from satsym.front.derivation import Derivation
    from satsym.symbolic.equilibria.momenta import Attitudes

Subject: TypeAlias = "Instance | symbolic.Problem | symbolic.Model | Derivation | str | Path"


class _Said(ABC):
    """A result that can be returned as an object for JSON and printed as text."""

    @property
    @abstractmethod
    def _object(self) -> dict[str, Any]: ...

    def to_dict(self) -> dict[str, Any]:
        """Return the object that the command line prints with ``--json``."""
        return dict(self._object)

    def to_json(self) -> str:
        """Return the analysis as JSON text."""
        return to_json(self._object)

    def __getitem__(self, key: str) -> Any:
        return self._object[key]

    def _repr_html_(self) -> str:
        said = self._object
        listed = {key: value for key, value in said.items() if not isinstance(value, Mapping) and key != "units"}
        deeper = [
            f"<details><summary>{html.escape(key)}</summary>{html.facts(value)}</details>"
            for key, value in said.items()
            if isinstance(value, Mapping) and key != "units"
        ]
        return html.page(f"{said['command']} {said['instance'] or said['model']}", [], html.facts(listed), *deeper)


@dataclass(frozen=True, eq=False, repr=False)
class Analysis(_Said):
    """The analysis of a model or of an orbit; ``analysis["stability"]`` is one of its parts.

    Attributes
    ----------
    given
        The instance or model that was analysed.
    linear, orbit
        The linear analysis and the analysis of the orbit, as plain data; one of them may be ``None``.
    derivation
        The derivation of the model if it was analysed without an instance file, otherwise ``None``.
    """

    given: Case | Kernels
    linear: Linear | None
    orbit: Survey | None
    derivation: Derivation | None = None

    @cached_property
    def _object(self) -> dict[str, Any]:
        from satsym.report.results.orbit import examination_object

        derived = self.derivation.derived if self.derivation else None
        return examination_object(self.given, self.linear, self.orbit, derived, self.attitudes)

    @cached_property
    def attitudes(self) -> Attitudes | None:
        """Return all equilibria, if the model is the attitude of a satellite in orbit."""
        from satsym.report.results.linear import attitudes

        return attitudes(self.given, self.derivation.derived if self.derivation else None)

    def __repr__(self) -> str:
        from satsym.report.terminal.linear import analysis_text, attitudes_text
        from satsym.report.terminal.orbit import orbit_text

        parts = [analysis_text(self.linear, False)] if self.linear else []
        parts += [orbit_text(self.orbit, False)] if self.orbit else []
        return "\n\n".join(parts + ([attitudes_text(self.attitudes)] if self.attitudes else []))


@dataclass(frozen=True, eq=False, repr=False)
class Regulator(_Said):
    """The linear feedback u = -K x of minimum cost.

    Attributes
    ----------
    given
        The instance or model for which the feedback was designed.
    design
        The design, as plain data.
    """

    given: Case | Kernels
    design: Design

    @property
    def K(self) -> Array:
        """Return the gain, a row for each active input."""
        return self.design.regulator.K

    @property
    def P(self) -> Array:
        """Return the solution of the Riccati equation."""
        return self.design.regulator.P

    @cached_property
    def _object(self) -> dict[str, Any]:
        from satsym.report.results.linear import regulator_object
        from satsym.report.results.objects import head_about

        return head_about("lqr", self.given, Status.CONVERGED) | regulator_object(self.design)

    def __repr__(self) -> str:
        from satsym.report.terminal.linear import regulator_text

        return regulator_text(self.design)


@single_threaded()
@in_one_line
def analyse(subject: Subject) -> Analysis:
    """Analyse a model near its reference or near an equilibrium, or an orbit about a centre.

    Parameters
    ----------
    subject
        An instance, or a model with its default parameters; as a Python object, a name or a path.

    Returns
    -------
    Analysis
        The analysis, which contains a linear analysis, an analysis of the orbit, or both.

    Raises
    ------
    BadInput
        If the subject cannot be analysed, with one line that gives the reason.
    """
    given, derivation = _given(subject)
    return Analysis(given, *subjects.examined(given), derivation)


@single_threaded()
@in_one_line
def lqr(subject: Subject) -> Regulator:
    """Design the linear feedback u = -K x of minimum cost (linear-quadratic regulator).

    Parameters
    ----------
    subject
        An instance with a table [lqr], or a model, for which all weights are 1; given as for :func:`analyse`.

    Returns
    -------
    Regulator
        The gain K, the solution P of the Riccati equation, and the properties of the closed loop.

    Raises
    ------
    BadInput
        If there is no such feedback, with one line that gives the reason.
    """
    from satsym.analysis.regulator.feedback import designed

    given, _ = _given(subject)
    return Regulator(given, designed(given))


def _given(subject: Subject) -> tuple[Case | Kernels, Derivation | None]:
    """Return the instance or kernels to be analysed, and the derivation if the subject is a model object."""
    if isinstance(subject, Instance):
        subject.case.require_numbers()
        return subject.case, None
    if isinstance(subject, str | Path):
        return subjects.find(str(subject)), None
    from satsym.front.derivation import derive

    derivation = derive(subject)
    return derivation.kernels, derivation
