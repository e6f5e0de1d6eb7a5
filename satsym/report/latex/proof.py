"""A proof as a section of a document: the theorem, its hypotheses with what was shown of each, and enclosures."""

from __future__ import annotations

import re
from collections.abc import Iterator

from satsym.proof.record import Enclosure, Proof
from satsym.report.display import capitalised
from satsym.report.latex.preamble import preamble
from satsym.report.latex.tex import bookmark, escape, name
from satsym.report.said import message, say, spoken
from satsym.report.texts import Texts, load

GROUP = 5
"""Digits after which a thin space makes long numbers legible."""
_NUMBER = re.compile(r"(?P<whole>-?\d+)(?:\.(?P<part>\d+))?(?:e(?P<power>[+-]?\d+))?\Z")


def render(proof: Proof, language: str = "en", *, standalone: bool = True) -> str:
    """LaTeX of a proof.

    Parameters
    ----------
    language
        Of all but names and of where theorems stand.
    standalone
        Whether it is a document; else a section for one, which needs the packages amsmath and booktabs.

    Returns
    -------
    str
        Text that depends on nothing but the arguments.
    """
    texts = load(language)
    with spoken(language):
        body = "\n\n".join(_section(proof, texts))
    source = "% Written by satsym prove. Do not edit.\n"
    if not standalone:
        return f"{source}{body}\n"
    title = texts.get("page", "proof_of", name=proof.instance)
    return f"{source}{preamble(texts, bookmark(title))}\\begin{{document}}\n{body}\n\\end{{document}}\n"


def _section(proof: Proof, texts: Texts) -> Iterator[str]:
    yield rf"\section*{{{escape(texts.get('page', 'proof_of', name=proof.instance))}}}"
    status = rf"\textbf{{{escape(message(proof.status.value))}}}"
    yield f"{status}: {escape(message(proof.reason))}." if proof.reason else f"{status}."
    if proof.theorem is not None:
        claims = "\n".join(rf"\item {escape(message(claim))}" for claim in proof.theorem.claims)
        yield f"\\begin{{enumerate}}\n{claims}\n\\end{{enumerate}}"
        said = say("Theorem: <name> (<source>).", name=message(proof.theorem.name), source=proof.theorem.source)
        yield escape(said)
    if proof.hypotheses:
        yield rf"\subsection*{{{escape(texts.get('page', 'hypotheses'))}}}"
        items = (
            rf"\item {_sentence(message(h.name))}. {_sentence(message(h.shown))}; {escape(message(h.value))}."
            for h in proof.hypotheses
        )
        yield "\\begin{enumerate}\n" + "\n".join(items) + "\n\\end{enumerate}"
    if rows := list(_enclosures(proof, texts)):
        yield rf"\subsection*{{{escape(texts.get('page', 'enclosures'))}}}"
        yield _table(rows, texts)
    if proof.scope:
        yield escape(message(proof.scope))
        numbers = [rf"{name(key)} = \texttt{{{escape(number)}}}" for key, number in proof.numbers.items()]
        yield rf"{{\raggedright {', '.join(numbers)}.\par}}"


def _enclosures(proof: Proof, texts: Texts) -> Iterator[tuple[str, Enclosure]]:
    known = [
        (escape(texts.get("page", "objective")), proof.objective),
        (escape(texts.get("page", "final_time")), proof.t_final),
        *((escape(say("change of law")), time) for time in proof.switching_times),
    ]
    yield from ((label, one) for label, one in known if one is not None)
    for key, values in (("costate_of", proof.costate_initial), ("final_of", proof.x_final)):
        for state, one in values.items():
            yield escape(texts.get("page", key, name=state)), one


def _table(rows: list[tuple[str, Enclosure]], texts: Texts) -> str:
    point = texts.get("words", "point")
    lines = [f"{label} & {_number(one.centre, point)} & {_number(one.radius, point)}" for label, one in rows]
    head = " & ".join(escape(texts.get("page", key)) for key in ("quantity", "value", "radius"))
    body = " \\\\\n".join(lines)
    return (
        rf"\begin{{tabular}}{{@{{}}lll@{{}}}}\toprule {head} \\ \midrule"
        + f"\n{body}"
        + r" \\ \bottomrule\end{tabular}"
    )


def _number(text: str, point: str) -> str:
    """A decimal number, its digits in groups."""
    found = _NUMBER.match(text)
    if found is None:
        return escape(text)
    whole, part = found["whole"], found["part"] or ""
    groups = r"\,".join(part[k : k + GROUP] for k in range(0, len(part), GROUP))
    digits = f"{whole}{point}{groups}" if groups else whole
    return rf"${digits} \times 10^{{{int(found['power'])}}}$" if found["power"] else f"${digits}$"


def _sentence(text: str) -> str:
    """A text that begins with a capital letter."""
    return escape(capitalised(text))
