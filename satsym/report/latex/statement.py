"""The statement of a problem, typeset: cost, control set, quantities, named constants, position and forces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import compress

from satsym.report.latex import tex
from satsym.report.latex.equations import LINE, Row, array, display, width
from satsym.report.latex.figure import figure
from satsym.report.texts import Texts
from satsym.spec import PRODUCT, Variable
from satsym.symbolic import Derivation
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import divisors_in_time
from satsym.symbolic.convention import worded
from satsym.symbolic.latex.products import Term, joined, plain
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.model import Line, Problem, variables_of, with_origins
from satsym.symbolic.principle.effort import cost_letter
from satsym.symbolic.principle.parts import Part as ControlPart
from satsym.symbolic.principle.parts import parts_of
from satsym.symbolic.principle.path.interior import condition, named
from satsym.symbolic.principle.path.notation import holds_controls, rate

HEAD = 9
"""Smallest number of lines that must be left on a page for the table of quantities to begin there."""
TAIL = 4
"""Smallest number of rows of the table of quantities on its last page."""


@dataclass(frozen=True)
class Part:
    """Paragraphs, and the addresses of the first and last equation of each declaration that steps refer to."""

    paragraphs: tuple[str, ...] = ()
    ends: Mapping[str, tuple[str, str]] = field(default_factory=dict)


def statement(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """Typeset the whole statement."""
    kinds = (
        *(_cost, _control_set, _conditions),
        *(_figure, _quantities, _assumed, _definitions),
        *(_motion, _outputs),
    )
    parts = [part(derivation, texts, typeset) for part in kinds]
    return Part(
        tuple(paragraph for part in parts for paragraph in part.paragraphs),
        {thing: ends for part in parts for thing, ends in part.ends.items()},
    )


def _address(derivation: Derivation, thing: str) -> str:
    return f"{derivation.name}:declared.{thing}"


def _cost(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    problem = derivation.problem
    if problem is None:
        return Part()
    terminal = not typeset.is_zero(problem.terminal_cost)
    controls = [v.latex for v in problem.model.controls]
    time, final = (typeset.symbol(s.name) for s in (n.TIME, n.FINAL_TIME))
    end, lead = rf"S\bigl(\mathbf{{x}}({final}), {final}\bigr)", "-" if problem.maximise else ""
    functional = (f"{lead}{end} {lead or '+'} " if terminal else lead) + rf"\int_{{{time}_0}}^{{{final}}} L \,d{time}"
    costs = {n.RUNNING_COST: problem.running_cost} | ({n.TERMINAL_COST: problem.terminal_cost} if terminal else {})
    rows = [
        Row(_address(derivation, symbol.name), typeset.terms(symbol), typeset.terms(stated))
        for symbol, stated in costs.items()
    ]
    cost = cost_letter(problem.model)
    whole = Row(_address(derivation, "J"), plain(cost), plain(functional))
    wanted = ("maximise" if problem.maximise else "minimise") + ("" if len(controls) > 1 else "_one")
    task = texts.get("statement", wanted, controls=r",\, ".join(controls))
    at_end = "where_terminal" if n.TIME in getattr(problem.terminal_cost, "free_symbols", ()) else "where_end"
    where = texts.get("statement", at_end if terminal else "where")
    paragraphs = [f"{task}\n{display([whole])}\n{where}\n{display(rows)}"]
    paragraphs += [texts.get("statement", worded("negative", problem), cost=cost)] if problem.maximise else []
    if "first_order" in derivation:
        equations = derivation.step("first_order").equations
        first, last = (tex.label(f"{derivation.name}:first_order.{e.name}") for e in (equations[0], equations[-1]))
        state = r",\, \allowbreak ".join(v.latex for v in problem.model.states)
        subject = "subject" if len(equations) > 1 else "subject_one"
        paragraphs.append(texts.get("statement", subject, first=first, last=last, state=state))
    return Part(tuple(paragraphs), {"cost": (whole.address, rows[-1].address)})


def _control_set(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    if derivation.problem is None:
        return Part()
    said, shown = admissible(derivation.problem, texts)
    if not shown:
        return Part((said,))
    in_a_line = r", \qquad ".join(shown)
    body = (
        in_a_line
        if width(in_a_line) <= LINE
        else "\\begin{gathered}\n  " + " \\\\\n  ".join(shown) + "\n  \\end{gathered}"
    )
    address = tex.label(_address(derivation, "control_set"))
    return Part((f"{said}\n\\begin{{equation}}\n  {body} \\label{{{address}}}\n\\end{{equation}}",))


def admissible(problem: Problem, texts: Texts) -> tuple[str, list[str]]:
    """Describe the control set, with the inequalities that controls obey; none where they are free."""
    parts = parts_of(problem)
    shown = [line for part in parts for line in _limited(part)]
    if not shown:
        kind = "free_but" if holds_controls(problem) else "free"
        return texts.get("statement", kind if len(problem.model.controls) > 1 else f"{kind}_one"), []
    if len(parts) == 1:
        kind = "ball" if parts[0].kind == "annulus" else parts[0].kind
        return texts.get("statement", f"{kind}_one" if kind == "box" and len(shown) == 1 else kind), shown
    return texts.get("statement", PRODUCT if len(shown) > 1 else f"{PRODUCT}_one"), shown


def _limited(part: ControlPart) -> list[str]:
    """Write the inequalities of the controls of one set."""
    controls, limits = [v.latex for v in part.controls], [v.latex for v in part.limits]
    if part.kind == "box":
        lower, upper = limits[: len(controls)], limits[len(controls) :]
        return [rf"{low} \le {u} \le {high}" for low, u, high in zip(lower, controls, upper, strict=True)]
    if part.kind in ("ball", "annulus"):
        squares = " + ".join(f"({c})^2" if "^" in c else f"{c}^2" for c in controls)
        least = rf"{limits[0]} \le " if part.kind == "annulus" else ""
        return [rf"{least}\sqrt{{{squares}}} \le {limits[-1]}"]
    return []


def _conditions(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    return Part(tuple(f"{said}\n{display(rows)}" for said, rows in conditions(derivation, texts, typeset)))


def conditions(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Iterator[tuple[str, list[Row]]]:
    """Write the conditions at the end, along the trajectory and on the way: a sentence and equations each."""
    problem = derivation.problem
    if problem is None:
        return
    end, equalities = typeset.at("t_f"), len(problem.terminal_constraints)
    at_end = [
        Row(
            _address(derivation, f"psi_{k}"),
            plain(rf"\psi_{{{k}}}"),
            end.terms(one),
            end="= 0" if k <= equalities else r"\le 0",
        )
        for k, one in enumerate(problem.end_conditions, 1)
    ]
    along = [
        Row(_address(derivation, name), typeset.terms(rate(name, 0)), typeset.terms(constraint), end=r"\le 0")
        for name, constraint in (problem.path_constraints or {}).items()
    ]
    on_the_way = [
        Row(_address(derivation, name), typeset.terms(condition(name)), typeset.terms(stated), end="= 0")
        for name, stated in (named(problem) if problem.interior else {}).items()
    ]
    stated_by_kind = {
        "constraints": at_end[:equalities],
        "terminal_inequalities": at_end[equalities:],
        "path_constraints": along,
    }
    for key, rows in stated_by_kind.items():
        if rows:
            yield texts.get("statement", _one(key, rows)), rows
    if on_the_way:
        yield texts.get("statement", "interior" if len(problem.interior) > 1 else "interior_one"), on_the_way


def _one(key: str, rows: Sequence[Row]) -> str:
    """Return the text for a single equation, where there is one row."""
    return key if len(rows) > 1 else f"{key}_one"


def _figure(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    drawn = figure(derivation.model, texts, tex.label(f"{derivation.name}:figure"))
    return Part((drawn,) if drawn else ())


def _quantities(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    groups = {
        "states": model.states,
        "controls": model.controls,
        "parameters": model.parameters,
        "constants": tuple(d.variable for d in model.definitions),
        "outputs": tuple(o.variable for o in model.outputs),
        "original": model.replaced_states(),
    }
    groups["others"] = _others(derivation, groups)
    words = f"\\satsymroom{{{HEAD}}}\n{texts.get('statement', 'quantities')}"
    return Part((words, _table(groups, texts, derivation.notation)))


def _others(derivation: Derivation, groups: Mapping[str, Sequence[Variable]]) -> tuple[Variable, ...]:
    """Return the other quantities that statement and steps name."""
    known = {v.symbol for group in groups.values() for v in group}
    stated = [side for said in derivation.model.statement() for line in said.lines for side in (line.left, line.right)]
    derived = [side for step in derivation.steps for e in step.equations for side in (e.lhs, e.rhs)]
    used = {s.name.removeprefix("d_") for side in (*stated, *derived) for s in getattr(side, "free_symbols", ())}
    found = {v.symbol: v for model in with_origins(derivation.model) for v in variables_of(model)}
    return tuple(v for name, v in found.items() if name in used - known)


def _assumed(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """Write the declared signs, and the conditions on parameters."""
    model = derivation.model
    declared = (*model.states, *model.parameters, *(d.variable for d in model.definitions))
    positive = r",\, \allowbreak ".join(v.latex for v in declared if v.positive)
    relations = (r"\ge", ">")
    more = [d for d in model.demanded() if not d.margin.is_positive]  # as symbols are that were declared so
    demanded = [f"${typeset.inline(d.margin)} {relations[d.strict]} 0$" for d in more]
    rates = derivation.rhs("first_order") if "first_order" in derivation else []
    timed = [f"${typeset.tex(d)} \\ne 0$" for d in divisors_in_time(model, rates)]
    conditions = [*([f"${positive} > 0$"] if positive else []), *demanded, *timed]
    return Part((texts.get("statement", "assumed", conditions=texts.listed(conditions)),) if conditions else ())


def _table(groups: Mapping[str, Sequence[Variable]], texts: Texts, notation: Mapping[str, str]) -> str:
    """Write all quantities in one table that may run over several pages, without a group split badly.

    The last page of several has more than a row or two. A unit or a default that none of them has takes no column.
    """
    point = texts.get("words", "point")
    left = sum(map(len, groups.values()))
    every = [v for variables in groups.values() for v in variables]
    units, defaults = any(v.unit != "1" for v in every), any(v.default is not None for v in every)
    kept = (True, True, units, defaults, True)
    heads = [texts.get("words", key) for key in ("symbol", "name", "unit", "default", "meaning")]
    head = " & ".join(compress(heads, kept)) + r" \\"
    lines = [r"\toprule", head, r"\midrule", r"\endhead", r"\bottomrule", r"\endfoot"]
    for place, (group, variables) in enumerate(groups.items()):
        if variables:
            lines += [r"\addlinespace"] if place else []
            lines.append(rf"\multicolumn{{{sum(kept)}}}{{@{{}}l}}{{\textit{{{texts.get('words', group)}}}}} \\*")
        for k, v in enumerate(variables):
            cells = (
                f"${v.latex}$",
                tex.name(v.symbol),
                tex.unit(v.unit),
                tex.number(v.default, point),
                tex.worded(texts.phrase(v.meaning), notation),
            )
            left -= 1
            alone = k < len(variables) - 1 and k in (0, len(variables) - 2)
            together = "*" if alone or 0 < left < TAIL else ""
            lines.append(f"{' & '.join(compress(cells, kept))} \\\\{together}")
    body = "\n".join(lines)
    columns = rf"@{{}}{''.join(compress('lllr', kept))}" r">{\raggedright\arraybackslash}p{0.42\linewidth}@{}"
    return f"\\begin{{longtable}}{{{columns}}}\n{body}\n\\end{{longtable}}"


def _definitions(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    rows = [
        Row(_address(derivation, d.variable.symbol), plain(d.variable.latex), typeset.terms(d.value))
        for d in derivation.model.definitions
    ]
    if not rows:
        return Part()
    ends = {"definitions": (rows[0].address, rows[-1].address)}
    return Part((f"{texts.get('statement', 'definitions')}\n{display(rows)}",), ends)


def _motion(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """Write the statement of the kind of model."""
    paragraphs: list[str] = []
    ends: dict[str, tuple[str, str]] = {}
    for said in derivation.model.statement():
        fill = {"name": tex.name(said.of.name), "title": tex.escape(texts.phrase(said.of.title))} if said.of else {}
        shown: dict[str, list[Row]] = {}
        for line in said.lines:
            new, rows = _rows(line, texts, typeset), shown.setdefault(line.thing, [])
            for k, row in enumerate(new, 1):
                own = f"{line.address}.{k}" if len(new) > 1 else line.address
                address = _address(derivation, own if line.address else f"{line.thing}.{len(rows) + 1}")
                rows.append(Row(address, row.left, row.right))
        equations = "\n" + display([row for rows in shown.values() for row in rows]) if shown else ""
        paragraphs.append(texts.get("statement", said.sentence, **fill) + equations)
        ends |= {thing: (rows[0].address, rows[-1].address) for thing, rows in shown.items()}
    return Part(tuple(paragraphs), ends)


def _rows(line: Line, texts: Texts, typeset: Typesetter) -> list[Row]:
    """Write an equation, or several where a vector is too wide."""
    left = line.left if isinstance(line.left, str) else typeset.symbol(line.left.name)
    left += rf"_{{\text{{{tex.escape(texts.phrase(line.index))}}}}}" if line.index else ""
    if line.components:
        return _vector(left, [typeset.terms(component) for component in line.components])
    if line.rows:
        return [Row("", plain(left), plain(array([[typeset.tex(cell) for cell in row] for row in line.rows])))]
    return [Row("", plain(left), typeset.terms(line.right))]


def _outputs(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    if not model.outputs:
        return Part()
    linear = "deviations" in derivation
    key = "outputs_of_linearised" if linear else "outputs"
    rows = [
        Row(
            _address(derivation, o.variable.symbol),
            plain(rf"g_{{{k}}}" if linear else o.variable.latex),
            typeset.terms(o.value),
        )
        for k, o in enumerate(model.outputs, 1)
    ]
    return Part(
        (f"{texts.get('statement', _one(key, rows))}\n{display(rows)}",),
        {"outputs": (rows[0].address, rows[-1].address)},
    )


def _vector(name: str, components: Sequence[tuple[Term, ...]]) -> list[Row]:
    """Write a vector in a row or as a column, whichever fits, or else component by component."""
    cells = [joined(terms) for terms in components]
    across = r",\; ".join(cells)
    if r"\frac" not in across and width(across) <= 0.6 * LINE:
        return [Row("", plain(name), plain(rf"({across})^{{\mathsf{{T}}}}"))]
    if max(map(width, cells)) <= 0.7 * LINE:
        return [Row("", plain(name), plain(array([[cell] for cell in cells])))]
    return [Row("", plain(f"({name})_{k}"), terms) for k, terms in enumerate(components, 1)]
