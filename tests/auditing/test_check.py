"""`satsym check`: one formula, right or wrong, in LaTeX or plain notation, and what is wrong in the same notation."""

from __future__ import annotations

import json
import time
from collections.abc import Callable

import pytest
import sympy as sp

import satsym
from satsym.cli import main
from satsym.formula import field
from satsym.formula import reading as safe
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def run_check(*arguments: str) -> tuple[int, str, str]:
        code = main(["check", *arguments])
        return code, *capsys.readouterr()

    return run_check


RIGHT = [
    ("hill", r"\ddot x - 2n\dot y - 3n^2x = 0", "hill:first_order.xi_dot"),
    ("hill", r"\ddot{x} = 3 n^2 x + 2 n \dot{y} + u_1", "hill:first_order.xi_dot"),
    ("hill", r"\frac{d^2 z}{dt^2} = -n^2 z", "hill:first_order.zeta_dot"),
    ("hill", r"2\ddot\eta + 4\omega\dot\xi = 2u_2", "hill:first_order.eta_dot"),
    ("hill", "x_ddot - 2 n y_dot - 3n^2 x = u1", "hill:first_order.xi_dot"),
    ("polar_orbit", r"\ddot r - r\dot\theta^2 = -\frac{\mu}{r^2}+u_1", "polar_orbit:first_order.r_dot"),
    ("polar_orbit", r"r\ddot\theta + 2\dot r\dot\theta = u_2", "polar_orbit:first_order.theta_dot"),
    ("polar_orbit", r"\frac{d}{dt}\left(r^2\dot\theta\right) = r u_2", "polar_orbit:first_order.theta_dot"),
    ("polar_orbit", r"\dot\lambda_r = -\frac{\partial H}{\partial r}", "polar_orbit:costate_equations.r"),
    ("polar_orbit", r"\dot x_1 = x_2", "polar_orbit:first_order.r"),
    ("polar_orbit", r"\lambda_r = k_1 r - k_1\sigma", "polar_orbit:boundary_conditions.lambda_r"),
    ("polar_orbit", r"u_2^* = -\frac{\lambda_{\dot\theta}}{c_2 r}", "polar_orbit:stationarity.u2_hat"),
    ("polar_orbit", "r^2 theta_dot^(1) = const", "polar_orbit:first_order.theta_dot"),
    ("polar_orbit", "d(r^2 theta_dot)/dt = r u2", "polar_orbit:first_order.theta_dot"),
    ("polar_orbit", "d lambda_r/dt = -dH/dr", "polar_orbit:costate_equations.r"),
    ("hill", "d2z/dt2 = -n^2 z", "hill:first_order.zeta_dot"),
    ("hill", r"\dot x = v", "hill:first_order.xi"),
    ("clohessy_wiltshire", r"\dot x = v", "clohessy_wiltshire:first_order.x1"),
    ("van_der_pol", "x1' = x2", "van_der_pol:first_order.x1"),
]


@pytest.mark.parametrize(("model", "formula", "address"), RIGHT)
def test_what_is_right_is_right_in_any_rearrangement(model: str, formula: str, address: str) -> None:
    found = satsym.check(formula, model)
    assert (found.verdict, found.address) == ("right", address)
    assert found


WRONG = [
    (
        "hill",
        r"\ddot x - 2n\dot y + 3n^2x = 0",
        "the sign of 3 n^2 x is reversed",
        r"\ddot x - 2 n \dot y - 3 n^2 x = 0",
    ),
    ("hill", r"\ddot{y} + n \dot x = 0", "n \\dot x should be 2 n \\dot x", r"\ddot y + 2 n \dot x = 0"),
    ("hill", "z_ddot = -n^3*z", "n^3 should be n^2", "z_ddot = -n^2*z"),
    (
        "polar_orbit",
        r"\dot\lambda_4 = -2\lambda_2x_1x_4-\lambda_3+\frac{2\lambda_4x_2}{x_1^2}",
        "x_1^2 should be x_1",
        r"\dot{\lambda}_4 = -2 \lambda_2 x_1 x_4 - \lambda_3 + \frac{2 \lambda_4 x_2}{x_1}",
    ),
    (
        "polar_orbit",
        r"\dot\lambda_r = \frac{\partial H}{\partial r}",
        "the sign of \\frac{\\partial H}{\\partial r} is reversed",
        r"\dot{\lambda}_r = -\frac{\partial H}{\partial r}",
    ),
    ("goddard", r"\dot m = \frac{T}{c}", "the sign", r"\dot m = -\frac{T}{c}"),
]


