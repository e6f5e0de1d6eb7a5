"""Single lines of a printed Runge-Kutta loop, read as they stand and held against the textbook's line.

The textbook's line is built from derived rates: a stage is h times the rates at the node, moved by the stage before
it, with controls and states from the middle of the step in the second and third stage and from its end in the fourth.
Where the two differ, the slips that such programs have are undone one after the other, until they agree.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, partial

from satsym.auditing.predicates import Finding, Question, predicate
from satsym.formula import reading
from satsym.formula.field import vanishes
from satsym.formula.runge_kutta import classical_weights
from satsym.formula.tree import Add, Mul, Neg, Node, Num, Sym, children, number, rebuilt, substituted, symbols
from satsym.formula.values import Relation
from satsym.formula.writing import written
from satsym.status import BadInput
from satsym.wording import shown

_INDEX = re.compile(r"\((i\+1|j\+1|i|j)\)")
_MARK = {"i": "_i", "i+1": "_i1", "j": "_j", "j+1": "_j1"}
_HALF = number(Fraction(1, 2))
_HALF_PRINTED = Num(Fraction(1, 2))


@dataclass(frozen=True)
class Loop:
    """A printed loop.

    Attributes
    ----------
    rates
        Address of the rates, but for the name of the variable; variables in order, ours and the printed ones.
    variables
        Our variable -> the printed array, in order.
    passive
        Our name of what is only looked up -> the printed array.
    stage, increment
        Patterns for printed names of stages (number, component) and of increments (component).
    names
        How component i (from 1) is called in names of stages and increments.
    here, there
        Marks of the node a step begins at, and of the one it leads to.
    sign
        -1 where the loop runs backwards.
    """

    rates: str
    variables: Mapping[str, str]
    passive: Mapping[str, str]
    stage: str
    increment: str
    names: tuple[str, ...]
    here: str
    there: str
    sign: int

    def stage_name(self, stage: int, component: int) -> str:
        """Printed name of a stage."""
        return self.stage.format(stage=stage, name=self.names[component])


LOOPS: Mapping[str, Loop] = {
    "initial": Loop(
        rates="clohessy_wiltshire:first_order.",
        variables={"x1": "x1", "x2": "x2", "x3": "x3", "x4": "x4"},
        passive={},
        stage="{name}{stage}",
        increment="{name}",
        names=("a", "b", "e", "d"),
        here="_i",
        there="_i1",
        sign=1,
    ),
    "state": Loop(
        rates="polar_orbit:first_order.",
        variables={"r": "x1s", "r_dot": "x2s", "theta": "x3s", "theta_dot": "x4s"},
        passive={"u1": "u1", "u2": "u2"},
        stage="k{stage}_{name}",
        increment="kx{number}",
        names=("x1s", "x2s", "x3s", "x4s"),
        here="_i",
        there="_i1",
        sign=1,
    ),
    "costate": Loop(
        rates="polar_orbit:costate_equations.",
        variables={"r": "lambda1", "r_dot": "lambda2", "theta": "lambda3", "theta_dot": "lambda4"},
        passive={"r": "x1s", "r_dot": "x2s", "theta": "x3s", "theta_dot": "x4s", "u1": "u1", "u2": "u2"},
        stage="k{stage}_{name}",
        increment="kl{number}",
        names=("l1", "l2", "l3", "l4"),
        here="_j1",
        there="_j",
        sign=-1,
    ),
}


@predicate
def listing_line(row: Question, loop: str) -> Finding:
    """Whether a printed line ``name=formula;`` of a loop is the textbook's: ``initial``, ``state`` or ``costate``."""
    if loop not in LOOPS or not isinstance(row.printed, str):
        raise BadInput(f"listing_line: no loop {shown(loop)}, or no line; write initial, state or costate")
    left, printed = _line(row.printed)
    target, stage = _textbook(LOOPS[loop], left)
    undone: list[str] = []
    tree = printed
    for slip, undo in _slips(LOOPS[loop], stage).items():
        if vanishes(_minus(tree, target), row.item):
            break
        mended = undo(tree)
        if mended != tree:
            tree, undone = mended, [*undone, slip]
    agrees = vanishes(_minus(tree, target), row.item)
    derived = f"{left} = {written(tree if agrees else target)}"
    return Finding(
        agrees and not undone,
        derived,
        {"slips": len(undone) if agrees else -1},
        remark="; ".join(undone) if agrees else "not by the slips that were tried",
    )


def _line(text: str) -> tuple[str, Node]:
    """A MATLAB line as the name it gives a value to, and a formula; ``x1s(i+1)`` is read as x1s_i1."""
    flat = _INDEX.sub(lambda match: _MARK[match[1]], text.replace(" ", "").rstrip(";"))
    left, sign, right = flat.partition("=")
    if not sign:
        raise BadInput(f"listing_line: {shown(text)} gives no name a value")
    for matlab, ours in ((".*", "*"), ("./", "/"), (".^", "**")):
        right = right.replace(matlab, ours)
    return left, reading.expression(right)


