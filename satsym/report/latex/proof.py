"""A proof as a section of a document: the theorem, its hypotheses with how each was shown, and enclosures."""

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
"""Number of digits between thin spaces in long numbers."""
_NUMBER = re.compile(r"(?P<whole>-?\d+)(?:\.(?P<part>\d+))?(?:e(?P<power>[+-]?\d+))?\Z")


def render(proof: Proof, language: str = "en", *, standalone: bool = True) -> str:
    """Return the LaTeX of a proof.

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
    status = rf"\textbf{{{_sentence(message(proof.status.value))}}}"
    yield f"{status}: {_typeset(message(proof.reason))}." if proof.reason else f"{status}."
    if proof.theorem is not None:
        yield _numbered([_typeset(message(claim)) for claim in proof.theorem.claims])
        said = say("Theorem: <name> (<source>).", name=message(proof.theorem.name), source=proof.theorem.source)
        yield _PAGES.sub("--", escape(said))
    if proof.hypotheses:
        yield rf"\subsection*{{{escape(texts.get('page', 'hypotheses'))}}}"
        yield _numbered(
            [
                f"{_sentence(message(h.name))}: {_typeset(message(h.shown))} ({_typeset(message(h.value))})."
                for h in proof.hypotheses
            ]
        )
    if rows := list(_enclosures(proof, texts)):
        yield rf"\subsection*{{{escape(texts.get('page', 'enclosures'))}}}"
        yield _table(rows, texts)
    if proof.scope:
        yield rf"\subsection*{{{escape(texts.get('page', 'proof_about'))}}}"
        yield _typeset(message(proof.scope))
        yield _given(proof, texts)


def _numbered(items: list[str]) -> str:
    return "\\begin{enumerate}\n" + "\n".join(rf"\item {item}" for item in items) + "\n\\end{enumerate}"


def _given(proof: Proof, texts: Texts) -> str:
    """Write the numbers of the instance, two to a line."""
    cells = [rf"{name(key)} & \texttt{{{escape(number)}}}" for key, number in proof.numbers.items()]
    cells += ["& "] * (len(cells) % 2)
    head = " & ".join([f"{escape(texts.get('page', 'key'))} & {escape(texts.get('page', 'value'))}"] * 2)
    body = " \\\\\n".join(f"{left} & {right}" for left, right in zip(cells[::2], cells[1::2], strict=True))
    return rf"\par\medskip\begin{{tabular}}{{@{{}}ll@{{\qquad}}ll@{{}}}}\toprule {head} \\ \midrule" + (
        f"\n{body}" + r" \\ \bottomrule\end{tabular}"
    )


def _enclosures(proof: Proof, texts: Texts) -> Iterator[tuple[str, Enclosure]]:
    known = [
        (escape(texts.get("page", "objective")), proof.objective),
        (escape(texts.get("page", "final_time")), proof.t_final),
        *((_sentence(say("change of law")), time) for time in proof.switching_times),
    ]
    yield from ((label, one) for label, one in known if one is not None)
    for key, values in (("costate_of", proof.costate_initial), ("final_of", proof.x_final)):
        for state, one in values.items():
            yield escape(texts.get("page", key, name=_PLACE)).replace(_PLACE, name(state)), one


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


_FORMULA = re.compile(
    r"(?P<number>\b\d+(?:\.\d+)?e[+-]?\d+\b)|(?P<start>(?<=W\(t0\) = )[^;,]+)|(?P<name>W\(t0\)|\bH_uu\b|\bH\b)"
)
"""Pattern of numbers with powers of ten, and of mathematical symbols, within sentences."""
_NAMES = {"W(t0)": "W(t_0)", "H_uu": "H_{uu}", "H": "H"}
_PLACE = "XFORMULAX"
"""Placeholder for a formula or name while the surrounding words are escaped."""
_PAGES = re.compile(r"(?<=\d)-(?=\d)")


def _typeset(text: str) -> str:
    """Typeset a sentence with its formulas."""
    formulas = [_formula(found) for found in _FORMULA.finditer(text)]
    around = escape(_FORMULA.sub(_PLACE, text)).split(_PLACE)
    return around[0] + "".join(f"${formula}${words}" for formula, words in zip(formulas, around[1:], strict=True))


def _formula(found: re.Match[str]) -> str:
    if found["name"]:
        return _NAMES[found[0]]
    if found["start"]:
        latex = re.sub(r"t_(\d+)", r"t_{\1}", found[0]).replace("diag", r"\operatorname{diag}")
        return latex.replace("lambda / x", r"\lambda / x").replace("*", r"\,")
    digits, power = found[0].split("e")
    return f"10^{{{int(power)}}}" if digits == "1" else rf"{digits} \times 10^{{{int(power)}}}"


def _number(text: str, point: str) -> str:
    """Write a decimal number with its digits in groups."""
    found = _NUMBER.match(text)
    if found is None:
        return escape(text)
    whole, part = found["whole"], found["part"] or ""
    groups = r"\,".join(part[k : k + GROUP] for k in range(0, len(part), GROUP))
    digits = f"{whole}{point}{groups}" if groups else whole
    return rf"${digits} \times 10^{{{int(found['power'])}}}$" if found["power"] else f"${digits}$"


def _sentence(text: str) -> str:
    """Return a text that begins with a capital letter."""
    return _typeset(capitalised(text))
