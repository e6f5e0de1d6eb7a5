"""The sentences of rules, in the form that suits the controls, the constraints and the sources of a step."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

from satsym.agreement import DIGITS, LIMIT
from satsym.report.latex import tex
from satsym.report.latex.equations import Context
from satsym.report.texts import Texts
from satsym.symbolic import Check, Derivation, Step
from satsym.symbolic.checks import POINTS
from satsym.symbolic.principle.effort import letter_of_parts
from satsym.symbolic.principle.parts import parts_of
from satsym.symbolic.principle.path.notation import entry, holds_controls, of_states


def listed_sources(texts: Texts, named: Mapping[str, str]) -> str:
    """Enumerate the sources of a step by name, followed by the constants that are substituted."""
    listed = texts.listed([text for name, text in named.items() if text and name != "definitions"])
    constants = named.get("definitions")
    return texts.get("references", "besides", listed=listed, constants=constants) if constants else listed


def rule(context: Context, step: Step, sources: str) -> str:
    """Return the sentence of a step's rule, in the form for free controls or a single one where there is one."""
    texts = context.texts
    angle = _angle(context.derivation)
    part = letter_of_parts(problem) if (problem := context.derivation.problem) else ""
    kinds = texts.listed([texts.get("kinds", kind, angle=angle, part=part) for kind in step.kinds])
    fill = {"sources": sources, "quantities": quantities(context, step), "kinds": kinds}
    for first in context.derivation.model.controls[:1]:
        fill |= {"control": first.latex, "squared": f"({first.latex})^2" if "^" in first.latex else f"{first.latex}^2"}
    fill |= _by_order(context, sources)
    forms = _forms(context.derivation)
    both = [f"{one}, {other}" for one, other in combinations(forms, 2)]
    keys = [f"{step.rule}, {form}" for form in (*both, *forms)]
    return texts.get("rules", next((key for key in keys if texts.find("rules", key)), step.rule), **fill)


def _angle(derivation: Derivation) -> str:
    """Return the one angle among the control sets, or a letter that stands for each of several."""
    parts = parts_of(derivation.problem) if derivation.problem else ()
    found = [v.latex for part in parts if part.kind == "angle" for v in part.controls]
    return found[0] if len(found) == 1 else r"\beta"


def _by_order(context: Context, sources: str) -> dict[str, str]:
    """Return the sentence on derivatives of path constraints, which may all be of one order."""
    if "constraint_order" not in context.derivation:
        return {}
    assert context.derivation.problem is not None
    stated = {e.name for e in context.derivation.step("constraint_order").equations}
    orders = {1 + (entry(name, 2) in stated) for name in of_states(context.derivation.problem)}
    form = "" if len(orders) > 1 else f", {('one', 'two')[orders.pop() - 1]}"
    keys = ("meet", "keep", "multiplier", "jump", "levels")
    return {key: context.texts.get("orders", f"{key}{form}", sources=sources) for key in keys}


def _forms(derivation: Derivation) -> list[str]:
    """Return the kinds of controls for which a sentence may have a form."""
    problem, controls = derivation.problem, derivation.model.controls
    limited = problem is not None and (problem.control_set != "free" or bool(problem.control_sets))
    held = problem is not None and holds_controls(problem)
    forms = {
        "held": held,
        "free": not limited and not held,
        "one control": len(controls) == 1,
        "no control": not controls,
        "no reference": not derivation.model.reference,
    }
    return [form for form, meant in forms.items() if meant]


def quantities(context: Context, step: Step) -> str:
    """Name the quantities of a step in words, where the texts have them: the conserved quantities."""
    table, found = "conserved", []
    for e in step.equations:
        word = context.texts.find(table, e.name) or context.texts.find(table, e.name.partition("_")[0])
        found.append(f"{word or ''} ${context.typeset.inline(e.lhs)}$".strip())
    return context.texts.listed(found)


BY_INSPECTION = frozenset({"declared", "dimensions agree"})
"""Claims that are checked term by term, without a calculation."""


def checked(texts: Texts, check: Check) -> str:
    """State what was verified, and how: with the limit of the deviation, not its measured value, which is noise."""
    return f"{texts.get('claims', check.claim)} ({_how(texts, check, '')})."


def listed(derivation: Derivation, texts: Texts) -> str:
    """List the checks of all steps, with what they have in common stated once."""
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
