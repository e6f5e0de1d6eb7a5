"""The answer and its certificate: facts, tables, and what the verdict claims and does not claim."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from satsym.instance import Instance
from satsym.instance.shown import spec_of
from satsym.proof.record import Enclosure, Outcome, Proof
from satsym.report.display import (
    capitalised,
    norm_latex,
    norm_text,
    number,
    radical,
    times_ten_to,
    unit_text,
    with_powers,
)
from satsym.report.html.markup import Markup, joined, math, scrolled, tag
from satsym.report.results.objects import time_unit
from satsym.report.said import counted, decimal, message, say
from satsym.report.terminal.arcs import rows_of_arcs
from satsym.report.terminal.certificate import competitor_rows, condition_rows, theorem_lines, verdict_text
from satsym.report.terminal.solution import boundary, control_rows, reason, state_rows
from satsym.report.terminal.table import figure
from satsym.report.texts import Texts
from satsym.solution import Certificate, Solution
from satsym.spec import ProblemSpec
from satsym.status import Scope, Verdict

DIGITS = 6
"""Number of significant digits of costates, as many as states have."""
MET = "\N{CHECK MARK}"
"""Mark of a condition that is met."""


def facts(solution: Solution, texts: Texts) -> Markup:
    """Return the cost, the final time, and how they were found."""
    instance, spec = solution.instance, spec_of(solution.instance)
    unit = unit_text(time_unit(spec) or "1")
    cost, span = _cost_and_span(solution, 10)
    arcs: dict[str, list[Markup]] = {}
    symbols = symbols_of(instance)
    for label, names, times in rows_of_arcs(solution, unit):
        named = joined(*(_symbol(name, symbols) for name in names.split(", ")), by=", ")
        arcs.setdefault(label.rstrip(":").capitalize(), []).append(joined(named, " ", with_powers(decimal(times))))
    events = "; ".join(
        f"{message(one.kind)} {one.name} {say('at <times>', times=f'{figure(one.t, 10)} {unit}'.rstrip())}"
        for one in solution.events
    )
    known = {
        "status": message(solution.status.value),
        "message": reason(solution),
        "maximum" if spec.maximise else "cost": cost if solution.status.answered else "",
        "final_time": span,
        "boundary": boundary(instance),
        "method": f"{solution.method}, {counted(solution.iterations, 'iteration')}",
        "events": events,
    }
    said = {
        texts.get("page", key): joined(with_powers(decimal(value.strip()))) for key, value in known.items() if value
    }
    said |= {label: joined(*listed, by="; ") for label, listed in arcs.items()}
    pairs = [tag("dt", title) + tag("dd", value) for title, value in said.items()]
    return tag("dl", *map(Markup, pairs))


def symbols_of(instance: Instance) -> dict[str, str]:
    """Return the LaTeX of states, controls and bounded norms, by the names that tables give them."""
    spec = spec_of(instance)
    found = {v.symbol: v.latex for v in (*spec.states, *spec.controls)}
    for norm in instance.bounded_norms:
        parts = [spec.controls[place] for place in norm.places]
        found[radical(norm_text([v.symbol for v in parts]))] = norm_latex([v.latex for v in parts])
    return found


def _symbol(name: str, symbols: Mapping[str, str]) -> Markup:
    """Return the symbol of a quantity as a formula; a name without symbol is unchanged."""
    return math(symbols[name]) if name in symbols else joined(name)


def glance(solution: Solution, texts: Texts) -> Markup:
    """Return what a reader looks for first: the cost, the final time, and what the certificate claims.

    Of a run without an answer, these are the status, the reason and what can be done about it, and that there is no
    certificate.
    """
    maximise, found = solution.instance.model.spec.maximise, solution.certificate
    cost, span = _cost_and_span(solution, 6)
    claimed = capitalised(verdict_text(found, maximise)) if found else ""
    if solution.status.answered:
        known = {"maximum" if maximise else "cost": cost, "final_time": span, "certificate": claimed}
    else:
        known = {
            "status": capitalised(message(solution.status.value)),
            "message": capitalised(reason(solution)),
            "certificate": claimed or texts.get("page", "no_certificate"),
        }
    pairs = (
        tag("div", tag("dt", texts.get("page", key)), tag("dd", decimal(value.strip())), class_=key)
        for key, value in known.items()
        if value
    )
    return tag("dl", *pairs)


def _cost_and_span(solution: Solution, digits: int) -> tuple[str, str]:
    """Return the cost and the final time with their units; an empty final time without a trajectory."""
    spec = spec_of(solution.instance)
    cost = f"{number(spec.objective(solution.objective), digits)} {unit_text(spec.objective_unit)}"
    unit = unit_text(time_unit(spec) or "1")
    return cost, f"{number(float(solution.times[-1]), digits)} {unit}" if len(solution.times) else ""


def states(solution: Solution, texts: Texts) -> Markup:
    """Return the initial and final value of each state, and its costate."""
    rows = state_rows(solution.instance, solution.times, solution.x, solution.lam, DIGITS)
    return table(texts.get("page", "states"), rows, symbols_of(solution.instance))


def controls(solution: Solution, texts: Texts) -> Markup:
    """Return the range of each control, and its bounds."""
    rows = control_rows(solution.instance, solution.times, solution.u)
    named = [(radical(name), *others) for name, *others in rows]
    return table(texts.get("page", "controls"), named, symbols_of(solution.instance))


def certificate(found: Certificate, spec: ProblemSpec, texts: Texts) -> Markup:
    """Return the verdict, measured values, and comparisons, in the words of the terminal."""
    theorem = message(found.because) if theorem_lines(found) else ""
    proved = found.verdict is Verdict.CERTIFIED and found.scope is Scope.LOCAL
    compared, (header, *conditions) = competitor_rows(found, spec), condition_rows(found)
    without = [message(one.kind.value) for one in found.competitors if one.tried and not one.solved]
    checked = [(*header[:3], say("met")), *((*row[:3], row[3] or MET) for row in conditions)]
    return joined(
        tag("p", capitalised(verdict_text(found, spec.maximise)), "."),
        tag("p", capitalised(say("shown by: <theorem>", theorem=theorem)), ".") if theorem else "",
        tag("p", texts.get("page", "certified")) if proved else "",
        table(texts.get("page", "checks"), checked),
        table(texts.get("page", "compared"), compared) if len(compared) > 1 else "",
        tag("p", texts.get("page", "none_solved", kinds=", ".join(without))) if without else "",
    )


NO_SYMBOLS: Mapping[str, str] = MappingProxyType({})
"""Symbols of a table whose first column contains plain words."""


def table(caption: str, rows: Sequence[Sequence[str]], symbols: Mapping[str, str] = NO_SYMBOLS) -> Markup:
    """Return rows below their header, without empty columns, with numbers as in print.

    The first cell of each row names it. Names that are listed with their LaTeX in ``symbols`` are set as formulas.
    """
    header, *body = rows
    body = [
        [unit_text(cell) if name == say("unit") else decimal(cell) for name, cell in zip(header, row, strict=True)]
        for row in body
    ]
    columns = list(zip(*body, strict=True))
    kept = [k for k, column in enumerate(columns) if any(column)]
    look = {k: {"class_": "number"} if k and _numeric(columns[k]) else {} for k in kept}
    head = tag("tr", *(tag("th", header[k], scope="col", **look[k]) for k in kept))
    lines = [
        tag(
            "tr",
            *(
                tag("td", typeset(row[k]), **look[k]) if k else tag("th", _symbol(row[k], symbols), scope="row")
                for k in kept
            ),
        )
        for row in body
    ]
    title = tag("caption", caption) if caption else Markup()
    return scrolled(tag("table", title, tag("thead", head), tag("tbody", *lines), class_="facts"))


MINUS = "\N{MINUS SIGN}"
_NUMBER = re.compile(rf"([-{MINUS}]?\d[\d.,]*)(e[-+]?\d+)?( %)?")
_RANGE = re.compile(r"\[(\S+)([,;] )(\S+)\]")


def typeset(cell: str) -> str:
    """Return a number, or a range of two, with signs and powers of ten as in print; other text is unchanged."""
    if ends := _RANGE.fullmatch(cell):
        return f"[{typeset(ends[1])}{ends[2]}{typeset(ends[3])}]"
    found = _NUMBER.fullmatch(cell)
    if not found:
        return cell
    mantissa, exponent, percent = found.groups()
    power = times_ten_to(int(exponent[1:])) if exponent else ""
    return f"{mantissa.replace('-', MINUS)}{power}{percent or ''}"


def _numeric(column: Sequence[str]) -> bool:
    """Tell whether a column has numbers, and at most single words beside them, such as ``free``."""
    filled = [cell for cell in column if cell]
    return any(map(_NUMBER.fullmatch, filled)) and all(" " not in cell or _NUMBER.fullmatch(cell) for cell in filled)


def proof(found: Proof, texts: Texts) -> Markup:
    """Return the section on a proof; for a failed attempt, why it failed, and what was shown until then."""
    parts = [tag("p", tag("b", message(found.status.value), class_=_CLASSES[found.status]), _reason(found))]
    if found.theorem is not None:
        parts += [
            tag("ol", *(tag("li", message(claim)) for claim in found.theorem.claims)),
            tag(
                "p",
                say("Theorem: <name> (<source>).", name=message(found.theorem.name), source=found.theorem.source),
            ),
        ]
    if found.hypotheses:
        steps = (
            with_powers(decimal(f"{capitalised(message(h.name))}: {message(h.shown)} ({message(h.value)})."))
            for h in found.hypotheses
        )
        parts += [tag("h3", texts.get("page", "hypotheses")), tag("ol", *(tag("li", step) for step in steps))]
    if known := _enclosures(found, texts):
        parts.append(table(texts.get("page", "enclosures"), [_head(texts), *known]))
    if found.nodes:
        parts.append(_nodes(found, texts))
    if found.scope:
        given = [(texts.get("page", "key"), texts.get("page", "value")), *found.numbers.items()]
        parts += [tag("h3", texts.get("page", "proof_about")), tag("p", message(found.scope))]
        parts.append(tag("details", tag("summary", texts.get("page", "proof_numbers")), table("", given)))
    return joined(*parts)


_CLASSES = {
    Outcome.PROVED: "verdict certified",
    Outcome.NOT_PROVED: "verdict failed",
    Outcome.BEYOND: "verdict extremal",
}


def _reason(found: Proof) -> str:
    return f": {message(found.reason)}." if found.reason else ""


def _head(texts: Texts) -> tuple[str, ...]:
    return tuple(texts.get("page", key) for key in ("quantity", "value", "radius"))


def _row(name: str, found: Enclosure) -> tuple[str, ...]:
    return name, found.centre, found.radius


def _enclosures(found: Proof, texts: Texts) -> list[tuple[str, ...]]:
    """Return rows of the objective, the times, the initial costates and the final states."""
    known = [
        (texts.get("page", "objective"), found.objective),
        (texts.get("page", "final_time"), found.t_final),
        *((capitalised(say("change of law")), time) for time in found.switching_times),
        *((texts.get("page", "costate_of", name=name), v) for name, v in found.costate_initial.items()),
        *((texts.get("page", "final_of", name=name), v) for name, v in found.x_final.items()),
    ]
    return [_row(name, one) for name, one in known if one is not None]


def _nodes(found: Proof, texts: Texts) -> Markup:
    """Return states and costates along the extremal, folded away."""
    parts = []
    for node in found.nodes:
        rows = [_row(name, one) for name, one in node.x.items()]
        rows += [_row(texts.get("page", "costate", name=name), one) for name, one in node.costates.items()]
        parts.append(
            table(
                texts.get("page", "at_time", time=decimal(node.t.text.replace("+/-", "\N{PLUS-MINUS SIGN}"))),
                [_head(texts), *rows],
            )
        )
    return tag("details", tag("summary", texts.get("page", "along")), *parts)
