"""Solutions, simulations and examined results as plain text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.shown import spec_of
from satsym.instance.unknowns import Place
from satsym.report.display import norm_text
from satsym.report.results.objects import cost_per, time_unit
from satsym.report.said import counted, each, message, say
from satsym.report.terminal.arcs import at_bound, in_words, rows_of_arcs
from satsym.report.terminal.certificate import certificate_lines
from satsym.report.terminal.table import WIDEST, figure, joined, room, table, wrapped
from satsym.solution import Iteration, Simulation, Solution
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.report.results.examination import Examination

ROUNDING = 1e-10
"""Fraction of a quantity's largest value below which a value is shown as zero."""

_PARTLY = "final state wholly or partly free"
_END = {1: "final state given", 2: "final state given", 3: _PARTLY, 4: "final state on the reference", 5: _PARTLY}
"""Boundary type -> description of the final state."""


def solution_text(solution: Solution, colour: bool = False) -> str:
    """Summarise a solution."""
    instance = solution.instance
    unit = time_unit(spec_of(instance))
    facts = [
        _objective(instance, solution.objective),
        *_interval(solution),
        *_found(instance, unit),
        (say("final time"), f"{figure(_last(solution.times), 10)} {unit}".rstrip()),
        (say("boundary type"), boundary(instance)),
    ]
    blocks = [
        _heading(instance, solution.status, f"{solution.method}, {_effort(solution)}", colour),
        wrapped(reason(solution)),
    ]
    if solution.status in (Status.INFEASIBLE, Status.NO_MINIMISER):
        return joined(blocks)  # there is no last attempt at an answer, for there is none
    blocks += [
        table([("", ""), *facts])[1:],
        _states(solution.instance, solution.times, solution.x, solution.lam),
        table(control_rows(instance, solution.times, solution.u), right=(1, 2, 4)),
        _switching(solution, unit),
        _events(solution, unit),
        certificate_lines(solution.certificate, spec_of(instance)) if solution.certificate else [],
    ]
    return joined(blocks)


def reason(solution: Solution) -> str:
    """Return the message of a solution, with the advice that it lacks."""
    return _advised(solution.status, solution.message, in_words(solution, solution.message))


def simulation_text(simulation: Simulation, colour: bool = False) -> str:
    """Summarise a simulation; see :func:`solution_text`."""
    instance = simulation.instance
    unit = time_unit(spec_of(instance))
    facts = [(say("final time"), f"{figure(_last(simulation.times), 10)} {unit}".rstrip())]
    kept = [(name, figure(i.initial, 10), figure(i.drift, 3)) for name, i in simulation.invariants.items()]
    metrics = [(name, figure(value, 10)) for name, value in _metrics(simulation).items()]
    blocks = [
        _heading(instance, simulation.status, say("feedback <law>", law=message(simulation.feedback)), colour),
        wrapped(_advised(simulation.status, simulation.message, message(simulation.message))),
        table([("", ""), *facts])[1:],
        _states(instance, simulation.times, simulation.x, None),
        table([each("invariant", "initial", "drift"), *kept], right=(1, 2)) if kept else [],
        table([each("metric", "value"), *metrics], right=(1,)) if metrics else [],
    ]
    return joined(blocks)


def _metrics(simulation: Simulation) -> dict[str, float]:
    """Return metrics by name; a metric is zero where it is negligible beside the variable's largest value."""
    names = simulation.instance.model.spec.state_names
    sizes = {name: float(np.abs(row).max(initial=0.0)) for name, row in zip(names, simulation.x, strict=True)}
    found = {}
    for key, value in simulation.metrics.items():
        variable, _, _ = key.rpartition("_")
        size = max(sizes.get(variable, 0.0), abs(simulation.metrics.get(f"{variable}_peak", 0.0)))
        found[key] = 0.0 if abs(value) <= ROUNDING * size else value
    return found


