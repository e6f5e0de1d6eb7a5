"""The quantities that are drawn against time: states, controls, costates and what ought to stay constant."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import stated_constraints
from satsym.report.display import formula, plain
from satsym.report.plots import curves
from satsym.report.plots.scene import Scene
from satsym.report.results import restrictions
from satsym.report.results.objects import cost_per, time_unit
from satsym.report.said import say
from satsym.solution import Simulation
from satsym.spec import PRODUCT, ProblemSpec, Variable

ON_BOUND = 1e-7
"""How near to a bound a control is on it, relative to the width of its range."""


STEADY = 1e-6
"""A Hamiltonian that ought to be constant varies by less, relative to its terms, or by something to be seen."""

STEP = 1e-30
"""Relative size of complex steps."""

SWITCHED, PASSED = "switching at <times>", "points passed at <times>"
"""What is said of times of a quantity, in English."""


Forbidden: TypeAlias = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Series:
    """One quantity against time."""

    latex: str
    name: str
    """Name as a formula, and in letters where a formula cannot be set."""
    unit: str
    meaning: str
    """Unit and meaning as in :class:`~satsym.spec.Variable`."""
    values: Array
    """At the nodes, NaN where there is nothing to draw."""
    reference: Array | None = None
    free: Array | None = None
    """Values on the reference curve, and in the uncontrolled motion."""
    target: float | None = None
    """The value that is required at the end."""
    angle: bool = False
    """Whether it is an angle."""
    lower: float = -math.inf
    upper: float = math.inf
    """Bounds, infinite where there are none."""
    active: NDArray[np.bool_] | None = None
    """Nodes at which it is on a bound."""
    switching: tuple[float, ...] = ()
    """Times at which it meets or leaves a bound, as in the scene."""
    said: str = SWITCHED
    """What is said of these, in English."""
    size: float = 0.0
    """What counts as large for it, where its values may be nothing but rounding errors."""
    steady: float = 0.0
    """Variation below this fraction of the size is none that matters."""
    from_first: bool = False
    """Whether to count from its first value."""
    from_zero: bool = False
    """Whether its axis must show zero."""
    forbidden: tuple[Forbidden, ...] = ()
    """What path constraints forbid: positive for values at the nodes, of shape (M, N+1), that are not allowed."""
    plain_unit: bool = False
    """Whether its unit stays as it is, so that it belongs to those beside it."""

    @property
    def symbol(self) -> str:
        return formula(self.latex, self.name)


def unit_of(variable: Variable, spec: ProblemSpec) -> str:
    """The unit on an axis: an angle that is stated without one is in radians."""
    return "rad" if variable.unit == "1" and variable.symbol in curves.angles(spec) else variable.unit


def states(scene: Scene) -> list[Series]:
    """The states, with the reference, the motion without control, and when points on the way are passed."""
    passed = tuple(time / scene.time_factor for time in scene.passed)
    return [
        Series(
            v.latex,
            v.symbol,
            unit_of(v, scene.spec),
            plain(say(v.meaning)),
            scene.x[i],
            reference=None if scene.reference is None else scene.reference[i],
            free=None if scene.free is None else scene.free[i],
            target=target(scene, i),
            angle=v.kind == "angle",
            switching=passed,
            said=PASSED,
            forbidden=_forbidden(scene, i),
        )
        for i, v in enumerate(scene.spec.states)
    ]


def _forbidden(scene: Scene, i: int) -> tuple[Forbidden, ...]:
    """What path constraints forbid that depend on this state, and on time, alone."""

    def field(one: restrictions.Restriction) -> Forbidden:
        return lambda values: one.values({i: values}, np.broadcast_to(scene.nodes, values.shape))

    return tuple(field(one) for one in restrictions.within(scene.restrictions, [i], timed=True))


def controls(scene: Scene) -> list[Series]:
    """The controls with their bounds, also their norm where it is bounded; none of a simulation without control."""
    instance, spec = scene.instance, scene.spec
    if isinstance(scene.result, Simulation) and scene.coasting:
        return []
    switching = getattr(scene.result, "switching_times", ()) or ((),) * len(spec.controls)
    box = spec.control_set in ("box", PRODUCT)
    found = [
        Series(
            v.latex,
            v.symbol,
            unit_of(v, scene.spec),
            plain(say(v.meaning)),
            scene.u[i],
            angle=v.symbol in curves.angles(spec),
            lower=instance.lower[i] if box else -math.inf,
            upper=instance.upper[i] if box else math.inf,
            active=_active(scene.u[i], instance.lower[i], instance.upper[i]) if box else None,
            switching=tuple(t / scene.time_factor for t in switching[i]) if box else (),
            from_zero=True,
        )
        for i, v in enumerate(spec.controls)
    ]
    for bound in instance.bounded_norms:
        norm = np.linalg.norm(scene.u[list(bound.places)], axis=0)
        lower = bound.lower or -math.inf
        times = {t / scene.time_factor for i in bound.places for t in switching[i]}
        found.append(
            Series(
                r"\Vert " + (rf"\mathrm{{{bound.name}}}" if bound.name else "u") + r" \Vert",
                f"|{bound.name or 'u'}|",
                spec.controls[bound.places[0]].unit,
                say("norm of <name>", name=bound.name) if bound.name else say("norm of the control"),
                norm,
                lower=lower,
                upper=bound.upper,
                active=_active(norm, lower, bound.upper),
                switching=tuple(sorted(times)),
                from_zero=True,
            )
        )
    return found


def constraints(scene: Scene) -> list[Series]:
    """The path constraints, none of which may be positive, with the times at which they are met and left."""
    instance, spec = scene.instance, scene.spec
    if not (stated := stated_constraints(spec)):
        return []
    with np.errstate(all="ignore"):
        given = scene.nodes, scene.x, scene.u, instance.parameters, instance.control_set.arguments
        rows = curves.clean(instance.model.path_constraints_batch(*given))
    met = getattr(scene.result, "events", ())
    return [
        Series(
            rf"\mathrm{{{name.replace('_', ' ')}}}",
            name,
            "1",
            say("path constraint <name>, which must not be positive", name=name.replace("_", " ")),
            rows[k],
            upper=0.0,
            active=rows[k] >= -ON_BOUND * _largest(rows[k]),
            switching=tuple(event.t / scene.time_factor for event in met if event.name == name),
            said="met at <times>",
            from_zero=True,
        )
        for name, k in stated.items()
    ]


def costates(scene: Scene) -> list[Series]:
    """The costates and the Hamiltonian; nothing for a simulation."""
    if scene.lam is None:
        return []
    model, p = scene.instance.model, scene.instance.parameters
    # what a costate is worth, cost per unit of its state, tells its rounding errors from its values
    widths = np.array([_largest(row) or 1.0 for row in scene.x])
    worth = max(_largest(row) * width for row, width in zip(scene.lam, widths, strict=True))
    found = [
        Series(
            rf"\lambda_{{{v.latex}}}",
            f"lambda_{v.symbol}",
            cost_per(v.unit, scene.spec),
            say("costate of <name>", name=formula(v.latex, v.symbol)),
            values,
            size=worth / width,
            plain_unit=True,
        )
        for v, values, width in zip(scene.spec.states, scene.lam, widths, strict=True)
    ]
    with np.errstate(all="ignore"):
        along = curves.clean(model.hamiltonian_batch(scene.nodes, scene.x, scene.u, scene.lam, p))
        terms = np.abs(scene.lam * model.dynamics_batch(scene.nodes, scene.x, scene.u, p))
    meaning = say("Hamiltonian (constant)" if scene.spec.autonomous else "Hamiltonian")
    time = time_unit(scene.spec)
    rate = cost_per(time, scene.spec) if time else "1"
    steady = STEADY if scene.spec.autonomous else 0.0
    return [
        *found,
        Series("H", "H", rate, meaning, along, size=_largest(curves.clean(terms)), steady=steady, plain_unit=True),
    ]


def invariants(scene: Scene) -> list[Series]:
    """What the uncontrolled motion keeps constant, with its value there."""
    model, p = scene.instance.model, scene.instance.parameters
    if not scene.spec.invariants:
        return []
    with np.errstate(all="ignore"):
        rows = curves.clean(model.invariants_batch(scene.nodes, scene.x, p))
        free = None if scene.free is None else curves.clean(model.invariants_batch(scene.nodes, scene.free, p))
        reference = (
            None if scene.reference is None else curves.clean(model.invariants_batch(scene.nodes, scene.reference, p))
        )
    sizes = _terms(scene)
    return [
        Series(
            v.latex,
            v.symbol,
            v.unit,
            plain(say(v.meaning or v.symbol.replace("_", " "))),
            rows[i],
            reference=None if reference is None else reference[i],
            free=None if free is None else free[i],
            size=max(_largest(rows[i]), sizes[i]),
            from_first=scene.coasting,
        )
        for i, v in enumerate(scene.spec.invariants)
    ]


def _terms(scene: Scene) -> list[float]:
    """How large each invariant would be if the parts that depend on one state did not cancel others."""
    model, p, known = scene.instance.model, scene.instance.parameters, np.isfinite(scene.x).all(axis=0)
    times, x, found = scene.nodes[known], scene.x[:, known], [0.0] * len(scene.spec.invariants)
    for k in range(len(x)):
        beside = x.astype(complex)
        beside[k] += 1j * STEP * x[k]
        with np.errstate(all="ignore"):
            rows = curves.clean(np.imag(model.invariants_batch(times, beside, p)) / STEP)
        found = [max(size, _largest(row)) for size, row in zip(found, rows, strict=True)]
    return found


def target(scene: Scene, i: int) -> float | None:
    """The final value that the instance asks for; of an angle that counts modulo a turn, the nearest one."""
    state, last = scene.spec.states[i], scene.x[i, -1] if scene.x.shape[1] else math.nan
    given = scene.instance.final.get(state.symbol)
    if given is None:
        return None
    if given == "reference":
        if scene.reference is None or not scene.reference.shape[1]:
            return None
        given = float(scene.reference[i, -1])
    if state.symbol in scene.instance.solver.free_angles and math.isfinite(last):
        turn = 360.0 if state.unit.startswith("deg") else 2.0 * math.pi
        given += turn * round((last - given) / turn)
    return float(given)


def _active(values: Array, lower: float, upper: float) -> NDArray[np.bool_] | None:
    if not (math.isfinite(lower) or math.isfinite(upper)):
        return None
    near = ON_BOUND * (upper - lower if math.isfinite(upper - lower) else _largest(values))
    with np.errstate(invalid="ignore"):
        return (values <= lower + near) | (values >= upper - near)


def _largest(values: Array) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))
