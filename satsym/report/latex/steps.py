"""The equations of one step, typeset: most as they stand, some in the way that suits what they say."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from satsym.report.latex import tex
from satsym.report.latex.equations import Row, display
from satsym.report.latex.matrices import matrix_rows, with_matrices
from satsym.report.texts import Texts
from satsym.symbolic import Conclusion, Derivation, Equation, Step
from satsym.symbolic.convention import worded
from satsym.symbolic.latex.terms import plain
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.principle.path.notation import of_states, rate


@dataclass(frozen=True)
class Context:
    """What typesetting a step needs besides the step."""

    derivation: Derivation
    texts: Texts
    typeset: Typesetter

    def address(self, step: Step) -> str:
        """The address of a step."""
        return f"{self.derivation.name}:{step.name}"

    def costates(self) -> list[str]:
        """Names of the costates, in the order of the states."""
        return [self.typeset.costate(v.symbol) for v in self.derivation.model.states]


@dataclass(frozen=True)
class Shown:
    """A step's equations in LaTeX, and the addresses of the first and the last that got numbers of their own."""

    body: str
    first: str
    last: str


def shown(context: Context, step: Step) -> Shown:
    """Typeset the equations of a step."""
    found = with_matrices(context.derivation, step, context.texts, context.typeset)
    if found:
        body, addresses = found
        return Shown(body, addresses[0], addresses[-1])
    return LAYOUTS.get(step.name, _as_they_stand)(context, step)


def _as_they_stand(context: Context, step: Step) -> Shown:
    if any(e.rhs.is_Matrix for e in step.equations):
        return _with_whole_matrices(context, step)
    return _once([row_of(context, step, e) for e in step.equations])


def _by_constraint(context: Context, step: Step) -> Shown:
    """What holds on the boundary of each constraint apart, where there are several."""
    problem = context.derivation.problem
    names = list(of_states(problem)) if problem else []
    if len(names) < 2:
        return _as_they_stand(context, step)
    groups: dict[str, list[Row]] = {}
    for e in step.equations:
        of = max((name for name in names if e.name == name or e.name.startswith(f"{name}_")), key=len)
        groups.setdefault(of, []).append(row_of(context, step, e))
    heads = {name: context.typeset.tex(rate(name, 0)) for name in groups}
    parts = [f"{context.texts.get('groups', 'constraint', of=heads[k])}\n{display(v)}" for k, v in groups.items()]
    rows = [row for group in groups.values() for row in group]
    return Shown("\n".join(parts), rows[0].address, rows[-1].address)


def _once(rows: Sequence[Row]) -> Shown:
    """What several of them say alike is shown the first time, and has its number for all of them."""
    first: dict[tuple[object, ...], Row] = {}
    same = [(row, first.setdefault((row.left, row.right), row)) for row in rows]
    shown, places = list(first.values()), {row.address: k for k, row in enumerate(reversed(first.values()))}
    found = _display(shown)
    also = [
        rf"\satsymalso{{{places[old.address]}}}{{{tex.label(row.address)}}}%" for row, old in same if row is not old
    ]
    return replace(found, body="\n".join([found.body, *also]))


def _with_whole_matrices(context: Context, step: Step) -> Shown:
    """Matrices among the equations; long entries that matrices show by name follow theirs."""
    parts: list[str] = []
    waiting: list[Row] = []
    shown: list[Row] = []
    for e in step.equations:
        rows, entries = _rows(context, step, e)
        waiting += rows
        shown += rows
        if entries:
            parts += [display(waiting), context.texts.get("groups", "entries"), display(entries)]
            waiting = []
    body = "\n".join([*parts, *([display(waiting)] if waiting else [])])
    return Shown(body, shown[0].address, shown[-1].address)


def _rows(context: Context, step: Step, equation: Equation) -> tuple[list[Row], list[Row]]:
    if equation.rhs.is_Matrix:
        address = f"{context.address(step)}.{equation.name}"
        return matrix_rows(address, context.typeset.tex(equation.lhs), equation.rhs, context.typeset)
    if equation.name == "characteristic_polynomial":
        return [_polynomial(context, step, equation)], []
    return [row_of(context, step, equation)], []


def _polynomial(context: Context, step: Step, equation: Equation) -> Row:
    """A polynomial by falling powers."""
    terms = [term for power in context.typeset.by_powers(equation.rhs) for term in power]
    address = f"{context.address(step)}.{equation.name}"
    return Row(address, context.typeset.terms(equation.lhs), tuple(terms))


def listed_sources(texts: Texts, named: Mapping[str, str]) -> str:
    """What a step follows from, by name: as an enumeration, after which come the constants that are put in."""
    listed = texts.listed([text for name, text in named.items() if text and name != "definitions"])
    constants = named.get("definitions")
    return texts.get("references", "besides", listed=listed, constants=constants) if constants else listed


def rule(context: Context, step: Step, sources: str) -> str:
    """The sentence by which a step follows: that for free controls or for a single one, where there is such a form."""
    texts, problem, controls = context.texts, context.derivation.problem, context.derivation.model.controls
    kinds = texts.listed([texts.get("kinds", kind) for kind in step.kinds])
    fill = {"sources": sources, "quantities": quantities(context, step), "kinds": kinds}
    free = problem is None or (problem.control_set == "free" and not problem.control_sets)
    forms = [form for form, meant in (("free", free), ("one control", len(controls) == 1)) if meant]
    keys = [f"{step.rule}, {form}" for form in forms if texts.find("rules", f"{step.rule}, {form}")]
    return texts.get("rules", [*keys, step.rule][0], **fill)


