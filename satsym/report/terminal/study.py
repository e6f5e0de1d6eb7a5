"""What a study says to people, as plain text."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from satsym.report.terminal.table import figure, table
from satsym.status import Status
from satsym.studies.running import Advance
from satsym.wording import counted


def progress_line(advance: Advance) -> str:
    """How far it is, how quick, how long it still takes, and what failed so far."""
    parts = [f"{advance.done} of {counted(advance.total, 'row')}"]
    if advance.rate > 0.0:
        parts.append(f"{advance.rate:.3g}/s")
        parts.append(f"{_time(advance.left)} left")
    parts.append(f"{advance.failures} failed")
    return ", ".join(parts)


def study_text(said: Mapping[str, Any]) -> str:
    """Summary of a study from what its result.json holds."""
    failed = said["rows"] - said["statuses"].get(Status.CONVERGED.value, 0)
    lines = [
        f"{said['instance']}, model {said['model']}: {said['each']} for {counted(said['rows'], 'row')} of "
        f"{', '.join(said['varied'])}",
        "",
        *table([("", ""), *((name, str(count)) for name, count in said["statuses"].items())], right=(1,))[1:],
    ]
    if said["verdicts"]:
        lines += ["", *table([("verdict", "rows"), *((k, str(v)) for k, v in said["verdicts"].items())], right=(1,))]
    if said["worst"]:
        rows = [(str(one["row"]), figure(one["objective"]), one["reproduce"]) for one in said["worst"]]
        lines += ["", "worst:", *table([("row", "objective", "command"), *rows], right=(0, 1))]
    if said["failures"]:
        rows = [(str(one["row"]), one["status"], one["reproduce"]) for one in said["failures"]]
        lines += ["", f"{counted(failed, 'row')} failed{', among them' if len(rows) < failed else ''}:"]
        lines += table([("row", "status", "command"), *rows], right=(0,))
    return "\n".join(lines)


def _time(seconds: float) -> str:
    if not math.isfinite(seconds):
        return "?"
    minutes, rest = divmod(math.ceil(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"
