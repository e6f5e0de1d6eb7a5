"""``satsym read``: a ledger drafted from a document."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, place_option
from satsym.cli.output import answer
from satsym.status import BadInput, ExitCode

EXAMPLES = """\b
Examples:
  satsym read paper.tex --model hill        drafts paper.ledger.toml in the same directory as the paper
  satsym read paper.tex                     the same again: confirmed rows are kept
  satsym read notes.md --model DIR/sled --out notes.toml
  satsym audit paper.ledger.toml            checks the document"""


@command(epilog=EXAMPLES)
@click.argument("document", metavar="FILE", type=click.Path(path_type=Path))
@click.option(
    "--model",
    metavar="NAME",
    default="",
    help="The model that the document is about: a shipped one, or DIR/NAME relative to FILE.",
    shell_complete=names.completed(names.models),
)
@click.option("--let", metavar="LETTER=NAME", multiple=True, help="What a printed letter means; may be repeated.")
@place_option("--out", metavar="LEDGER", help="Write the ledger to this file, not to the directory of the document.")
@json_option
def read(document: Path, model: str, let: tuple[str, ...], out: Path | None, as_json: bool) -> ExitCode:
    """List the formulas of a document in a file for the audit.

    FILE is LaTeX, or Markdown with $$. The file that is written, a ledger, lists the displayed formulas and what each
    is to be checked against: each equation becomes a row with a proposed address in the model. You confirm a row by
    deleting its line `draft = true`. If the document is read again, confirmed rows are kept. Formulas that cannot be
    read are listed with their positions.
    """
    from satsym.auditing.document import drafting
    from satsym.report.results.files import write_text
    from satsym.report.terminal.audit import drafted_text

    ledger = out or document.with_suffix(drafting.SUFFIX)
    found = drafting.draft(document, model, _text_before(ledger), let)
    write_text(ledger, found.text)
    answer(as_json, drafting.as_object(ledger, found), lambda: drafted_text(ledger, found))
    return ExitCode.DONE


def _text_before(ledger: Path) -> str:
    """Return the text of an existing ledger, if there is one.

    Raises
    ------
    BadInput
        If it is no text.
    """
    if not ledger.is_file():
        return ""
    try:
        return ledger.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        raise BadInput(f"{ledger}: exists already and is not a text file; give another --out") from None
