"""Matrices in LaTeX: long entries get names and follow below; a matrix that is still too wide becomes a list."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from satsym.report.latex import tex
from satsym.report.latex.equations import LINE, Context, Row, Shown, also, array, display, numbers_of, row_of, width
from satsym.report.texts import Texts
from satsym.symbolic import Derivation, Equation, Step
from satsym.symbolic.latex.products import Piece, Term, joined, plain
from satsym.symbolic.latex.typeset import NamedMatrix, Typesetter, matrices
from satsym.symbolic.notation import is_solved, letter_of

DEFINED = {
    "A": r"A = \frac{\partial\mathbf{f}}{\partial\mathbf{x}}",
    "B": r"B = \frac{\partial\mathbf{f}}{\partial\mathbf{u}}",
    "C": r"C = \frac{\partial\mathbf{g}}{\partial\mathbf{x}}",
    "D": r"D = \frac{\partial\mathbf{g}}{\partial\mathbf{u}}",
    "H": r"H_{\mathbf{uu}} = \frac{\partial^2 H}{\partial\mathbf{u}^2}",
}
"""Prefix of the names of a matrix's entries -> definition of the matrix."""
TALL = 14
"""Largest number of lines of a matrix; a row with fractions counts as two."""
GAP = 1.0
"""Space between columns, in em."""

_LETTER = re.compile(r"(?:\\[a-z]+\{)?[A-Za-z]\}?")


def with_matrices(
    derivation: Derivation, step: Step, texts: Texts, typeset: Typesetter
) -> tuple[str, list[str]] | None:
    """Typeset equations that define the entries of matrices as matrices, and list those with numbers.

    ``None`` if there are no matrices. Entries without a number of their own share that of their matrix.
    """
    found = matrices(derivation, step)
    if not found:
        return None
    address = f"{derivation.name}:{step.name}"
    shown, listed = [], []
    for matrix in found:
        written, named = _written(matrix, _entry_letter(matrix.prefix, derivation), typeset)
        if written is None:
            listed.append(matrix)
        else:
            shown.append((matrix, written, named))
    stands = _defined([v.latex for v in derivation.model.controls])
    rows = [Row(f"{address}.{m.prefix}", plain(stands.get(m.prefix, m.prefix)), plain(w)) for m, w, _ in shown]
    parts = [display(rows)] if rows else []
    for back, (matrix, _, named) in zip(range(len(shown) - 1, -1, -1), shown, strict=True):
        parts.append(also(back, [f"{address}.{e.name}" for e in matrix.equations if e not in named.values()]))
    for matrix, _, named in shown:
        if named:
            stated = [e for e in matrix.equations if not typeset.is_zero(e.rhs)]
            parts.append(entries_are(texts, matrix.prefix, len(named), len(stated)))
            entries = [Row(f"{address}.{e.name}", plain(name), typeset.terms(e.rhs)) for name, e in named.items()]
            parts.append(display(entries))
            rows += entries
    for place, matrix in enumerate(listed):
        name = _flat(stands.get(matrix.prefix, matrix.prefix))
        parts.append(texts.get("groups", "nonzero_next" if place or shown else "nonzero", matrix=name))
        entries = [
            Row(f"{address}.{e.name}", plain(name), typeset.terms(e.rhs))
            for name, e in _places(matrix, matrix.prefix)
            if not typeset.is_zero(e.rhs)
        ]
        zero = [e for e in matrix.equations if typeset.is_zero(e.rhs)]
        parts += [display(entries), also(0, [f"{address}.{e.name}" for e in zero])]
        rows += entries
    return "\n".join(p for p in parts if p), [row.address for row in rows]


def _entry_letter(matrix: str, derivation: Derivation) -> str:
    """Return the letter of a matrix's entries: its own in lower case, unless variables are indexed by that."""
    sides = (side for step in derivation.steps for e in step.equations for side in (e.lhs, e.rhs))
    names: set[str] = set().union(*({s.name for s in side.free_symbols} for side in sides))
    indexed = [latex for name in names if "_" in (latex := derivation.notation.get(name, ""))]
    return next((letter for letter in (matrix.lower(), matrix) if letter not in map(letter_of, indexed)), matrix)


