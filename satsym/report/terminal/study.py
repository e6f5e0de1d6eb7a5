"""Studies as plain text."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from satsym.report.said import counted, each, message, say
from satsym.report.terminal.certificate import meaning
from satsym.report.terminal.table import figure, table
from satsym.status import Status, Verdict
from satsym.studies.running import Advance


def progress_line(advance: Advance) -> str:
    """Return progress, speed, time left, and failures of a study."""
    parts = [say("<done> of <rows>", done=advance.done, rows=counted(advance.total, "case"))]
    if advance.rate > 0.0:
        parts.append(f"{advance.rate:.3g}/s")
        parts.append(say("<time> left", time=_time(advance.left)))
    parts.append(say("<number> failed", number=advance.failures))
    if advance.compiling:
        parts.append(say("compiling first, once for each model"))
    return ", ".join(parts)


def study_text(found: Mapping[str, Any]) -> str:
    """Summarise a study from its result.json."""
    failed = found["rows"] - found["statuses"].get(Status.CONVERGED.value, 0)
    lines = [
        say(
            "<name>, model <model>: study of <rows> (<each>), varying <varied>",
            name=found["instance"],
            model=found["model"],
            each=found["each"],
            rows=counted(found["rows"], "case"),
            varied=", ".join(found["varied"]),
        ),
        "",
        *table([("", ""), *((message(name), str(count)) for name, count in found["statuses"].items())], right=(1,))[1:],
    ]
    if found["verdicts"]:
        lines += [
            "",
            *table([each("certificate", "cases", "meaning"), *map(_verdict, found["verdicts"].items())], right=(1,)),
        ]
    if found.get("branches") and found["branches"]["borders"] + found["branches"]["changed"]:
        lines += ["", _branches(found["branches"])]
    if found["worst"]:
        rows = [(str(one["row"]), figure(one["objective"]), one["reproduce"]) for one in found["worst"]]
        lines += ["", say("cases with the worst objective:")]
        case, objective, reproduce = each("case", "objective", "command")
        unit = "1" if found.get("multiples") else found["units"].get("objective") or "1"
        head = (case, objective if unit == "1" else f"{objective} [{unit}]", reproduce)
        lines += table([head, *rows], right=(0, 1))
    if found["failures"]:
        rows = [(str(one["row"]), message(one["status"]), one["reproduce"]) for one in found["failures"]]
        heading = "<rows> failed, among them:" if len(rows) < failed else "<rows> failed:"
        lines += ["", say(heading, rows=counted(failed, "case"))]
        lines += table([each("case", "status", "command"), *rows], right=(0,))
    return "\n".join(lines)


def _verdict(counted_verdict: tuple[str, int]) -> tuple[str, str, str]:
    """Return a verdict with its number of rows and its claim, in the words of a solution."""
    name, count = counted_verdict
    return message(name), str(count), meaning(Verdict(name))


def _branches(found: Mapping[str, int]) -> str:
    """State the outcome of comparing neighbouring rows."""
    return say(
        "<branches> of solutions (column branch) were found, and <pairs> of neighbouring cases were compared; "
        "<rows> changed to a branch with a lower cost",
        branches=counted(found["count"], "branch", "branches"),
        pairs=counted(found["borders"], "pair"),
        rows=counted(found["changed"], "case"),
    )


def _time(seconds: float) -> str:
    if not math.isfinite(seconds):
        return "?"
    minutes, rest = divmod(math.ceil(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"
