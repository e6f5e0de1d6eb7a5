"""The predicates behind the ITS ledgers can say yes and no: printed things that are put right, and others put wrong."""

from __future__ import annotations

from dataclasses import replace

import pytest

from satsym.auditing.predicates import Finding, Question, registry

ROW = Question("row", "claim", "", (), {}, "main", {})
ZEROS = tuple((a, b, "0.0000") for a, b in (("50", "10"), ("10", "50"), ("10", "10"), ("50", "50")))


def ask(name: str, lines: object = "", **arguments: object) -> Finding:
    """What a predicate finds, given a row if it wants one."""
    found = registry()[name]
    if "row" in found.__code__.co_varnames[: found.__code__.co_argcount]:
        arguments["row"] = replace(ROW, printed=lines)
    return found(**arguments)


@pytest.mark.parametrize(
    ("name", "yes", "no"),
    [
        ("stands_still", {"inclination": "0 deg", "eccentricity": "0"}, {"inclination": "3 deg", "eccentricity": "0"}),
        (
            "stands_still",
            {"inclination": "0 deg", "eccentricity": "0"},
            {"inclination": "0 deg", "eccentricity": "0.1"},
        ),
        ("signal_delay", {"printed": "250 ms", "legs": "2"}, {"printed": "120 ms", "legs": "2"}),
        ("satellites_needed", {"printed": "3"}, {"printed": "2"}),
        ("altitude_classes", {"bounds": ("300 km", "36000 km")}, {"bounds": ("300 km", "20000 km")}),
        ("coherent", {"left": "kN", "right": "kg*km/s**2"}, {"left": "N", "right": "kg*km/s**2"}),
        (
            "weight_unit",
            {"printed": "kg*s", "cost": "J", "control": "km/s**2", "time": "s"},
            {"printed": "kg", "cost": "J", "control": "km/s**2", "time": "s"},
        ),
        ("form_kept", {"model": "polar_orbit", "angle": "rad"}, {"model": "polar_orbit", "angle": "deg"}),
        (
            "displacement",
            {"instance": "its-thesis", "state": "r", "printed": "0"},
            {"instance": "its-thesis", "state": "r", "printed": "1"},
        ),
        (
            "returns",
            {"instance": "return-to-orbit", "control": "0", "states": ("r",)},
            {"instance": "its-thesis", "control": "0", "states": ("r",)},
        ),
        (
            "optimal_control",
            {"instance": "its-thesis", "printed": "0.000"},
            {"instance": "its-thesis", "printed": "0.31"},
        ),
        ("final_costates_known", {"instance": "its-thesis"}, {"instance": "return-to-orbit"}),
        ("truncation_error", {"power": 4}, {"power": 1}),
        ("truncation_error", {"power": 5}, {"power": 3}),
        ("stage_order", {"formulas": "general", "stage": "1"}, {"formulas": "general", "stage": "3"}),
        (
            "sweep_stage",
            {"direction": "backward", "stage": 2, "component": 3},
            {"direction": "backward", "stage": 2, "component": 1},
        ),
        ("update_keeps_law", {"relaxation": "0.5"}, {"relaxation": "-0.5"}),
        ("law_from_zero_vectors", {"nodes": 1}, {"nodes": 5}),
        (
            "unstable",
            {"model": "clohessy_wiltshire", "reason": "multiplicity"},
            None,
        ),
    ],
)
def test_a_predicate_says_yes_and_no(name, yes, no):
    assert ask(name, **yes).holds
    if no is not None:
        found = ask(name, **no)
        assert found.holds is False
        assert not found.artefact


@pytest.mark.parametrize("reason", ["real parts zero", "positive"])
def test_a_true_conclusion_with_another_reason_is_unsound(reason):
    found = ask("unstable", model="clohessy_wiltshire", reason=reason)
    assert found.holds
    assert not found.sound


def test_the_table_of_zeros_is_right():
    assert ask("cost_table", ZEROS, instance="its-thesis", control="0.005").holds


def test_other_digits_are_wrong_and_no_artefact():
    found = ask("cost_table", (*ZEROS[:3], ("50", "50", "0.0700")), instance="its-thesis", control="0.005")
    assert found.holds is False
    assert not found.artefact


def test_whether_two_sided_thrust_can_return_is_left_open():
    assert ask("can_return", instance="its-thesis-return-two-sided").holds is None


@pytest.mark.parametrize(
    ("line", "loop", "slips"),
    [
        ("k2_x1s=h.*(x2s(i)+0.5.*k1_x2s);", "state", 0),
        ("k2_x1s=h.*(x2s(i)+0.5.*h.*k1_x2s);", "state", 1),
        ("k4_x4s=h.*((-2.*(x2s(i)+k3_x2s).*(x4s(i)+k3_x4s)+(0.5.*(u2(i)+u2(i+1))))./(x1s(i)+k3_x1s));", "state", 1),
        ("k1_x4s=h.*((-2.*x2s(i).*x4s(i)-(u2(i)))./x1s(i));", "state", -1),
        ("lambda1(j)=lambda2(j+1)-kl1;", "costate", -1),
        ("a=(a1+2.*a2+2.*a3+a4)./8;", "initial", -1),
    ],
)
def test_slips_in_a_line_are_counted(line, loop, slips):
    """-1: differs, and not by the slips that are known."""
    found = ask("listing_line", line, loop=loop)
    assert found.evidence["slips"] == slips
    assert found.holds == (slips == 0)


def test_a_name_used_in_time_is_no_slip():
    assert ask("defined_before_use", ("a=2*b;", "c=a+1;")).holds
    assert ask("defined_before_use", ("c=a+1;", "a=2*b;")).holds is False
