"""A referee's report on documents, in LaTeX: conclusions first, then findings by their weight."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.auditing.causes import Finding, Weight
from satsym.report.display import raised, with_raised_units
from satsym.report.findings.review import (
    IN_FULL,
    Review,
    correction,
    flat,
    is_mathematical,
    items,
    measured,
    quote,
    recompute,
    title,
    where,
)
from satsym.report.latex import formula_tex
from satsym.report.latex.equations import width
from satsym.report.latex.preamble import preamble
from satsym.report.latex.tex import bookmark, escape, name
from satsym.report.texts import Texts, load

_CODE = re.compile(r"`([^`]*)`")
_LONGEST_WORD = 12
_BAR, _COLOURS = 12.0, ("green!45!black", "red!70!black", "black!30")
"""The width of a bar in em, and the colours of right, wrong and open rows."""
_COLUMN = 0.3 * formula_tex.WIDEST
"""Width of one column of three, in em of the main font."""
_MACROS = r"""\usepackage{graphicx}
% {width}{body}: a column of a finding
\newcommand\satsymcolumn[2]{\parbox[t]{#1\linewidth}{\raggedright\hbadness=10000 #2}}
% {what is said}{the same as a proposition}
\newcommand\satsymbeside[2]{\par\noindent\satsymcolumn{0.44}{#1}\hfill\satsymcolumn{0.53}{#2}\par\smallskip}
% {what is printed}{what is right}{what differs}
\newcommand\satsymthree[3]{\par\noindent\satsymcolumn{0.32}{#1}\hfill\satsymcolumn{0.32}{#2}\hfill\satsymcolumn{0.32}{#3}\par\smallskip}
\newcommand\satsymfact[2]{\par\noindent\satsymcolumn{0.16}{\textcolor{black!60}{#1}}\satsymcolumn{0.84}{#2}\par}
"""


def render(
    ledgers: Sequence[Ledger], judged: Mapping[str, Sequence[Judged]], language: str = "en", code: bool = False
) -> str:
    """Return a document with a section for each ledger.

    Parameters
    ----------
    judged
        Key of a document -> its rows with their verdicts.
    language
        Of all but what the documents print and of what is measured.
    code
        Whether what claims were tested as, and what was measured, is given as code, too.

    Returns
    -------
    str
        LaTeX that depends on nothing but the arguments.
    """
    texts = load(language)
    reviews = [Review.of(ledger, judged[ledger.document.key], texts) for ledger in ledgers]
    head = [
        rf"\begin{{center}}{{\LARGE {_breakable(title(reviews))}\par}}\vspace{{1ex}}",
        rf"{escape(texts.get('audit', 'made'))}\end{{center}}",
        *_legend(texts, reviews),
    ]
    body = "\n\n".join([*head, *(part for review in reviews for part in _section(review, code))])
    source = "% Written by satsym audit. Do not edit.\n"
    opening = preamble(texts, bookmark(title(reviews)))
    return f"{source}{opening}{_MACROS}\\begin{{document}}\n{body}\n\\end{{document}}\n"


def _legend(texts: Texts, reviews: Sequence[Review]) -> Iterator[str]:
    """Return the meaning of verdicts and weights, and the number of rows of each document with each verdict."""
    yield rf"\section*{{{escape(texts.get('audit', 'legend'))}}}"
    head = " & ".join([escape(texts.get("audit", "verdict")), *(name(review.key) for review in reviews)])
    lines = [
        " & ".join([escape(texts.get("verdicts", v)), *(str(review.counts.get(v, 0)) for review in reviews)])
        for v in VERDICTS
        if any(v in review.counts for review in reviews)
    ]
    body = " \\\\\n".join(lines)
    columns = f"@{{}}l{'r' * len(reviews)}@{{}}"
    yield rf"\begin{{tabular}}{{{columns}}}\toprule {head} \\ \midrule" + f"\n{body}" + r" \\ \bottomrule\end{tabular}"
    for names, meanings, keys in (
        ("verdicts", "verdict_meanings", VERDICTS),
        ("weights", "weight_meanings", [w.value for w in Weight]),
    ):
        pairs = "; ".join(rf"\emph{{{escape(texts.get(names, k))}}}: {escape(texts.get(meanings, k))}" for k in keys)
        yield f"{pairs}."


def _section(review: Review, code: bool) -> Iterator[str]:
    texts = review.texts
    yield rf"\section*{{{_breakable(review.ledger.document.title)}}}"
    yield _breakable(review.byline)
    yield " ".join(map(_sentence, review.summary))
    yield _chart(review)
    if not review.findings:
        yield escape(texts.get("audit", "nothing"))
    for weight, group in review.by_weight:
        yield rf"\subsection*{{{escape(texts.get('weights', weight.value))}}}"
        for number, finding in group:
            if weight in IN_FULL:
                yield from _in_full(review, number, finding, code)
            else:
                yield from _in_brief(review, number, finding)
    for heading, listed in (("not_judged", items(review.open)), ("confirmed_items", review.confirmed_items)):
        if listed:
            yield rf"\subsection*{{{escape(texts.get('audit', heading))}}}"
            yield f"{', '.join(map(escape, listed))}."


def _chart(review: Review) -> str:
    """Return bars of how many rows of each kind are right, wrong and open."""
    names = [review.texts.get("audit", key) for key in ("stands", "falls_here", "open_here")]
    lines = []
    for kind, *counts in review.chart:
        widths = [f"{_BAR * count / sum(counts):.2f}" for count in counts]
        bars = "".join(
            rf"\textcolor{{{colour}}}{{\rule{{{width}em}}{{1.2ex}}}}"
            for colour, width, count in zip(_COLOURS, widths, counts, strict=True)
            if count
        )
        lines.append(" & ".join([escape(kind), *map(str, counts), bars]))
    heading = " & ".join([escape(review.texts.get("audit", "of_kind")), *map(escape, names), ""])
    body = " \\\\\n".join(lines)
    return "\n".join(
        (
            r"\begin{center}\begin{tabular}{@{}lrrrl@{}}\toprule",
            rf"{heading} \\ \midrule",
            rf"{body} \\ \bottomrule\end{{tabular}}\end{{center}}",
        )
    )


def _in_brief(review: Review, number: int, finding: Finding) -> Iterator[str]:
    said = (
        rf"\noindent\textbf{{{number}.~{escape(review.places(finding.places))}}}: {_sentence(review.brief(finding))}."
    )
    row = finding.places[0]
    formula, (key, quoted) = review.formulas.get(row.key), quote(row)
    if formula is not None:
        key, printed = "printed", _printed(formula, "")
    else:
        printed = rf"\textit{{{_breakable(quoted)}}}" if key == "says" else _breakable(quoted)
    yield f"{said}\n{_fact(review.texts, key, printed)}" if printed else said


def _in_full(review: Review, number: int, finding: Finding, code: bool) -> Iterator[str]:
    row, texts = finding.places[0], review.texts
    verdict = escape(texts.get("verdicts", row.verdict))
    heading = rf"\paragraph{{{number}.~{escape(review.places(finding.places))}}} \emph{{{verdict}}}"
    yield f"{heading}{f' ({escape(review.placed(where(row)))})' if where(row) else ''}"
    spoiled = escape(review.spoiled(finding)) if finding.spoiled else ""
    evidence, command = recompute(row)
    right = formula_tex.read(correction(row)) if is_mathematical(row) else None
    original = rf"\textit{{{_breakable(row.original)}}}" if row.original else ""
    claim = row.kind == "claim"
    formulas = [one for one in (review.formulas.get(row.key), right) if one is not None]
    narrow = all(width(tex) <= _COLUMN for one in formulas for tex in formula_tex.lines(one))
    three = row.by_formula and bool(correction(row)) and not claim and narrow
    beside = original if claim and code else ""
    if beside:
        yield rf"\satsymbeside{{{beside}}}{{{_printed(None, flat(row.printed))}}}"
    if three:
        heads = (escape(texts.get("audit", key)) for key in ("printed", "right", "difference"))
        bodies = (
            _printed(review.formulas.get(row.key), flat(row.printed)),
            _printed(right, correction(row)),
            _sentence(review.fact(row)),
        )
        columns = (
            rf"{{\textcolor{{black!60}}{{{head}}}\newline {body}}}" for head, body in zip(heads, bodies, strict=True)
        )
        yield rf"\satsymthree{''.join(columns)}"
    facts = {
        "says": "" if beside else original,
        "about": "" if original else _breakable(row.says),
        "printed": "" if claim or three else _printed(review.formulas.get(row.key), flat(row.printed)),
        "in_fact": "" if three else _sentence(review.fact(row)),
        "measured": _sentence(review.in_words(row), raised) if measured(row) else "",
        "chosen": _breakable(review.chosen(row)),
        "right": "" if three else _printed(right, correction(row)),
        "spoils": spoiled,
        "evidence": rf"\footnotesize {_breakable(evidence)}" if evidence and code else "",
        "recompute": rf"\footnotesize{_typewriter(command)}",
    }
    yield "\n".join(_fact(texts, key, text) for key, text in facts.items() if text)


def _fact(texts: Texts, key: str, text: str) -> str:
    return rf"\satsymfact{{{escape(texts.get('audit', key))}}}{{{text}}}"


def _printed(formula: formula_tex.Printed | None, text: str) -> str:
    """Typeset a formula as mathematics, any other content in typewriter."""
    if formula is None:
        return _typewriter(text) if text else ""
    return r" \newline\quad ".join(map(_fitted, formula_tex.lines(formula)))


def _fitted(tex: str) -> str:
    """Typeset mathematics, reduced in size where it is wider than the column."""
    plain = rf"$\displaystyle {tex}$"
    return plain if width(tex) <= formula_tex.WIDEST else rf"\resizebox{{\linewidth}}{{!}}{{{plain}}}"


def _sentence(text: str, written: Callable[[str], str] = with_raised_units) -> str:
    r"""Typeset a sentence whose formulas are between backquotes, and whose other parts are written so."""
    pieces = _CODE.split(text)
    return "".join(_breakable(written(piece)) if k % 2 == 0 else _inline(piece) for k, piece in enumerate(pieces))


def _inline(text: str) -> str:
    tex = formula_tex.inline(text)
    return _typewriter(text) if tex is None else f"${tex}$"


def _typewriter(text: str) -> str:
    """Typeset text as it is typed, with straight quotes."""
    straight = _breakable(text).replace("'", r"\textquotesingle{}")
    return rf"\texttt{{{straight}}}"


def _breakable(text: str) -> str:
    """Return escaped text whose long words may be broken at signs."""
    words = []
    for word in text.split():
        escaped = escape(word)
        if len(word) > _LONGEST_WORD:
            escaped = re.sub(r"([*/+=,;.()-]|\\_)(?=[^\s}])", r"\1\\allowbreak{}", escaped)
        words.append(escaped)
    before, after = (" " if text[k : k + 1].isspace() else "" for k in (0, len(text) - 1))
    return f"{before}{' '.join(words)}{after}"
