"""What the formulas of a ledger may call, beyond what is printed: how a thing follows from derived or printed ones.

None of these functions holds an answer; each derives. Their meaning is in :mod:`satsym.symbolic.lookup.operations` (by
sympy) and in :mod:`satsym.formula.calculus` (by our own rules).
"""

from __future__ import annotations

from satsym.formula.reading import FUNCTIONS, Functions

MANY = 20

JUDGING: Functions = {
    **FUNCTIONS,
    "at": (1, 1),  # the right-hand side, or the matrix, at an address
    "row": (1, 2),  # what a row prints
    "lhs": (1, 1),
    "rhs": (1, 1),
    "diff": (2, MANY),
    "subs": (1, 1),  # subs(e, x=..., y=...), all at once
    "solve": (2, 2),  # the only solution of a linear equation for a symbol
    "matrix": (1, 1),
    "entry": (3, 3),
    "transpose": (1, 1),
    "det": (1, 1),
    "minor": (3, 3),  # without a row and a column, counted from one
    "rank": (1, 1),
    "inverse": (1, 1),
    "charpoly": (2, 2),  # det(x I - A)
    "eigenvalues": (1, 1),  # as often as they are roots
    "nullspace": (1, 1),  # a basis, as columns
    "eye": (1, 1),
    "zeros": (1, 2),
    "hstack": (1, MANY),
    "vstack": (1, MANY),
    "controllability": (2, 2),  # [B, AB, A^2 B, ...]
    "observability": (2, 2),  # [C; CA; C A^2; ...]
    "jacobian": (2, 2),  # of a column by a list of symbols
    "rk4_increment": (4, 4),  # the weighted mean of four slopes that gives order four
}
