"""The quantities that are drawn against time: states, controls, costates, Hamiltonian and invariants."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import stated_constraints
from satsym.report.display import formula, norm_latex, norm_text, plain
from satsym.report.plots import curves
from satsym.report.plots.scene import Scene
from satsym.report.results import restrictions
from satsym.report.results.objects import cost_per, time_unit
from satsym.report.said import say
from satsym.solution import Simulation
from satsym.spec import PRODUCT, ProblemSpec, Variable

ON_BOUND = 1e-7
"""Distance of a control from its bound, relative to the width of its range, up to which it counts as saturated."""


STEADY = 1e-6
"""Variation of a constant Hamiltonian, relative to its terms, above which the variation is displayed."""

STEP = 1e-30
"""Relative size of complex steps."""

SWITCHED, PASSED = "switching at <times>", "waypoints passed at <times>"
REACHED = "met or left at <times>"
"""English descriptions of the marked times of a quantity."""


Forbidden: TypeAlias = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Series:
    """One quantity against time."""

    latex: str
    name: str
    """Name as a formula, and in letters where a formula cannot be set."""
    unit: str
    meaning: str
    """Unit and meaning, as in :class:`~satsym.spec.Variable`."""
    values: Array
    """Values at the nodes, NaN where nothing is plotted."""
    reference: Array | None = None
    free: Array | None = None
    """Values on the reference curve, and in the uncontrolled motion."""
    target: float | None = None
    """The required final value."""
    angle: bool = False
    """Whether the quantity is an angle."""
    lower: float = -math.inf
    upper: float = math.inf
    """Bounds, infinite if there are none."""
    active: NDArray[np.bool_] | None = None
    """Nodes at which the quantity is at a bound."""
    switching: tuple[float, ...] = ()
    """Times at which the quantity meets or leaves a bound, in the displayed unit of time."""
    said: str = SWITCHED
    """The English description of the marked times."""
    size: float = 0.0
    """Typical magnitude of the quantity, by which rounding errors are recognised."""
    steady: float = 0.0
    """Fraction of the magnitude below which a variation is insignificant."""
    from_first: bool = False
    """Whether values are shown relative to the first one."""
    from_zero: bool = False
    """Whether the axis must include zero."""
    forbidden: tuple[Forbidden, ...] = ()
    """Functions of path constraints, positive for forbidden values (M, N+1) at the nodes."""
    plain_unit: bool = False
    """Whether the unit is left unchanged, so that neighbouring panels have the same unit."""

    @property
    def symbol(self) -> str:
        return formula(self.latex, self.name)


def unit_of(variable: Variable, spec: ProblemSpec) -> str:
    """Return the unit on an axis; an angle that is stated without one is in radians."""
    return "rad" if variable.unit == "1" and variable.symbol in curves.angles(spec) else variable.unit


def states(scene: Scene) -> list[Series]:
    """Return the states, with the reference, the uncontrolled motion, and times of points on the way."""
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
    """Return what path constraints that depend only on this state, and on time, forbid."""

    def field(one: restrictions.Restriction) -> Forbidden:
        return lambda values: one.values({i: values}, np.broadcast_to(scene.nodes, values.shape))

    return tuple(field(one) for one in restrictions.within(scene.restrictions, [i], timed=True))


def controls(scene: Scene) -> list[Series]:
    """Return the controls with bounds, and their norm where it is bounded; none without control."""
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
                norm_latex([spec.controls[i].latex for i in bound.places]),
                norm_text([spec.control_names[i] for i in bound.places]),
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
    """Return the path constraints, none of which may be positive, with times of entry and exit."""
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
            said=REACHED,
            from_zero=True,
        )
        for name, k in stated.items()
    ]


def unseen(scene: Scene, in_path: bool) -> list[Series]:
    """Return the path constraints that neither the panel of a state nor the picture of the path shows."""
    seen = {one.name for one in scene.restrictions if len(one.states) == 1 or in_path}
    return [one for one in constraints(scene) if one.name not in seen]


def costates(scene: Scene) -> list[Series]:
    """Return the costates and the Hamiltonian; nothing for a simulation."""
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
    """Return the invariants of the uncontrolled motion, with their value there."""
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
    """Return the size of each invariant if the parts that depend on one state did not cancel others."""
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
    """Return the required final value; for an angle modulo a turn, the nearest one."""
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
