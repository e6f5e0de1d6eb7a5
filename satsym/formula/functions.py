"""Functions that formulas over derived and printed expressions may call; each derives its result."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from satsym.formula.evaluation import Engine, Operation
from satsym.formula.tree import Call, Grid, Node, Sym, Text, constant
from satsym.formula.values import Kernel, Matrix, Relation, Roots, S, Value, plain, square, stacked, transposed, without
from satsym.status import BadInput

MOST_ARGUMENTS = 20


def _symbol(engine: Engine[S], tree: Node) -> str:
    if not isinstance(tree, Sym):
        raise BadInput("a single symbol is needed here")
    return engine.sources.symbol(tree.name)


def _index(tree: Node, size: int) -> int:
    value = constant(tree)
    if value is None or value.denominator != 1 or not 1 <= value <= size:
        raise BadInput(f"an index from 1 to {size} is needed here")
    return int(value) - 1


def _place(engine: Engine[S], tree: Call) -> tuple[Matrix[S], int, int]:
    matrix = engine.matrix(tree.arguments[0])
    return matrix, _index(tree.arguments[1], matrix.shape[0]), _index(tree.arguments[2], matrix.shape[1])


def row_key(call: Call) -> str:
    """Return the key of the row that ``row['item']`` or ``row['item', 'part']`` refers to."""
    return " ".join(argument.value for argument in call.arguments if isinstance(argument, Text))


def _row(engine: Engine[S], tree: Call) -> Value:
    return engine.sources.row(row_key(tree))


def _at(engine: Engine[S], tree: Call) -> Value:
    (address,) = tree.arguments
    return engine.operand(address) if isinstance(address, Text) else engine.sources.address("")


def _diff(engine: Engine[S], tree: Call) -> Value:
    found = engine.operand(tree.arguments[0])
    for by in [_symbol(engine, argument) for argument in tree.arguments[1:]]:
        if isinstance(found, Matrix):
            found = found.mapped(partial(engine.derivative, by=by))
        else:
            found = engine.derivative(plain(found), by)
    return found


def _subs(engine: Engine[S], tree: Call) -> Value:
    values = {engine.sources.symbol(name): engine.scalar(value) for name, value in tree.named}
    put_in = partial(engine.substitute, values=values)
    found = engine.value(tree.arguments[0])
    if isinstance(found, Matrix):
        return found.mapped(put_in)
    return Relation(put_in(found.lhs), put_in(found.rhs)) if isinstance(found, Relation) else put_in(plain(found))


def _norm(engine: Engine[S], tree: Call) -> Value:
    column = engine.matrix(tree.arguments[0])
    if column.shape[1] != 1:
        raise BadInput("norm(...) requires a column vector")
    squares = [engine.power(row[0], Fraction(2)) for row in column.rows]
    return engine.power(engine.add(squares), Fraction(1, 2))


def _entry(engine: Engine[S], tree: Call) -> Value:
    matrix, i, j = _place(engine, tree)
    return matrix.rows[i][j]


def _zeros(engine: Engine[S], tree: Call) -> Value:
    sizes = [_index(argument, MOST_ARGUMENTS) + 1 for argument in tree.arguments]
    return Matrix(tuple((engine.number(Fraction(0)),) * sizes[-1] for _ in range(sizes[0])))


def _reached(engine: Engine[S], tree: Call) -> Value:
    a, b = map(engine.matrix, tree.arguments)
    blocks = [b]
    for _ in range(square(a) - 1):
        blocks.append(engine.product(a, blocks[-1]))
    return stacked(blocks, beside=True)


def _observed(engine: Engine[S], tree: Call) -> Value:
    a, c = map(engine.matrix, tree.arguments)
    blocks = [c]
    for _ in range(square(a) - 1):
        blocks.append(engine.product(blocks[-1], a))
    return stacked(blocks, beside=False)


def _jacobian(engine: Engine[S], tree: Call) -> Value:
    column, symbols = engine.matrix(tree.arguments[0]), tree.arguments[1]
    names = [_symbol(engine, entry) for entry in (symbols.entries if isinstance(symbols, Grid) else (symbols,))]
    if column.shape[1] != 1:
        raise BadInput("jacobian(...) requires a column vector")
    return Matrix(tuple(tuple(engine.derivative(row[0], name) for name in names) for row in column.rows))


def classical_weights() -> tuple[Fraction, ...]:
    """Return the weights of the classical Runge-Kutta method, solved from its order conditions.

    With the nodes 0, 1/2, 1/2, 1 and each stage built on the one before it, the conditions sum b = 1, sum b c = 1/2,
    sum b c^2 = 1/3 and sum b_i a_ij c_j = 1/6 of order three have one solution; it is of order four (Hairer, Norsett
    and Wanner, Solving Ordinary Differential Equations I, II.1).
    """
    from flint import fmpq, fmpq_mat

    c = [fmpq(0), fmpq(1, 2), fmpq(1, 2), fmpq(1)]
    chained = [fmpq(0), fmpq(0), c[2] * c[1], c[3] * c[2]]
    conditions = fmpq_mat([[fmpq(1)] * 4, c, [node**2 for node in c], chained])
    found = conditions.solve(fmpq_mat(4, 1, [fmpq(1), fmpq(1, 2), fmpq(1, 3), fmpq(1, 6)]))
    return tuple(Fraction(int(b.p), int(b.q)) for b in found.entries())


def _increment(engine: Engine[S], tree: Call) -> Value:
    slopes = [engine.scalar(argument) for argument in tree.arguments]
    weights = classical_weights()
    return engine.add([engine.multiply([engine.number(w), k]) for w, k in zip(weights, slopes, strict=True)])


def _stack(engine: Engine[S], tree: Call, beside: bool) -> Value:
    return stacked([engine.matrix(argument) for argument in tree.arguments], beside=beside)


OPERATIONS: Mapping[str, Operation] = {
    "row": Operation(_row, 1, 2),  # what a row prints
    "at": Operation(_at),  # the right-hand side, or the matrix, at an address
    "lhs": Operation(lambda engine, tree: engine.relation(tree.arguments[0]).lhs),
    "rhs": Operation(lambda engine, tree: engine.relation(tree.arguments[0]).rhs),
    "diff": Operation(_diff, 2, MOST_ARGUMENTS),
    "d": Operation(lambda engine, tree: engine.along(engine.scalar(tree.arguments[0]))),  # by time, along the motion
    "subs": Operation(_subs),  # subs(e, x=..., y=...), all at once
    # the only solution of a linear equation for a symbol
    "solve": Operation(lambda e, tree: e.solution(e.value(tree.arguments[0]), _symbol(e, tree.arguments[1])), 2, 2),
    "matrix": Operation(lambda engine, tree: engine.matrix(tree.arguments[0])),
    "norm": Operation(_norm),
    "entry": Operation(_entry, 3, 3),
    "minor": Operation(
        lambda engine, tree: without(*_place(engine, tree)), 3, 3
    ),  # without a row and a column, counted from one
    "transpose": Operation(lambda engine, tree: transposed(engine.matrix(tree.arguments[0]))),
    "det": Operation(lambda engine, tree: engine.determinant(engine.matrix(tree.arguments[0]))),
    "rank": Operation(lambda engine, tree: engine.number(Fraction(engine.rank(engine.matrix(tree.arguments[0]))))),
    "inverse": Operation(lambda engine, tree: engine.inverse(engine.matrix(tree.arguments[0]))),
    "charpoly": Operation(  # det(x I - A)
        lambda e, tree: e.characteristic(e.matrix(tree.arguments[0]), e.scalar(tree.arguments[1])), 2, 2
    ),
    "eigenvalues": Operation(lambda engine, tree: Roots(engine.matrix(tree.arguments[0]))),  # repeated ones, too
    "nullspace": Operation(lambda engine, tree: Kernel(engine.matrix(tree.arguments[0]))),  # a basis, as columns
    "eye": Operation(lambda engine, tree: engine.identity(_index(tree.arguments[0], MOST_ARGUMENTS) + 1)),
    "zeros": Operation(_zeros, 1, 2),
    "hstack": Operation(lambda engine, tree: _stack(engine, tree, beside=True), 1, MOST_ARGUMENTS),
    "vstack": Operation(lambda engine, tree: _stack(engine, tree, beside=False), 1, MOST_ARGUMENTS),
    "controllability": Operation(_reached, 2, 2),  # [B, AB, A^2 B, ...]
    "observability": Operation(_observed, 2, 2),  # [C; CA; C A^2; ...]
    "jacobian": Operation(_jacobian, 2, 2),  # of a column by a list of symbols
    "rk4_increment": Operation(_increment, 4, 4),  # the weighted mean of four slopes that gives order four
}
