"""The equations of one step, typeset: most unchanged, some in a form that suits their content."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from satsym.report.latex import matrices, tex
from satsym.report.latex.equations import LINE, Context, Row, Shown, also, display, numbers_of, row_of, width
from satsym.report.latex.figure import phase_figure
from satsym.report.latex.matrices import entries_are, is_mirrored, matrix_rows, with_matrices
from satsym.symbolic import Conclusion, Equation, Step
from satsym.symbolic.convention import worded
from satsym.symbolic.latex.products import joined, plain
from satsym.symbolic.model import variables_of
from satsym.symbolic.principle.path.notation import mixed, of_states, rate
from satsym.symbolic.principle.transversality import on_a_reference
from satsym.symbolic.switching.phase_plane import phase_plane

LONGEST_ROW = 12
"""Largest number of lines of an equation that is shown in a step with several equations that are not used later."""
ZEROS_IN_A_LINE = 6
"""Largest number of vanishing quantities listed on one line."""


def shown(context: Context, step: Step) -> Shown:
    """Typeset the equations of a step, and its conclusions where they belong: after a group of them, or at the end."""
    parts, ends, groups, appendix = [], [], groups_of(step), ""
    for place, (equations, conclusions) in enumerate(groups):
        if place and equations:
            parts.append("\n" + next_group(context, step, equations[0]))
        if equations:
            found = _equations_of(context, replace(step, equations=equations))
            parts.append(found.body)
            ends += [found.first, found.last]
            appendix += found.appendix
        parts += [conclusion(context, one) for one in conclusions]
    return Shown("\n".join(parts), ends[0], ends[-1], appendix)


def groups_of(step: Step) -> list[tuple[tuple[Equation, ...], tuple[Conclusion, ...]]]:
    """Return the equations of a step up to each one after which something is concluded, with what is."""
    said: dict[str, list[Conclusion]] = {}
    for one in step.conclusions:
        said.setdefault(one.after, []).append(one)
    groups: list[tuple[tuple[Equation, ...], tuple[Conclusion, ...]]] = []
    waiting: list[Equation] = []
    for equation in step.equations:
        waiting.append(equation)
        if equation.name in said:
            groups.append((tuple(waiting), tuple(said[equation.name])))
            waiting = []
    return [*groups, (tuple(waiting), tuple(said.get("", ())))]


def next_group(context: Context, step: Step, first: Equation) -> str:
    """Introduce the next group of equations of a step, which is about what its first equation is named after."""
    named = next(v.latex for v in variables_of(context.derivation.model) if v.symbol == first.name)
    return context.texts.get("groups", f"{step.name}_alone", port=named)


def _equations_of(context: Context, step: Step) -> Shown:
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
    """Typeset the equations for each active constraint separately, where there are several."""
    problem = context.derivation.problem
    names = [*of_states(problem), *mixed(problem)] if problem else []
    groups: dict[str, list[Row]] = {}
    for e in step.equations:
        of = max((name for name in names if e.name == name or e.name.startswith(f"{name}_")), key=len)
        groups.setdefault(of, []).append(row_of(context, step, e))
    if len(names) < 2 or (len(groups) < 2 and step.name != "mixed_costates"):  # which only some may have
        return _as_they_stand(context, step)
    parts = []
    for place, (name, rows) in enumerate(groups.items()):
        last = place and place == len(groups) - 1
        of = f"${context.typeset.inline(rate(name, 0))}$"
        parts += [context.texts.get("groups", "constraint_next" if last else "constraint", of=of), display(rows)]
    shown = [row for rows in groups.values() for row in rows]
    return Shown("\n".join(parts), shown[0].address, shown[-1].address)


def _once(rows: Sequence[Row]) -> Shown:
    """Show equations that several constraints share only once, with one number for all of them."""
    first: dict[tuple[object, ...], Row] = {}
    same = [(row, first.setdefault((row.left, row.right), row)) for row in rows]
    shown = list(first.values())
    found = _display(shown)
    return replace(
        found, body="\n".join([found.body, *_repeated(shown, [pair for pair in same if pair[0] is not pair[1]])])
    )


def _repeated(shown: Sequence[Row], same: Sequence[tuple[Row, Row]]) -> list[str]:
    """Return the labels of omitted rows, at the numbers of equal rows that are shown."""
    places = {row.address: k for k, row in enumerate(reversed(shown))}
    return [also(places[old.address], [row.address]) for row, old in same]


def _with_whole_matrices(context: Context, step: Step) -> Shown:
    """Typeset matrices among the equations; long entries that they show by name follow."""
    parts: list[str] = []
    waiting: list[Row] = []
    shown: list[Row] = []
    for e in step.equations:
        rows, entries = _rows(context, step, e)
        waiting += rows
        shown += rows
        if entries:
            stated = sum(not context.typeset.is_zero(cell) for cell in e.rhs)
            head = context.typeset.tex(e.lhs)
            said = entries_are(context.texts, head.partition(" = ")[0], len(entries), stated)
            parts += [display(waiting), said, display(entries)]
            waiting = []
        elif len(rows) > 1 and not is_mirrored(e.rhs):
            first = not parts and waiting == rows
            key = "nonzero_first" if first else "nonzero_of"  # the sentence of the rule goes on
            words = context.texts.get("groups", key, matrix=context.typeset.tex(e.lhs))
            parts += [display(waiting[: -len(rows)])] if waiting[: -len(rows)] else []
            parts += [words, display(rows)]
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
    """Typeset a polynomial by falling powers."""
    address = f"{context.address(step)}.{equation.name}"
    return Row(address, context.typeset.terms(equation.lhs), tuple(context.typeset.by_powers(equation.rhs)))


def conclusion(context: Context, said: Conclusion) -> str:
    """Return the sentence of a conclusion, with its expressions filled in; tuples as enumerations."""
    fill = {
        place: context.texts.listed([f"${text}$" for text in context.typeset.items(value)])
        for place, value in said.values.items()
    }
    several = any(len(context.typeset.items(value)) > 1 for value in said.values.values())
    many = f"{said.key}, several"
    return context.texts.get(
        "conclusions", many if several and context.texts.find("conclusions", many) else said.key, **fill
    )


def _stationarity(context: Context, step: Step) -> Shown:
    """Typeset the conditions as derivatives of H, then their solution for the controls."""
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
    """Return terms in the order of the costates, even where a minus comes first."""
    terms = context.typeset.terms
    return [replace(row_of(context, step, e), right=terms(e.rhs, plus_first=False)) for e in step.equations]


def _at_the_end(context: Context, step: Step) -> Shown:
    end = context.typeset.at("t_f")
    stated = on_a_reference(context.derivation.model, step.equations)
    return _display([row_of(context, step, e, typeset=end) for e in stated])


def _boundary_conditions(context: Context, step: Step) -> Shown:
    """Typeset initial state, final costates and final time separately, then the boundary types in words."""
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
    return Shown("\n" + "\n".join(parts), rows[0].address, rows[-1].address)


def _transfer_functions(context: Context, step: Step) -> Shown:
    """Typeset ratios of polynomials by falling powers, without fractions in them."""
    rows = []
    for e in step.equations:
        above, below = map(joined, context.typeset.ratio_in_laplace(e.rhs))
        ratio = plain(rf"\frac{{{above}}}{{{below}}}")
        rows.append(Row(f"{context.address(step)}.{e.name}", context.typeset.terms(e.lhs), ratio))
    return _display(rows)


def _poles(context: Context, step: Step) -> Shown:
    """Typeset the polynomial by falling powers, then its zeros."""
    rows = [row_of(context, step, e) for e in step.equations]
    right = tuple(context.typeset.in_laplace(step.equations[0].rhs))
    return _display([replace(rows[0], right=right), *rows[1:]])


def _smoothed(context: Context, step: Step) -> Shown:
    """Typeset controls of the regularised problem with their mark."""
    marked = {v.symbol: plain(rf"{v.latex}^{{\varepsilon}}") for v in context.derivation.model.controls}
    rows = [(row_of(context, step, e), e.lhs) for e in step.equations]
    return _display([replace(row, left=marked.get(str(left), row.left)) for row, left in rows])


def _with_phase_plane(context: Context, step: Step) -> Shown:
    """Typeset the law of the state, and draw its phase plane."""
    found = _display([row_of(context, step, e) for e in step.equations])
    plane = phase_plane(context.derivation)
    assert plane is not None
    label = tex.label(f"{context.derivation.name}:figure.{step.name}")
    return replace(found, body=f"{found.body}\n{phase_figure(plane, context.typeset.symbol, context.texts, label)}")


def _shorter(context: Context, step: Step) -> Shown:
    """Typeset without equations that take much of a page, which share the number of the one before."""
    rows = [row_of(context, step, e) for e in step.equations]
    shown = [row for row in rows if width(joined(row.right)) <= LONGEST_ROW * LINE] or rows
    left = [row for row in rows if row not in shown]
    if not left:
        return _once(rows)
    named = context.texts.listed([f"${row.left_tex}$" for row in left])
    words = context.texts.get("groups", "omitted", listed=named)
    before = [(row, ([s for s in rows[: rows.index(row)] if s in shown] or shown)[-1]) for row in left]
    found = _once(shown)
    return replace(found, body="\n".join([found.body, *_repeated(shown, before), words]))


def _zeros_together(context: Context, step: Step) -> Shown:
    """Typeset several quantities that are zero on one line; the others separately."""
    rows = [(row_of(context, step, e), context.typeset.is_zero(e.rhs)) for e in step.equations]
    zero, others = ([row for row, vanishes in rows if vanishes is kept] for kept in (True, False))
    if len(zero) < ZEROS_IN_A_LINE:
        return _as_they_stand(context, step)
    lines = [zero[k : k + ZEROS_IN_A_LINE] for k in range(0, len(zero), ZEROS_IN_A_LINE)]
    shown = [replace(line[0], left=plain(" = ".join(row.left_tex for row in line))) for line in lines]
    labels = [also(len(lines) - 1 - k, [row.address for row in line[1:]]) for k, line in enumerate(lines)]
    body = "\n".join([*([display(others)] if others else []), display(shown), *filter(None, labels)])
    return Shown(body, (others or shown)[0].address, shown[-1].address)


def _vectors(context: Context, step: Step) -> Shown:
    """Typeset vectors, with the zero vector distinguished from the number zero."""
    rows = [(row_of(context, step, e), context.typeset.is_zero(e.rhs)) for e in step.equations]
    return _once([replace(row, right=plain(r"\mathbf{0}")) if zero else row for row, zero in rows])


LAYOUTS: dict[str, Callable[[Context, Step], Shown]] = {
    **dict.fromkeys(
        (
            *("constraint_order", "boundary_control", "control_rates", "constraint_multiplier"),
            *("constrained_costates", "junction_conditions", "mixed_constraints", "mixed_costates"),
        ),
        _by_constraint,
    ),
    "unit_vectors": _vectors,
    "stationarity": _stationarity,
    "state_equations": _state_equations,
    "costate_equations": _costate_equations,
    "boundary_conditions": _boundary_conditions,
    "boundary_residual": _at_the_end,
    "lqr_stationarity": _stationarity,
    "singular_arcs": _shorter,
    "transfer_function": _transfer_functions,
    "poles_and_zeros": _poles,
    "smoothed_law": _smoothed,
    "switching_feedback": _with_phase_plane,
    "kinematics": matrices.kinematics,
    "kane": matrices.kane,
    "first_order": matrices.first_order,
    "reference": _zeros_together,
    "invariant_motions": _zeros_together,
    "lqr_costates": _costate_equations,
}


def _derivative(by: str) -> str:
    return rf"\frac{{\partial H}}{{\partial {by}}}"


def _display(rows: Sequence[Row]) -> Shown:
    return Shown(display(rows), rows[0].address, rows[-1].address)