def conclusion(context: Context, said: Conclusion) -> str:
    """The sentence of a conclusion, with its expressions filled in; tuples as enumerations."""
    fill = {
        place: context.texts.listed([f"${text}$" for text in context.typeset.items(value)])
        for place, value in said.values.items()
    }
    return context.texts.get("conclusions", said.key, **fill)


def _stationarity(context: Context, step: Step) -> Shown:
    """The conditions as derivatives of H, then what they say of the controls."""
    symbol = context.typeset.symbol
    conditions = [
        Row(
            f"{context.address(step)}.{e.name}",
            plain(_derivative(symbol(e.name))),
            context.typeset.terms(e.rhs),
            end="= 0",
        )
        for e in step.equations
        if context.typeset.is_zero(e.lhs)
    ]
    solved = [row_of(context, step, e) for e in step.equations if not context.typeset.is_zero(e.lhs)]
    words = context.texts.get("groups", "solved" if len(conditions) > 1 else "solved_one")
    return Shown(f"{display(conditions)}\n{words}\n{display(solved)}", conditions[0].address, solved[-1].address)


def _state_equations(context: Context, step: Step) -> Shown:
    symbol = context.typeset.symbol
    costates = dict(zip((v.symbol for v in context.derivation.model.states), context.costates(), strict=True))
    return _display([row_of(context, step, e, also=_derivative(symbol(costates[e.name]))) for e in step.equations])


def _costate_equations(context: Context, step: Step) -> Shown:
    symbol = context.typeset.symbol
    rows = costate_rows(context, step)
    return _display(
        [replace(row, also=f"-{_derivative(symbol(e.name))}") for row, e in zip(rows, step.equations, strict=True)]
    )


def costate_rows(context: Context, step: Step) -> list[Row]:
    """Terms in the order of the costates, even where that begins with a minus."""
    terms = context.typeset.terms
    return [replace(row_of(context, step, e), right=terms(e.rhs, plus_first=False)) for e in step.equations]


def _at_the_end(context: Context, step: Step) -> Shown:
    end = context.typeset.at("t_f")
    return _display([row_of(context, step, e, typeset=end) for e in step.equations])


def _boundary_conditions(context: Context, step: Step) -> Shown:
    """Initial state, final costates and final time apart, then the boundary types in words."""
    texts, problem = context.texts, context.derivation.problem
    assert problem is not None
    states = [v.symbol for v in context.derivation.model.states]
    start, end = context.typeset.at("t_0"), context.typeset.at("t_f")
    groups: dict[str, list[Row]] = {"initial": [], "costates": [], "final_time": [], "": []}
    for e in step.equations:
        group = "initial" if e.name in states else "costates" if e.name in context.costates() else e.name
        group = group if group in groups else ""
        groups[group].append(row_of(context, step, e, typeset=start if group == "initial" else end))
    parts = []
    for group, rows in groups.items():
        heading = group if group == "initial" else worded(group, problem)
        parts += [texts.get("groups", heading)] if group and rows else []
        parts += [display(rows)] if rows else []
    numbers = {group: numbers_of(rows[0].address, rows[-1].address) for group, rows in groups.items() if rows}
    curve = worded("curve", problem)
    types = [texts.get("boundary", key, **numbers) for key in ("none", "time", "state", curve, "both")]
    items = "\n".join(rf"  \item {text}" for text in types)
    parts.append(f"{texts.get('boundary', 'intro')}\n\\begin{{enumerate}}\\satsymtogether\n{items}\n\\end{{enumerate}}")
    if problem.end_conditions:
        parts.append(texts.get("boundary", "constraints"))
    if problem.terminal_inequalities:
        parts.append(texts.get("boundary", "inequalities"))
    rows = [row for group in groups.values() for row in group]
    return Shown("\n".join(parts), rows[0].address, rows[-1].address)


def quantities(context: Context, step: Step) -> str:
    """What the step names, in words where the texts have some: the conserved quantities."""
    table, found = "conserved", []
    for e in step.equations:
        word = context.texts.find(table, e.name) or context.texts.find(table, e.name.partition("_")[0])
        found.append(f"{word or ''} ${context.typeset.tex(e.lhs)}$".strip())
    return context.texts.listed(found)


LAYOUTS: dict[str, Callable[[Context, Step], Shown]] = {
    **dict.fromkeys(
        (
            *("constraint_order", "boundary_control", "control_rates", "constraint_multiplier"),
            *("constrained_costates", "junction_conditions"),
        ),
        _by_constraint,
    ),
    "stationarity": _stationarity,
    "state_equations": _state_equations,
    "costate_equations": _costate_equations,
    "boundary_conditions": _boundary_conditions,
    "boundary_residual": _at_the_end,
    "lqr_stationarity": _stationarity,
    "lqr_costates": _costate_equations,
}


def numbers_of(first: str, last: str) -> str:
    """The equation number of an address, or the range of two."""
    ends = dict.fromkeys((tex.label(first), tex.label(last)))
    return "--".join(rf"\eqref{{{label}}}" for label in ends)


def _derivative(by: str) -> str:
    return rf"\frac{{\partial H}}{{\partial {by}}}"


def _display(rows: Sequence[Row]) -> Shown:
    return Shown(display(rows), rows[0].address, rows[-1].address)


def row_of(context: Context, step: Step, equation: Equation, also: str = "", typeset: Typesetter | None = None) -> Row:
    """An equation as it stands, or in the notation of another typesetter."""
    typeset = typeset or context.typeset
    left, right = typeset.terms(equation.lhs), typeset.terms(equation.rhs)
    return Row(f"{context.address(step)}.{equation.name}", left, right, also)
