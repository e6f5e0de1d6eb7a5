"""What a row of a ledger may take is counted: more is refused in one line that names the row, and less is judged."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from satsym.auditing.measurements import programs
from satsym.auditing.program import run as program_run
from satsym.auditing.program import text as program
from satsym.cli import main
from satsym.formula import budget, reading, weight, writing
from satsym.formula.budget import Limit, OverBudget
from satsym.formula.tree import Mul, Node, Sym
from tests.bench.fuzz_ledgers import audited
from tests.support.ledgers import HEAD, Row, row, text

PRELUDE = ("import numpy as np", "from scipy.integrate import solve_ivp", "from scipy.linalg import eig")
TWICE = "diff(sin(exp(cos(tan(r))))**20*exp(sin(r)*theta), r, r, r, r, r, r, r, r, r, r)"


def refused(folder: Path, capsys: pytest.CaptureFixture[str], rows: list[Row], head: str = HEAD) -> str:
    """The one line with which a ledger is refused."""
    path = folder / "ledger.toml"
    path.write_text(text(rows, head), encoding="utf-8")
    assert main(["audit", str(path), "--fresh"]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    return line


@pytest.mark.parametrize(
    ("printed", "holds", "complaint"),
    [
        ("x1*exp(exp(exp(20)))", "r", "printed: takes exp(...) of numbers larger"),
        ("sin(exp(exp(20)))", "r", "printed: takes exp(...) of numbers larger"),
        ("exp(exp(exp(exp(x1))))", "r", "printed: takes exp(...) of numbers larger"),
        ("x1", "subs(exp(r), r=exp(exp(20)))", "holds: takes exp(...) of numbers larger"),
        ("x1", "subs(exp(exp(r)), r=exp(exp(r)))", "takes exp(...) of numbers larger"),
        ("x1", "subs((r+theta)**12, r=(r-theta)**12)", "too large when multiplied out"),
        pytest.param("x1", TWICE, "parts after abbreviations are replaced", marks=pytest.mark.study),
        ("sin(1000000*x1)", "2*sin(500000*r)*cos(500000*r)", "takes more than 25,000,000 operations"),
    ],
)
def test_a_formula_that_grows_without_end_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], printed: str, holds: str, complaint: str
) -> None:
    line = refused(tmp_path, capsys, [row("7", printed, holds)])
    assert complaint in line
    assert "row 7" in line


@pytest.mark.parametrize(("rule", "complaint"), [("a{0}*a{0}", "multiplied out"), ("sin(a{0})", "deep")])
def test_abbreviations_that_double_one_another_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rule: str, complaint: str
) -> None:
    entries = "".join(f'\na{i} = "{rule.format(i - 1)}"' for i in range(1, 200))
    head = HEAD.replace("\n[inputs]", f'\n[derived]\na0 = "r + theta"{entries}\n\n[inputs]')
    assert complaint in refused(tmp_path, capsys, [row("7", "x1", "a199")], head)


def test_a_number_of_a_thousand_digits_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = refused(tmp_path, capsys, [row("7", "1" * 5000 + " km", "altitude", "number")])
    assert "more than 30 digits" in line
    assert "row 7" in line


ENDLESS = [
    ("def f(t, y):", "    return np.sqrt(y)", "x = solve_ivp(f, (1, 1e18), np.zeros(200))"),
    ("b = np.eye(150)", "ok = all(len(eig(b)) > 1 for x in np.zeros(999))"),
    ("a = 'ab'", *["a = f'{a}{a}'"] * 40),
    ("a = [1, 2]", *["a = [a, a]"] * 40),
    ("v = np.zeros((1, 99999)) <= np.zeros((99999, 1))",),
    ("v = np.zeros((1, 99999, 1, 1)) + np.zeros((99999, 1, 99999, 1)) + np.zeros((1, 1, 1, 99999))",),
    ("i = [0, 0, 0, 0, 0, 0, 0, 0]", "v = np.zeros((2, 40000))[i]"),
    ("v = np.zeros((1000000, 1000000))",),
    ("t = np.linspace(0, 1, 1000000000)",),
    ("x = " + "+".join(["1"] * 800),),
    ("def g(n):", "    return g(n)", "x = g(1)"),
]


@pytest.mark.parametrize("lines", ENDLESS)
def test_a_program_without_end_is_no_program_that_stops(lines: tuple[str, ...]) -> None:
    listing = program.read([*PRELUDE, *lines])
    with pytest.raises(OverBudget):
        program_run.run(listing)


@pytest.mark.parametrize(
    "lines",
    [
        ("def f(t, y):", "    return np.sqrt(y)", "x = solve_ivp(f, (1, 1e18), [1.0], rtol=1e-12, atol=1e-12)"),
        ("ok = all(all(y == y for y in np.zeros(99999)) for x in np.zeros(99999))",),
    ],
)
def test_work_is_counted_in_whatever_library_it_goes_on(lines: tuple[str, ...]) -> None:
    with pytest.raises(OverBudget, match="operations"):
        budget.within(Limit(200_000), lambda: program_run.run(program.read([*PRELUDE, *lines])))


def test_what_cannot_be_walked_through_is_not_called_wrong() -> None:
    with pytest.raises(OverBudget):
        programs.stops(["a = 'ab'", *["a = f'{a}{a}'"] * 40])


def test_counting_is_exact_and_ends_with_the_work() -> None:
    spent: list[int] = []
    for _ in range(2):
        budget.within(Limit(10_000), lambda: [abs(i) for i in range(1000)], spent.append)
    assert spent[0] == spent[1]
    assert 2000 <= spent[0] <= 2100
    assert sys.getprofile() is None
    with pytest.raises(OverBudget, match="more than 1,000 operations"):
        budget.within(Limit(1000), lambda: [abs(i) for i in range(1000)])
    assert sys.getprofile() is None
    assert budget.within(Limit(10_000), lambda: 1) == 1


def test_a_handler_of_mere_exceptions_does_not_swallow_the_end() -> None:
    def stubborn() -> None:
        while True:
            try:
                abs(1)
            except Exception:
                continue

    with pytest.raises(OverBudget):
        budget.within(Limit(1000), stubborn)


def test_numbers_are_counted_beside_calls() -> None:
    with pytest.raises(OverBudget, match="more than 10 numbers"):
        budget.within(Limit(1000, 10), lambda: budget.charge(numbers=11))
    budget.charge(numbers=10**12)  # where nothing is counted


def test_exempt_work_is_not_counted() -> None:
    def work() -> None:
        with budget.exempt():
            for i in range(5000):
                abs(i)
        abs(1)

    spent: list[int] = []
    budget.within(Limit(100), work, spent.append)
    assert 0 < spent[0] <= 100

    def counted_again() -> None:
        work()
        for i in range(200):
            abs(i)

    with pytest.raises(OverBudget):
        budget.within(Limit(100), counted_again)


def test_rows_share_what_a_ledger_may_take() -> None:
    allowance = budget.Allowance(left=1500)
    allowance.within(Limit(1200), lambda: [abs(i) for i in range(500)])
    with pytest.raises(OverBudget):
        allowance.within(Limit(1200), lambda: [abs(i) for i in range(500)])


def test_a_shared_part_is_weighed_once_and_counted_as_often_as_it_is_printed() -> None:
    tree: Node = Sym("x")
    for _ in range(8):
        tree = Mul((tree, tree))
    found = weight.Scales().weight(tree)
    assert (found.nodes, found.depth, found.degree) == (2**9 - 1, 9, 2**8)
    with pytest.raises(OverBudget):
        weight.Scales().checked(Mul((tree, tree, Sym("y"))))


@pytest.mark.parametrize("text", ["exp(-t/0.000001)", "exp(10000)", "sin(1000000000*t)", "exp(exp(5))", "(a+b)**9/c"])
def test_what_people_print_is_light_enough(text: str) -> None:
    found = reading.expression(text)
    assert reading.expression(writing.written(found)) == found


@pytest.mark.parametrize(
    "seed", [*range(22), *(pytest.param(n, marks=pytest.mark.study) for n in (105, 140, 153, 394, 475))]
)
def test_a_ledger_that_nobody_would_write_ends_in_verdicts_or_in_one_line(seed: int, tmp_path: Path) -> None:
    assert not audited(seed, tmp_path).fault
