"""Linearised models: true to the motion they linearise, refused where they are not, and generated as derived."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm, solve_continuous_are

from satsym.codegen import module
from satsym.kernels import Kernels, from_text, load
from satsym.kernels.digest import sealed
from satsym.status import BadInput
from satsym.symbolic import (
    Definition,
    Derivation,
    DerivationError,
    FirstOrder,
    Linearised,
    Output,
    Variable,
    derive,
    pipeline,
    symbols_of,
    t,
)
from satsym.symbolic.kinds import linearised
from satsym.symbolic.motion import steps
from tests.support.deviations import satellite, small, stated

KNOWN = [[0, 1, 0, 0], [3, 0, 0, 2], [0, 0, 0, 1], [0, -2, 0, 0]]
"""A for omega = sigma = 1: Clohessy and Wiltshire (1960), in the variables of Olsder and van der Woude (2004)."""
STEPS = {f.__name__: f for f in (*stated("clohessy_wiltshire", "clohessy_wiltshire").steps(), *pipeline.OUTPUTS)}
P = (1.3, 0.7)
"""Other values of sigma and omega."""


def matrix(derivation: Derivation, step: str, letter: str, **values: float) -> np.ndarray:
    """The matrix whose entries a step names, with numbers for the parameters."""
    found = [e.rhs for e in derivation.step(step).equations if e.name.startswith(f"{letter}_")]
    numbers = [float(e.subs({s: values[s.name] for s in e.free_symbols})) for e in found]
    columns = derivation.model.states if letter in "AC" else derivation.model.controls
    return np.array(numbers).reshape(-1, len(columns))


@pytest.fixture(scope="module")
def kernels() -> Kernels:
    return load("clohessy_wiltshire")


def test_the_matrices_are_the_known_ones():
    unit = {"omega": 1, "sigma": 1}
    assert (matrix(satellite(), "linearisation", "A", **unit) == KNOWN).all()
    assert (matrix(satellite(), "linearisation", "B", **unit) == [[0, 0], [1, 0], [0, 0], [0, 1]]).all()
    assert (matrix(satellite(), "output_matrix", "C", **unit) == [[1, 0, 0, 0], [0, 0, 1, 0]]).all()
    assert not matrix(satellite(), "output_matrix", "D", **unit).any()


def test_the_state_matrix_depends_on_the_angular_velocity_only():
    symbols = set().union(*(e.rhs.free_symbols for e in satellite().step("linearisation").equations))
    assert [s.name for s in symbols] == ["omega"]


def test_the_gravity_parameter_is_found_and_not_taken_over():
    (equation,) = satellite().step("reference_condition").equations
    sigma, omega = symbols_of(satellite().model.parameters)
    assert equation.lhs.name == "mu"
    assert sp.simplify(equation.rhs - sigma**3 * omega**2) == 0


def test_another_gravity_parameter_is_refused_with_the_right_one():
    model = stated("clohessy_wiltshire", "clohessy_wiltshire")
    (definition,) = model.definitions
    wrong = (Definition(definition.variable, 2 * definition.value),)
    motion = replace(model.of, definitions=wrong)
    with pytest.raises(DerivationError, match=r"if and only if mu = omega\*\*2\*sigma\*\*3, but mu is defined as"):
        derive(replace(model, of=motion, definitions=wrong))


def test_the_same_matrices_follow_from_the_jacobians_of_the_orbit_in_its_own_variables():
    """T J T^-1 + T' T^-1 with T = diag(1, 1, sigma, sigma), which is constant."""
    assert satellite().original is not None
    orbit = derive(satellite().original.model)
    sigma, omega = P
    point = {"r": sigma, "r_dot": 0, "theta": 0.4, "theta_dot": omega, "sigma": sigma, "omega": omega, "u1": 0, "u2": 0}
    point["mu"] = sigma**3 * omega**2
    change = np.diag([1, 1, sigma, sigma])
    a, b = (matrix(orbit, "linearisation", letter, **point) for letter in "AB")
    values = {"sigma": sigma, "omega": omega}
    expected = change @ a @ np.linalg.inv(change)
    np.testing.assert_allclose(matrix(satellite(), "linearisation", "A", **values), expected, atol=1e-14)
    np.testing.assert_allclose(matrix(satellite(), "linearisation", "B", **values), change @ b, atol=1e-14)


