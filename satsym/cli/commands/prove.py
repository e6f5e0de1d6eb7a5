"""``satsym prove``: a theorem beside the answer of an instance."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli.help import command
from satsym.cli.options import json_option, out_option, place_option, set_option, subject_argument, with_values
from satsym.cli.output import answer, in_colour, live
from satsym.cli.saving import folder_for, save
from satsym.report.said import language
from satsym.status import ExitCode, Status

EXAMPLES = """\b
Examples:
  satsym prove return-to-orbit          a proof of the solution, with 20 digits
  satsym prove my_case.toml --json      the same as JSON, for another program
  satsym prove soft-return --latex soft-return.tex

Exit codes: 0 proved, 3 the instance cannot be used, 4 the problem has a feature that no theorem used here covers
(the message states it), 5 not proved (the message states the step that fails)."""


@command(epilog=EXAMPLES)
@subject_argument
@click.option(
    "--digits", type=click.IntRange(6, 60), default=20, metavar="N", help="Significant digits; 20 by default."
)
@place_option(
    "--latex", "document", metavar="FILE", help="Also typeset the proof in this file, which is replaced if it exists."
)
@set_option
@json_option
@out_option
def prove(
    subject: str, digits: int, document: Path | None, values: tuple[str, ...], as_json: bool, out: Path | None
) -> ExitCode:
    """Prove that the solution is a strict local minimum.

    X is a shipped instance or the path of a TOML file. The instance is solved first. Then ball arithmetic, in which
    every number carries a bound on its error, proves that an extremal exists, that there is no other one nearby, and
    that no nearby motion costs less.
    """
    from satsym import instance, solvers
    from satsym.proof.proving import prove as prove_found
    from satsym.proof.record import Outcome
    from satsym.report.results.objects import head, with_settings
    from satsym.report.terminal.proof import proof_text
    from satsym.report.terminal.solution import progress_line, with_files

    case, given = with_values(instance.load(subject), values)
    folder = folder_for(case.name, "prove", out, None)
    with live() as line:
        proof = prove_found(
            case,
            lambda: solvers.solve(case, progress=lambda iteration: line.show(progress_line(iteration, case))),
            digits,
        )
    result = with_settings(head("prove", case.model.spec, case, Status.CONVERGED) | proof.to_dict(), given)
    saved = save(folder, result, {})
    if document is not None:
        from satsym.report.latex.proof import render
        from satsym.report.results.files import write_text

        write_text(document, render(proof, language()))
        saved = [*saved, document]
    answer(as_json, result, lambda: with_files(proof_text(proof, in_colour()), saved))
    if proof.status is Outcome.PROVED:
        return ExitCode.DONE
    return ExitCode.NO_ANSWER if proof.status is Outcome.BEYOND else ExitCode.CERTIFICATE_FAILED
