"""The pitch axis derived: each named result against one found by hand, or by another route."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import pytest
import sympy as sp

from satsym.symbolic import Derivation, DerivationError, Gyrostat, Model, Problem, Reduced, Scaled, derive, loader
from satsym.symbolic.lookup import library

PROBLEMS = {p.name: p for p in loader.load(loader.find("pitch_wheel"))}


@pytest.fixture(scope="module")
def wheel() -> Derivation:
    return library.derivation("pitch_wheel")


@pytest.fixture(scope="module")
def loop() -> Derivation:
    return library.derivation("pitch_classical")


@pytest.fixture(scope="module")
def energy() -> Derivation:
    return library.derivation("pitch_scaled_energy")


def symbols(derivation: Derivation) -> dict[str, sp.Symbol]:
    found = [s for step in derivation.steps for e in step.equations for s in (e.lhs.free_symbols | e.rhs.free_symbols)]
    return {s.name: s for s in found}


def test_gravity_turns_a_body_that_is_longest_across_the_vertical_away_from_it(wheel: Derivation) -> None:
    # the torque as an integral of the field's gradient over a dumb-bell: two masses m at distance l along the roll
    # axis, so that I_x = 0, I_y = I_z = 2 m l^2; then gravity pulls the lower mass down more strongly
    theta, rate, w0 = 0.3, 1e-3, 7e-4
    radius, m, length = mp.mpf(7e6), 3.0, mp.mpf(1e-1)
    mu = w0**2 * radius**3
    torque = mp.mpf(0)
    for end in (1, -1):
        # axes of the orbit: x along the motion, z towards the earth's centre; the body is turned by theta about y
        place = [end * length * mp.cos(theta), 0, -end * length * mp.sin(theta)]
        to_centre = [-place[0], 0, radius - place[2]]
        distance = mp.sqrt(sum(c**2 for c in to_centre))
        force = [m * mu * c / distance**3 for c in to_centre]
        torque += place[2] * force[0] - place[0] * force[2]
    inertia = 2 * m * length**2
    values = {"I_x": 0.0, "I_y": inertia, "I_z": inertia, "w0": w0, "theta": theta, "theta_dot": rate}
    stated = wheel.equation("balance.angular_momentum").rhs
    assert float(stated.subs({s: values[s.name] for s in stated.free_symbols})) == pytest.approx(
        float(torque), rel=1e-6
    )


def test_the_torque_on_the_wheel_is_what_speeds_it_up_in_inertial_space(wheel: Derivation) -> None:
    s = symbols(wheel)
    rates = {e.name: e.rhs for e in wheel.step("first_order").equations}
    absolute = s["I_wy"] * (rates["wheel_speed"] - rates["theta_dot"])
    assert sp.simplify(wheel.equation("quantities.motor_torque").rhs - absolute) == 0


def test_the_voltage_of_the_motor_overcomes_what_the_turning_wheel_induces(wheel: Derivation) -> None:
    s = symbols(wheel)
    voltage, current = wheel.equation("quantities.voltage").rhs, s["current"]
    at_rest = {s["nominal_speed"]: 0, s["wheel_speed"]: 0}
    assert sp.simplify(voltage.subs(at_rest) - s["R_a"] * current) == 0
    assert sp.diff(voltage, s["wheel_speed"]) == 1 / s["K_m"]


@pytest.mark.slow
def test_the_closed_loop_has_the_zero_of_proportional_and_differential_action(loop: Derivation) -> None:
    s = symbols(loop)
    body, k1, k2, z = s["I_y"], s["K1"], s["K2"], s["s"]
    expected = (k1 * z + k2) / (body * z**2 + k1 * z + k2)
    assert sp.simplify(loop.equation("transfer_function.theta").rhs - expected) == 0
    assert sp.simplify(loop.equation("poles_and_zeros.zero_1").rhs + k2 / k1) == 0


@pytest.mark.slow
def test_critical_damping_gives_the_gains_of_the_paper(loop: Derivation) -> None:
    s = symbols(loop)
    assert loop.equation("critical_damping.K1").rhs == 2 * s["E"] * s["I_y"]
    assert loop.equation("critical_damping.K2").rhs == s["E"] ** 2 * s["I_y"]


def test_the_answer_to_a_step_is_that_of_the_differential_equation(loop: Derivation) -> None:
    # by dsolve, from the state just after the impulse: theta = 0, theta' = K1 P_c / I_y
    step, damping, body, wheel = sp.symbols("P_c E I_y I_wy", positive=True)
    time = sp.Symbol("t", positive=True)
    angle = sp.Function("angle")
    equation = angle(time).diff(time, 2) + 2 * damping * angle(time).diff(time) + damping**2 * (angle(time) - step)
    start = {angle(0): 0, angle(time).diff(time).subs(time, 0): 2 * damping * step}
    solved = sp.dsolve(equation, angle(time), ics=start).rhs
    names = {s: sp.Symbol(n, positive=True) for n, s in symbols(loop).items() if n in ("P_c", "E", "I_y", "I_wy", "t")}

    def found(address: str) -> sp.Expr:
        return loop.equation(address).rhs.subs(names)

    assert sp.simplify(found("step_response.theta") - solved) == 0
    assert sp.simplify(found("step_response.wheel_speed") - body / wheel * solved.diff(time)) == 0
    assert sp.simplify(found("control_response.smooth") - body * solved.diff(time, 2)) == 0
    assert found("control_response.impulse") == 2 * damping * body * step
    assert sp.simplify(found("extremes.total_impulse") - body * step * damping * (4 + 2 * sp.exp(-3))) == 0
    assert found("extremes.final_wheel_speed") == 0  # the paper has 4 P_c I_y E / I_wy
    assert found("extremes.overshoot") == sp.exp(-2)


def test_the_scaled_motion_is_a_double_integrator_in_plain_numbers(energy: Derivation) -> None:
    x2, u = sp.Symbol("X2", real=True), sp.Symbol("U", real=True)
    assert [e.rhs for e in energy.step("first_order").equations] == [x2, u]
    assert energy.notation["t"] == r"\tau"
    assert all(check.passed for step in energy.steps for check in step.checks if check.claim == "dimensions agree")


def test_the_scaled_power_is_that_of_the_paper(energy: Derivation) -> None:
    s = symbols(energy)
    assert sp.expand(energy.equation("quantities.scaled_power").rhs - s["U"] * (s["U"] + s["C_p"] * s["X2"])) == 0


def test_the_weight_of_the_wheels_power_changes_costates_and_not_the_control(energy: Derivation) -> None:
    s = symbols(energy)
    assert energy.equation("exact_differential.potential").rhs == s["C_p"] * s["X2"] ** 2 / 2
    assert energy.equation("exact_differential.reduced_cost").rhs == s["U"] ** 2
    law = energy.equation("least_effort.from_rest").rhs
    assert not law.has(s["C_p"])
    start, end = s["X1_0"], s["t_f"]
    assert sp.simplify(law + 6 * start / end**2 * (1 - 2 * s["t"] / end)) == 0
    assert sp.simplify(energy.equation("least_effort.cost_from_rest").rhs - 12 * start**2 / end**3) == 0
    assert [c.key for c in energy.step("least_effort").conclusions] == ["longer is always cheaper"]


def of(name: str) -> Model:
    found = PROBLEMS[name]
    return found.model if isinstance(found, Problem) else found


@pytest.mark.slow
def test_a_scaling_that_leaves_a_unit_over_is_refused() -> None:
    model = of("pitch_scaled")
    assert isinstance(model, Scaled)
    with pytest.raises(DerivationError, match="still depends on"):
        derive(replace(model, where={}))
    with pytest.raises(DerivationError, match="has the dimension"):
        derive(replace(model, unit_of_time=model.unit_of_time**2))


def test_a_state_that_does_not_keep_following_from_others_cannot_be_left_out() -> None:
    model = of("pitch_minimum_time")
    assert isinstance(model, Reduced)
    ((speed, value),) = model.along.items()
    with pytest.raises(DerivationError, match="do not determine the states that are left out"):
        derive(replace(model, along={speed: 2 * value}))


@pytest.mark.slow
def test_gravity_keeps_the_wheel_from_following_the_body_where_the_satellite_is_not_symmetric() -> None:
    model = of("pitch_minimum_time")
    assert isinstance(model, Reduced)
    with pytest.raises(DerivationError, match="do not determine the states that are left out"):
        derive(replace(model, where={}))


def test_a_wrong_torque_between_the_bodies_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    from satsym.symbolic.kinds import gyrostat

    model = of("pitch_wheel")
    assert isinstance(model, Gyrostat)
    right = gyrostat._torque_on

    def unbalanced(model: Gyrostat, body: str) -> sp.Expr:
        return right(model, body) * (2 if body == "wheel" else 1)

    monkeypatch.setattr(gyrostat, "_torque_on", unbalanced)
    with pytest.raises(DerivationError, match="first_order"):
        derive(model)


def test_drives_that_do_not_determine_the_motion_are_refused() -> None:
    model = of("pitch_wheel")
    assert isinstance(model, Gyrostat)
    ((torque, drive),) = model.drives.items()
    with pytest.raises(DerivationError, match="do not determine"):
        derive(replace(model, motors=(), quantities=()))  # two bodies and a drive are three equations for two rates
    with pytest.raises(DerivationError, match="drives: every control must be defined, and nothing else"):
        derive(replace(model, drives={torque: drive, sp.Symbol("brake", real=True): torque}))
    with pytest.raises(DerivationError, match="uses undeclared symbols: brake"):
        derive(replace(model, torques={"body": sp.Symbol("brake", real=True)}))
    with pytest.raises(DerivationError, match="act on declared bodies"):
        derive(replace(model, torques={"panel": sp.Integer(0)}))


def test_special_values_are_put_into_the_states_that_are_left_out() -> None:
    model = of("pitch_minimum_time")
    assert isinstance(model, Reduced)
    ((state, value),), ((special, meant),) = model.along.items(), model.where.items()
    assert replace(model, along={state: value * special / meant}).special()[state] == value
