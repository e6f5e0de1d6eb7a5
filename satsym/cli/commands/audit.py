"""``satsym audit``: what documents print, judged."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, place_option
from satsym.cli.output import answer, live
from satsym.report.said import counted, language
from satsym.status import BadInput, ExitCode

EXAMPLES = """\b
Examples:
  satsym audit                          all documents that come with satsym
  satsym audit its_thesis --item 4.27   one equation, recomputed
  satsym audit --html audit.html        one page with the audits of all documents
  satsym audit my_ledger.toml --latex report.tex --lang id
  satsym audit --coverage               the numbered items of the documents that have no ledger row
  satsym audit its_thesis --coverage --text thesis.txt   the parts of a text that have no ledger row"""


@command(epilog=EXAMPLES)
@click.argument("ledgers", metavar="[LEDGER]...", nargs=-1, shell_complete=names.completed(names.documents))
@json_option
@place_option("--html", metavar="FILE", help="Also write a report as an HTML page.")
@place_option("--latex", metavar="FILE", help="Also write a report as a LaTeX document.")
@click.option("--item", "items", metavar="X", multiple=True, help="Check only this item; may be repeated.")
@click.option(
    "--coverage",
    is_flag=True,
    help="List the numbered items of the document that have no row in its ledger, and check nothing.",
)
@place_option("--text", metavar="FILE", help="With --coverage: compare the ledger with this text of the document.")
@place_option(
    "--keep",
    metavar="FILE",
    help="With --text: write the numbers found in the text to this file, to be kept with the ledger.",
)
@click.option("--rows", is_flag=True, help="After the findings, print every ledger row that is not fully confirmed.")
@click.option("--code", is_flag=True, help="Also print the tests and the measurements as code.")
@click.option("--fresh", is_flag=True, help="Recompute everything, without the cache.")
def audit(
    ledgers: tuple[str, ...],
    as_json: bool,
    html: Path | None,
    latex: Path | None,
    items: tuple[str, ...],
    coverage: bool,
    text: Path | None,
    keep: Path | None,
    rows: bool,
    code: bool,
    fresh: bool,
) -> ExitCode:
    """Check the formulas and statements in a document.

    Equations, matrices, numbers, units, tables, algorithms and claims are checked against what satsym derives. LEDGER
    is the name of a document that comes with satsym, or a TOML file that lists the items of a document and says what
    each of them is to be checked against. Every verdict is computed; a ledger cannot contain verdicts. The exit code
    does not depend on the verdicts.
    """
    from satsym import auditing
    from satsym.auditing import cache
    from satsym.report.findings import objects
    from satsym.report.terminal import audit as reporting

    paths = [auditing.locate(name) for name in ledgers] if ledgers else auditing.shipped()
    read = [auditing.read(path) for path in paths]
    auditing.refuse_unknown_items(read, items)
    if (text and not (coverage and len(read) == 1)) or (keep and not text):
        raise BadInput("--text requires --coverage and one LEDGER, and --keep requires --text; give them together")
    if coverage:
        from satsym.auditing.ledger import coverage as contents

        found = [contents.measured(x, contents.text_of(text)) if text else contents.kept(x) for x in read]
        if keep and found[0]:
            from satsym.report.results.files import write_text

            write_text(keep, contents.to_toml(found[0]))
        answer(as_json, objects.coverage_object(read, found), lambda: reporting.coverage_text(read, found))
        return ExitCode.DONE
    with live() as line:
        judged = cache.audit_all(read, items, line.show, fresh=fresh)
        if html is not None:
            from satsym.report.html.audit import render as page
            from satsym.report.results.files import write_text

            write_text(html, page(read, judged, language(), line.show))
    if latex is not None:
        from satsym.report.latex.audit import render
        from satsym.report.results.files import write_text

        write_text(latex, render(read, judged, language(), code))
    drafts = sum(row.table.draft for ledger in read for row in ledger.rows)
    remark = [
        "",
        counted(
            drafts,
            "ledger row is a draft that has not been confirmed",
            "ledger rows are drafts that have not been confirmed",
        ),
    ]

    def text_of_it() -> str:
        whole = reporting.audit_text(read, judged, rows=rows or bool(items), code=code, language=language())
        return "\n".join([whole.rstrip("\n"), *(remark if drafts else ())])

    answer(as_json, objects.audit_object([row for found in judged.values() for row in found]), text_of_it)
    return ExitCode.DONE
