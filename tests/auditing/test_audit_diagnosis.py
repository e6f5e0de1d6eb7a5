"""What is wrong with a formula: known slips, and random ones planted into formulas that were confirmed."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import pytest

from satsym import auditing
from satsym.auditing.comparison.bench import Bench, Both, Formula
from satsym.auditing.comparison.compare import plans
from satsym.auditing.comparison.plan import Plan
from satsym.auditing.diagnosis.edits import Change, in_exponent, mean_edits, times
from satsym.auditing.diagnosis.smallest_edit import Remedy, remedy
from satsym.auditing.ledger.contents import Row
from satsym.auditing.ledger.scopes import Scope
from satsym.formula import reading
from satsym.formula.tree import (
    Add,
    Call,
    Div,
    Equality,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    children,
    constant,
    number,
    replaced,
    symbols,
    walk,
)
from satsym.formula.tree import Path as Place
from satsym.formula.values import Relation
from satsym.formula.writing import written
from tests.support.ledgers import HAMILTONIAN, TANGENTIAL, judged, ledger, row

RADIAL = "polar_orbit:first_order.r_dot"
COSTATE = "polar_orbit:costate_equations.r"
B = "polar_orbit:linearisation.B"

SLIPS = {
    "sign": ("d_x4 = -(2*x2*x4 + u2)/x1", TANGENTIAL, "The sign of `u2` is reversed."),
    "sign of a bracket": ("d_x4 = (2*x2*x4 - u2)/x1", TANGENTIAL, "The sign of `(2*x2*x4 - u2)/x1` is reversed."),
    "index": ("d_x4 = (u1 - 2*x2*x4)/x1", TANGENTIAL, "`u1` should be `u2`."),
    "index on the left": ("d_x3 = (u2 - 2*x2*x4)/x1", TANGENTIAL, "In the left-hand side `d_x3` should be `d_x4`."),
    "factor": ("d_x4 = (u2 - x2*x4)/x1", TANGENTIAL, "`x2*x4` should be `2*x2*x4`: a factor is wrong."),
    "odd factor": ("d_x4 = (u2 - 14*x2*x4)/x1", TANGENTIAL, "`-14*x2*x4` should be `-2*x2*x4`: a factor is wrong."),
    "exponent": ("d_x2 = x1*x4**2 - g/x1**3 + u1", RADIAL, "`x1**3` should be `x1**2`: an exponent is wrong."),
    "no exponent": ("d_x2 = x1*x4 - g/x1**2 + u1", RADIAL, "`x4` should be `x4**2`: an exponent is wrong."),
    "missing term": ("d_x2 = x1*x4**2 - g/x1**2", RADIAL, "The term `+u1` is missing."),
    "missing term in a bracket": ("d_x4 = -(2*x2*x4)/x1", TANGENTIAL, "The term `+u2/x1` is missing."),
    "term too many": ("d_x2 = x1*x4**2 - g/x1**2 + u1 + u2", RADIAL, "there is one term too many"),
    "factor too many": ("d_x2 = x1*x4**2*x1 - g/x1**2 + u1", RADIAL, "there is one factor too many"),
    "factor twice": (
        "x1*(x2 + x1*u1*x4)",
        "r*(r_dot + u1*theta_dot)",
        "`x1*u1*x4` should be `u1*x4`: there is one factor too many.",
    ),
    "missing factor": ("d_x4 = (u2 - 2*x2)/x1", TANGENTIAL, "`2*x2` should be `2*x2*x4`: a factor is missing."),
    "other letter": ("d_x2 = x1*x4**2 - m/x1**2 + u1", RADIAL, "`m` should be `g`."),
    "upside down": ("d_x4 = x1/(u2 - 2*x2*x4)", TANGENTIAL, "The fraction `x1/(u2 - 2*x2*x4)` is inverted."),
    "two slips": ("d_x2 = -x1*x4**2 - g/x1**3 + u1", RADIAL, "`x1**3` should be `x1**2`"),
    "two slips of a sign": (
        "d_lambda1 = -(x4**2*lambda2 - 2*g/x1**3*lambda2 - (2*x2*x4 - u2)/x1**2*lambda4)",
        COSTATE,
        "The sign of `2*g/x1**3*lambda2` is reversed; the sign of `(2*x2*x4 - u2)/x1**2*lambda4` is reversed.",
    ),
    "everywhere": ("d_x2 = x2*x4**2 - g/x2**2 + u1", RADIAL, "`x2` should be `x1` at 2 places."),
    "beyond repair": ("d_x2 = x3**3 + u2*x1", RADIAL, "No small change corrects the formula; "),
}
MATRICES = {
    "rows": ([["1", "0"], ["0", "0"], ["0", "0"], ["0", "1/x1"]], "Rows 1 and 2 are exchanged."),
    "columns": ([["0", "0"], ["0", "1"], ["0", "0"], ["1/x1", "0"]], "Columns 1 and 2 are exchanged."),
    "entries": ([["0", "0"], ["1/x1", "0"], ["0", "0"], ["0", "1"]], "The entries (2, 1) and (4, 2) are exchanged."),
    "size": ([["0", "0"]], "The size is wrong: the printed matrix is 1 by 2, but should be 4 by 2."),
    "entry": ([["0", "0"], ["1", "0"], ["0", "0"], ["0", "-1/x1"]], "Entry (4, 2): the sign of `1/x1` is reversed."),
    "two entries": (
        [["0", "0"], ["-1", "0"], ["0", "0"], ["0", "1/x1**2"]],
        "Entry (2, 1): the sign of `1` is reversed; entry (4, 2): `x1**2` should be `x1`: an exponent is wrong.",
    ),
}


@pytest.fixture(scope="module")
def slips(tmp_path_factory: pytest.TempPathFactory) -> dict[str, auditing.Judged]:
    rows = [row(key, printed, holds) for key, (printed, holds, _) in SLIPS.items()]
    rows += [row(key, printed, B, "matrix") for key, (printed, _) in MATRICES.items()]
    return judged(tmp_path_factory.mktemp("slips"), rows)


@pytest.mark.parametrize("key", [*SLIPS, *MATRICES])
def test_known_slips_are_named(slips: dict[str, auditing.Judged], key: str) -> None:
    said = SLIPS[key][2] if key in SLIPS else MATRICES[key][1]
    assert slips[key].verdict == "misprint"
    assert said in slips[key].diagnosis


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("rows", "Baris 1 dan 2 tertukar."),
        ("columns", "Kolom 1 dan 2 tertukar."),
        ("entries", "Entri (2, 1) dan (4, 2) tertukar."),
        ("no exponent", "rumus ini menggabungkan "),
        ("size", "Ukurannya tidak cocok: yang tercetak 1 kali 2, seharusnya 4 kali 2."),
    ],
)
def test_an_indonesian_report_is_indonesian_throughout(slips: dict[str, auditing.Judged], key: str, said: str) -> None:
    assert said in slips[key].diagnosis_id


def test_what_is_put_right_is_shown_as_the_document_writes(slips: dict[str, auditing.Judged]) -> None:
    assert slips["sign"].derived == "d_x4 = -(2*x2*x4 - u2)/x1"
    assert slips["entry"].derived == "[[0, 0], [1, 0], [0, 0], [0, 1/x1]]"
    assert slips["beyond repair"].derived.startswith("d_x2 = ")


def test_wrong_dimensions_are_told_beside_the_slip(slips: dict[str, auditing.Judged]) -> None:
    assert "The dimensions also reveal the error: the formula combines" in slips["no exponent"].diagnosis
    assert "dimensions" not in slips["sign"].diagnosis


# Random slips, planted into formulas that were confirmed


@dataclass(frozen=True)
class Subject:
    """A confirmed formula, and what it is held against."""

    bench: Bench
    row: Row
    target: Both


@dataclass(frozen=True)
class Planted:
    """A slip: its kind, and the formula that has it."""

    kind: str
    formula: Formula


FORMULAS = [
    row("state 2", "d_x2 = x1*x4**2 - sigma**3*omega**2/x1**2 + u1", RADIAL),
    row("state 4", "d_x4 = -2*x2*x4/x1 + u2/x1", TANGENTIAL),
    row("newton", "x1*d_x4 + 2*x2*x4 = u2", TANGENTIAL),
    row("H", HAMILTONIAN, "polar_orbit:hamiltonian.H"),
    row("stationarity", "c2*u2 + lambda4/x1 = 0", "polar_orbit:stationarity.u2"),
    row(
        "costate 1",
        "d_lambda1 = -(x4**2*lambda2 + 2*sigma**3*omega**2/x1**3*lambda2 + (2*x2*x4 - u2)/x1**2*lambda4)",
        COSTATE,
    ),
    row("costate 2", "d_lambda2 = -(lambda1 - 2*x4/x1*lambda4)", "polar_orbit:costate_equations.r_dot"),
    row(
        "costate 4",
        "d_lambda4 = -(2*x1*x4*lambda2 + lambda3 - 2*x2/x1*lambda4)",
        "polar_orbit:costate_equations.theta_dot",
    ),
    row("bounds", "min(1, max(0, -lambda4/(c2*x1)))", "min(1, max(0, -lambda_theta_dot/(c2*r)))"),
    row("root", "sqrt(sigma**3*omega**2/x1)", "(mu/r)**(1/2)"),
    row("angles", "x1*cos(x3)*u1 - sin(x3)*u2", "r*cos(theta)*u1 - sin(theta)*u2"),
    row("B", [["0", "0"], ["1", "0"], ["0", "0"], ["0", "1/x1"]], B, "matrix"),
]


@pytest.fixture(scope="module")
def subjects(tmp_path_factory: pytest.TempPathFactory) -> list[Subject]:
    """Formulas of this test, and of the shipped ledgers, that are confirmed."""
    read = [ledger(tmp_path_factory.mktemp("formulas"), FORMULAS)]
    read += [auditing.read(path) for path in auditing.shipped() if path.name.startswith("its_")]
    found = []
    for each in read:
        bench = Bench(each)
        for entry in each.rows:
            if entry.printed is not None and entry.holds is not None:
                subject = Subject(bench, entry, bench.target(entry))
                if right(subject, entry.printed):
                    found.append(subject)
    assert {entry["item"] for entry in FORMULAS} <= {subject.row.key for subject in found}
    return found


def ways(subject: Subject, formula: Formula) -> list[Plan]:
    return plans(subject.bench, replace(subject.row, printed=formula), formula, subject.target)


def right(subject: Subject, formula: Formula) -> bool:
    return any(way.is_right(way.printed) for way in ways(subject, formula))


def cells(formula: Formula) -> list[Node]:
    if isinstance(formula, tuple):
        return [entry for line in formula for entry in line]
    return [formula.lhs, formula.rhs] if isinstance(formula, Equality) else [formula]


def with_cell(formula: Formula, index: int, cell: Node) -> Formula:
    new = cells(formula)
    new[index] = cell
    if isinstance(formula, tuple):
        width = len(formula[0])
        return tuple(tuple(new[i : i + width]) for i in range(0, len(new), width))
    return Equality(new[0], new[1]) if isinstance(formula, Equality) else new[0]


def slips_of(cell: Node, scope: Scope) -> Iterator[tuple[str, Place, Node]]:
    """Slips of a sign, a factor, an exponent or an index, independent of the edits that look for them."""
    for place, part in walk(cell):
        if in_exponent(cell, place):
            continue
        parent, current = None, cell
        for step in place:
            parent, current = current, children(current)[step]
        if (parent is None or isinstance(parent, Add)) and constant(part) != 0:
            yield "sign", place, part.operand if isinstance(part, Neg) else Neg(part)
            if not isinstance(part, Neg):
                for factor in (Fraction(2), Fraction(3), Fraction(1, 2)):
                    yield "factor", place, times(part, factor)
        if isinstance(part, Pow):
            exponent = constant(part.exponent) or Fraction(0)
            for other in (exponent + 1, exponent - 1):
                if other:
                    yield "exponent", place, part.base if other == 1 else Pow(part.base, number(other))
        if isinstance(part, Sym):
            if not isinstance(parent, Pow):
                yield "exponent", place, Pow(part, number(2))
            for other_name in scope.family(part.name):
                if scope.is_slip(part.name, other_name):
                    yield "index", place, Sym(other_name)


def plant(subject: Subject, rng: random.Random) -> Planted | None:
    formula = subject.row.printed
    assert formula is not None
    index = rng.randrange(len(cells(formula)))
    cell = cells(formula)[index]
    found = list(slips_of(cell, subject.bench.scope(subject.row)))
    if isinstance(formula, Equality) and index == 0 and isinstance(cell, Sym):
        # where it is held against an expression, a symbol on the left only names what is on the right
        known = isinstance(subject.target.trees, Relation)
        found = [slip for slip in found if slip[0] == "index" and known]
    if not found:
        return None
    kind = rng.choice(sorted({slip[0] for slip in found}))
    _, place, new = rng.choice([slip for slip in found if slip[0] == kind])
    return Planted(kind, with_cell(formula, index, replaced(cell, place, new)))


def value(node: Node, at: dict[str, complex]) -> complex:
    """A value by floating-point arithmetic: a third route, of neither engine."""
    if isinstance(node, Num):
        return complex(float(node.value))
    if isinstance(node, Sym):
        return {"I": 1j, "pi": complex(math.pi)}.get(node.name) or at[node.name]
    parts = [value(child, at) for child in children(node)]
    if isinstance(node, Neg):
        return -parts[0]
    if isinstance(node, Add):
        return sum(parts)
    if isinstance(node, Mul):
        return math.prod(parts)
    if isinstance(node, Div):
        return parts[0] / parts[1]
    if isinstance(node, Pow):
        return parts[0] ** parts[1]
    assert isinstance(node, Call)
    plain = [part.real for part in parts]
    known = {
        "sqrt": math.sqrt,
        "sin": math.sin,
        "cos": math.cos,
        "exp": math.exp,
        "min": min,
        "max": max,
        "log": math.log,
    }
    return complex(known[node.function](*plain))


def equivalent(subject: Subject, formula: Formula, rng: random.Random) -> bool:
    """Whether a planted slip changes nothing: shown by numbers, at random values of all symbols.

    An equation may be multiplied by what never vanishes: the quotient of old and new depends on positive symbols alone.
    """
    meanings = subject.bench.meanings(subject.row)
    original = subject.row.printed
    assert original is not None
    names = sorted(set().union(*(symbols(meaning) for meaning in meanings.values())))
    fixed = {name: complex(rng.uniform(0.5, 1.5)) for name in names if name in subject.bench.names.positive}
    ratios = []
    for _ in range(4):
        ours = {name: complex(rng.uniform(0.5, 1.5)) for name in names} | fixed
        theirs = {name: value(meaning, ours) for name, meaning in meanings.items()}
        before, after = ([value(cell, theirs) for cell in cells(f)] for f in (original, formula))
        if isinstance(original, Equality):
            gaps = [one - other for one, other in (before, after)]
            if abs(gaps[0]) < 1e-12:
                ratios.append(1.0 if abs(gaps[1]) < 1e-12 else math.inf)
            else:
                ratios.append(abs(gaps[1] / gaps[0]))
        elif len(before) == 1:
            ratios.append(1.0 if abs(before[0] - after[0]) < 1e-9 * (1 + abs(before[0])) else math.inf)
        else:  # eigenvalues in any order, any basis of a null space: their plans prove it
            return True
    return 0 < max(ratios) < math.inf and max(ratios) - min(ratios) <= 1e-9 * max(ratios)


def is_exact(found: Remedy | None) -> bool:
    """Whether one edit of one place, and no replacement of a whole, puts it right."""
    if found is None or found.exchange or len(found.edits) != 1:
        return False
    edit = found.edits[0][1]
    return edit.times == 1 and edit.change not in (Change.TERM, Change.ENTRY)


def census(subjects: Sequence[Subject], count: int, seed: int) -> tuple[int, int, list[str]]:
    """Of so many planted slips, how many were caught and how many named exactly; and what was not."""
    rng, caught, exact, rest = random.Random(seed), 0, 0, []
    planted = 0
    while planted < count:
        subject = rng.choice(subjects)
        slip = plant(subject, rng)
        if slip is None:
            continue
        tried = ways(subject, slip.formula)
        if any(way.is_right(way.printed) for way in tried):
            if not equivalent(subject, slip.formula, rng):
                planted += 1
                rest.append(f"missed: {slip.kind} in {subject.row.key}: {slip.formula}")
            continue
        planted, caught = planted + 1, caught + 1
        found = next((fix for way in tried if (fix := remedy(way)) is not None), None)
        if is_exact(found):
            exact += 1
        else:
            rest.append(f"not named: {slip.kind} in {subject.row.key}: {slip.formula}")
    return caught, exact, rest


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.study) for seed in range(1, 5))])
def test_a_hundred_random_slips_are_caught_and_named(subjects: list[Subject], seed: int) -> None:
    caught, exact, rest = census(subjects, 100, seed)
    assert caught >= 99, rest
    assert exact >= 90, rest


def test_means_give_way_to_one_end_wherever_they_stand():
    formula = reading.expression("a*(0.5*(p + q))**2 + b*0.5*(r + s)*c - 0.5*(p + 2*q)")
    found = [written(edit.result) for edit in mean_edits(formula)]
    assert found == [written(reading.expression(f"a*{x}**2 + b*{y}*c - 0.5*(p + 2*q)")) for x, y in ("pr", "qs")]
    assert not list(mean_edits(reading.expression("2*(p + q)")))