@pytest.mark.parametrize(("model", "formula", "diagnosis", "correct"), WRONG)
def test_what_is_wrong_is_named_in_the_notation_of_the_formula(
    model: str, formula: str, diagnosis: str, correct: str
) -> None:
    found = satsym.check(formula, model)
    assert found.verdict == "wrong"
    assert diagnosis in found.diagnosis
    assert found.correct == correct
    assert satsym.check(found.correct, model, found.letters).verdict == "right"


def test_letters_are_guessed_said_and_corrected(run: Run) -> None:
    code, out, err = run(r"\ddot x - 2n\dot y - 3n^2x = 0", "--model", "hill")
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "symbols interpreted as: x = xi, n = omega, y = eta, the uncontrolled motion (to correct one: --let "
        "LETTER=NAME)",
        "right: hill:first_order.xi_dot",
    ]
    code, out, _ = run(r"\ddot x - 2n\dot y - 3n^2x = 0", "--model", "hill", "--let", "n=sigma")
    assert code in (4, 5)
    assert "n = sigma" in out


def test_json_has_what_is_agreed(run: Run) -> None:
    code, out, _ = run(r"\ddot x - 2n\dot y + 3n^2x = 0", "--model", "hill", "--json")
    found = json.loads(out)
    assert code == 5
    keys = ["formula", "model", "letters", "free", "verdict", "address", "diagnosis", "correct"]
    assert list(found) == keys
    assert found["letters"] == {"x": "xi", "y": "eta", "n": "omega"}
    assert found["correct"] == {
        "latex": r"\ddot x - 2 n \dot y - 3 n^2 x = 0",
        "plain": "x_ddot - 2*n*y_dot - 3*n^2*x = 0",
    }


def test_several_equations_are_judged_one_by_one(run: Run) -> None:
    code, out, _ = run(
        r"\begin{aligned}\dot x_1 &= x_2 \\ \dot x_2 &= x_1x_4^2 - \frac{\mu}{x_1^2} - u_1\end{aligned}",
        "--model",
        "polar_orbit",
    )
    assert code == 5
    assert "right: polar_orbit:first_order.r\n" in out
    assert "wrong: the sign of u_1 is reversed" in out


@pytest.mark.parametrize(
    ("formula", "verdict", "address"),
    [
        (r"\lambda_r(t_f) = k_1(r(t_f) - \sigma)", "right", "boundary_conditions.lambda_r"),
        (r"\lambda_r(t_f) = -k_1(r(t_f) - \sigma)", "wrong", "boundary_conditions.lambda_r"),
        (r"\lambda_r(0) = k_1(r(0) - \sigma)", "undecided", ""),  # what holds at the end alone
        ("r(0) = r_0", "right", "boundary_conditions.r"),
        ("r(t_f) = r_0", "undecided", ""),  # what holds at the beginning alone
        (r"r(t) = r(0)\cos\omega t", "undecided", ""),  # about two times
        (r"0 \le r", "undecided", ""),
    ],
)
def test_what_is_said_of_one_end_is_held_against_the_conditions_there(formula: str, verdict: str, address: str) -> None:
    found = satsym.check(formula, "polar_orbit")
    assert found.verdict == verdict
    assert not address or found.address == f"polar_orbit:{address}"


@pytest.mark.parametrize("text", ["x" * 19999, "x^(" * 6000, "d" + "a" * 9000 + " " * 9000 + "/", "x = " + "1" * 15000])
def test_hostile_plain_notation_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(BadInput, match=r"more than .* \(character [0-9]+\)\Z"):
        satsym.check(text, "hill")


@pytest.mark.parametrize(("entry", "verdict"), [("-n^2", "right"), ("n^2", "wrong")])
def test_matrices_are_compared_entry_by_entry(entry: str, verdict: str) -> None:
    rows = [
        "0&0&0&1&0&0",
        "0&0&0&0&1&0",
        "0&0&0&0&0&1",
        "3n^2&0&0&0&2n&0",
        "0&0&0&-2n&0&0",
        f"0&0&{entry}&0&0&0",
    ]
    inside = r" \\ ".join(rows)
    found = satsym.check(r"A = \begin{pmatrix}" + inside + r"\end{pmatrix}", "hill")
    assert (found.verdict, found.address) == (verdict, "hill:linearisation.A")


