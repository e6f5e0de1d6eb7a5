"""Measured orders of numerical methods, and what printed lines of MATLAB do, against what is known of them."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.auditing import measurements
from satsym.auditing.propositions.values import Undecided
from satsym.status import BadInput

WORDS = measurements.words()
MEASURE = WORDS.functions
RK4 = WORDS.values["RK4"]()
X, U, LAMBDA = ["x1", "x2", "x3", "x4"], ["u1", "u2"], ["l1", "l2", "l3", "l4"]
STAGES = ["k1 = f(x_n, y_n)", "k2 = f(x_n + h/2, y_n + h/2*k1)", "k3 = f(x_n + h/2, y_n + h/2*k2)"]

METHODS = {
    "Runge and Kutta": (RK4, 4),
    "Heun": (WORDS.values["HEUN"](), 2),
    "Euler": (WORDS.values["EULER"](), 1),
    "the rule of three eighths": (
        [
            "k1 = f(x_n, y_n)",
            "k2 = f(x_n + h/3, y_n + h/3*k1)",
            "k3 = f(x_n + 2*h/3, y_n + h*(k2 - k1/3))",
            "k4 = f(x_n + h, y_n + h*(k1 - k2 + k3))",
            "y_n1 = y_n + h/8*(k1 + 3*k2 + 3*k3 + k4)",
        ],
        4,
    ),
    "Kutta's of order three": (
        [*STAGES[:2], "k3 = f(x_n + h, y_n - h*k1 + 2*h*k2)", "y_n1 = y_n + h/6*(k1 + 4*k2 + k3)"],
        3,
    ),
    "the middle of the step": ([*STAGES[:2], "y_n1 = y_n + h*k2"], 2),
    "equal weights": ([*RK4[:4], "y_n1 = y_n + h/4*(k1 + k2 + k3 + k4)"], 2),
    "half the slope": (["y_n1 = y_n + h/2*f(x_n, y_n)"], 0),
    "a slope for a step": (["y_n1 = y_n + f(x_n, y_n)"], -1),
}


@pytest.mark.parametrize("name", METHODS)
def test_methods_have_the_order_that_textbooks_give_them(name):
    lines, order = METHODS[name]
    assert MEASURE["order"](lines) == order


@pytest.mark.parametrize(
    ("unknown", "others", "model", "names"),
    [
        (X, U, "polar_orbit", (X, U)),
        (X, [], "clohessy_wiltshire", (X,)),
        (LAMBDA, [*X, *U], "polar_orbit", (X, U, LAMBDA)),
    ],
)
def test_the_method_for_several_unknowns_is_of_order_four_both_ways(unknown, others, model, names):
    lines = MEASURE["runge_kutta"](unknown, others, previous=unknown is LAMBDA)
    along = MEASURE["moving"](model, *names)
    assert MEASURE["order"](lines, along) == 4
    late = [line.replace("_n0h", "_n").replace("_nh", "_n") for line in lines]  # what else counts is taken from node n
    assert MEASURE["order"](late, along) == (1 if others else 4)


@pytest.mark.parametrize("amiss", [None, 0, 1, 2, 3])
def test_a_slip_in_an_argument_that_a_rate_of_the_model_lacks_shows_along_a_coupled_motion(amiss):
    method, signs = MEASURE["runge_kutta"](X, U), ["-" if k == amiss else "+" for k in range(4)]
    moved = ", ".join(f"{x}_n {sign} k3_{x}" for x, sign in zip(X, signs, strict=True))
    lines = MEASURE["with_line"](method, f"k4_{X[2]} = h*f3({moved}, {', '.join(f'{u}_n1' for u in U)})")
    alone, coupled = (MEASURE["order"](lines, MEASURE["moving"]("polar_orbit", X, U, coupled=c)) for c in (False, True))
    assert (alone == 4) is (amiss != 3)  # x3' = x4
    assert (coupled == 4) is (amiss is None)


def test_a_stage_that_adds_a_slope_without_the_step_spoils_the_method():
    assert MEASURE["order"](MEASURE["with_line"](RK4, "k3 = f(x_n + h/2, y_n + k2/2)")) == 0
    assert MEASURE["order"](MEASURE["with_line"](RK4, "k3 = f(x_n + h/2, y_n + h*k2/2)")) == 4


def test_a_method_that_says_nothing_has_no_order():
    with pytest.raises(Undecided, match="k1"):
        MEASURE["order"](["y_n1 = y_n + h*k1"])
    with pytest.raises(BadInput, match="next node"):
        MEASURE["order"](["k1 = f(x_n, y_n)"])
    with pytest.raises(BadInput, match="k5"):
        MEASURE["with_line"](RK4, "k5 = 0")


def test_the_error_of_one_step_of_euler_is_known():
    assert MEASURE["error"](["y_n1 = y_n + h*f(x_n, y_n)"], 1) == pytest.approx(abs(2.0 - np.exp(np.sin(1.0))))


def test_a_known_motion_moves_at_its_rates():
    along, t, h = MEASURE["moving"]("polar_orbit", X, U, LAMBDA), np.array([0.3, 0.8]), 1e-4
    at = {name: curve(t) for name, curve in along.part("curves").items()}
    arguments = [at[name] for name in (*LAMBDA, *X, *U)]
    for k, name in enumerate(LAMBDA, start=1):
        curve = along.part("curves")[name]
        np.testing.assert_allclose((curve(t + h) - curve(t - h)) / (2 * h), along.part(f"f{k}")(*arguments), rtol=1e-6)


def test_a_quotient_of_rows_is_the_least_squares_one_and_entry_by_entry_with_a_point():
    b, a = np.array([0.1, -0.4, 0.3]), np.array([1.0, 1.5, 2.0])
    whole = MEASURE["matlab"]("q=b/a;", a=a, b=b).part("q")
    assert whole == pytest.approx(np.linalg.lstsq(a[:, None], b, rcond=None)[0])
    assert MEASURE["matlab"]("q=b./(2.*a);", a=a, b=b).part("q") == pytest.approx(b / a / 2)
    assert MEASURE["matlab"]("q=b/2;", b=b).part("q") == pytest.approx(b / 2)


@pytest.mark.parametrize(("errors", "again"), [((0.02, 0.02), True), ((0.02, 0.0), False), ((-1.0, 0.5), False)])
def test_a_printed_loop_goes_round_again_while_both_conditions_hold(errors, again):
    found = MEASURE["matlab"](["tol=0.01;", "while((e1>tol)&&(e2>tol))"], e1=errors[0], e2=errors[1])
    assert found.part("again") is again


def test_names_are_used_early_where_a_later_line_gives_them_a_value():
    lines = ["x(i+1)=x(i)+k;", "k=(a+b)./6;"]
    assert MEASURE["used_early"](lines) == ["k"]
    assert MEASURE["used_early"](lines[::-1]) == []


def test_lines_that_would_stop_have_no_values():
    with pytest.raises(Undecided, match="b"):
        MEASURE["matlab"]("a=2.*b;")


def test_iterations_change_by_their_share():
    for member in WORDS.values["ITERATES"]():
        old, new = member.part("old"), member.part("new")
        assert np.abs(old - new).sum() == pytest.approx(member.part("share") * np.abs(new).sum())
