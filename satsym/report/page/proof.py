"""The proof beside an answer: what is claimed, its hypotheses with what was shown of each, and enclosures."""

from __future__ import annotations

from satsym.proof.record import Enclosure, Outcome, Proof
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.page.answer import table
from satsym.report.said import decimal, message, say
from satsym.report.texts import Texts


def proof(found: Proof, texts: Texts) -> Markup:
    """The section of a page; of an attempt that failed, why, and what was shown until then."""
    parts = [tag("p", tag("b", message(found.status.value), class_=_CLASSES[found.status]), *_reason(found))]
    if found.theorem is not None:
        parts += [
            tag("ol", *(tag("li", message(claim)) for claim in found.theorem.claims)),
            tag(
                "p",
                say("Theorem: <name> (<source>).", name=message(found.theorem.name), source=found.theorem.source),
            ),
        ]
    if found.hypotheses:
        steps = (f"{message(h.name)}: {message(h.shown)}; {message(h.value)}" for h in found.hypotheses)
        parts += [tag("h3", texts.get("page", "hypotheses")), tag("ol", *(tag("li", step) for step in steps))]
    if known := _enclosures(found, texts):
        parts.append(table(texts.get("page", "enclosures"), [_head(texts), *known]))
    if found.nodes:
        parts.append(_nodes(found, texts))
    if found.scope:
        numbers = ", ".join(f"{name} = {number}" for name, number in found.numbers.items())
        parts += [tag("p", message(found.scope)), tag("p", numbers)]
    return joined(*parts)


_CLASSES = {
    Outcome.PROVED: "verdict certified",
    Outcome.NOT_PROVED: "verdict failed",
    Outcome.BEYOND: "verdict extremal",
}


def _reason(found: Proof) -> list[str]:
    return [f": {message(found.reason)}."] if found.reason else ["."]


def _head(texts: Texts) -> tuple[str, ...]:
    return tuple(texts.get("page", key) for key in ("quantity", "value", "radius"))


def _row(name: str, found: Enclosure) -> tuple[str, ...]:
    return name, found.centre, found.radius


def _enclosures(found: Proof, texts: Texts) -> list[tuple[str, ...]]:
    """Rows of the objective, the times, the costates at the start and the states at the end."""
    known = [
        (texts.get("page", "objective"), found.objective),
        (texts.get("page", "final_time"), found.t_final),
        *((say("change of law"), time) for time in found.switching_times),
        *((texts.get("page", "costate_of", name=name), v) for name, v in found.costate_initial.items()),
        *((texts.get("page", "final_of", name=name), v) for name, v in found.x_final.items()),
    ]
    return [_row(name, one) for name, one in known if one is not None]


def _nodes(found: Proof, texts: Texts) -> Markup:
    """States and costates along the extremal, folded away."""
    parts = []
    for node in found.nodes:
        rows = [_row(name, one) for name, one in node.x.items()]
        rows += [_row(texts.get("page", "costate", name=name), one) for name, one in node.costates.items()]
        parts.append(table(texts.get("page", "at_time", time=decimal(node.t.text)), [_head(texts), *rows]))
    return tag("details", tag("summary", texts.get("page", "along")), *parts)
