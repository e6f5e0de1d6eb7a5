"""Single rows, and rows beside each other: what is right, what differs, what follows from what."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing import quantities
from satsym.formula.reading import expression
from satsym.status import BadInput
from tests.support.ledgers import HAMILTONIAN, TANGENTIAL, judged, ledger, row

FREE = """
format = 1
[document]
key = "free"
title = "Nothing derived"
[symbols]
s = ""
w = { unit = "1/s", positive = true }
[scope.main]
s = "s"
w = "w"
a = "a"
b = "b"
h = "h"
y = "y"
k1 = "k1"
k2 = "k2"
k3 = "k3"
k4 = "k4"
"""


@pytest.fixture(scope="module")
def satellite(tmp_path_factory: pytest.TempPathFactory) -> dict[str, auditing.Judged]:
    """Rows about the satellite in polar coordinates."""
    right = "d_x4 = -2*x2*x4/x1 + u2/x1"
    rows = [
        row("same order", right, TANGENTIAL),
        row("other way round", "(u2 - 2*x2*x4)/x1 = d_x4", TANGENTIAL),
        row("right-hand side alone", "(u2 - 2*x2*x4)/x1", TANGENTIAL),
        row("multiplied by a mass", "m*x1*d_x4 = m*(u2 - 2*x2*x4)", TANGENTIAL),
        row("all on one side", "x1*d_x4 + 2*x2*x4 - u2 = 0", TANGENTIAL),
        row("multiplied by what may vanish", "x2*x1*d_x4 = x2*(u2 - 2*x2*x4)", TANGENTIAL),
        row("defined constant", "d_x2 = x1*x4**2 - g/x1**2 + u1", "polar_orbit:first_order.r_dot"),
        row("its value", "d_x2 = x1*x4**2 - sigma**3*omega**2/x1**2 + u1", "polar_orbit:first_order.r_dot"),
        row("stationarity", "c2*u2 + lambda4/x1 = 0", "polar_orbit:stationarity.u2"),
        row("stationarity, zero first", "0 = -c2*u2 - lambda4/x1", "polar_orbit:stationarity.u2"),
        row("bounds", "min(1, max(0, -lambda2/c1))", "subs(at('polar_orbit:control_law.u1'), u1_min=0, u1_max=1)"),
        row("bounds, inner first", "max(0, min(1, -lambda2/c1))", "min(1, max(0, -lambda_r_dot/c1))"),
        row("second derivative", "c1", "diff(at('polar_orbit:hamiltonian.H'), u1, u1)"),
        row("declared", "(c1*u1**2 + c2*u2**2)/2", "at('polar_orbit:declared.L')"),
        row("solved", "x2 = (u2 - x1*d_x4)/(2*x4)", TANGENTIAL),
        row(
            "matrix",
            [["0", "1"], ["1", "0"], ["0", "0"], ["0", "0"]],
            "matrix([[0, 1], [1, 0], [0, 0], [0, 0]])",
            "matrix",
        ),
        row(
            "column",
            ["x2", "x1*x4**2 - g/x1**2", "x4", "-2*x2*x4/x1"],
            "subs(matrix([at('polar_orbit:first_order.r'), at('polar_orbit:first_order.r_dot'), "
            "at('polar_orbit:first_order.theta'), at('polar_orbit:first_order.theta_dot')]), u1=0, u2=0)",
            "matrix",
        ),
        row(
            "B",
            [["0", "0"], ["1", "0"], ["0", "0"], ["0", "1/x1"]],
            "polar_orbit:linearisation.B",
            "matrix",
        ),
        row(
            "B, other order",
            [["0", "0"], ["0", "0"], ["1", "0"], ["0", "1/(x1 + sigma)"]],
            "polar_orbit:linearisation.B",
            "matrix",
            scope="deviations",
        ),
        row("size", [["0", "1"]], "polar_orbit:linearisation.B", "matrix"),
        row("defined by both", "x1 = r - sigma", "k = r - sigma", scope="deviations"),
        row("defined otherwise", "x1 = r + sigma", "k = r - sigma", scope="deviations"),
        row("another letter", "d_x1 = x2", "polar_orbit:first_order.theta", scope="deviations"),
        row("no angle", "x2*(sin(x1)**2 + cos(x1)**2)", "polar_orbit:first_order.r"),
        row("km5", "km^5/s^2", "mu", "unit"),
        row("km3", "km^3/s^2", "mu", "unit"),
        row("newton", "N", "m*u1", "unit"),
        row("lost page", "", "", legible=False, says="the page is torn"),
    ]
    return judged(tmp_path_factory.mktemp("satellite"), rows)


@pytest.mark.parametrize(
    "key",
    [
        "same order",
        "other way round",
        "right-hand side alone",
        "multiplied by a mass",
        "all on one side",
        "defined constant",
        "its value",
        "stationarity",
        "stationarity, zero first",
        "bounds",
        "second derivative",
        "declared",
        "solved",
        "matrix",
        "column",
        "B",
        "B, other order",
        "defined by both",
        "km3",
    ],
)
def test_what_is_right_is_confirmed_however_it_is_written(satellite: dict[str, auditing.Judged], key: str) -> None:
    assert (satellite[key].verdict, satellite[key].diagnosis) == ("confirmed", "")


@pytest.mark.parametrize("key", ["multiplied by what may vanish", "defined otherwise", "another letter"])
def test_what_only_looks_alike_is_not_confirmed(satellite: dict[str, auditing.Judged], key: str) -> None:
    assert satellite[key].verdict == "misprint"


def test_a_matrix_of_another_size_is_told(satellite: dict[str, auditing.Judged]) -> None:
    assert "the printed matrix is 1 by 2, but should be 4 by 2" in satellite["size"].diagnosis


def test_a_unit_of_another_dimension_is_a_unit_error(satellite: dict[str, auditing.Judged]) -> None:
    found = satellite["km5"]
    assert found.verdict == "unit error"
    assert "[length]^5/[time]^2; it should be [length]^3/[time]^2" in found.diagnosis
    assert satellite["newton"].verdict == "confirmed"


def test_a_right_formula_with_impossible_dimensions_is_a_unit_error(satellite: dict[str, auditing.Judged]) -> None:
    found = satellite["no angle"]
    assert found.verdict == "unit error"
    assert "numerically right" in found.diagnosis
    assert "[length], but" in found.diagnosis


def test_what_cannot_be_read_is_not_judged(satellite: dict[str, auditing.Judged]) -> None:
    assert satellite["lost page"].verdict == "illegible"
    assert "the page is torn" in satellite["lost page"].diagnosis


def chain(
    tmp_path: Path, hamiltonian: str, costate: str, start: str = "d_x2 = x1*x4**2 - g/x1**2 + u1"
) -> dict[str, str]:
    rows = [
        row("state", start, "polar_orbit:first_order.r_dot"),
        row("H", hamiltonian, "polar_orbit:hamiltonian.H"),
        row("costate", costate, "polar_orbit:costate_equations.r_dot", **{"from": "-diff(row['H'], x2)"}),
    ]
    return {key: found.verdict for key, found in judged(tmp_path, rows).items()}


RIGHT_COSTATE = "d_lambda2 = -(lambda1 - 2*x4/x1*lambda4)"
WRONG_H = HAMILTONIAN.replace("lambda4*(-2", "lambda4*(2")


def test_right_rows_that_follow_are_confirmed(tmp_path: Path) -> None:
    assert chain(tmp_path, HAMILTONIAN, RIGHT_COSTATE)["costate"] == "confirmed"


def test_a_slip_that_what_follows_does_not_use_is_a_misprint(tmp_path: Path) -> None:
    found = chain(tmp_path, WRONG_H, RIGHT_COSTATE)
    assert (found["H"], found["costate"]) == ("misprint", "confirmed")


def test_a_slip_that_is_carried_on_is_wrong(tmp_path: Path) -> None:
    found = chain(tmp_path, WRONG_H, RIGHT_COSTATE.replace("- 2*", "+ 2*"))
    assert (found["H"], found["costate"]) == ("wrong", "misprint")


def test_a_right_result_that_does_not_follow_is_unsound(tmp_path: Path) -> None:
    rows = [
        row("H", HAMILTONIAN, "polar_orbit:hamiltonian.H"),
        row("costate", RIGHT_COSTATE, "polar_orbit:costate_equations.r_dot", **{"from": "diff(row['H'], x2)"}),
    ]
    found = judged(tmp_path, rows)["costate"]
    assert found.verdict == "unsound"
    assert "does not follow from H" in found.diagnosis


@pytest.mark.parametrize("holds", ["u1/(r - r)", "d_r = 1/(r - r)"])
def test_nothing_is_held_against_a_division_by_zero(tmp_path: Path, holds: str) -> None:
    with pytest.raises(BadInput, match=r"row x: the expression in `holds` divides by zero"):
        judged(tmp_path, [row("x", "u1", holds)])


@pytest.mark.parametrize("derivation", ["u1/(row['H'] - row['H'])", "d_x1 = u1/(row['H'] - row['H'])"])
def test_nothing_follows_from_a_division_by_zero(tmp_path: Path, derivation: str) -> None:
    rows = [
        row("H", HAMILTONIAN, "polar_orbit:hamiltonian.H"),
        row("costate", RIGHT_COSTATE, "polar_orbit:costate_equations.r_dot", **{"from": derivation}),
    ]
    found = judged(tmp_path, rows)["costate"]
    assert found.verdict == "unsound"
    assert "does not follow from H" in found.diagnosis


def test_a_slip_that_is_carried_on_is_wrong_even_where_the_document_has_it_right_elsewhere(tmp_path: Path) -> None:
    rows = [
        row("first", "d_x4 = -(2*x2*x4 + u2)/x1", TANGENTIAL),
        row("second", "d_x4 = (u2 - 2*x2*x4)/x1", TANGENTIAL),
        row("third", "d_x4 = -(2*x2*x4 + u2)/x1", TANGENTIAL, **{"from": "row['first']"}),
    ]
    found = judged(tmp_path, rows)
    assert [entry.verdict for entry in found.values()] == ["wrong", "confirmed", "misprint"]
    assert "right form in second" in found["first"].diagnosis
    assert "propagates to third" in found["first"].diagnosis
    assert "The same slip occurs in third" in found["first"].diagnosis
    assert "follows from first as printed, and contains no other error" in found["third"].diagnosis


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> dict[str, auditing.Judged]:
    """Rows that need no derivation."""
    a = "matrix([[0, 1, 0], [-w**2, 0, 0], [0, 0, 0]])"
    rows = [
        row("roots", ["-I*w", "0", "I*w"], f"eigenvalues({a})", "matrix"),
        row("roots, one wrong", ["-I*w", "0", "2*I*w"], f"eigenvalues({a})", "matrix"),
        row("roots, one lost", ["-I*w", "I*w"], f"eigenvalues({a})", "matrix"),
        row("kernel", [["0"], ["0"], ["5"]], f"nullspace({a})", "matrix"),
        row("kernel, wrong", [["0"], ["1"], ["0"]], f"nullspace({a})", "matrix"),
        row("kernel, too short", [["0"], ["5"]], f"nullspace({a})", "matrix"),
        row("characteristic", "s**3 + w**2*s", f"charpoly({a}, s)"),
        row("rank", "2", f"rank({a})", "number"),
        row("rank, wrong", "3", f"rank({a})", "number"),
        row("controllable", "3", "rank(controllability(matrix([[0,1,0],[0,0,1],[0,0,0]]), matrix([0,0,1])))", "number"),
        row("observable", "1", "rank(observability(matrix([[0,1],[0,0]]), matrix([[0,1]])))", "number"),
        row("step", "y + h/6*(k1 + 2*k2 + 2*k3 + k4)", "y + h*rk4_increment(k1, k2, k3, k4)"),
        row("step, wrong", "y + h/6*(k1 + k2 + 2*k3 + k4)", "y + h*rk4_increment(k1, k2, k3, k4)"),
        row("inverse", [["1/a", "0"], ["0", "1/b"]], "inverse(matrix([[a, 0], [0, b]]))", "matrix"),
        row("determinant", "a*b - 1", "det(matrix([[a, 1], [1, b]]))"),
        row("product", [["b", "0"]], "matrix([[a, b]]) @ matrix([[0, 1], [1, 0]]) - matrix([[0, a]])", "matrix"),
        row("equal for real numbers only", "s**2*(s**2 + w) = 0", "s**2*(s**2 + w**2) = 0"),
        row("line of a program", "h*(y + h*k1)", "h*(y + k1)", "algorithm"),
    ]
    return judged(tmp_path_factory.mktemp("free"), rows, FREE)


@pytest.mark.parametrize(
    "key",
    "roots kernel characteristic rank controllable observable step inverse determinant product".split(),
)
def test_matrices_and_what_is_made_of_them(free: dict[str, auditing.Judged], key: str) -> None:
    assert free[key].verdict == "confirmed"


def test_a_column_of_another_length_is_no_kernel(free: dict[str, auditing.Judged]) -> None:
    assert free["kernel, too short"].verdict == "misprint"
    assert "the printed columns have 2 entries, but should have 3" in free["kernel, too short"].diagnosis


@pytest.mark.parametrize(
    "key", ["roots, one wrong", "roots, one lost", "kernel, wrong", "step, wrong", "equal for real numbers only"]
)
def test_matrices_that_differ_are_not_confirmed(free: dict[str, auditing.Judged], key: str) -> None:
    assert free[key].verdict == "misprint"


def test_a_false_number_and_a_false_line_of_a_program_are_wrong(free: dict[str, auditing.Judged]) -> None:
    assert (free["rank, wrong"].verdict, free["rank, wrong"].derived) == ("wrong", "2")
    assert free["line of a program"].verdict == "wrong"


NUMBERS = {
    "exact": ("35786 km", "(mu_earth*(sidereal_day/(2*pi))**2)**(1/3) - R_earth", "confirmed"),
    "rounded": ("35790 km", "altitude", "confirmed"),
    "rounded to thousands": ("36000 km", "altitude", "confirmed"),
    "other unit": ("22236 mi", "altitude", "confirmed"),
    "one off": ("35787 km", "altitude", "imprecise"),
    "two off": ("35788 km", "altitude", "wrong"),
    "cut off": ("0.66 m", "h*2/3", "confirmed"),
    "a rounded input": ("0.68 m", "about*2/3", "confirmed"),
    "more than a rounded input leaves open": ("0.61 m", "about*2/3", "wrong"),
    "of a school book": ("3.000e6 m", "c_light*one/100", "imprecise"),
    "decimals count": ("0.50 m", "h/2", "confirmed"),
    "decimals count, too": ("0.5 m", "h*0.54", "confirmed"),
    "and are held to": ("0.50 m", "h*0.54", "wrong"),
    "dimension": ("35786 s", "altitude", "unit error"),
    "power of ten": ("3.0e8 m/s", "c_light", "confirmed"),
    "angle": ("57.3 deg", "1", "confirmed"),
}


@pytest.mark.parametrize("key", NUMBERS)
def test_numbers_are_held_to_what_their_digits_claim(tmp_path: Path, key: str) -> None:
    printed, holds, verdict = NUMBERS[key]
    head = FREE + '[inputs]\naltitude = "35786.03 km"\n'
    found = judged(
        tmp_path, [row("it", printed, holds, "number", inputs={"h": "1 m", "about": "~ 1.0 m", "one": "1 s"})], head
    )["it"]
    assert found.verdict == verdict
    assert ("customary value c_light = 3e8 m/s" in found.diagnosis) == (key == "of a school book")


@pytest.mark.parametrize(
    ("text", "value", "half"),
    [("35800", 35800, 50), ("35800.", 35800, 0.5), ("0.050", 0.05, 0.0005), ("-2e3 m", -2000, 500)],
)
def test_what_printed_digits_claim(text: str, value: float, half: float) -> None:
    found = quantities.printed_number(text)
    assert (float(found.value), float(found.half_unit)) == (value, half)


@pytest.mark.parametrize(
    ("text", "inputs", "expected"),
    [
        ("x*(1 - x)", {"x": "~ 0.5"}, (0.45 * 0.55, 0.25)),
        ("(x - 3)**2 + (y - 3)**2", {"x": "~ 3", "y": "~ 3"}, (0.0, 0.5)),
        ("sin(40*x) + y", {"x": "~ 0.3", "y": "~ 1.0"}, (0.95 - 1.0, 1.05 + math.sin(14.0))),
        ("+".join(f"x{k}" for k in range(12)), {f"x{k}": "~ 1" for k in range(12)}, (6.0, 18.0)),
        ("a*b/c", {"a": "~ 2 km", "b": "3", "c": "~ 4 s"}, (1500 * 3 / 4.5, 2500 * 3 / 3.5)),
        ("a + b", {"a": "2", "b": "3"}, (5.0, 5.0)),
    ],
)
def test_rounded_inputs_may_be_anywhere_in_their_intervals(
    text: str, inputs: dict[str, str], expected: tuple[float, float]
) -> None:
    assert quantities.bounds(expression(text), inputs) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_quantities_of_different_dimensions_are_not_added() -> None:
    with pytest.raises(BadInput, match="different dimensions"):
        quantities.evaluated(expression("a + b"), {"a": "1 km", "b": "1 s"})


def test_propositions_judge_claims_tables_and_algorithms(tmp_path: Path) -> None:
    rows = [
        row("true", "len(LINEAR) > 3", "", "claim"),
        row("false", "len(LINEAR) < 3", "", "claim"),
        row("by luck", "len(LINEAR) > 3", "", "claim", because="len(LINEAR) < 3"),
        row("of nothing", "all(implies(dimension(S) > 99, stable(S)) for S in LINEAR)", "", "claim"),
        row("made by the program", "len(LINEAR) == 1", "", "claim", produced="len(LINEAR) > 1"),
        row("table", [["1", "2"]], "all(quantity(a) < quantity(b) for a, b in printed)", "table", columns=["a", "b"]),
        row("digit", "abs(-2.04) == '2.05'", "", "claim", why="it is {abs(-2.04)}"),
    ]
    found = judged(tmp_path, rows, FREE)
    verdicts = ["confirmed", "wrong", "unsound", "unsound", "artefact", "confirmed", "imprecise"]
    assert [entry.verdict for entry in found.values()] == verdicts
    assert "len(LINEAR) = " in found["false"].diagnosis
    assert found["digit"].why == "It is 2.04."
    assert found["table"].printed == (("1", "2"),)


@pytest.mark.parametrize(
    ("printed", "holds", "reason"),
    [
        ("never(1) == 2", "", "unknown"),
        ("rank() == 2", "", "missing a required"),
        ("it will be stable", "", "not a proposition"),
        ("rank(1) == a_letter", "", "is unknown here"),
        ("1 == 1", "rank(1) == 1", "leave out `holds`"),
        ("text['nowhere'] == 'x'", "", "no row"),
    ],
)
def test_propositions_are_checked_before_anything_is_measured(
    tmp_path: Path, printed: str, holds: str, reason: str
) -> None:
    with pytest.raises(BadInput, match=reason):
        ledger(tmp_path, [row("claim", printed, holds, "claim")], FREE)


def test_a_letter_with_two_meanings_is_found(tmp_path: Path) -> None:
    rows = [row(x, f"len(meanings['{x}']) == 1", "", "claim", role="notation") for x in ("x1", "x2")]
    found = judged(tmp_path, rows)
    assert [entry.verdict for entry in found.values()] == ["notation", "confirmed"]
    assert "len(meanings['x1']) = 2" in found["x1"].diagnosis


def test_any_expression_may_stand_on_the_right_of_what_is_held_against_zero(tmp_path: Path) -> None:
    forms = {
        "zero": "c2*u2 + lambda4/x1 = 0",
        "one": "c2*u2 + lambda4/x1 = 1",
        "moved": "c2*u2 = -lambda4/x1",
        "moved amiss": "c2*u2 = lambda4/x1",
    }
    slope = "diff(at('polar_orbit:hamiltonian.H'), u2)"
    found = {key: judged(tmp_path, [row(key, form, slope)])[key] for key, form in forms.items()}
    assert [entry.verdict for entry in found.values()] == ["confirmed", "misprint", "confirmed", "misprint"]
    assert "the term `+1` is missing" in found["one"].diagnosis
    assert "the sign of `c2*u2` is reversed" in found["moved amiss"].diagnosis


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        (row("1", "x2", "polar_orbit:first_order.nothing"), 'has no "nothing"'),
        (row("1", "x2", "polar_orbit:nothing.r"), 'no step "nothing"'),
        (row("1", "x2", "polar_orbit:declared.nothing"), "no declared variable has this name"),
        (row("1", [["x1"]], "polar_orbit:first_order.r", "matrix"), "compare it with a matrix"),
        (row("1", "x2", "solve(x**2 - r, r_dot)"), "is not a name"),
        (row("1", "x2", "solve(r_dot**2 - r, r_dot)"), "linear in r_dot"),
        (row("1", "x2", "solve(sigma/r - r_dot, r)"), "linear in r"),
        (row("1", "x2", "det(matrix([[1, 2]]))"), "requires a square matrix"),
        (row("1", "x2", "matrix([[1, 2]]) @ matrix([[1, 2]])"), "a 1 by 2 matrix cannot be multiplied by a 1 by 2"),
        (row("1", "2", "at('polar_orbit:first_order.r')", "number"), "which is not a number"),
    ],
)
def test_what_cannot_be_compared_is_bad_input_with_its_line(
    tmp_path: Path, entry: dict[str, object], reason: str
) -> None:
    with pytest.raises(BadInput, match=r"small\.toml:\d+: row 1: ") as refusal:
        judged(tmp_path, [entry])
    assert reason in str(refusal.value)
