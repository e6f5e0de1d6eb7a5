"""The problem that is proved: every feature of an instance is either recognised here, or refused by name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Any

from flint import arb

from satsym.control_part import ControlPart
from satsym.instance import Instance
from satsym.instance.control import MAX_NORM, MIN_NORM
from satsym.instance.ends import Side
from satsym.instance.resolve import REFERENCE
from satsym.instance.unknowns import Place
from satsym.proof.balls.arithmetic import Ball, BeyondProof, constant
from satsym.proof.balls.exact import Source
from satsym.proof.balls.kernel import CONSTRAINTS, BallKernel
from satsym.proof.lifting import Lifted
from satsym.spec import ProblemSpec

_OF_INSTANCES = frozenset(
    """name path title model parameters initial final t0 tf tf_guess lower upper max_norm solver lqr guess classical
    limits deadband driven norms free continuation ranges met work orbit""".split()
)
"""The fields of instances that a proof covers; `orbit` only places a motion in the sky."""

_OF_MODELS = frozenset(
    """name title source states controls parameters control_set has_cost has_terminal_cost has_reference autonomous
    invariants position multipliers outputs linear keplerian switching coordinates velocities quantities balances
    switching_curve conditions equilibria control_parts mode_groups maximise objective_unit chattering moving_magnitudes
    path_constraints linear_quadratic terminal_inequalities interior""".split()
)
"""The fields of models that a proof covers; an instance or a model with other fields is refused."""


_ALONG = frozenset(
    """dynamics running_cost costate_rate control_law control_hessian canonical canonical_jacobian extremal_jacobian
    switching_function magnitude_weight throttle_slope path_constraints path_rates path_gradient path_effect
    path_multiplier path_vanishing boundary_control""".split()
)
"""Functions of generated modules that are evaluated along an extremal."""
_NOTHING: Mapping[str, Side] = MappingProxyType({})


@dataclass(frozen=True)
class Target:
    """The target of a final state.

    Attributes
    ----------
    value
        Given value; ``None`` for a state on the reference.
    side
        The end of its range that is met; ``None`` where the value is given.
    turns
        Number of whole turns that are added to an angle counted modulo a turn; ``None`` for other states.
    """

    value: Ball | None
    side: Side | None = None
    turns: int | None = None


@dataclass(frozen=True)
class Statement:
    """The exact statement of a problem, with numbers as balls of the present precision.

    Attributes
    ----------
    bounds
        The argument of that name: constants, infinite floats, and what regularises nothing.
    targets
        Conditions on final states by the place of the state; a state without one is free.
    open_ranges
        The ends between which free final states must lie, by the place of the state.
    free
        Places of the initial states that are free; in `initial` they have the values where a solver begins.
    active, limits
        Places of the constraints at the end that hold with equality, and of those that are inequalities.
    clock
        The place of time among the states; ``None`` where it is none. It is one where the initial time is free, and
        `t0` and `tf` are then counted from it.
    """

    case: Instance
    kernel: BallKernel
    source: Source
    parameters: list[Ball]
    initial: list[Ball]
    t0: Ball
    tf: Ball | None
    bounds: tuple[Any, ...]
    lower: list[Any]
    upper: list[Any]
    targets: dict[int, Target]
    open_ranges: dict[int, tuple[Any, Any]]
    free: tuple[int, ...]
    active: tuple[int, ...]
    limits: tuple[int, ...]
    clock: int | None = None

    @property
    def spec(self) -> ProblemSpec:
        """Return the specification of the model."""
        return self.kernel.spec

    @property
    def p(self) -> list[Any]:
        """Return the parameters as constants."""
        return [constant(v) for v in self.parameters]

    @property
    def own(self) -> int:
        """Return the number of the model's own states."""
        return len(self.case.model.spec.states)