def _defined(controls: Sequence[str]) -> dict[str, str]:
    """Return what matrices stand for; for a single control H has no matrix of second derivatives."""
    if len(controls) != 1:
        return DEFINED
    return {**DEFINED, "H": rf"\frac{{\partial^2 H}}{{\partial {{{controls[0]}}}^2}}"}


def entries_are(texts: Texts, matrix: str, named: int, stated: int) -> str:
    """Introduce the entries that a matrix shows by name, if they are not zero."""
    key = "entries_all" if 1 < named == stated else "entries_one" if named == 1 else "entries"
    return texts.get("groups", key, matrix=matrix)


def _flat(tex: str) -> str:
    """Return LaTeX with fractions on one line."""
    return re.sub(r"\\frac\{(\S+)\}\{(\S+)\}", r"\1 / \2", tex)


def matrix_rows(address: str, name: str, matrix: Any, typeset: Typesetter) -> tuple[list[Row], list[Row]]:
    """Return an equation whose right-hand side is a matrix, with those of its long entries, or of all."""
    cells = [[typeset.tex(matrix[i, j]) for j in range(matrix.cols)] for i in range(matrix.rows)]
    head, _, _ = name.partition(" = ")
    letter = head[0].lower() if head[:1].isalpha() and head[1:2] in ("", "^") else "m"
    written, named = fitted(cells, LINE - width(name) - 2.0, letter)
    mirrored = bool(named or written is None) and is_mirrored(matrix)
    if written is None and not mirrored and (parted := in_parts(cells, LINE - width(name) - 2.0)):
        return [Row(address, plain(name), (parted,))], []
    if written is not None and not mirrored:
        places = [Row(f"{address}.{i}.{j}", plain(text), typeset.terms(matrix[i, j])) for text, (i, j) in named.items()]
        return [Row(address, plain(name), plain(array(written)))], places
    first, *rest = [
        Row(f"{address}.{i}.{j}", plain(_indexed(name, i, j, matrix)), typeset.terms(matrix[i, j]))
        for i in range(matrix.rows)
        for j in range(matrix.cols)
        if not typeset.is_zero(matrix[i, j]) and not (mirrored and j < i)
    ]
    return [replace(first, address=address), *rest], []


