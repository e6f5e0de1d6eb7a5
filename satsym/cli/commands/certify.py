"""``satsym certify``: a saved result examined again, from its files alone."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import answer, complain, in_colour, live
from satsym.report.said import say
from satsym.status import ExitCode, Verdict

EXAMPLES = """\b
Examples:
  satsym solve soft-return --out answer     writes a result
  satsym certify answer                     examines that result again, here or on another machine

Exit codes: 0 the result is confirmed, 3 the folder cannot be used, 4 the folder contains no solution,
5 an optimality condition is violated, or a number in result.json does not agree with the other files."""


@command(epilog=EXAMPLES)
@click.argument("folder", metavar="FOLDER", type=click.Path(path_type=Path))
@json_option
def certify(folder: Path, as_json: bool) -> ExitCode:
    """Examine a saved result again.

    FOLDER is a folder to which `satsym solve` wrote a result with --out or --plot. The certificate is computed again
    from the saved problem and trajectory, and the numbers in result.json are compared with the new ones, except the
    number of iterations and the computing time. The solution itself is read from the folder; only the competing
    solutions are computed again. No file is written.
    """
    from satsym.report.results import problem
    from satsym.report.results.certificate import certificate_object
    from satsym.report.results.examination import examine
    from satsym.report.results.objects import head
    from satsym.report.terminal.solution import examination_text

    instance = problem.read(folder)
    with live() as line:
        line.show(say("examining ..."))
        found = examine(instance, folder)
    solution, certificate = found.solution, found.certificate
    if not solution.status.answered:
        complain(say("<folder>: contains no solution to examine", folder=str(folder)))
        return ExitCode.NO_ANSWER
    spec = instance.model.spec
    result = head("certify", spec, instance, solution.status) | {
        "stated": found.stated.value if found.stated else None,
        "differences": [vars(one) for one in found.differences],
        "certificate": certificate_object(certificate, spec) if certificate else None,
    }
    answer(as_json, result, lambda: examination_text(found, in_colour()))
    failed = certificate is None or certificate.verdict is Verdict.FAILED or found.differences
    return ExitCode.CERTIFICATE_FAILED if failed else ExitCode.DONE
