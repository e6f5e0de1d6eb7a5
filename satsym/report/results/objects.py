"""The objects of ``--json`` and result.json, in the model's order, without NaN or infinity."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from satsym import units as expressions
from satsym.control_part import ControlPart
from satsym.control_set import stated_constraints
from satsym.instance.unknowns import Place
from satsym.report import display
from satsym.report.results.certificate import certificate_object, plain
from satsym.source_files import digest_of
from satsym.spec import ProblemSpec, Variable
from satsym.status import Status
from satsym.version import __version__

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from satsym.arrays import Array
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.solution import CostInterval, Simulation, Solution
    from satsym.spec import ProblemSpec


SCHEMA = 1
"""Version of the result objects, increased when a key changes its meaning or is removed."""


def head(command: str, spec: ProblemSpec, instance: Instance | None, status: Status) -> dict[str, Any]:
    """Return the keys with which the object of every command begins.

    Parameters
    ----------
    instance
        ``None`` where the command is about a model, or about several instances.
    """
    return {
        "satsym": __version__,
        "schema": SCHEMA,
        "command": command,
        "model": spec.name,
        "instance": instance.name if instance else None,
        "status": status.value,
        "units": units(spec),
        "instance_file": file_of(instance) if instance else None,
    }


def file_of(instance: Instance) -> dict[str, str] | None:
    """Return the name of an instance's file with a digest of it; ``None`` for an instance made in Python."""
    digest = digest_of(instance.path)
    return {"name": instance.path.name, "digest": digest} if digest else None


def head_about(command: str, given: Instance | Kernels, status: Status) -> dict[str, Any]:
    """Return the head of an object that is about an instance, or about a model as such."""
    from satsym.kernels import Kernels

    if isinstance(given, Kernels):
        return head(command, given.spec, None, status)
    return head(command, given.model.spec, given, status)


def with_settings(result: dict[str, Any], given: Mapping[str, float]) -> dict[str, Any]:
    """Add the numbers that were set on the command line to an object, by name; no key without any."""
    return result | {"set": dict(given)} if given else result


def solution_object(solution: Solution) -> dict[str, Any]:
    """Return the object of ``satsym solve --json``.

    Returns
    -------
    dict
        Keys in a fixed order. States and costates by the state's name; ``None`` where a number is not finite.
        ``switching_times`` are those of all controls together, each once, sorted; ``events`` are entries, exits and
        touch points of path constraints, points on the way, and jumps between
        minimisers of H, in order of time.
    """
    spec, states = solution.instance.model.spec, solution.instance.model.spec.state_names
    switches = {float(t) for times in solution.switching_times for t in times}
    return head("solve", spec, solution.instance, solution.status) | {
        "method": solution.method,
        "message": solution.status.explain(solution.message),
        "boundary_type": solution.instance.boundary_type,
        "objective": plain(spec.objective(solution.objective)),
        "t_final": _at(solution.times, -1),
        "x_final": _each(states, solution.x, -1),
        "costate_initial": _each(states, solution.lam, 0),
        "switching_times": sorted(switches),
        "iterations": solution.iterations,
        "wall_s": plain(solution.wall_s),
        "certificate": certificate_object(solution.certificate, spec) if solution.certificate else None,
        "x_initial": _each(states, solution.x, 0),
        "t_initial": _at(solution.times, 0),
        "parameters_found": _found(solution),
        **(_interval(solution.interval, spec) if solution.interval else {}),
        "events": plain(solution.events),
        **_ranges(solution.instance),
        **_continuation(solution),
    }


def _interval(interval: CostInterval, spec: ProblemSpec) -> dict[str, Any]:
    """Return the interval of the best objective, in the author's sense, and the smoothing."""
    ends = sorted(spec.objective(end) for end in (interval.lower, interval.upper))
    return {"cost_interval": plain(ends), "smoothing": plain(interval.smoothing)}


def _ranges(instance: Instance) -> dict[str, dict[str, str | None]]:
    """Return the active limits of the end, ``None`` within them; no key where there are none."""
    met = {name: instance.met[name].value if name in instance.met else None for name in instance.end_limits}
    return {"ends_met": met} if met else {}


def _continuation(solution: Solution) -> dict[str, list[dict[str, Any]]]:
    """Return the earlier answers of a continuation, each with its values; no key where there are none."""
    spec = solution.instance.model.spec
    rows = [
        {
            **{one.key.short: plain(one.key.of(answer.instance)) for one in solution.instance.continuation},
            "objective": plain(spec.objective(answer.objective)),
            "t_final": _at(answer.times, -1),
            "costate_initial": _each(spec.state_names, answer.lam, 0),
        }
        for answer in solution.intermediate
    ]
    return {"continuation": rows} if rows else {}


def simulation_object(simulation: Simulation) -> dict[str, Any]:
    """Return the object of ``satsym simulate --json``; see :func:`solution_object`."""
    return head("simulate", simulation.instance.model.spec, simulation.instance, simulation.status) | {
        "feedback": simulation.feedback,
        "t_final": _at(simulation.times, -1),
        "x_final": _each(simulation.instance.model.spec.state_names, simulation.x, -1),
        "invariants": plain(simulation.invariants),
        "metrics": plain(simulation.metrics),
    }