def stated(case: Instance, met: Mapping[str, Side] = _NOTHING, last: Sequence[float] = ()) -> Statement:
    """Return the statement of an instance's problem.

    Parameters
    ----------
    met
        Ends of ranges at which final states are, by name.
    last
        Final states of an answer, by which angles that count modulo a turn are those near by.

    Raises
    ------
    BeyondProof
        If the instance has a feature that no theorem here covers.
    """
    refuse(case)
    spec, source = case.model.spec, Source(case)
    unknown = {one.name for one in case.free if one.place is Place.PARAMETER}
    parameters = [
        source.free(value, "parameters", v.symbol)
        if v.symbol in unknown
        else source.number(value, v.unit, "parameters", v.symbol)
        if value != v.default or source.gives("parameters", v.symbol)
        else source.default(value, "parameters", v.symbol)
        for v, value in zip(spec.parameters, case.parameters, strict=True)
    ]
    free = tuple(sorted(one.index for one in case.free if one.place is Place.INITIAL))
    initial = [
        source.free(value, "initial", v.symbol) if i in free else source.number(value, v.unit, "initial", v.symbol)
        for i, (v, value) in enumerate(zip(spec.states, case.initial, strict=True))
    ]
    time = _time_unit(case) if source.has_units("time") else "1"
    targets, ranges = _ends(case, source, met)
    if case.solver.free_angles:
        targets = {i: _turned(case, i, target, last[i] if last else 0.0) for i, target in targets.items()}
    kernel = BallKernel(case.model)
    _refuse_cases(kernel)
    starts = any(one.place is Place.TIME for one in case.free)
    lower, upper = (
        [
            source.number(value, v.unit, "control", v.symbol, side) if math.isfinite(value) else value
            for v, value in zip(spec.controls, row, strict=True)
        ]
        for side, row in enumerate((case.lower, case.upper))
    )
    statement = Statement(
        case,
        kernel,
        source,
        parameters,
        initial,
        source.free(case.t0, "time", "t0") if starts else source.number(case.t0, time, "time", "t0"),
        None if case.tf is None else source.number(case.tf, time, "time", "tf"),
        _bounds(case, source, lower, upper),
        lower,
        upper,
        targets,
        ranges,
        free,
        *_constraints(spec, met),
    )
    places = [i for i, v in enumerate(spec.parameters) if v.symbol in unknown]
    return _lifted(statement, places, starts) if places or starts else statement


def _lifted(statement: Statement, places: Sequence[int], starts: bool) -> Statement:
    """Return the problem with free parameters among its states, and time where it is free or enters the motion."""
    spec, t0, tf = statement.spec, statement.t0, statement.tf
    on_reference = [i for i, target in statement.targets.items() if target.value is None]
    clocked = starts or not spec.autonomous
    kernel, own = Lifted(statement.case.model, places, clocked, on_reference), len(spec.states)
    clock = own + len(places) if clocked else None
    free = [*statement.free, *range(own, own + len(places)), *([clock] if starts else [])]
    targets = {i: target for i, target in statement.targets.items() if target.value is not None}
    before = len(on_reference)
    if clock is not None and starts and tf is not None:
        targets[clock], tf = Target(tf), None
    if clock is not None and tf is not None:
        tf = tf - t0
    return replace(
        statement,
        kernel=kernel,
        initial=[*statement.initial, *(statement.parameters[i] for i in places), *([t0] if clocked else [])],
        t0=arb(0) if clocked else t0,
        tf=tf,
        targets=targets,
        free=tuple(i for i in free if i is not None),
        active=(*range(before), *(before + k for k in statement.active)),
        limits=tuple(before + k for k in statement.limits),
        clock=clock,
    )


