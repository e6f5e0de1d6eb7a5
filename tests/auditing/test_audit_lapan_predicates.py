"""The predicates behind the ledger of lapan_pitch can say yes and no: of things put right, and of others put wrong."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import pytest

from satsym.auditing.predicates import Finding, Question, registry
from tests.support.ledgers import whole

LEDGER = tomllib.loads(whole("lapan_pitch"))
INPUTS = LEDGER["inputs"]
PRINTED = {f"{row['item']} {row.get('part', '')}".strip(): row.get("printed", "") for row in LEDGER["row"]}
ROW = Question("row", "claim", "", (), INPUTS, "main", {}, PRINTED)


def ask(predicate: str, text: str = "", inputs: dict | None = None, rows: dict | None = None, **words) -> Finding:
    """What a predicate finds, given a row if it wants one; some numbers and rows of the document replaced."""
    found = registry()[predicate]
    if "row" in found.__code__.co_varnames[: found.__code__.co_argcount]:
        words["row"] = replace(ROW, printed=text, inputs=INPUTS | (inputs or {}), document=PRINTED | (rows or {}))
    return found(**words)


@pytest.mark.parametrize("axis", ["roll", "yaw"])
def test_the_acceleration_of_the_wheel_turns_roll_and_yaw(axis):
    assert ask("wheel_couples", axes=(axis,)).holds


def test_it_does_not_turn_the_gimbals():
    assert not ask("wheel_couples", axes=("roll gimbal",)).holds


@pytest.mark.parametrize(
    ("axis", "term", "yes", "no"),
    [
        ("roll", "psi_dot", "(I_y - I_x - I_z)*w0 + H_b", "(I_y - I_x + I_z)*w0 + H_b"),
        ("yaw", "phi_dot", "-((I_y - I_x - I_z)*w0 + H_b)", "(I_y - I_x - I_z)*w0 + H_b"),
        ("roll", "g_z", "I_wy*d_Omega", "-I_wy*d_Omega"),
        ("yaw", "g_x", "-I_wy*d_Omega", "I_wy*d_Omega"),
        ("roll gimbal", "psi_dot", "w0*(I_wy - 2*I_wx) + H_b", "-w0*(I_wy - 2*I_wx) - H_b"),
    ],
)
def test_terms_of_roll_and_yaw(axis, term, yes, no):
    assert ask("gimbal_term", yes, axis=axis, term=term).holds
    assert not ask("gimbal_term", no, axis=axis, term=term).holds


@pytest.mark.parametrize(
    ("predicate", "yes", "no"),
    [
        ("mode_rate", "eta_ddot + 2*zeta*w_n*eta_dot + w_n**2*eta", "eta_ddot + zeta*w_n*eta_dot + w_n**2*eta"),
        ("transform_of_step", "P_c/s", "P_c/s**2"),
        ("largest_torque", "3000*P_c*I_y*E**2", "4*P_c*I_y*E**2"),
    ],
)
def test_printed_formulas(predicate, yes, no):
    assert ask(predicate, yes).holds
    assert not ask(predicate, no).holds


@pytest.mark.parametrize("law", ["classical", "minimum time", "minimum energy"])
def test_the_wheel_returns_whatever_the_law(law):
    assert ask("wheel_returns", law=law, printed=True).holds
    assert not ask("wheel_returns", law=law, printed=False).holds


def test_words_about_the_classical_law():
    assert ask("wheel_stays", law="classical", share="0.1").holds
    assert not ask("wheel_stays", law="classical", share="0.03").holds
    assert ask("settled_by", printed="600 s", band="0.02").holds
    assert not ask("settled_by", printed="100 s", band="0.02").holds


def test_references():
    assert ask("cites", numbers=("19", "18"), letters=("P2", "H")).holds
    found = ask("cites", numbers=("18", "17"), letters=("P2", "H"))
    assert found.holds is False
    assert found.slip
    assert ask("cites", numbers=("77",), letters=("P2",)).holds is False


def test_a_formula_that_is_nearly_right_is_unsound():
    words = {
        "address": "pitch_wheel:quantities.motor_torque",
        "meanings": ("I_x = I_z", "wheel_torque = I_wy*d_Omega"),
    }
    found = ask("nearly", "T_m = I_wy*d_Omega", within="0.001", **words)
    assert found.holds
    assert not found.sound
    assert ask("nearly", "T_m = I_wy*d_Omega", within="1e-5", **words).holds is False
    exact = ask("nearly", "T_m = I_wy*d_Omega*(1 - I_wy/I_y)", within="1e-5", **words)
    assert exact.holds
    assert exact.sound


def test_an_integral_with_its_impulse():
    right = {"14": "Omega = P_c*I_y*E*exp(-E*t)*(E*t - 2)/I_wy"}
    assert ask("is_integral", rate="13", speed="14", rows=right).holds
    assert not ask("is_integral", rate="13", speed="14").holds
    without_impulse = {"14": "Omega = P_c*I_y*E*(exp(-E*t)*(E*t - 2) + 2)/I_wy"}
    assert not ask("is_integral", rate="13", speed="14", rows=without_impulse).holds


def test_manoeuvres_compared():
    assert ask("smaller_impulse").holds
    assert not ask("smaller_impulse", inputs={"transition": "50 s"}).holds
    assert not ask("faster").sound
    assert not ask("faster", inputs={"transition": "600 s"}).holds
    assert ask("energy_law_better").holds
    assert not ask("least_of_both").holds
    assert not ask("shakes_least").holds


def test_waves():
    assert ask("wave_arrives", rate="0").holds
    assert not ask("wave_arrives", rate="-0.1").holds


def test_without_outer_torques_nothing_loads_the_wheel():
    assert ask("never_desaturates", torque="0 N*m", share="0.1").holds
    assert not ask("never_desaturates", torque="1e-6 N*m", share="0.1").holds


def test_moments_of_inertia_that_no_body_has():
    assert ask("possible_body").holds
    assert not ask("possible_body", inputs={"I_x": "3000 kg*m^2"}).holds


def test_laws_held_against_the_derived_hamiltonian():
    words = {"problem": "pitch_scaled_time", "costate": "19 P2"}
    assert ask("law_maximises", "sign(C2 - C1*tau)", **words).holds
    assert not ask("law_maximises", "sign(C1*tau - C2)", **words).holds
    costate = "pitch_scaled_energy:exact_differential.lambda_X2"
    assert ask("limited_law_maximises", "(C2 - C1*tau)/2", costate=costate).holds
    assert not ask("limited_law_maximises", "(C2 - C1*tau + C_p*X2)/2", costate=costate).holds


def test_counts_of_switches():
    assert ask("switches_at_most", costate="19 P2", printed=1).holds
    assert not ask("switches_at_most", costate="19 P2", printed=2).holds


def test_the_largest_hamiltonian_is_zero_for_a_free_time_only():
    assert ask("largest_is_zero", final_time="free").holds
    assert not ask("largest_is_zero", final_time="given").holds


def test_constants_of_the_costates():
    words = {"hamiltonian": "20", "costate": "19 P2"}
    assert ask("constants_follow", **words).holds
    assert not ask("constants_follow", rows={"20": "H = C1*X2 + (C2 - C1*tau)*U - 2"}, **words).holds


def test_a_costate_integrated():
    words = {"rate": "27 rate of P2", "solution": "27 P2"}
    assert not ask("costate_solves", **words).holds
    right = {"27 rate of P2": "d_P2 = -P1 + C_p", "27 P2": "P2 = (C_p - C1)*tau + C2"}
    assert ask("costate_solves", rows=right, **words).holds
    assert not ask("costate_solves", rows=right | {"27 P2": "P2 = (C_p + C1)*tau + C2"}, **words).holds


def test_a_concave_hamiltonian_is_largest_where_its_slope_vanishes():
    right = {"28": "H = C1*X2 + U*(C2 - C1*tau) - U**2"}
    assert ask("setting_to_zero_maximises", hamiltonian="28", rows=right).holds
    assert not ask("setting_to_zero_maximises", hamiltonian="28").holds


def test_what_cannot_be_otherwise_is_still_computed():
    assert ask("critically_damped").evidence["overshoot"] == pytest.approx(0.1353, abs=1e-4)
    assert ask("continuous_suffices").holds is False
    assert ask("has_least_energy").holds is False
    assert ask("nonlinear_switches_not", hamiltonian="28").sound is False