@pytest.mark.parametrize(
    ("formula", "model", "reason"),
    [
        (r"\ddot x = \lim x", "hill", "a limit needs an arrow below it (character 11)"),
        (r"\ddot x = 3 +", "hill", "the formula is incomplete"),
        ("x = = 3", "hill", "an expression is missing after this sign (character 3)"),
        ("= 3", "hill", "an expression is missing before this sign (character 1)"),
        ("x ++ 3 = 0", "hill", "two signs stand side by side (character 4)"),
        ("(" * 3000, "hill", "not closed"),
        ("{" * 3000, "hill", ""),
        (r"\frac" * 5000, "hill", "longer than"),
        ("x" * 100_000, "hill", "longer than 20000 characters"),
        (r"x \iint 3", "hill", "integrals without a differential at the end are not supported (character 3)"),
        ("x\x00 = 1", "hill", "a character is invalid"),
        (r"\frac{x", "hill", ""),
        ("x_dot = v @ w", "hill", '"@" is not supported here'),
        ("x = 1", "nope", "no derivation"),
        ("x = 1", "../../etc/passwd", ""),
        ("", "hill", ""),
        ("__import__('os')", "hill", ""),
    ],
)
def test_what_cannot_be_read_is_told_in_one_line_with_the_place(
    run: Run, formula: str, model: str, reason: str
) -> None:
    begun = time.perf_counter()
    code, out, err = run(formula, "--model", model)
    assert (code, out) in ((3, ""), (4, out))
    assert reason in err + out
    assert "Traceback" not in err
    assert (err + out).count("\n") <= 2
    assert time.perf_counter() - begun < 20.0


def test_unknown_letters_are_undecided_and_named() -> None:
    found = satsym.check(r"\dot q_7 = \kappa q_7", "hill")
    assert found.verdict == "undecided"
    assert found.letters.keys() == {"q_7", r"\kappa"}


def test_a_letter_may_be_said_to_be_what_there_is_not() -> None:
    with pytest.raises(BadInput, match='"nope" is not a name of hill'):
        satsym.check("x = 1", "hill", {"x": "nope"})


def test_notebooks_show_mathematics() -> None:
    shown = satsym.check(r"\ddot z = n^2 z", "hill")._repr_latex_()
    assert shown.startswith("$$")
    assert r"\ddot z = -n^2 z" in shown


def test_indonesian_has_the_same(run: Run) -> None:
    code, out, _ = run(r"\ddot z = n^2 z", "--model", "hill", "--lang", "id")
    assert code == 5
    assert r"salah: tanda n^2 z terbalik; bentuk yang benar \ddot z = -n^2 z" in out


def test_capitals_that_are_read_as_a_product_are_told_and_may_be_one_name() -> None:
    printed = r"\ddot x - 2\omega\dot y - 3\omega^2x = SF"
    assert satsym.check(printed, "hill").letters["SF"] == "S*F"
    named = satsym.check(printed, "hill", let="SF=u1")
    assert named.verdict == "right"
    assert "SF" not in named.letters


@pytest.mark.parametrize("factor", ["c_1+c_2", "c_1+r", "-2", "r^2"])
def test_an_equation_times_what_never_vanishes_is_the_equation(factor: str) -> None:
    printed = rf"({factor})(\ddot r - r\dot\theta^2 + \frac{{\mu}}{{r^2}}) = ({factor})u_1"
    assert satsym.check(printed, "polar_orbit").verdict == "right"


def test_what_has_a_value_nowhere_is_found_at_the_first_point() -> None:
    with pytest.raises(field.Nowhere):
        field.Point("point").value(safe.expression("1/(x - x)"))
    with pytest.raises(field.Undecided):
        field.points_for([safe.expression("1/(x - x)")], "any")
    assert len(field.points_for([safe.expression("sqrt(x + y)")], "any")) == field.POINTS  # another point has a root


def test_numbers_rule_out_a_common_factor_before_sympy_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    original = formulas.nonvanishing_quotient

    def counted(one: sp.Expr, other: sp.Expr) -> sp.Expr | None:
        if other != 0:
            asked.append(one)
        return original(one, other)

    monkeypatch.setattr(formulas, "nonvanishing_quotient", counted)
    assert satsym.check(r"w = g\sin n + c^3", "hill").verdict == "undecided"
    assert not asked