def _constraints(spec: ProblemSpec, met: Mapping[str, Side]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the places of constraints at the end that hold with equality, and of the inequalities."""
    names, first = spec.terminal_inequalities, len(spec.multipliers) - len(spec.terminal_inequalities)
    active = [*range(first), *(first + k for k, name in enumerate(names) if name in met)]
    return tuple(active), tuple(range(first, len(spec.multipliers)))


def walled(statement: Statement) -> bool:
    """Tell whether path constraints limit the states alone."""
    return bool(statement.spec.path_constraints) and not mixed(statement.spec)


def mixed(spec: ProblemSpec) -> bool:
    """Tell whether path constraints contain the control."""
    return any(one.order == 0 for one in spec.path_constraints)


def _time_unit(case: Instance) -> str:
    from satsym import units

    spec = case.model.spec
    return units.time_unit(v.unit for v in (*spec.states, *spec.controls, *spec.parameters))


def _turned(case: Instance, i: int, target: Target, last: float) -> Target:
    """Return the target of an angle modulo a turn that is nearest to a final state; other targets are unchanged."""
    name = case.model.spec.state_names[i]
    if name not in case.solver.free_angles:
        return target
    if target.value is None or target.side is not None:
        raise BeyondProof(
            "a final angle that counts modulo a full turn and is required to lie on the reference or in a range"
        )
    return replace(target, turns=round((last - float(target.value.mid())) / math.tau))


def _ends(
    case: Instance, source: Source, met: Mapping[str, Side]
) -> tuple[dict[int, Target], dict[int, tuple[Any, Any]]]:
    targets: dict[int, Target] = {}
    ranges: dict[int, tuple[Any, Any]] = {}
    for i, v in enumerate(case.model.spec.states):
        name = v.symbol
        if name in case.ranges:
            low, high = (
                source.number(value, v.unit, "final", name, side) if math.isfinite(value) else value
                for side, value in enumerate(case.ranges[name])
            )
            if name in met:
                targets[i] = Target(high if met[name] is Side.UPPER else low, met[name])
            else:
                ranges[i] = (low, high)
        elif (given := case.final.get(name)) == REFERENCE:
            targets[i] = Target(None)
        elif isinstance(given, float):
            written = source.number(given, v.unit, "final", name)
            targets[i] = Target(written)
    return targets, ranges


def _bounds(case: Instance, source: Source, lower: list[Any], upper: list[Any]) -> tuple[Any, ...]:
    """Return the argument ``bounds`` of generated functions."""
    spec = case.model.spec
    if spec.switching or spec.control_set == "free":
        return ()
    if spec.control_set == "box":
        return tuple(constant(v) if not isinstance(v, float) else v for v in (*lower, *upper))
    if spec.control_set == "ball":
        if math.isinf(case.max_norm):
            return (case.max_norm,)
        return (constant(source.number(case.max_norm, spec.controls[0].unit, "control", "max_norm")),)
    (part,) = spec.control_parts
    if part.kind == "angle":
        return (constant(1), constant(0))  # full length, nothing regularised
    largest, least = (_norm(case, source, part, key) for key in (MAX_NORM, MIN_NORM))
    # Of what regularises, nothing is left on an arc that is wholly on or off.
    left = (constant(0),) if part.branch == "direction" else (constant(arb("1e-100")), constant(1))
    if part.kind == "annulus":
        return (least, largest, *left)
    return (largest, *left, *([least] if part.branch == "throttled" else []))


def _norm(case: Instance, source: Source, part: ControlPart, key: str) -> Any:
    """Return the largest or the smallest norm of a vector of controls."""
    value = case.norms[part.name][key == MAX_NORM]
    if key == MIN_NORM and value == 0.0:
        return constant(0)
    keys = ("control", part.name, key) if source.gives("control", part.name) else ("control", key)
    return constant(source.number(value, case.model.spec.controls[0].unit, *keys))


def _refuse_cases(kernel: BallKernel) -> None:
    """Refuse motions and costs with cases, except for magnitudes in the cost of controls that switch."""
    spec = kernel.spec
    besides = (("reference",) if spec.has_reference else ()) + (("path_constraints",) if spec.path_constraints else ())
    besides += (CONSTRAINTS,) if spec.multipliers else ()
    for name in ("dynamics", "running_cost", "terminal_cost", *besides):
        known = {f"{control}{after}" for control in spec.control_names for after in ("", "_value")}
        allowed = known if name == "running_cost" and spec.switching else set()
        if set(kernel.cases(name)) - allowed:
            raise BeyondProof("a motion, a cost or a constraint that is defined piecewise or contains absolute values")
    timed = kernel.timed & _ALONG
    if any(name.startswith(("path_", "boundary_")) for name in timed):
        raise BeyondProof("path constraints that depend on time")
    if spec.autonomous and timed:
        raise BeyondProof("a motion that depends on time, although the model is declared not to")


def refuse(case: Instance) -> None:
    """Refuse an instance with a feature that no theorem covers.

    Raises
    ------
    BeyondProof
        With the feature.
    """
    spec = case.model.spec
    unknown = {f.name for f in fields(case)} - _OF_INSTANCES | {f.name for f in fields(spec)} - _OF_MODELS
    if unknown:
        raise BeyondProof(f"a feature that proofs do not support ({', '.join(sorted(unknown))})")
    if not spec.has_cost:
        raise BeyondProof("a model without a cost")
    orders = {one.order for one in spec.path_constraints}
    lifts = any(one.place is not Place.INITIAL for one in case.free)
    for there, feature in (
        (spec.path_constraints and spec.control_set != "free", "path constraints together with bounds of the controls"),
        (
            0 in orders and len(orders) > 1,
            "path constraints on states and the control together with constraints on states alone",
        ),
        (mixed(spec) and len(spec.controls) != 1, "constraints on states and several controls"),
        (spec.interior, "waypoints"),
        (spec.chattering, "chattering controls"),
        (spec.moving_magnitudes, "magnitudes of controls in the motion"),
        (lifts and spec.path_constraints, "path constraints together with free parameters or a free initial time"),
        (
            spec.conditions and any(one.place is Place.PARAMETER for one in case.free),
            "free parameters that must obey conditions together",
        ),
        (
            lifts and any(part.branch == "throttled" for part in spec.control_parts),
            "throttled thrust together with free parameters or a free initial time",
        ),
        (spec.equilibria, "a model of an attitude in orbit"),
    ):
        if there:
            raise BeyondProof(feature)
    if spec.control_set not in ("free", "box", "ball", "product"):
        raise BeyondProof(f"a control set of the kind {spec.control_set}")
    if spec.switching and spec.control_set != "box":
        raise BeyondProof("controls that switch in a set that is not a box")
    if spec.control_set != "product":
        return
    if len(spec.control_parts) != 1 or len(spec.control_parts[0].controls) != len(spec.controls):
        raise BeyondProof("a product of several control sets")
    (part,) = spec.control_parts
    known = part.kind == "angle" or (part.normed and part.branch in ("direction", "throttled"))
    if not known or part.turned_by or (part.kind == "angle" and len(part.controls) != 1):
        raise BeyondProof(f"a control set of the kind {part.kind} with a law of the kind {part.branch}")
