"""The steps of Kane's equations, typeset as matrices; what is too long for these goes to an appendix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from satsym.report.latex import tex
from satsym.report.latex.context import Context, Shown, numbers_of, row_of
from satsym.report.latex.equations import LINE, Row, also, array, display
from satsym.report.latex.matrices import with_names
from satsym.report.latex.width import width
from satsym.symbolic import Step
from satsym.symbolic.latex.terms import joined, plain
from satsym.symbolic.notation import is_solved

COLUMN = 13.5
"""Width in em that an equation may take in one of two columns, beside its number."""
BOLD = r"\mathbf{"
PART = "part_"
"""What the names of common subexpressions begin with."""


def kinematics(context: Context, step: Step) -> Shown:
    """The matrix that places the body, its longer entries, and the rates of the coordinates."""
    typeset, cosines = context.typeset, context.derivation.model.direction_cosines()
    rows = {e.name: row_of(context, step, e) for e in step.equations}
    if cosines is None or not {s.name for s in cosines} <= rows.keys():
        found = list(rows.values())
        return Shown(display(found), found[0].address, found[-1].address)
    names = [[s.name for s in cosines.row(i)] for i in range(3)]
    cells = [[joined(rows[name].right) for name in row] for row in names]
    letters = [[typeset.symbol(name) for name in row] for row in names]
    shown, named = with_names(cells, letters, LINE - 3.0)
    whole = Row(f"{context.address(step)}.attitude", plain(r"\mathbf{A}"), plain(array(shown)))
    inside = [
        rows.pop(name).address for i, row in enumerate(names) for j, name in enumerate(row) if (i, j) not in named
    ]
    body = [display([whole]), also(0, inside), context.texts.get("groups", "with"), display(list(rows.values()))]
    return Shown("\n".join(body), whole.address, list(rows.values())[-1].address)


def kane(context: Context, step: Step) -> Shown:
    """M, b and Q as matrices; entries that are too long for these, and common subexpressions, in the appendix."""
    typeset, address = context.typeset, context.address(step)
    rows = {e.name: row_of(context, step, e) for e in step.equations}
    size = sum(name.startswith("bias_") for name in rows)
    parts = {e.lhs for e in step.equations if e.name.startswith(PART)}
    tall = {e.name for e in step.equations if e.rhs.free_symbols & parts}
    numbers = range(1, size + 1)
    mass = [[f"mass_{max(i, k)}_{min(i, k)}" for k in numbers] for i in numbers]
    columns = {BOLD + "b}": [[f"bias_{i}" for i in numbers]], BOLD + "Q}": [[f"force_{i}" for i in numbers]]}
    whole, apart = [], dict[str, Row]()
    for letter, names in {"M": mass, **columns}.items():
        symbols = [[typeset.symbol(name) for name in row] for row in names]
        cells = [
            [
                symbol if name in tall else joined(rows[name].right) if name in rows else "0"
                for name, symbol in zip(row, line, strict=True)
            ]
            for row, line in zip(names, symbols, strict=True)
        ]
        shown, named = with_names(cells, symbols, LINE - width(letter) - 3.0)
        turned = "" if len(names) > 1 else r"^{\mathsf{T}}"
        whole.append(
            Row(f"{address}.{tex.label(letter[-2] if turned else letter)}", plain(letter), plain(array(shown) + turned))
        )
        kept = {name for i, row in enumerate(names) for j, name in enumerate(row) if name in tall or (i, j) in named}
        apart |= {name: row for name, row in rows.items() if name in kept}
    left = [rows[e.name] for e in step.equations if e.name.startswith(PART) or e.name in apart]
    inside = [row.address for row in rows.values() if row not in left]
    body = [display(whole), also(0, inside)]
    if left:
        place = tex.label(f"{context.derivation.name}:section.subexpressions")
        body.append(context.texts.get("groups", "in_appendix", section=place))
    return Shown("\n".join(body), whole[0].address, whole[-1].address, in_columns(left) if left else "")


def first_order(context: Context, step: Step) -> Shown:
    """The rates of the speeds as the solution of one equation, where they have no closed form that is shown."""
    derivation = context.derivation
    rows = [row_of(context, step, e) for e in step.equations]
    solved = [row for row, e in zip(rows, step.equations, strict=True) if any(map(is_solved, e.rhs.free_symbols))]
    if not solved or "kinematics" not in derivation:
        return Shown(display(rows), rows[0].address, rows[-1].address)
    whole = replace(solved[0], left=plain(r"\dot{\mathbf{w}}"), right=plain(r"M^{-1} (\mathbf{Q} - \mathbf{b})"))
    body = [display([whole]), also(0, [row.address for row in rows if row is not solved[0]])]
    kinematic = derivation.step("kinematics")
    rates = [f"{context.address(kinematic)}.{e.name}" for e in kinematic.equations if e.name.startswith("rate_")]
    body.append(context.texts.get("groups", "rates_of_coordinates", equations=numbers_of(rates[0], rates[-1])))
    return Shown("\n".join(body), whole.address, whole.address)


def in_columns(rows: Sequence[Row]) -> str:
    """Equations in two columns."""
    return f"\\begin{{multicols}}{{2}}\\satsymcolumns\n{display(rows, COLUMN)}\n\\end{{multicols}}"
