"""``satsym doctor``: whether everything is here that satsym needs."""

from __future__ import annotations

from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import emit, emit_json, live
from satsym.report.said import each, message, say
from satsym.status import ExitCode

EXAMPLES = """\b
Example:
  satsym doctor

Exit codes: 0 everything required works, 1 something required is broken."""


@command(epilog=EXAMPLES)
@json_option
def doctor(as_json: bool) -> ExitCode:
    """Check the installation.

    Checks versions, extras, programs and shipped files, and solves a small problem.
    """
    from satsym.cli.machine.examination import examine
    from satsym.report.terminal.table import table

    with live() as line:
        findings = examine(lambda name: line.show(say("examining <name> ...", name=name)))
    healthy = not any(finding.broken for finding in findings)
    if as_json:
        emit_json({"healthy": healthy, "findings": [finding.as_object() for finding in findings]})
    else:
        what, found, note = each("what", "found", "note")
        rows = [tuple(map(message, (f.name, f.mark, f.value, f.note))) for f in findings]
        emit("\n".join(table([(what, "", found, note), *rows], indent="")))
    return ExitCode.DONE if healthy else ExitCode.UNFORESEEN