def test_the_exact_equations_of_the_deviations_describe_the_same_motion(kernels: Kernels):
    orbit, thrust = load("polar_orbit"), (0.02, -0.03)
    weights = (*P, *[1.0] * (len(orbit.spec.parameters) - 2))
    start = (0.1, -0.05, 0.2, 0.08)
    times = {"t_span": (0.0, 5.0), "rtol": 1e-11, "atol": 1e-12}
    mine = solve_ivp(lambda t, x: kernels.deviation_dynamics(t, x, thrust, P), y0=start, **times).y[:, -1]
    there = kernels.original_state(0.0, start, P)
    theirs = solve_ivp(lambda t, x: orbit.dynamics(t, x, thrust, weights), y0=there, **times).y[:, -1]
    np.testing.assert_allclose(kernels.original_state(5.0, mine, P), theirs, rtol=1e-9)
    np.testing.assert_allclose(kernels.deviation_state(5.0, theirs, P), mine, atol=1e-9)


def test_the_linear_equations_are_the_first_order_of_the_exact_ones(kernels: Kernels):
    x, u = np.array([0.3, -0.2, 0.5, 0.4]), np.array([0.1, -0.6])
    defects = []
    for scale in (1e-2, 1e-3, 1e-4):
        exact = np.array(kernels.deviation_dynamics(0.7, scale * x, scale * u, P))
        defects.append(np.linalg.norm(exact - kernels.dynamics(0.7, scale * x, scale * u, P)))
    orders = np.diff(np.log10(defects))
    np.testing.assert_allclose(orders, -2, atol=0.05)


def test_a_motion_that_varies_with_time_has_matrices_that_do():
    """Example 2.7 of uny_thesis, by hand: f = (-t x2 + u, x1/t), g = x1^2/t^2 + t x2^2, x1 = t sin t, x2 = -cos t."""
    found = small("time_varying")
    entries = {e.name: e.rhs for step in ("linearisation", "output_matrix") for e in found.step(step).equations}
    assert entries == {
        "A_z1_z1": 0,
        "A_z1_z2": -t,
        "A_z2_z1": 1 / t,
        "A_z2_z2": 0,
        "B_z1_v1": 1,
        "B_z2_v1": 0,
        "C_w1_z1": 2 * sp.sin(t) / t,
        "C_w1_z2": -2 * t * sp.cos(t),
        "D_w1_v1": 0,
    }


def test_outputs_of_neighbouring_motions_differ_by_what_the_linear_model_says():
    """Two motions integrated from neighbouring states, against the linear model integrated from their difference."""
    model = stated("small_systems", "explicit_time")
    x1, x2 = symbols_of(model.states)
    measured = sp.lambdify((t, x1, x2), model.outputs[0].value)
    linear, size = load("time_varying"), 1e-6
    start = np.array([1.0, -2.0]) * size

    def rates(time: float, x: np.ndarray) -> list[float]:
        return [-time * x[1] + np.sin(time), x[0] / time]

    times = {"t_span": (1.0, 4.0), "rtol": 1e-12, "atol": 1e-14}
    known = np.array([np.sin(1.0), -np.cos(1.0)])
    other = solve_ivp(rates, y0=known + start, **times).y[:, -1]
    difference = measured(4.0, *other) - measured(4.0, 4 * np.sin(4.0), -np.cos(4.0))
    z = solve_ivp(lambda time, z: linear.dynamics(time, z, (0.0,), ()), y0=start / size, **times).y[:, -1]
    (c1, c2) = linear.output_matrix(4.0, ())
    assert difference / size == pytest.approx(c1 * z[0] + c2 * z[1], rel=1e-4)


# Refusals.