def with_files(text: str, saved: Sequence[Path]) -> str:
    """Add the written files and their place to a summary."""
    if not saved:
        return text
    places: dict[Path, list[str]] = {}
    for path in saved:
        places.setdefault(path.parent, []).append(path.name)
    lines = []
    for folder, names in places.items():
        if folder == Path():
            lines.append(wrapped(say("written: <names>", names=", ".join(names))))
            continue
        summary = wrapped(say("written to <folder>: <names>", folder=folder, names=", ".join(names)))
        # a folder that leaves no room for a name stands alone
        first = say("written to <folder>:", folder=folder)
        alone = len(f"  {first} {names[0]},") > (room() or WIDEST)
        lines.append([f"  {first}", *wrapped(", ".join(names))] if alone else summary)
    return joined([text.splitlines(), *lines])


def boundary(instance: Instance) -> str:
    """Describe the ends in words; a range is not a given state, though the answer may be at its end."""
    kind = instance.boundary_type
    end = _END[kind]
    if instance.ranges:
        whole = len(instance.ranges) == len(instance.initial)
        end = "final state within ranges" if whole else "final state partly within ranges"
    return f"{kind}, {say('final time free' if instance.tf is None else 'final time given')}, {message(end)}"


def _objective(instance: Instance, cost: float) -> tuple[str, str]:
    """State the objective in the author's sense and unit, and the sign of costates where that differs."""
    spec = spec_of(instance)
    unit = "" if spec.objective_unit == "1" else spec.objective_unit
    text = f"{figure(spec.objective(cost), 10)} {unit}".rstrip()
    return (
        (say("objective J, maximised"), say("<value> (costs and costates are those of -J)", value=text))
        if spec.maximise
        else (say("cost J"), text)
    )


def _interval(solution: Solution) -> list[tuple[str, str]]:
    """State the interval of the best objective, where the optimum switches infinitely often."""
    if solution.interval is None:
        return []
    spec = spec_of(solution.instance)
    ends = sorted(spec.objective(end) for end in (solution.interval.lower, solution.interval.upper))
    name = say("maximum objective" if spec.maximise else "minimum cost")
    return [(name, say("from <low> to <high>", low=figure(ends[0], 12), high=figure(ends[1], 12)))]


def _found(instance: Instance, time: str) -> list[tuple[str, str]]:
    """State the values of initial states, times and parameters that were free."""
    spec = spec_of(instance)
    groups = {Place.INITIAL: (say("initial"), spec.states), Place.PARAMETER: (say("parameter"), spec.parameters)}
    rows = []
    for one in instance.free:
        word, variables = groups.get(one.place, (say("initial time"), ()))
        unit = variables[one.index].unit if variables else time
        name = f"{word} {one.name}" if variables else word
        value = f"{figure(one.of(instance), 10)} {'' if unit == '1' else unit}".rstrip()
        rows.append((name, say("<value>, found", value=value)))
    return rows


def progress_line(iteration: Iteration, instance: Instance) -> str:
    """Return one iteration of a solver, for the live line."""
    value = figure(spec_of(instance).objective(iteration.objective), 8)
    residual = f"{iteration.residual:.1e}"
    return say(
        "iteration <number>   J <value>   residual <residual>", number=iteration.number, value=value, residual=residual
    )


def _heading(instance: Instance, status: Status, how: str, colour: bool) -> list[str]:
    word = message(status.value)
    word = f"\x1b[{32 if status.answered else 31}m{word}\x1b[0m" if colour else word
    name = say("<name>, model <model>", name=instance.name, model=spec_of(instance).name)
    return [*filter(None, [say(instance.title)]), f"{name}: {word} ({how})"]


def _effort(solution: Solution) -> str:
    whole = len(f"{solution.wall_s:.0f}")
    return f"{counted(solution.iterations, 'iteration')}, {figure(solution.wall_s, max(2, whole))} s"


def _advised(status: Status, english: str, said: str) -> str:
    """Return a message, as it is said, with the advice that it lacks."""
    return "; ".join(filter(None, [said, message(status.advice_beside(english))]))