def in_parts(cells: Sequence[Sequence[str]], room: float) -> Term | None:
    """Write a matrix that is too wide as blocks of columns on a few lines; ``None`` if these are too many."""
    rows, columns = len(cells), len(cells[0])
    for count in range(2, TALL // rows + 2):
        size, rest = divmod(columns, count)
        blocks = [[row[k : k + size] for row in cells] for k in range(0, columns, size or 1)]
        if not rest and size > 1 and all(_total(block) + 2 * GAP <= room for block in blocks):
            first, *others = [array(block) for block in blocks]
            pieces = [
                f"{_open(first, right=True)} \\cdots",
                *(rf"\cdots {_open(block, left=True)}" for block in others),
            ]
            pieces[1:-1] = [rf"{_open(piece, right=True)} \cdots" for piece in pieces[1:-1]]
            return Term(False, " ".join(pieces), tuple(map(Piece, pieces)))
    return None


def _open(matrix: str, *, left: bool = False, right: bool = False) -> str:
    """Write a matrix without a parenthesis on one side."""
    matrix = matrix.replace(r"\left(", r"\left.") if left else matrix
    return matrix.replace(r"\right)", r"\right.") if right else matrix


def is_mirrored(matrix: Any) -> bool:
    """Tell whether a matrix is symmetric; entries are simplified only where needed to decide."""
    if matrix.rows != matrix.cols:
        return False
    pairs = [(matrix[i, j], matrix[j, i]) for i in range(matrix.rows) for j in range(i)]
    return all((a == 0) == (b == 0) for a, b in pairs) and bool(matrix.is_symmetric())


def _indexed(name: str, i: int, j: int, matrix: Any) -> str:
    """Return the symbol of a matrix entry; zero stays zero."""
    head = name.partition(" = ")[0]
    letter = head if _LETTER.fullmatch(head) else f"({head})"
    return name if name == "0" else _place(letter, i, j, matrix.shape)


def fitted(
    cells: Sequence[Sequence[str]], room: float, letter: str
) -> tuple[list[list[str]] | None, dict[str, tuple[int, int]]]:
    """Replace the longest cells by names until the cells fit; return both, or ``None`` if that does not help."""
    if _total(cells) <= room:
        return [list(row) for row in cells], {}
    widths = {(i, j): width(cell) for i, row in enumerate(cells) for j, cell in enumerate(row)}
    for limit in sorted(set(widths.values()), reverse=True):
        long = [(i, j) for (i, j), w in widths.items() if w >= limit and cells[i][j] != "0"]
        named = {_place(letter, i, j, (len(cells), len(cells[0]))): (i, j) for i, j in long}
        names = {place: name for name, place in named.items()}
        short = [[names.get((i, j), cell) for j, cell in enumerate(row)] for i, row in enumerate(cells)]
        if _total(short) <= room:
            return short, named
    return None, {}


def with_names(
    cells: Sequence[Sequence[str]], names: Sequence[Sequence[str]], room: float
) -> tuple[list[list[str]], set[tuple[int, int]]]:
    """Return the cells, the longest of them replaced by their names until they fit, and the places of those."""
    shown, named = [list(row) for row in cells], set[tuple[int, int]]()
    widths = {width(cell) for row in cells for cell in row}
    for limit in sorted(widths, reverse=True):
        if _total(shown) <= room:
            break
        for i, row in enumerate(cells):
            for j, cell in enumerate(row):
                if cell != "0" and width(cell) >= limit:
                    shown[i][j] = names[i][j]
                    named.add((i, j))
    return shown, named


def _written(matrix: NamedMatrix, letter: str, typeset: Typesetter) -> tuple[str | None, dict[str, Equation]]:
    """Return the matrix, and the entries it shows by a name; ``None`` if it is still too wide, or too tall."""
    room = LINE - width(DEFINED.get(matrix.prefix, matrix.prefix)) - 2.0
    cells = [["0" if e is None else typeset.tex(e.rhs) for e in row] for row in matrix.entries]
    short, named = fitted(cells, room, letter)
    if short is None or sum(1 + any(r"\frac" in cell for cell in row) for row in short) > TALL:
        return None, {}
    entries = {name: matrix.entries[i][j] for name, (i, j) in named.items()}
    return array(short), {name: e for name, e in entries.items() if e is not None}


def _place(letter: str, i: int, j: int, shape: tuple[int, int]) -> str:
    """Return the letter with the indices of an entry of a matrix of this shape."""
    comma = "," if max(shape) > 9 else ""
    return f"{letter}_{{{i + 1}{comma}{j + 1}}}"


def _places(matrix: NamedMatrix, letter: str) -> list[tuple[str, Equation]]:
    """Return all entries as letters with indices."""
    return [
        (_place(letter, i, j, (len(matrix.entries), len(matrix.entries[0]))), entry)
        for i, row in enumerate(matrix.entries)
        for j, entry in enumerate(row)
        if entry is not None
    ]


def _total(cells: Sequence[Sequence[str]]) -> float:
    return sum(max(map(width, column)) + GAP for column in zip(*cells, strict=True))


COLUMN = 13.5
"""Width in em that an equation may take in one of two columns, beside its number."""
BOLD = r"\mathbf{"
PART = "part_"
"""Prefix of the names of common subexpressions."""


def kinematics(context: Context, step: Step) -> Shown:
    """Write the matrix that places the body, its longer entries, and the rates of the coordinates."""
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
    """Write M, b and Q as matrices, with long entries and common subexpressions in the appendix."""
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
    """Write the rates of the speeds as the solution of one equation, if no closed form is shown."""
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
    """Write equations in two columns."""
    return f"\\begin{{multicols}}{{2}}\\satsymcolumns\n{display(rows, COLUMN)}\n\\end{{multicols}}"