PLANE = tuple(Variable(name, name) for name in ("q1", "q2"))
PUSH = (Variable("f1", "f_1"),)
NEW = tuple(Variable(name, name) for name in ("d1", "d2"))
q1, q2, f1, d1, d2 = symbols_of((*PLANE, *PUSH, *NEW))
pendulum = FirstOrder(
    name="pendulum", title="", states=PLANE, controls=PUSH, parameters=(), rates={q1: q2, q2: f1 - sp.sin(q1)}
)
hanging = Linearised(
    name="hanging",
    title="",
    of=pendulum,
    about={q1: sp.Integer(0), q2: sp.Integer(0)},
    states=NEW,
    controls=PUSH,
    parameters=(),
    deviations={d1: q1, d2: q2},
)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"about": {q1: 1, q2: 0}}, "is not a motion of pendulum"),
        ({"about": {q1: 0}}, "no value for q2"),
        (
            {"about": {q1: 0, q2: 0, f1: 1}},
            "f1 is not zero along the reference motion; give the deviation a different name",
        ),
        ({"about": {q1: d1, q2: 0}}, "cannot depend on d1|undeclared symbols: d1"),
        ({"deviations": {d1: q1 - 1, d2: q2}}, "some deviations do not vanish"),
        ({"deviations": {d1: q1, d2: q1}}, "cannot be solved for the variables of pendulum"),
        ({"deviations": {d1: q1}}, "one deviation for each state"),
        ({"states": NEW[:1], "deviations": {d1: q1}}, "give a replacement for each state and each control of pendulum"),
        ({"states": PLANE, "deviations": {q1: q1, q2: q2}}, "'q1' is used twice"),
        ({"outputs": (Output(Variable("y1", "y_1"), d1),)}, "an output"),
        ({"parameters": (Variable("routh_array", "K"),)}, "'routh_array' is reserved for a derived quantity"),
    ],
)
def test_a_linearisation_that_does_not_fit_its_motion_is_refused_in_one_line(change: dict[str, Any], message: str):
    with pytest.raises(DerivationError, match=message) as refused:
        derive(replace(hanging, **change))
    assert "\n" not in str(refused.value)


def test_a_linearisation_can_be_linearised_again():
    names = tuple(Variable(name, name) for name in ("e1", "e2"))
    first = derive(hanging)
    again = Linearised(
        name="again",
        title="",
        of=hanging,
        about={d1: sp.Integer(0), d2: sp.Integer(0)},
        states=names,
        controls=PUSH,
        parameters=(),
        deviations=dict(zip(symbols_of(names), (d1, d2), strict=True)),
    )
    second = derive(again)
    for letter in "AB":
        assert (matrix(second, "linearisation", letter) == matrix(first, "linearisation", letter)).all()


def test_the_upright_pendulum_is_a_saddle_and_the_hanging_one_is_not():
    for angle, sign in ((0, -1), (sp.pi, 1)):
        found = derive(replace(hanging, about={q1: angle, q2: sp.Integer(0)}, deviations={d1: q1 - angle, d2: q2}))
        assert found.equation("linearisation.A_d2_d1").rhs == sign


def test_deviations_need_not_be_linear_in_the_old_variables():
    """d2 = (1 + q1) q2 near rest: to first order the same as q2."""
    found = derive(replace(hanging, deviations={d1: q1, d2: (1 + q1) * q2}))
    assert matrix(found, "linearisation", "A").tolist() == [[0, 1], [-1, 0]]


def test_a_unit_that_does_not_fit_is_refused():
    model = stated("clohessy_wiltshire", "clohessy_wiltshire")
    seconds = (replace(model.states[0], unit="s"), *model.states[1:])
    with pytest.raises(DerivationError, match=r"the deviation x1 has the dimension \[length\], but needs \[time\]"):
        derive(replace(model, states=seconds))
    angle = (Output(Variable("y1", "y_1", "km"), model.of.states and symbols_of(model.of.states)[2]),)
    with pytest.raises(DerivationError, match="the output y1 has the dimension 1"):
        derive(replace(model, outputs=angle))


# The checks can fail.


def redo(derivation: Derivation, name: str) -> None:
    index = [s.name for s in derivation.steps].index(name)
    before = replace(derivation, steps=derivation.steps[:index])
    before.extended(STEPS[name](before))


