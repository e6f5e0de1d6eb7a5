"""Choice of the plans by which a printed formula is compared with its target."""

from __future__ import annotations

from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.comparison.equations import Equal, EqualMatrix, Multiple, SameRoots, Spans
from satsym.auditing.comparison.plan import Never, Plan
from satsym.auditing.ledger.contents import Row
from satsym.auditing.ledger.scopes import CONSTANTS
from satsym.auditing.sentences import say
from satsym.formula.tree import ZERO, Equality, Formula, Node, Sym, names_in, symbols
from satsym.formula.values import Kernel, Matrix, Relation, Roots
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas


def plans(bench: Bench, row: Row, printed: Formula, target: Both) -> list[Plan]:
    """Return the plans for comparing a printed formula with its target; the formula is right if one of them holds."""
    trees = target.trees
    if isinstance(printed, tuple):
        return [_of_matrix(bench, row, printed, target)]
    if isinstance(trees, Roots | Kernel):
        raise BadInput('eigenvalues(...) and nullspace(...) are compared with a list, which requires kind = "matrix"')
    if isinstance(trees, Matrix):
        side = printed.rhs if isinstance(printed, Equality) and isinstance(printed.lhs, Sym) else printed
        if isinstance(side, Equality):
            raise BadInput("equations between matrices are not supported: print the matrix of one side")
        return [EqualMatrix(bench, row, (side,), ("",), target)]
    if isinstance(trees, Relation):
        return _of_relation(bench, row, printed, target)
    if not isinstance(printed, Equality):
        return [Equal(bench, row, (printed,), ("",), (target,))]
    if ZERO not in (printed.lhs, printed.rhs) and _is_label(printed):
        return [Equal(bench, row, (printed.rhs,), ("",), (target,))]
    return [Multiple(bench, row, printed, Both(Relation(trees, ZERO), Relation(target.exact, formulas.ZERO)))]


def _is_label(printed: Equality) -> bool:
    """Return whether the left-hand side is a symbol that only names the right-hand side."""
    return isinstance(printed.lhs, Sym) and printed.lhs.name not in symbols(printed.rhs)


def _of_relation(bench: Bench, row: Row, printed: Node | Equality, target: Both) -> list[Plan]:
    relation = target.trees
    lhs, rhs = (Both(getattr(relation, name), getattr(target.exact, name)) for name in ("lhs", "rhs"))
    if not isinstance(printed, Equality):
        if relation.lhs == ZERO:
            return [Multiple(bench, row, Equality(printed, ZERO), target)]
        return [Equal(bench, row, (printed,), ("",), (rhs,))]
    meanings = bench.meanings(row)
    if names_in(printed) - {*meanings, *CONSTANTS}:
        raise BadInput("a symbol that denotes a matrix occurs in an equation between numbers")
    if ZERO not in (relation.lhs, relation.rhs):
        for mine, other in ((printed.lhs, printed.rhs), (printed.rhs, printed.lhs)):
            if Equal(bench, row, (mine,), ("",), (lhs,)).may_hold((mine,)):
                return [Equal(bench, row, (other,), ("",), (rhs,))]
    found: list[Plan] = [Multiple(bench, row, printed, target)]
    if isinstance(printed.lhs, Sym) and _is_label(printed):
        meaning = bench.scope(row).meanings[printed.lhs.name]
        if isinstance(meaning, Sym):
            solved = bench.solved(row, target, meaning.name)
            return found if solved is None else [Equal(bench, row, (printed.rhs,), ("",), (solved,)), *found]
        defined = Equal(bench, row, (printed.lhs,), ("",), (rhs,)).may_hold((printed.lhs,))
        if isinstance(relation.lhs, Sym) and defined:  # the notation defines the symbol as the equation does
            found.append(Equal(bench, row, (printed.rhs,), ("",), (rhs,)))
    return found


def _of_matrix(bench: Bench, row: Row, printed: tuple[tuple[Node, ...], ...], target: Both) -> Plan:
    cells = [entry for line in printed for entry in line]
    m, n = len(printed), len(printed[0])
    labels = [f"{i}, {j}" for i in range(1, m + 1) for j in range(1, n + 1)]
    trees = target.trees
    if isinstance(trees, Roots):
        roots = SameRoots(bench, row, cells, target)
        if len(cells) != trees.of.shape[0]:
            return Never(roots, say("too_many", str(len(cells)), str(len(roots.targets)), table="sizes"))
        return roots
    if isinstance(trees, Kernel):
        columns = Spans(bench, row, cells, labels, target)
        long = trees.of.shape[1]
        return columns if m == long else Never(columns, say("columns", str(m), str(long), table="sizes"))
    if not isinstance(trees, Matrix):
        raise BadInput("a matrix cannot be compared with an expression; compare it with a matrix")
    targets = list(map(Both, trees.entries, target.exact.entries))
    entries = Equal(bench, row, cells, labels, targets)
    if trees.shape != (m, n):
        return Never(entries, say("matrix", *map(str, (m, n, *trees.shape)), table="sizes"))
    return entries