def _states(instance: Instance, times: Array, x: Array, lam: Array | None) -> list[str]:
    return table(state_rows(instance, times, x, lam), right=(*range(1, 6), 7))


def state_rows(
    instance: Instance, times: Array, x: Array, lam: Array | None, digits: int = 10
) -> list[tuple[str, ...]]:
    """Return a table with a row for each state: initial, final and required value, and its costate.

    Parameters
    ----------
    digits
        Number of significant digits of costates.
    """
    spec = spec_of(instance)
    reference, worth = _reference(instance, times), [0.0] * len(x) if lam is None else _worth(x, lam)
    rows: list[tuple[str, ...]] = [
        each("state", "initial", "final", "given", "reference", "difference", "unit", "costate at t0", "unit")
    ]
    for i, state in enumerate(spec.states):
        final = _without_rounding(_last(x[i]), x[i])
        off = "" if reference is None else figure(_difference(instance, state.symbol, final, reference[i], x[i]), 3)
        rows.append(
            (
                state.symbol,
                figure(instance.initial[i]),
                figure(final),
                _given(instance, state.symbol),
                "" if reference is None else figure(reference[i]),
                off,
                "" if state.unit == "1" else state.unit,
                "" if lam is None else figure(_without_rounding(_first(lam[i]), lam[i], worth[i]), digits),
                "" if lam is None or (by := cost_per(state.unit, spec)) == "1" else by,
            )
        )
    return rows


def _difference(instance: Instance, name: str, value: float, reference: float, row: Array) -> float:
    """Return the difference from the reference, modulo a turn where turns do not count; zero for rounding."""
    turn_does_not_count = name in instance.solver.free_angles and math.isfinite(value)
    off = math.remainder(value - reference, math.tau) if turn_does_not_count else value - reference
    return _without_rounding(off, row)


def _given(instance: Instance, name: str) -> str:
    value = instance.final.get(name)
    if name in instance.ranges:
        lower, upper = (figure(end) if math.isfinite(end) else say("free") for end in instance.ranges[name])
        return f"[{lower}, {upper}]"
    if value is None:
        return say("free") if instance.final else ""
    return message(value) if isinstance(value, str) else figure(value)


def _reference(instance: Instance, times: Array) -> Sequence[float] | None:
    """Return the reference at the final time, where the model has one."""
    if not spec_of(instance).has_reference or not len(times):
        return None
    values: Sequence[float] = instance.model.reference(float(times[-1]), instance.parameters)
    return values


def control_rows(instance: Instance, times: Array, u: Array) -> list[tuple[str, ...]]:
    """Return a table with a row for each control, and one for their norm where it is bounded."""
    spec = spec_of(instance)
    rows: list[tuple[str, ...]] = [each("control", "minimum", "maximum", "bounds", "saturated", "unit")]
    for i, control in enumerate(spec.controls):
        limits = (instance.lower[i], instance.upper[i])
        unit = "" if control.unit == "1" else control.unit
        rows.append((control.symbol, *_range(times, u[i], limits), unit))
    for bound in instance.bounded_norms:
        norm = np.sqrt((u[list(bound.places)] ** 2).sum(axis=0)) if u.size else u[0]
        named = norm_text([spec.control_names[i] for i in bound.places])
        unit = spec.controls[bound.places[0]].unit
        unit = "" if unit == "1" else unit
        rows.append((named, *_range(times, norm, (bound.lower or -math.inf, bound.upper)), unit))
    return rows


