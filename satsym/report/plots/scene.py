"""A result prepared for drawing: trajectories, what is drawn beside them, and readable times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.shown import spec_of
from satsym.report import display
from satsym.report.plots import curves
from satsym.report.results import restrictions
from satsym.report.said import message, say
from satsym.solution import Iteration, Simulation, Solution
from satsym.spec import ProblemSpec

ROUNDING = 1e-9
"""Distance from the reference, relative to its size, up to which a state counts as being on the reference."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A solution or a simulation, with what is drawn beside it."""

    result: Solution | Simulation
    """The solution or simulation that is plotted."""
    name: str
    """Name of the motion in a legend."""
    times: Array
    time_unit: str
    """Nodes in a readable unit of time, and that unit; ``"1"`` if the model has no unit of time."""
    time_factor: float
    """Number of the model's units of time in that unit."""
    x: Array
    u: Array
    lam: Array | None
    """Values of the result, NaN if they cannot be plotted; ``lam`` is ``None`` for a simulation."""
    reference: Array | None
    free: Array | None
    """States of the reference curve and of the uncontrolled motion at the nodes.

    ``None`` if there is none; the uncontrolled motion also if it equals the motion itself or lies on the reference.
    """

    @classmethod
    def of(cls, result: Solution | Simulation) -> Scene:
        """Gather what the pictures of a result show."""
        instance, nodes = result.instance, np.asarray(result.times, dtype=float)
        spec, p = spec_of(instance), instance.parameters
        variables = (*spec.states, *spec.controls, *spec.parameters)
        factor, unit = display.time_scale((v.unit for v in variables), float(np.ptp(nodes)) if len(nodes) else 0.0)
        x, reference = curves.states(instance.model, result.x), None
        if spec.has_reference:
            reference = curves.reference(instance.model, nodes, p)
        return cls(
            result=result,
            name=_name(result),
            times=nodes / factor,
            time_unit=unit,
            time_factor=factor,
            x=x,
            u=curves.clean(result.u),
            lam=curves.clean(result.lam) if isinstance(result, Solution) and spec.has_cost else None,
            reference=reference,
            free=_free(result, nodes, x, reference),
        )

    @property
    def instance(self) -> Instance:
        return self.result.instance

    @cached_property
    def spec(self) -> ProblemSpec:
        return spec_of(self.instance)

    @property
    def title(self) -> str:
        """Return the subject of the instance in one line."""
        title = say(self.instance.title or self.spec.title) or self.instance.name
        return display.raised(display.with_powers(title))

    @property
    def nodes(self) -> Array:
        """Return the nodes in the model's unit of time."""
        return np.asarray(self.result.times, dtype=float)

    @property
    def coasting(self) -> bool:
        """Tell whether there is no control at any time."""
        return _coasts(self.result)

    @property
    def drawable(self) -> bool:
        """Tell whether there is any trajectory to draw."""
        return len(self.times) > 1 and int(np.isfinite(self.x).all(axis=0).sum()) > 1

    @cached_property
    def rated(self) -> list[tuple[int, int]]:
        """Return the places of states, and of the states that are their rates."""
        return curves.pairs(self.instance.model, self.nodes, self.x, self.u, self.instance.parameters)

    @cached_property
    def restrictions(self) -> list[restrictions.Restriction]:
        """Return the path constraints on states alone."""
        return restrictions.of(self.instance, self.nodes, self.x, self.u)

    @property
    def passed(self) -> tuple[float, ...]:
        """Return the times, in the model's unit, at which points on the way are passed."""
        return tuple(event.t for event in getattr(self.result, "events", ()) if event.kind == "interior")

    @property
    def history(self) -> tuple[Iteration, ...]:
        return self.result.history if isinstance(self.result, Solution) else ()


def _name(result: Solution | Simulation) -> str:
    if isinstance(result, Solution):
        return say("solution" if result.status.answered else "last iterate")
    if result.feedback != "none":
        return say("with <law>", law=message(result.feedback))
    return say("uncontrolled" if _coasts(result) else "trajectory")


def _free(result: Solution | Simulation, nodes: Array, x: Array, reference: Array | None) -> Array | None:
    """Return states of the uncontrolled motion, unless that is drawn already."""
    model, p = result.instance.model, result.instance.parameters
    if _coasts(result) or not curves.rests(model, nodes, x, p):
        return None
    found = curves.uncontrolled(model, nodes, result.instance.initial, p)
    if reference is not None and np.allclose(found, reference, rtol=ROUNDING, atol=ROUNDING * _size(reference)):
        return None
    return found


def _size(values: Array) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _coasts(result: Solution | Simulation) -> bool:
    return len(result.times) < 2 or not bool((np.nan_to_num(result.u) != 0.0).any())