def model_object(spec: ProblemSpec) -> dict[str, Any]:
    """Return a model's object in the list of ``satsym models --json``."""
    stated = list(stated_constraints(spec).values())
    return {
        "name": spec.name,
        "title": spec.title,
        "source": spec.source,
        "states": [_variable(v) | {"kind": v.kind} for v in spec.states],
        "controls": [_variable(v) for v in spec.controls],
        "parameters": [_variable(v) | {"default": v.default} for v in spec.parameters],
        "control_set": spec.control_set,
        **({"control_sets": [_set(part) for part in spec.control_parts]} if spec.control_parts else {}),
        **({"path_constraints": [plain(spec.path_constraints[k]) for k in stated]} if stated else {}),
        "has_cost": spec.has_cost,
        "has_terminal_cost": spec.has_terminal_cost,
        "has_reference": spec.has_reference,
        "invariants": [v.symbol for v in spec.invariants],
    }


def instance_object(instance: Instance) -> dict[str, Any]:
    """Return an instance's object in the list of ``satsym instances --json``; a free ``tf`` is ``None``."""
    return {
        "name": instance.name,
        "title": instance.title,
        "model": instance.model.spec.name,
        "boundary_type": instance.boundary_type,
        "t0": instance.t0,
        "tf": instance.tf,
        "bounded": bounded(instance),
    }


def bounded(instance: Instance) -> bool:
    """Tell whether anything limits the controls; an angle is not limited."""
    whole = instance.control_set
    limited = [part for _, part in whole.parts if part.kind != "angle"] or [whole]
    return any(math.isfinite(v) for part in limited for v in (*part.lower, *part.upper, part.radius))


def _set(part: ControlPart) -> dict[str, Any]:
    return {"name": part.name, "kind": part.kind, "controls": list(part.controls)}


def _variable(variable: Variable) -> dict[str, Any]:
    return {"name": variable.symbol, "unit": variable.unit, "meaning": variable.meaning}


def _found(solution: Solution) -> dict[str, float | None]:
    """Return the found values of free parameters, where there is an answer."""
    instance, answered = solution.instance, solution.status.answered
    free = (unknown for unknown in instance.free if unknown.place is Place.PARAMETER)
    return {unknown.name: plain(unknown.of(instance)) if answered else None for unknown in free}


def _each(names: Sequence[str], rows: Array, place: int) -> dict[str, float | None]:
    return {name: _at(row, place) for name, row in zip(names, rows, strict=True)}


def _at(row: Array, place: int) -> float | None:
    found: float | None = plain(row[place]) if len(row) else None
    return found


COST = "cost"
"""The unit of J if it does not follow from the units of the model."""


def time_unit(spec: ProblemSpec) -> str:
    """Return the unit of time as the model's units spell it; ``None`` where they do not agree on one.

    The units of parameters count where no state and no control has a unit of time. The unit is found from the words
    alone: asking pint takes longer than solving.
    """
    found = (display.time_unit(v.unit for v in each) for each in ((*spec.states, *spec.controls), spec.parameters))
    return next((unit for unit in found if unit != "1"), "")


def cost_per(unit: str, spec: ProblemSpec) -> str:
    """Return the unit of a costate: that of the cost, per unit of the state."""
    return per(spec.objective_unit or COST, unit) or COST


def of_regulator(spec: ProblemSpec, inputs: Collection[str], relative: bool) -> str:
    """Return the unit of a regulator's cost; :data:`COST` where inputs of different units share a plain weight.

    Parameters
    ----------
    inputs
        Names of the active controls.
    relative
        Whether states and inputs count relative to allowed deviations. Else R is taken for plain numbers, which
        leaves the unit of the inputs squared by time, and what Q has of units makes its terms the same.
    """
    time = time_unit(spec) or "1"
    shared = {v.unit for v in spec.controls if v.symbol in inputs}
    if relative:
        return time
    if len(shared) > 1:
        return COST
    return times(time, *2 * [*shared])


def times(*units: str) -> str:
    """Return the product of units, with common names cancelled."""
    total = Counter[str]()
    for unit in units:
        total.update(expressions.factors(unit))
    return expressions.expression(total)


def per(unit: str, other: str | None) -> str | None:
    """Return the quotient of two units, with common names cancelled; ``None`` where that is not clear."""
    if other is None:
        return None
    total = Counter(expressions.factors(unit))
    total.subtract(expressions.factors(other))
    return expressions.expression(total)


def units(spec: ProblemSpec) -> dict[str, str | None]:
    """Return units by name: of states, controls, invariants, costates, the time ``t`` and the ``objective``.

    Names are those of trajectory.csv; ``"1"`` for a plain number, ``None`` where a unit is not clear.
    """
    plain = all(v.unit == "1" for v in (*spec.states, *spec.controls))
    found: dict[str, str | None] = {"t": time_unit(spec) or ("1" if plain else None)}
    found |= {v.symbol: v.unit for v in (*spec.states, *spec.controls, *spec.invariants)}
    if spec.has_cost:
        found |= {f"lambda_{v.symbol}": cost_per(v.unit, spec) for v in spec.states}
        found["objective"] = spec.objective_unit or COST
    return found


def with_units(names: Sequence[str], known: Mapping[str, str | None]) -> list[str]:
    """Return names of columns with their units in brackets, if these are clear and not plain numbers."""
    return [f"{name} [{unit}]" if (unit := known.get(name)) and unit != "1" else name for name in names]
