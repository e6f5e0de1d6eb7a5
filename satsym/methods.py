"""The methods that solve, one record each, from which instance files, the command line and calls are made.

A record names its function as text, so that reading an instance and showing help load no solver.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from satsym.spec import ProblemSpec

BOUNDARY_ARCS = "boundary-arcs"
"""The method for path constraints and points on the way, whose answers have a certificate of their own."""

AUTO = "auto"
"""The value in place of a method's name by which the best method is chosen."""


class Model(Protocol):
    """The traits of an instance's model that the choice of a method depends on."""

    @property
    def spec(self) -> ProblemSpec:
        """Return names and traits of the model."""


class Asked(Protocol):
    """The traits of an instance that decide whether a method can solve it."""

    @property
    def model(self) -> Model:
        """Return the model, which has a cost."""

    @property
    def tf(self) -> float | None:
        """Return the final time; ``None`` where it is free."""

    @property
    def final(self) -> Mapping[str, Any]:
        """Return the given final states by name."""

    @property
    def end_limits(self) -> Mapping[str, Any]:
        """Return the limits of the end, by name."""


@dataclass(frozen=True)
class Method:
    """A method that solves instances.

    Attributes
    ----------
    name
        Name of the method in ``[solver] method``.
    title
        Description in one line for the help of the command line.
    solver
        ``"module:function"`` of the function ``(instance, progress) -> Solution``, imported when it is first called.
    switching
        Whether the method is for controls that enter the Hamiltonian without a square, or else for those that do not.
    constrained
        Whether the method is for problems with path constraints or points on the way, or else for those without.
    automatic
        Whether ``"auto"`` begins with this method for such controls.
    certified
        Whether its answers are accurate enough for a certificate.
    relaxed
        Whether the method uses ``[solver] relaxation``.
    refusal
        Function that returns why the method cannot solve an instance, and what to do; empty if it can.
    remembers
        How many numbers are kept for each step at once: for each state, and for each control.
    """

    name: str
    title: str
    solver: str
    switching: bool = False
    constrained: bool = False
    automatic: bool = False
    certified: bool = True
    relaxed: bool = False
    refusal: Callable[[Asked], str] = lambda _: ""
    remembers: tuple[int, int] = (0, 0)


def _no_sweep(asked: Asked) -> str:
    """Explain why sweeps cannot solve an instance: they need costates at the final time, and meet no final state."""
    spec = asked.model.spec
    if asked.tf is None:
        return 'time.tf: the sweep method does not support a free final time; use method "collocation"'
    if asked.final:
        return (
            f"a given final {', '.join(asked.final)} is not supported by the sweep method; leave it free and "
            'penalise its error in the terminal cost, or use method "collocation"'
        )
    if asked.end_limits:
        return f'the sweep method does not support limits of the final {", ".join(asked.end_limits)}; use "collocation"'
    if spec.multipliers:
        return f'the sweep method does not support the terminal constraints of {spec.name}; use method "collocation"'
    return ""


SWEEP = Method(
    "sweep",
    "forward-backward sweeps, for a free final state",
    "satsym.solvers.by_sweeps:solve",
    certified=False,
    relaxed=True,
    refusal=_no_sweep,
    remembers=(70, 90),  # at nodes and midpoints: twenty pairs of controls and gradients, and what a step makes of them
)

METHODS = {
    method.name: method
    for method in (
        SWEEP,
        Method(
            "collocation",
            "Gauss collocation from a cold start, with mesh refinement",
            "satsym.solvers.by_search:collocation",
            automatic=True,
        ),
        Method("shooting", "multiple shooting from a cold start", "satsym.solvers.by_search:shooting"),
        Method("linear", "closed-form solution of linear canonical equations", "satsym.solvers.linear:solve"),
        Method(
            "bang-bang",
            "exact arcs, for controls whose squares do not enter the cost",
            "satsym.solvers.by_search:bang_bang",
            switching=True,
            automatic=True,
        ),
        Method(
            BOUNDARY_ARCS,
            "exact arcs, for path constraints and waypoints",
            "satsym.solvers.by_search:boundary_arcs",
            constrained=True,
            automatic=True,
        ),
    )
}
"""The methods by name, in the order in which they are listed."""


def names() -> tuple[str, ...]:
    """Return all values of ``[solver] method``."""
    return (AUTO, *METHODS)


def possible(name: str) -> list[Method]:
    """Return the methods that may solve an instance: all for ``"auto"``, else the named one."""
    return [method for method in METHODS.values() if name in (AUTO, method.name)]


def automatic(spec: ProblemSpec) -> Method:
    """Return the method that ``"auto"`` begins with."""
    switches, constrained = spec.switching or spec.throttled, spec.in_arcs
    fitting = (one for one in METHODS.values() if one.automatic and one.constrained == constrained)
    return next(method for method in fitting if constrained or method.switching == switches)


def refusal(name: str, asked: Asked) -> str:
    """Explain why a named method cannot solve an instance, and what to do; empty if it can."""
    spec = asked.model.spec
    if name == AUTO:
        return ""
    if name not in METHODS:
        available = " or ".join(f'"{one}"' for one in names())
        return f'solver.method: "{name}" is not available; use {available}'
    method, instead = METHODS[name], automatic(spec).name
    if method.constrained != spec.in_arcs:
        what = "waypoints" if spec.interior else f"{'' if spec.in_arcs else 'no '}path constraints"
        return f'solver.method: the model has {what}; use "{instead}"'
    if spec.switching and not (method.switching or method.constrained):
        return (
            "solver.method: the squares of the controls do not enter the cost, so the controls switch, which "
            f'"{name}" does not support; use "{instead}"'
        )
    if method.switching and not (spec.switching or spec.throttled):
        return f'solver.method: "{name}" is for controls whose squares do not enter the cost; use "{instead}"'
    return method.refusal(asked)