def _range(times: Array, row: Array, limits: tuple[float, float]) -> tuple[str, str, str, str]:
    """Return least and greatest value, the bounds, and the fraction of time spent at one of them."""
    if not len(row):
        return "-", "-", "", ""
    extremes = figure(_without_rounding(float(row.min()), row)), figure(_without_rounding(float(row.max()), row))
    finite = [bound for bound in limits if math.isfinite(bound)]
    if not finite:
        return *extremes, "", ""
    lower, upper = (figure(limit) if math.isfinite(limit) else "" for limit in limits)
    words = f"[{lower}, {upper}]" if lower and upper else ""
    words = words or (say("at least <value>", value=lower) if lower else say("at most <value>", value=upper))
    fraction = float(np.trapezoid(at_bound(row, limits).astype(float), times)) / float(times[-1] - times[0])
    return *extremes, words, f"{100.0 * fraction:.3g} %"


def _switching(solution: Solution, unit: str) -> list[str]:
    rows = rows_of_arcs(solution, unit)
    return table([("", "", ""), *rows])[1:] if rows else []


def _events(solution: Solution, unit: str) -> list[str]:
    """State entries and exits of path constraints, points on the way, and changes of the minimiser of H."""
    jumping = any(one.kind == "jump" for one in solution.events)
    head = say("minimiser of H") if jumping else say("path constraint")
    head = say("waypoint") if spec_of(solution.instance).interior else head
    rows = [
        (message(one.kind), one.name, say("at <times>", times=f"{figure(one.t, 10)} {unit}".rstrip()))
        for one in solution.events
    ]
    return table([(head, "", ""), *rows]) if rows else []


def _worth(x: Array, lam: Array) -> list[float]:
    """Return the size of each costate if its state were worth as much as the most valuable one."""
    widths = [float(np.abs(row).max(initial=0.0)) or 1.0 for row in x]
    most = max((width * float(np.abs(row).max(initial=0.0)) for width, row in zip(widths, lam, strict=True)), default=0)
    return [most / width for width in widths]


def _without_rounding(value: float, row: Array, size: float = 0.0) -> float:
    """Return a value, zero where it is negligible beside the largest one, or beside a given size."""
    return 0.0 if abs(value) <= ROUNDING * max(float(np.abs(row).max(initial=0.0)), size) else value


def _first(row: Array) -> float:
    return float(row[0]) if len(row) else math.nan


def _last(row: Array) -> float:
    return float(row[-1]) if len(row) else math.nan


_STATED = {
    "cost": "cost",
    "switching times": "switching times",
    "stated switching times, to the spacing of the nodes": "switching times",
    "stated times of saturation": "times of saturation",
    "stated times of events": "times of events",
}
"""Check -> what result.json states and the trajectory contradicts where it fails."""


def _contradicted(found: Examination) -> str:
    """Name the numbers of result.json that the certificate found not to be those of the trajectory."""
    checks = found.certificate.checks if found.certificate else ()
    wrong = dict.fromkeys(_STATED[one.name] for one in checks if not one.passed and one.name in _STATED)
    return ", ".join(map(say, wrong))


def examination_text(found: Examination, colour: bool) -> str:
    """Return the claims of a saved result, the differences from its files, and the new certificate."""
    instance, spec = found.solution.instance, found.solution.instance.model.spec
    stated = message(found.stated.value) if found.stated else say("no certificate")
    heading = say("<name>, model <model>", name=instance.name, model=spec.name)
    rows = [(one.key, str(one.stated), str(one.found)) for one in found.differences]
    agreement = say("result.json agrees with the other files")
    if not rows and (wrong := _contradicted(found)):
        agreement = say("the trajectory contradicts these numbers in result.json: <quantities>", quantities=wrong)
    elif len(rows) == 1:
        agreement = say("one number in result.json does not agree with the other files")
    elif rows:
        agreement = say("<number> numbers in result.json do not agree with the other files", number=len(rows))
    title = instance.title or spec.title
    return joined(
        [
            [
                f"\x1b[1m{title}\x1b[0m" if colour else title,
                f"{heading}: {say('recorded as <verdict>', verdict=stated)}",
            ],
            wrapped(agreement),
            table([each("key", "recorded", "recomputed"), *rows]) if rows else [],
            certificate_lines(found.certificate, spec) if found.certificate else [],
        ]
    )
