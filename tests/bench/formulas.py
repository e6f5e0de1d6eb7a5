"""How much `satsym check` sees: slips planted in derived equations of models that no audited document is about.

Equations are written in LaTeX in the notation of their models; slips are drawn on their trees by rules of their own: a
sign turned, a factor more, an exponent changed, another letter, a dot more or less. Each must be called wrong, and what
is said to be right must be the equation it was made of. Rewritings (sides exchanged, terms moved, a factor on both
sides) must be called right. Slips that leave an equation true are not counted.

    python -m tests.bench.formulas [NUMBER]
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction

from satsym.auditing.check.answer import check
from satsym.auditing.check.derived import Derived, says_nothing, vanishes
from satsym.auditing.check.meanings import Meanings
from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.tokens import tokens
from satsym.auditing.latex.writing import in_latex
from satsym.formula.calculus import difference
from satsym.formula.tree import Add, Equality, Mul, Neg, Node, Num, Pow, Sym, replaced, walk
from satsym.formula.weight import Scales
from satsym.records import record, shelf

MODELS = ("goddard", "cart_pole", "catalyst", "zermelo", "linear_tangent", "obstacle", "transfer_time", "hill")
STEPS = ("first_order", "hamiltonian", "costate_equations")
TWO = Num(Fraction(2))


def equations(model: str) -> Iterator[tuple[str, Equality]]:
    """Addresses and equations, as the model has them, of two letters at least on the right."""
    found = shelf.find(model)
    for step in found.steps:
        for stated in step.equations if step.name in STEPS else ():
            if stated.lhs and isinstance(stated.rhs, str):
                sides = record.formula(stated.lhs), record.formula(stated.rhs)
                if sum(isinstance(part, Sym) for _, part in walk(sides[1])) >= 2 and len(stated.rhs) < 200:
                    yield f"{model}:{step.name}.{stated.name}", Equality(*sides)


def slips(
    sides: Equality, names: list[str], rates: dict[str, str], rng: random.Random
) -> Iterator[tuple[str, Equality]]:
    """One slip of each kind, at a random place of the right-hand side."""
    places = list(walk(sides.rhs))
    terms = [(path, part) for path, part in places if not path or isinstance(_at(sides.rhs, path[:-1]), Add)]
    letters = [(path, part) for path, part in places if isinstance(part, Sym)]
    path, part = rng.choice(terms)
    yield "sign", _with(sides, path, part.operand if isinstance(part, Neg) else Neg(part))
    path, part = rng.choice(terms)
    inner = part.operand if isinstance(part, Neg) else part
    doubled = Mul((TWO, *(inner.factors if isinstance(inner, Mul) else (inner,))))
    yield "factor", _with(sides, path, Neg(doubled) if isinstance(part, Neg) else doubled)
    path, part = rng.choice(letters)
    above = _at(sides.rhs, path[:-1]) if path else None
    if isinstance(above, Pow):
        assert isinstance(above.exponent, Num | Neg)
        yield "exponent", _with(sides, path[:-1], part)
    else:
        yield "exponent", _with(sides, path, Pow(part, TWO))
    moving = [(path, part) for path, part in letters if part.name in rates and path[-1:] != (1,)]
    if moving:
        path, part = rng.choice(moving)
        yield "derivative", _with(sides, path, Sym(rates[part.name]))
    path, part = rng.choice(letters)
    others = [name for name in names if name != part.name]
    yield "letter", _with(sides, path, Sym(rng.choice(others)))


def rewritings(sides: Equality, rng: random.Random) -> Iterator[tuple[str, Equality]]:
    """The same, written otherwise."""
    yield "exchanged", Equality(sides.rhs, sides.lhs)
    yield "to one side", Equality(Add((sides.lhs, Neg(sides.rhs))), Num(Fraction(0)))
    yield "doubled", Equality(Mul((TWO, sides.lhs)), Mul((TWO, sides.rhs)))
    if isinstance(sides.rhs, Add):
        terms = list(sides.rhs.terms)
        moved = terms.pop(rng.randrange(len(terms)))
        left = Add((sides.lhs, moved.operand if isinstance(moved, Neg) else Neg(moved)))
        yield "moved", Equality(left, terms[0] if len(terms) == 1 else Add(tuple(terms)))


def _at(tree: Node, path: tuple[int, ...]) -> Node:
    return next(part for place, part in walk(tree) if place == path)


def _with(sides: Equality, path: tuple[int, ...], new: Node) -> Equality:
    return Equality(sides.lhs, replaced(sides.rhs, path, new))


def _weighs_little(sides: Equality) -> bool:
    try:
        Scales().checked(sides)
    except Exception:
        return False
    return True


def main(number: int) -> None:
    """Print how many were caught, named and wrongly refused."""
    rng = random.Random(7)
    counts: Counter[str] = Counter()
    drawn = [(model, address, sides) for model in MODELS for address, sides in equations(model)]
    rng.shuffle(drawn)
    rates = {model: record.rates(shelf.find(model)) for model in MODELS}
    known = {model: Derived(shelf.find(model)) for model in MODELS}
    while counts["slips"] < number or counts["rewritings"] < number:
        model, address, sides = drawn[rng.randrange(len(drawn))]
        derived = known[model]
        meanings = Meanings(derived)
        typeset = {name: letter.latex for name, letter in meanings.letters.items()}
        inside = {part.name for side in (sides.lhs, sides.rhs) for _, part in walk(side) if isinstance(part, Sym)}
        if not inside <= {*typeset, "pi"}:
            continue
        write = in_latex(typeset)
        again = read(tokens(write(sides)), write(sides)).statements
        kind, changed = rng.choice(list(slips(sides, sorted(derived.base & typeset.keys()), rates[model], rng)))
        ours = difference(*(_normal(side, derived) for side in (changed.lhs, changed.rhs)))
        if counts["slips"] < number and not says_nothing(ours, derived) and not vanishes(ours, derived):
            counts["slips"] += 1
            counts[f"slips of {kind}"] += 1
            (answer,) = check(write(changed), model)
            counts["caught"] += answer.verdict == "wrong"
            right = read(tokens(answer.correct), answer.correct).statements if answer.correct else []
            named = right == again
            counts["named"] += named
            counts[f"named of {kind}"] += named
            if answer.verdict != "wrong" or not named:
                print(kind, address, "|", write(sides), "|", write(changed), "|", answer.verdict, answer.address, "|")
                print("    ", answer.diagnosis, "|", answer.correct, flush=True)
        for kind, same in rewritings(sides, rng):
            if counts["rewritings"] < number:
                counts["rewritings"] += 1
                (answer,) = check(write(same), model)
                counts["false alarms"] += answer.verdict != "right"
                if answer.verdict != "right":
                    print("ALARM", kind, address, write(same), answer.verdict, answer.diagnosis, flush=True)
    print(dict(counts))


def _normal(side: Node, derived: Derived) -> Node:
    from satsym.formula.tree import substituted

    return substituted(side, derived._one_name)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300)
