"""How the steps were checked: one sentence for a page, a list of all of them for the end of a document."""

from __future__ import annotations

from satsym.agreement import DIGITS, LIMIT
from satsym.report.latex import tex
from satsym.report.texts import Texts
from satsym.symbolic import Check, Derivation
from satsym.symbolic.checks import POINTS

BY_INSPECTION = frozenset({"declared", "dimensions agree"})
"""Claims that are checked term by term, not by calculation."""


def checked(texts: Texts, check: Check) -> str:
    """What was found true, and how; not the measured deviation, which is noise, but its limit."""
    return f"{texts.get('claims', check.claim)} ({_how(texts, check, '')})."


def listed(derivation: Derivation, texts: Texts) -> str:
    """List the checks of all steps; what was found of every step is said once."""
    steps = derivation.steps
    common = [c for c in steps[0].checks if all(c.claim in {other.claim for other in s.checks} for s in steps)]
    paragraphs = [texts.get("methods", "all", **_measures(texts, LIMIT))]
    paragraphs += [texts.get("methods", "common", claim=_brief(texts, check)) for check in common]
    paragraphs[-1] += r"\nopagebreak"
    said = {check.claim for check in common}
    items = [
        rf"\satsymchecked{{{tex.label(f'{derivation.name}:{s.name}')}}}{{{found}}}"
        for s in steps
        if (found := " ".join(dict.fromkeys(f"{_brief(texts, c)}." for c in s.checks if c.claim not in said)) or "--")
    ]
    return "\n\n".join([*paragraphs, "\n".join((r"{\small", *items, r"\par}"))])


def _brief(texts: Texts, check: Check) -> str:
    return f"{texts.get('claims', check.claim)} ({_how(texts, check, ', brief')})"


def _how(texts: Texts, check: Check, brief: str) -> str:
    method = "inspection" if check.claim in BY_INSPECTION else "numeric" if check.limit else "exact"
    if brief and check.limit not in (0, LIMIT):
        method = "limited"
    return texts.get("methods", f"{method}{brief}", **_measures(texts, check.limit))


def _measures(texts: Texts, limit: float) -> dict[str, str]:
    return {"points": str(POINTS), "digits": str(DIGITS), "limit": tex.number(limit, texts.get("words", "point"))}
