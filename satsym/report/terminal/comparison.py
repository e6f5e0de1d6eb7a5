"""Comparisons of instances, for people and for programs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from satsym.instance.shown import spec_of
from satsym.report.results.objects import file_of, head, plain, times, units
from satsym.report.said import each, message, say
from satsym.report.terminal.arcs import in_words
from satsym.report.terminal.solution import ROUNDING
from satsym.report.terminal.table import figure, joined, table, wrapped
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.analysis.comparison import Case, Range
    from satsym.spec import ProblemSpec

LEFT_OUT = ("gain_rate", "gain_state")
"""Metrics that exist for one control law only, and are not compared."""
MEANINGS = {
    "transition_time": "duration of the manoeuvre: the optimal time, or the settling time of a control law",
    "first_reached": "time at which the command is first reached",
    "settling_time": "time after which the response remains within 2 % of the command",
    "overshoot": "largest excess over the command, as a fraction of the step",
    "impulse": "impulse of the control at the instant of the step",
    "_total": "integral of the magnitude, including the impulse",
    "_peak": "largest magnitude, without the impulse",
    "_effort": "integral of the square; infinite with an impulse",
    "_energy": "integral of the power; infinite with an impulse",
    "_final": "value at the final time",
    "_driven": "largest deviation from the undriven motion",
    "_share": "effect of the boundary control on the rate of the constraint, relative to its largest value on the arc",
}
"""Name of a metric, or its ending -> its meaning."""


def metrics_of(cases: Sequence[Case]) -> dict[str, list[float | None]]:
    """Return each metric that any case has, with its value for each of them."""
    keys = dict.fromkeys(key for case in cases for key in case.metrics if key not in LEFT_OUT)
    return {key: [case.metrics.get(key) for case in cases] for key in keys}


def comparison_object(cases: Sequence[Case], over: Range | None = None) -> dict[str, Any]:
    """Return the object of ``satsym compare --json``."""
    specs = [case.instance.model.spec for case in cases]
    status = Status.CONVERGED if all(case.answered for case in cases) else Status.NOT_CONVERGED
    begins = head("compare", specs[0], None, status)
    if any(spec.name != specs[0].name for spec in specs):
        begins |= {"model": None, "units": {name: unit for spec in specs for name, unit in units(spec).items()}}
    found: dict[str, Any] = begins | {
        "instances": [
            {
                "instance": case.instance.name,
                "instance_file": file_of(case.instance),
                "model": case.instance.model.spec.name,
                "how": case.how,
                "answered": case.answered,
                "verdict": case.verdict,
                "message": case.message,
                "switching_times": list(case.switching_times),
            }
            for case in cases
        ],
        "metrics": {
            key: dict(zip((case.instance.name for case in cases), plain(values), strict=True))
            for key, values in metrics_of(cases).items()
        },
    }
    if over is not None:
        found["range"] = plain(over)
    return found


def comparison_text(cases: Sequence[Case], over: Range | None = None) -> str:
    """Return the metrics side by side, remarks on each case, and a range if there is one."""
    names = [case.instance.name for case in cases]
    found = metrics_of(cases)
    shown = {key: ["" if v is None else figure(v, 8) for v in _without_rounding(key, found)] for key in found}
    rows = [(key, *values, unit_of(cases, key)) for key, values in shown.items()]
    said = [
        (
            case.instance.name,
            message(case.how),
            message(case.verdict) if case.verdict else "" if case.answered else say("no solution"),
            in_words(case.solution, case.message) if case.solution else message(case.message),
        )
        for case in cases
    ]
    blocks = [
        table([(say("metric"), *names, say("unit")), *rows], right=range(1, len(names) + 1)),
        _meanings(found),
        table([each("instance", "how", "certificate", "message"), *said]),
    ]
    return joined([*blocks, _range(cases[0], over)] if over else blocks)


def _meanings(found: Iterable[str]) -> list[str]:
    """Return the meanings of the metrics, each kind once."""
    kinds = {key: f"..{key}" if key.startswith("_") else key for key in MEANINGS}
    used = [key for key in kinds if any(name == key or (key[0] == "_" and name.endswith(key)) for name in found)]
    return table([each("metric", "meaning"), *((kinds[key], say(MEANINGS[key])) for key in used)]) if used else []


def _without_rounding(key: str, found: Mapping[str, Sequence[float | None]]) -> list[float | None]:
    """Return values of a metric, with final values as zero where they are rounding beside the peak."""
    name, _, kind = key.rpartition("_")
    peaks = found.get(f"{name}_peak") if kind == "final" else None
    return [
        0.0 if value and peak and abs(value) <= ROUNDING * abs(peak) else value
        for value, peak in zip(found[key], peaks or [None] * len(found[key]), strict=True)
    ]


def _range(case: Case, over: Range) -> list[str]:
    limits = case.instance.limits
    watched = [name for name in over.peaks if name in limits]
    peaks = (say("<name> peak", name=name) for name in watched)
    header = (*each("damping", "command", "control peak", "impulse"), *peaks, "")
    rows = []
    for i, damping in enumerate(over.dampings):
        for j, command in enumerate(over.commands):
            beyond = [name for name in watched if over.peaks[name][i, j] > limits[name]]
            rows.append(
                (
                    *(figure(v) for v in (damping, command, over.control_peak[i, j], over.impulse[i, j])),
                    *(figure(over.peaks[name][i, j]) for name in watched),
                    say("beyond the limit of <names>", names=", ".join(beyond)) if beyond else "",
                )
            )
    return [
        *wrapped(say("<name> for other damping ratios and commands", name=case.instance.name)),
        *table([header, *rows], right=range(len(header) - 1)),
    ]


def unit_of(cases: Sequence[Case], key: str) -> str:
    """Return the unit of a metric, from its variable and its kind; empty where cases do not share it."""
    found = {_unit_of(spec, key) for spec in specs_of(cases)} - {None}
    return str(found.pop()) if len(found) == 1 else ""


def specs_of(cases: Sequence[Case]) -> list[ProblemSpec]:
    """Return the specification of each case, without units where its numbers are multiples."""
    return [spec_of(case.instance) for case in cases]


def _unit_of(spec: ProblemSpec, key: str) -> str | None:
    """Return the unit of a metric of one case; ``None`` if the case does not have the metric."""
    if key in ("transition_time", "first_reached", "settling_time"):
        return "s" if any(v.unit != "1" for v in spec.states) else ""
    name, _, kind = key.rpartition("_")
    for v in (*spec.states, *spec.quantities, *spec.controls):
        if v.symbol == name:
            if v.unit == "1":
                return ""
            known = {"total": times(v.unit, "s"), "effort": times(v.unit, v.unit, "s"), "energy": "J"}
            return known.get(kind, v.unit)
    if key == "impulse":
        unit = spec.controls[0].unit if spec.controls else "1"
        return "" if unit == "1" else times(unit, "s")
    return None