@pytest.mark.parametrize("step", ["reference_condition", "original_states", "linearisation", "output_matrix"])
def test_no_expression_of_a_step_can_be_falsified(step: str, monkeypatch: pytest.MonkeyPatch):
    """Every single expression e that a step tidies is made 1 - e in turn, and caught."""
    source = sys.modules[STEPS[step].__module__]
    tidy = source.tidy
    calls = index = 0

    def falsified(*arguments: Any) -> sp.Expr:
        nonlocal calls
        calls += 1
        return 1 - tidy(*arguments) if calls == index else tidy(*arguments)

    monkeypatch.setattr(source, "tidy", falsified)
    redo(satellite(), step)
    total = calls
    assert total
    for chosen in range(1, total + 1, max(1, total // 6)):
        index, calls = chosen, 0
        with pytest.raises(DerivationError, match="failed its check"):
            redo(satellite(), step)


def test_a_falsified_rate_of_the_deviations_is_caught(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(linearised, "_shorter", lambda rate: 2 * rate)
    with pytest.raises(DerivationError, match="failed its check 'along the original motion'"):
        redo(satellite(), "deviation_equations")


@pytest.mark.parametrize("step", ["first_order", "output_equations"])
def test_falsified_matrices_do_not_pass_for_the_first_order(step: str):
    source = "linearisation" if step == "first_order" else "output_matrix"
    wrong = tuple(replace(e, rhs=e.rhs + 1) for e in satellite().step(source).equations)
    steps = tuple(replace(s, equations=wrong) if s.name == source else s for s in satellite().steps)
    with pytest.raises(DerivationError, match="failed its check 'first order of the exact"):
        redo(replace(satellite(), steps=steps), step)


# Generated functions.


def batch_of_parameters(count: int = 50) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    return rng.uniform(0.5, 2.0, count), rng.uniform(0.5, 2.0, count)


def test_matrices_come_for_batches_of_parameters(kernels: Kernels):
    sigma, omega = batch_of_parameters()
    a = kernels.state_matrix_batch(0.0, (sigma, omega))
    assert a.shape == (4, 4, 50)
    for k in range(50):
        np.testing.assert_array_equal(np.ravel(a[..., k]), kernels.state_matrix(0.0, (sigma[k], omega[k])))
    np.testing.assert_allclose(a[1, 0], 3 * omega**2, rtol=1e-15)
    assert kernels.input_matrix_batch(0.0, (sigma, omega)).shape == (4, 2, 50)
    assert kernels.output_matrix_batch(0.0, (sigma, omega)).shape == (2, 4, 50)


def test_closed_forms_agree_with_numeric_libraries(kernels: Kernels):
    sigma, omega = batch_of_parameters()
    a = np.moveaxis(kernels.state_matrix_batch(0.0, (sigma, omega)), -1, 0)
    polynomial = kernels.characteristic_polynomial_batch((sigma, omega))
    values = kernels.eigenvalues_batch((sigma, omega))
    transition = kernels.transition_matrix_batch(2.5, (sigma, omega))
    for k in range(50):
        np.testing.assert_allclose(polynomial[:, k], np.poly(a[k]), atol=1e-6)
        np.testing.assert_allclose(transition[..., k], expm(2.5 * a[k]), atol=1e-11)
        found = np.sort_complex(values[:, 0, k] + 1j * values[:, 1, k])
        np.testing.assert_allclose(found, np.sort_complex(np.linalg.eigvals(a[k])), atol=1e-6)


def test_closed_loop_polynomials_and_routh_columns_agree_with_eigenvalues(kernels: Kernels):
    rng = np.random.default_rng(1)
    sigma, omega = batch_of_parameters()
    gain = rng.normal(size=(8, 50))
    a, b = (f(0.0, (sigma, omega)) for f in (kernels.state_matrix_batch, kernels.input_matrix_batch))
    polynomial = kernels.closed_loop_polynomial_batch(gain, (sigma, omega))
    column = kernels.closed_loop_routh_batch(gain, (sigma, omega))
    counts = set()
    for k in range(50):
        closed = a[..., k] - b[..., k] @ gain[:, k].reshape(2, 4)
        np.testing.assert_allclose(polynomial[:, k], np.poly(closed), atol=1e-10)
        right = int((np.linalg.eigvals(closed).real > 0).sum())
        assert int((np.diff(np.sign(column[:, k])) != 0).sum()) == right
        counts.add(right)
    assert len(counts) > 2


def test_the_riccati_residual_vanishes_at_the_solution_of_scipy_and_nowhere_near(kernels: Kernels):
    rng = np.random.default_rng(2)
    a, b = np.reshape(kernels.state_matrix(0.0, P), (4, 4)), np.reshape(kernels.input_matrix(0.0, P), (4, 2))
    root, other = rng.normal(size=(4, 4)), rng.normal(size=(2, 2))
    q, r = root @ root.T, other @ other.T + np.eye(2)
    p = solve_continuous_are(a, b, q, r)
    weights = (tuple(np.ravel(q)), tuple(np.ravel(r)), P)
    assert np.abs(kernels.riccati_residual(tuple(np.ravel(p)), *weights)).max() < 1e-10 * np.abs(p).max()
    crooked = p + np.triu(np.ones((4, 4)), 1)
    expected = a.T @ crooked + crooked @ a - crooked @ b @ np.linalg.inv(r) @ b.T @ crooked + q
    found = kernels.riccati_residual(tuple(np.ravel(crooked)), *weights)
    np.testing.assert_allclose(found, np.ravel(expected), rtol=1e-9, atol=1e-12)


def test_a_module_names_the_functions_of_linear_models_it_has():
    assert load("polar_orbit").spec.linear == ()
    assert "eigenvalues" in load("saddle").spec.linear
    varying = load("time_varying")
    assert {"state_matrix", "deviation_dynamics"} <= set(varying.spec.linear)
    assert "characteristic_polynomial" not in varying.spec.linear
    assert [v.symbol for v in varying.spec.outputs] == ["w1"]
    assert load("explicit_time").spec.linear == ()


def test_a_module_with_functions_that_no_linear_model_has_is_refused(repository: Path):
    text = (repository / "generated" / "saddle.py").read_text(encoding="utf-8")
    with pytest.raises(BadInput, match="functions of linear models that no linear model has"):
        from_text(text.replace("'routh_column',", "'root_column',"), "saddle.py")
    with pytest.raises(BadInput, match="does not contain eigenvalues_batch"):
        from_text(text[: text.index("def eigenvalues_b")] + text[text.index("def transition_matrix_b") :], "saddle.py")


def test_a_model_without_parameters_and_controls_is_generated():
    saddle = load("saddle")
    assert saddle.eigenvalues(()) == (3.0, 0.0, -2.0, 0.0)
    assert saddle.state_matrix_batch(np.zeros(3), ()).shape == (2, 2, 3)
    assert saddle.characteristic_polynomial_batch(()).tolist() == [1.0, -1.0, -6.0]


def test_the_text_is_the_same_every_time(repository: Path):
    text = module.render(small("time_varying"), "derivations/small_systems.py")
    assert text == sealed((repository / "generated" / "time_varying.py").read_text(encoding="utf-8"))


def test_linear_functions_compile():
    pytest.importorskip("numba")
    compiled = load("saddle").compiled()
    assert tuple(compiled.transition_matrix(0.0, ())) == (1.0, 0.0, 0.0, 1.0)


def test_outputs_of_a_nonlinear_model_are_linearised_along_any_motion():
    model = replace(pendulum, outputs=(Output(Variable("h1", "h_1"), q2**2 / 2 - sp.cos(q1)),))
    found = {e.name: e.rhs for e in derive(model).step("output_matrix").equations}
    assert found == {"C_h1_q1": sp.sin(q1), "C_h1_q2": q2, "D_h1_f1": 0}
    assert steps.output_equations(derive(model)) is None


def test_a_control_may_be_counted_from_one_that_depends_on_the_states():
    """f1 = v1 - q1: part of the control belongs to the motion, and to the state matrix then."""
    pushed = (Variable("v1", "v_1"),)
    (v1,) = symbols_of(pushed)
    found = derive(replace(hanging, controls=pushed, deviations={d1: q1, d2: q2, v1: f1 + q1}))
    assert matrix(found, "linearisation", "A").tolist() == [[0, 1], [-2, 0]]
    assert matrix(found, "linearisation", "B").tolist() == [[0], [1]]
