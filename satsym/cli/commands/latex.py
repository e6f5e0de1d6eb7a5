"""``satsym latex``: a derivation, typeset."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import place_option
from satsym.cli.output import emit, live
from satsym.report.said import language
from satsym.status import ExitCode

if TYPE_CHECKING:
    from satsym.symbolic.model import Convention

EXAMPLES = r"""
Examples:
  satsym latex polar_orbit -o polar_orbit.tex
  satsym latex my_model.py --fragment   for \input in your own document
  satsym latex my_model.py:my_problem   one of several problems in a file"""


@command(epilog=f"\b{EXAMPLES}")
@click.argument("name", shell_complete=names.completed(names.models, names.derivations))
@place_option("-o", "--output", metavar="FILE", help="Write to this file instead of stdout.")
@click.option("--fragment", is_flag=True, help="Leave out the preamble, for inclusion in another document.")
@click.option(
    "--convention",
    type=click.Choice(("minimum", "maximum")),
    help="Minimum or maximum principle; by default as in the derivation file.",
)
def latex(name: str, output: Path | None, fragment: bool, convention: Convention | None) -> ExitCode:
    """Typeset a derivation.

    NAME is a shipped model (`satsym models` lists them) or a derivation file. The problem is derived again, and every
    step is checked by machine before anything is written.
    """
    from satsym.report.latex import document as typesetting
    from satsym.report.results.files import write_text
    from satsym.symbolic import derive, loader
    from satsym.symbolic.convention import in_convention

    subject, path = loader.problem(name)
    with live() as line, loader.explained(path, subject):
        line.show(f"deriving {name} ...")
        derivation = derive(in_convention(subject, convention))
    text = typesetting.render(derivation, language=language(), standalone=not fragment)
    if output is None:
        emit(text)
    else:
        write_text(output, text)
    return ExitCode.DONE
