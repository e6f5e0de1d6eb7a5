"""Matrices as matrices: long entries get names and follow below, and a matrix too wide even so becomes a list."""

from __future__ import annotations

from collections.abc import Sequence

from satsym.report import tex
from satsym.report.equations import LINE, Row, array, display
from satsym.report.texts import Texts
from satsym.report.width import width
from satsym.symbolic import Derivation, Equation, Step
from satsym.symbolic.terms import plain
from satsym.symbolic.typeset import NamedMatrix, Typesetter, matrices

DEFINED = {
    "A": r"A = \frac{\partial\mathbf{f}}{\partial\mathbf{x}}",
    "B": r"B = \frac{\partial\mathbf{f}}{\partial\mathbf{u}}",
    "H": r"H_{\mathbf{uu}} = \frac{\partial^2 H}{\partial\mathbf{u}^2}",
}
"""What a matrix stands for, by the prefix that the names of its entries have."""
GAP = 1.0
"""Between columns, in em."""


def with_matrices(
    derivation: Derivation, step: Step, texts: Texts, typeset: Typesetter
) -> tuple[str, list[str]] | None:
    """The equations of a step that are entries of matrices, and the addresses that got numbers of their own.

    ``None`` if there are no matrices. Entries without a number of their own share that of their matrix.
    """
    found = matrices(derivation, step)
    if not found:
        return None
    address = f"{derivation.name}:{step.name}"
    shown, listed = [], []
    for matrix in found:
        written, named = _written(matrix, typeset)
        if written is None:
            listed.append(matrix)
        else:
            shown.append((matrix, written, named))
    rows = [Row(f"{address}.{m.prefix}", plain(DEFINED.get(m.prefix, m.prefix)), plain(w)) for m, w, _ in shown]
    parts = [display(rows)] if rows else []
    for back, (matrix, _, named) in zip(range(len(shown) - 1, -1, -1), shown, strict=True):
        parts.append(_also(back, address, [e for e in matrix.equations if e not in named.values()]))
    for _, _, named in shown:
        if named:
            parts.append(texts.get("groups", "entries"))
            entries = [Row(f"{address}.{e.name}", plain(name), typeset.terms(e.rhs)) for name, e in named.items()]
            parts.append(display(entries))
            rows += entries
    for matrix in listed:
        parts.append(texts.get("groups", "nonzero", matrix=DEFINED.get(matrix.prefix, matrix.prefix)))
        entries = [
            Row(f"{address}.{e.name}", plain(name), typeset.terms(e.rhs))
            for name, e in _places(matrix, matrix.prefix)
            if not typeset.is_zero(e.rhs)
        ]
        zero = [e for e in matrix.equations if typeset.is_zero(e.rhs)]
        parts += [display(entries), _also(0, address, zero)]
        rows += entries
    return "\n".join(p for p in parts if p), [row.address for row in rows]


def _written(matrix: NamedMatrix, typeset: Typesetter) -> tuple[str | None, dict[str, Equation]]:
    """The matrix, and which entries it shows by a name; ``None`` if it is too wide even so."""
    room = LINE - width(DEFINED.get(matrix.prefix, matrix.prefix)) - 2.0
    cells = [["0" if e is None else typeset.tex(e.rhs) for e in row] for row in matrix.entries]
    if _total(cells) <= room:
        return array(cells), {}
    named = {}
    places = {name: (e, width(typeset.tex(e.rhs))) for name, e in _places(matrix, matrix.prefix.lower())}
    for limit in sorted({w for _, w in places.values()}, reverse=True):
        named = {name: e for name, (e, w) in places.items() if w >= limit}
        names = {e.name: name for name, e in named.items()}
        short = [
            [cell if e is None else names.get(e.name, cell) for cell, e in zip(texts, row, strict=True)]
            for texts, row in zip(cells, matrix.entries, strict=True)
        ]
        if _total(short) <= room:
            return array(short), named
    return None, {}


def _places(matrix: NamedMatrix, letter: str) -> list[tuple[str, Equation]]:
    """Entries with the letter and indices that stand for them."""
    comma = "," if max(len(matrix.entries), len(matrix.entries[0])) > 9 else ""
    return [
        (f"{letter}_{{{i}{comma}{j}}}", entry)
        for i, row in enumerate(matrix.entries, 1)
        for j, entry in enumerate(row, 1)
        if entry is not None
    ]


def _total(cells: Sequence[Sequence[str]]) -> float:
    return sum(max(map(width, column)) + GAP for column in zip(*cells, strict=True))


def _also(back: int, address: str, equations: Sequence[Equation]) -> str:
    """Labels for what shares the number of an equation, counted back from the last one."""
    labels = ",".join(tex.label(f"{address}.{e.name}") for e in equations)
    return rf"\satsymalso{{{back}}}{{{labels}}}%" if labels else ""
