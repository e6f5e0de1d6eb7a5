"""A referee's report on documents, in LaTeX: what is confirmed first, then each remark with what is printed."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from satsym.auditing import Judged, Ledger
from satsym.formula import reading
from satsym.report.latex import formula_tex
from satsym.report.latex.document import PREAMBLE
from satsym.report.latex.tex import escape
from satsym.report.terminal.audit import counts, items
from satsym.status import BadInput

FORMULAS = ("equation", "matrix", "algorithm")
_CODE = re.compile(r"`([^`]*)`")
_LONGEST_WORD = 12


def render(ledgers: Sequence[Ledger], judged: Mapping[str, Sequence[Judged]]) -> str:
    """A document with a section for each ledger.

    Parameters
    ----------
    judged
        Key of a document -> its rows with their verdicts.

    Returns
    -------
    str
        LaTeX that depends on nothing but the arguments.
    """
    sections = [_section(ledger, judged[ledger.document.key]) for ledger in ledgers]
    source = "% Written by satsym audit. Do not edit.\n"
    return f"{source}{PREAMBLE}\\begin{{document}}\n" + "\n".join(sections) + "\\end{document}\n"


def _section(ledger: Ledger, judged: Sequence[Judged]) -> str:
    document = ledger.document
    by = ", ".join(filter(None, [document.authors, str(document.year or "")]))
    parts = [rf"\section*{{{escape(document.title)}}}"]
    if by:
        parts.append(escape(by))
    right = [row for row in judged if row.verdict == "confirmed"]
    remarks = [row for row in judged if row.verdict != "confirmed"]
    if right:
        listed = ", ".join(map(escape, items(right)))
        parts.append(rf"\textbf{{Confirmed}} ({len(right)} of {len(judged)}): {listed}.")
    if not remarks:
        return "\n\n".join([*parts, "There is nothing to correct.", ""])
    listed = ", ".join(f"{number} {verdict}" for verdict, number in counts(remarks).items())
    parts.append(rf"\textbf{{Remarks}}: {listed}.")
    return "\n\n".join([*parts, *map(_remark, remarks), ""])


def _remark(row: Judged) -> str:
    where = rf" ({escape(row.where)})" if row.where else ""
    lines = [rf"\paragraph{{{escape(row.key)}}} \emph{{{row.verdict}}}{where}. {escape(row.says)}"]
    if row.printed:
        lines.append(_printed("Printed:", row, row.printed))
    if row.derived and row.derived not in row.diagnosis:
        lines.append(_printed("Derived:", row, row.derived))
    lines.append(_sentence(row.diagnosis))
    lines.append(rf"{{\footnotesize {_breakable(row.evidence)}\par}}")
    return "\n\n".join(filter(None, lines))


def _printed(label: str, row: Judged, what: object) -> str:
    """A formula as a display, anything else as text."""
    if row.kind in FORMULAS:
        try:
            return f"{label}\n{_formula(what)}"
        except BadInput:
            pass
    return f"{label} {_breakable(_flat(what))}"


def _formula(what: object) -> str:
    if isinstance(what, str) and not what.startswith("["):
        return formula_tex.display(reading.statement(what))
    if isinstance(what, str):
        tree = reading.expression(what, judging=True)
        rows = [list(getattr(row, "entries", (row,))) for row in getattr(tree, "entries", ())]
        return formula_tex.matrix(rows)
    lines = [[line] if isinstance(line, str) else list(line) for line in what] if isinstance(what, Sequence) else []
    return formula_tex.matrix([[reading.expression(entry) for entry in line] for line in lines])


def _flat(what: object) -> str:
    return what if isinstance(what, str) else f"[{', '.join(map(_flat, what))}]" if isinstance(what, Sequence) else ""


def _sentence(text: str) -> str:
    r"""A sentence whose formulas, between backquotes, are typeset."""
    pieces = _CODE.split(text)
    return "".join(_breakable(piece) if k % 2 == 0 else _inline(piece) for k, piece in enumerate(pieces))


def _inline(text: str) -> str:
    try:
        sign = "+" if text.startswith("+") else ""
        return f"${sign}{formula_tex.formula(reading.statement(text.removeprefix('+')))}$"
    except BadInput:
        return rf"\texttt{{{_breakable(text)}}}"


def _breakable(text: str) -> str:
    """Escaped text whose long words may be broken at signs."""
    words = []
    for word in text.split():
        escaped = escape(word)
        if len(word) > _LONGEST_WORD:
            escaped = re.sub(r"([*/+=,;)-]|\\_)(?=[^\s}])", r"\1\\allowbreak{}", escaped)
        words.append(escaped)
    before, after = (" " if text[k : k + 1].isspace() else "" for k in (0, len(text) - 1))
    return f"{before}{' '.join(words)}{after}"
