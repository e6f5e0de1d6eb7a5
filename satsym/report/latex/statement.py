"""What a derivation starts from, typeset: cost, control set, quantities, named constants, position and forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from satsym.report.latex import tex
from satsym.report.latex.equations import LINE, Row, array, display
from satsym.report.latex.width import width
from satsym.report.texts import Texts
from satsym.spec import Variable
from satsym.symbolic import ClosedLoop, Derivation, Gyrostat, Linearised, Newton, Reduced, Scaled
from satsym.symbolic import notation as n
from satsym.symbolic.latex.terms import Term, joined, plain
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.principle.control_sets import bounds


@dataclass(frozen=True)
class Part:
    """Paragraphs, and the addresses of the first and last equation of each declared thing that steps refer to."""

    paragraphs: tuple[str, ...] = ()
    ends: Mapping[str, tuple[str, str]] = field(default_factory=dict)


def statement(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """The whole of it."""
    kinds = (
        *(_cost, _control_set, _constraints),
        *(_quantities, _definitions),
        *(_physics, _turning, _motion_of, _linearised, _outputs),
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
    functional = (r"S\bigl(\mathbf{x}(t_f), t_f\bigr) + " if terminal else "") + r"\int_{t_0}^{t_f} L \,dt"
    costs = {n.RUNNING_COST: problem.running_cost} | ({n.TERMINAL_COST: problem.terminal_cost} if terminal else {})
    rows = [
        Row(_address(derivation, symbol.name), typeset.terms(symbol), typeset.terms(cost))
        for symbol, cost in costs.items()
    ]
    whole = Row(_address(derivation, "J"), plain("J"), plain(functional))
    task = texts.get("statement", "minimise" if len(controls) > 1 else "minimise_one", controls=r",\, ".join(controls))
    where = texts.get("statement", "where_terminal" if terminal else "where")
    paragraphs = [f"{task}\n{display([whole])}\n{where}\n{display(rows)}"]
    if "first_order" in derivation:
        equations = derivation.step("first_order").equations
        first, last = (tex.label(f"{derivation.name}:first_order.{e.name}") for e in (equations[0], equations[-1]))
        paragraphs.append(texts.get("statement", "subject", first=first, last=last))
    return Part(tuple(paragraphs), {"cost": (whole.address, rows[-1].address)})


def _control_set(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    problem = derivation.problem
    if problem is None:
        return Part()
    controls = [v.latex for v in problem.model.controls]
    limits = [v.latex for v in bounds(problem.control_set, problem.model.controls)]
    if problem.control_set == "free":
        return Part((texts.get("statement", "free"),))
    if problem.control_set == "ball":
        squares = " + ".join(f"({c})^2" if "^" in c else f"{c}^2" for c in controls)
        shown = [rf"\sqrt{{{squares}}} \le {limits[0]}"]
    else:
        lower, upper = limits[: len(controls)], limits[len(controls) :]
        shown = [rf"{low} \le {u} \le {high}" for low, u, high in zip(lower, controls, upper, strict=True)]
    in_a_line = r", \qquad ".join(shown)
    body = (
        in_a_line
        if width(in_a_line) <= LINE
        else "\\begin{gathered}\n  " + " \\\\\n  ".join(shown) + "\n  \\end{gathered}"
    )
    address = tex.label(_address(derivation, "control_set"))
    equation = f"\\begin{{equation}}\n  {body} \\label{{{address}}}\n\\end{{equation}}"
    return Part((f"{texts.get('statement', problem.control_set)}\n{equation}",))


def _constraints(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    if derivation.problem is None or not derivation.problem.terminal_constraints:
        return Part()
    end = typeset.at("t_f")
    rows = [
        Row(_address(derivation, f"psi_{k}"), plain(rf"\psi_{{{k}}}"), end.terms(constraint), end="0")
        for k, constraint in enumerate(derivation.problem.terminal_constraints, 1)
    ]
    return Part((f"{texts.get('statement', 'constraints')}\n{display(rows)}",))


def _quantities(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    groups = {
        "states": model.states,
        "controls": model.controls,
        "parameters": model.parameters,
        "constants": tuple(d.variable for d in model.definitions),
        "outputs": tuple(o.variable for o in model.outputs),
        "original": model.of.states if isinstance(model, Linearised) else (),
    }
    return Part((texts.get("statement", "quantities"), _table(groups, texts)))


def _table(groups: Mapping[str, Sequence[Variable]], texts: Texts) -> str:
    """All quantities in one table that may run over several pages."""
    heads = [texts.get("words", key) for key in ("symbol", "name", "unit", "default", "meaning")]
    lines = [r"\toprule", " & ".join(heads) + r" \\", r"\midrule", r"\endhead", r"\bottomrule", r"\endfoot"]
    for place, (group, variables) in enumerate(groups.items()):
        if variables:
            lines += [r"\addlinespace"] if place else []
            lines.append(rf"\multicolumn{{5}}{{@{{}}l}}{{\textit{{{texts.get('words', group)}}}}} \\*")
        for v in variables:
            cells = (f"${v.latex}$", tex.name(v.symbol), tex.unit(v.unit), tex.number(v.default), tex.escape(v.meaning))
            lines.append(" & ".join(cells) + r" \\")
    body = "\n".join(lines)
    columns = r"@{}lllr>{\raggedright\arraybackslash}p{0.44\linewidth}@{}"
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


def _physics(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    if not isinstance(model, Newton):
        return Part()
    force = typeset.symbol(n.FORCE.name)
    vectors = {
        "directions": {typeset.symbol(name): vector for name, vector in model.directions.items()},
        "position": {typeset.symbol(n.POSITION.name): model.position},
        "forces": {rf"{force}_{{\text{{{tex.escape(name)}}}}}": vector for name, vector in model.forces.items()},
    }
    rows: list[Row] = []
    ends = {}
    for thing, named in vectors.items():
        new = [row for name, vector in named.items() for row in _vector(name, [typeset.terms(c) for c in vector])]
        new = [Row(_address(derivation, f"{thing}.{k}"), row.left, row.right) for k, row in enumerate(new, 1)]
        ends[thing] = (new[0].address, new[-1].address)
        rows += new
    return Part((f"{texts.get('statement', 'newton')}\n{display(rows)}",), ends)


def _linearised(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    if not isinstance(model, Linearised):
        return Part()
    rows = [
        Row(_address(derivation, f"reference.{symbol.name}"), typeset.terms(symbol), typeset.terms(curve))
        for symbol, curve in model.about.items()
    ]
    text = texts.get("statement", "linearised", name=tex.name(model.of.name), title=tex.escape(model.of.title))
    return Part((f"{text}\n{display(rows)}",), {"reference": (rows[0].address, rows[-1].address)})


def _turning(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """Bodies that turn about one axis, and the torques on them."""
    model = derivation.model
    if not isinstance(model, Gyrostat):
        return Part()
    rows: dict[str, list[Row]] = {"bodies": [], "torques": []}
    for name, (inertia, spin) in model.bodies.items():
        label = rf"\mathrm{{{name}}}"
        rows["bodies"] += [
            Row(_address(derivation, f"inertia.{name}"), plain(f"I_{{{label}}}"), typeset.terms(inertia)),
            Row(_address(derivation, f"rate.{name}"), plain(rf"\omega_{{{label}}}"), typeset.terms(spin)),
        ]
        if name in model.torques:
            row = Row(
                _address(derivation, f"torque.{name}"), plain(f"T_{{{label}}}"), typeset.terms(model.torques[name])
            )
            rows["torques"].append(row)
    text = texts.get("statement", "bodies")
    ends = {thing: (found[0].address, found[-1].address) for thing, found in rows.items() if found}
    return Part((f"{text}\n{display([*rows['bodies'], *rows['torques']])}",), ends)


def _motion_of(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    """Which model's motion it is."""
    model = derivation.model
    if not isinstance(model, Scaled | Reduced | ClosedLoop):
        return Part()
    return Part((texts.get("statement", "motion_of", name=tex.name(model.of.name), title=tex.escape(model.of.title)),))


