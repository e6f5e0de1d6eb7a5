"""``satsym report``: one run as one page."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli.help import command
from satsym.cli.options import place_option, set_option, subject_argument, with_values
from satsym.cli.output import live, tell
from satsym.report.said import language, message, say
from satsym.status import BadInput, ExitCode, Verdict

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.proof.record import Proof
    from satsym.solution import Solution
    from satsym.symbolic import Derivation

EXAMPLES = """\b
Examples:
  satsym report soft-return --html soft-return.html
  satsym report transfer-fuel --html transfer.html --interactive    with a slider for the time
  satsym report soft-return --html soft-return.html --prove         with a proof in addition to the certificate
  satsym report my_case.toml --html my_case.html --derivation my_model.py"""


@command(epilog=EXAMPLES)
@subject_argument
@place_option("--html", "page", metavar="FILE", help="Write the page to this file, which is replaced if it exists.")
@place_option(
    "--derivation", "stated", metavar="FILE.py", help="Derivation file of X's model, if the model is your own."
)
@click.option("--interactive", is_flag=True, help="Add sliders, the values at the pointer, and the motion in space.")
@place_option(
    "--study", "study", metavar="DIR", help="With --interactive: a study of X; a slider chooses among its solutions."
)
@click.option("--prove", "proving", is_flag=True, help="Add the proof that `satsym prove` gives of the solution.")
@set_option
def report(
    subject: str,
    page: Path | None,
    stated: Path | None,
    interactive: bool,
    study: Path | None,
    proving: bool,
    values: tuple[str, ...],
) -> ExitCode:
    """Solve an instance, and show everything on one page.

    X is an instance, specified as for `satsym solve`. The page contains the problem, the solution, its certificate,
    the motion, pictures and the derivation, and loads nothing from elsewhere. FILE.py is Python and is executed. With
    --interactive, the page also contains scripts; a browser without scripts still shows everything else. The study in
    DIR must have been made with --trajectories.
    """
    from satsym import instance, solvers
    from satsym.report.extra import library
    from satsym.report.page.explore import explored
    from satsym.report.page.run import Given, render
    from satsym.report.results.files import write_text
    from satsym.report.terminal.solution import progress_line, with_files

    if page is None:
        raise click.UsageError("Give --html FILE, the file to write the page to.")
    if study is not None and not interactive:
        raise click.UsageError("--study DIR requires --interactive.")
    if interactive:
        library("plotly.offline", "plotly", "interactive")  # now, before solving
    case, _ = with_values(instance.load(subject), values)
    with live() as line:
        derivation = _derivation(case, stated, line.show)
        solution = solvers.solve(case, progress=lambda iteration: line.show(progress_line(iteration, case)))
        proof = _proof(case, solution, line.show) if proving else None
        line.show(say("drawing ..."))
        answers = explored(solution, study) if interactive else []
        options = f"--interactive{f' --study {shlex.quote(str(study))}' if study else ''}" if interactive else ""
        given = Given(subject, str(stated or ""), values, options, str(page))
        text = render(solution, derivation, given, language(), answers, proof)
    write_text(page, text)
    tell(with_files(f"{case.name}: {message(solution.status.value)}", [page]))
    if not solution.status.answered:
        return ExitCode.NO_ANSWER
    failed = solution.certificate is not None and solution.certificate.verdict is Verdict.FAILED
    return ExitCode.CERTIFICATE_FAILED if failed else ExitCode.DONE


def _proof(case: Instance, solution: Solution, show: Callable[[str], None]) -> Proof:
    """Prove an answer."""
    from satsym.proof.proving import prove

    show(say("proving ..."))
    return prove(case, lambda: solution)


def _derivation(case: Instance, stated: Path | None, show: Callable[[str], None]) -> Derivation | None:
    """Return the derivation of an instance's model: the shipped one, or that of a named file.

    No other file is used: an instance is data, and derivation files are executed.
    """
    from satsym import kernels
    from satsym.symbolic import derive, loader
    from satsym.symbolic.convention import in_convention

    name = case.model.spec.name
    if stated is None:
        try:
            if kernels.load(name).spec != case.model.spec:
                return None
        except BadInput:
            return None
    subject, path = loader.problem(f"{stated}:{name}" if stated else name)
    with loader.explained(path, subject):
        show(say("deriving <name> ...", name=name))
        return derive(in_convention(subject, None))