@cache
def _rates(prefix: str, variables: tuple[str, ...]) -> tuple[Node, ...]:
    """Derived rates as trees."""
    from satsym.symbolic.lookup import library

    shared = library.names([prefix.partition(":")[0]], {})
    found = [
        library.in_trees(library.at(f"{prefix}{name}", shared, lambda names: tuple(range(len(names)))))
        for name in variables
    ]
    return tuple(relation.rhs for relation in found if isinstance(relation, Relation))


def _textbook(loop: Loop, name: str) -> tuple[Node, int]:
    """The textbook's formula for what the printed loop calls so, and which stage it is (0 for none)."""
    for i, variable in enumerate(loop.variables.values()):
        stages = [Sym(loop.stage_name(k, i)) for k in (1, 2, 3, 4)]
        weighted = Add(
            tuple(Mul((Num(weight), stage)) for weight, stage in zip(classical_weights(), stages, strict=True))
        )
        if name == variable + loop.there:
            increment = Sym(_increment(loop, i))
            return Add((Sym(variable + loop.here), increment if loop.sign > 0 else Neg(increment))), 0
        if name == _increment(loop, i):
            return weighted, 0
        for k, stage in enumerate(stages, start=1):
            if name == stage.name:
                return _stage(loop, k, i), k
    raise BadInput(f"listing_line: {shown(name)} is no name of this loop")


def _increment(loop: Loop, component: int) -> str:
    return loop.increment.format(name=loop.names[component], number=component + 1)


def _stage(loop: Loop, stage: int, component: int) -> Node:
    """h times the rate of a component where the stage looks."""
    share = {1: Num(Fraction(0)), 2: _HALF, 3: _HALF, 4: Num(Fraction(1))}[stage]
    values: dict[str, Node] = {}
    for i, (ours, printed) in enumerate(loop.variables.items()):
        moved: Node = Sym(printed + loop.here)
        if stage > 1:
            step: Node = Mul((share, Sym(loop.stage_name(stage - 1, i))))
            moved = Add((moved, step if loop.sign > 0 else Neg(step)))
        values[f"lambda_{ours}" if loop.passive and loop.sign < 0 else ours] = moved
    for ours, printed in loop.passive.items():
        here, there = Sym(printed + loop.here), Sym(printed + loop.there)
        values[ours] = here if stage == 1 else there if stage == 4 else Mul((_HALF, Add((here, there))))
    if not loop.passive:
        # without control: the listing gives it the names u1_0 and u2_0
        values |= {"u1": Sym("u1_0"), "u2": Sym("u2_0")}
    rate = _rates(loop.rates, tuple(loop.variables))[component]
    return Mul((Sym("h"), substituted(rate, values)))


def _slips(loop: Loop, stage: int) -> Mapping[str, Callable[[Node], Node]]:
    """What may have gone wrong in a line, in words, and how to undo it."""
    stages = {loop.stage_name(k, i) for k in (1, 2, 3, 4) for i in range(4)}
    means = {
        frozenset((printed + loop.here, printed + loop.there)): printed + loop.there
        for printed in loop.passive.values()
    }

    def once(factors: list[Node]) -> list[Node]:
        if any(isinstance(factor, Sym) and factor.name in stages for factor in factors):
            return [factor for factor in factors if factor != Sym("h")]
        return factors

    def at_the_end(factors: list[Node]) -> list[Node]:
        for k, factor in enumerate(factors):
            end = means.get(frozenset(symbols(factor))) if isinstance(factor, Add) else None
            if stage == 4 and end and _HALF_PRINTED in factors:
                factors = [*factors[:k], Sym(end), *factors[k + 1 :]]
                factors.remove(_HALF_PRINTED)
        return factors

    return {
        "the stage before carries h already, and is multiplied by h again": partial(_rewritten, once),
        "the fourth stage takes what belongs to the end of the step from its middle": partial(_rewritten, at_the_end),
    }


def _rewritten(rule: Callable[[list[Node]], list[Node]], node: Node) -> Node:
    """The tree in which a rule was applied to the factors of each product, the innermost first."""
    parts = tuple(_rewritten(rule, part) for part in children(node))
    tree = rebuilt(node, parts) if parts else node
    if not isinstance(tree, Mul):
        return tree
    factors = rule(list(tree.factors))
    return factors[0] if len(factors) == 1 else Mul(tuple(factors))


def _minus(one: Node, other: Node) -> Node:
    return Add((one, Neg(other)))