def _outputs(derivation: Derivation, texts: Texts, typeset: Typesetter) -> Part:
    model = derivation.model
    if not model.outputs:
        return Part()
    key = "outputs_of_linearised" if isinstance(model, Linearised) else "outputs"
    rows = [
        Row(
            _address(derivation, o.variable.symbol),
            plain(rf"g_{{{k}}}" if isinstance(model, Linearised) else o.variable.latex),
            typeset.terms(o.value),
        )
        for k, o in enumerate(model.outputs, 1)
    ]
    return Part((f"{texts.get('statement', key)}\n{display(rows)}",), {"outputs": (rows[0].address, rows[-1].address)})


def _vector(name: str, components: Sequence[tuple[Term, ...]]) -> list[Row]:
    """A vector in a row or as a column, whichever fits, or else component by component."""
    cells = [joined(terms) for terms in components]
    across = r",\; ".join(cells)
    if r"\frac" not in across and width(across) <= 0.6 * LINE:
        return [Row("", plain(name), plain(rf"({across})^{{\mathsf{{T}}}}"))]
    if max(map(width, cells)) <= 0.7 * LINE:
        return [Row("", plain(name), plain(array([[cell] for cell in cells])))]
    return [Row("", plain(f"({name})_{k}"), terms) for k, terms in enumerate(components, 1)]
