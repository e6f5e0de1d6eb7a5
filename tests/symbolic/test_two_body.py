"""The two-body model along inertial axes: its kernels, what the machine recognises in it, and its instances."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp

from satsym import instance, kernels
from satsym.codegen import module
from satsym.kernels import Kernels
from satsym.spec import names
from satsym.symbolic import Derivation, DerivationError, Newton, derive, loader, symbols_of, t
from satsym.symbolic.analysis.spectrum import LAMBDA
from satsym.symbolic.derivation import Step
from satsym.symbolic.lookup import library
from satsym.symbolic.motion import central_force
from tests.support.derived import derived

(TWO_BODY,) = loader.load(loader.find("two_body"))
POLAR = loader.load(loader.find("polar_orbit"))[0].model
EARTHS = ("itb-earth", "itb-earth-kicked", "itb-earth-escape")


x, y, z, v_x, v_y, v_z = symbols_of(TWO_BODY.states)
(mu,) = symbols_of(TWO_BODY.parameters)
place, velocity = sp.Matrix([x, y, z]), sp.Matrix([v_x, v_y, v_z])


@pytest.fixture(scope="module")
def derivation() -> Derivation:
    return library.derivation("two_body")


@pytest.fixture(scope="module")
def model() -> Kernels:
    return kernels.load("two_body")


@pytest.fixture(scope="module")
def polar_derivation() -> Derivation:
    return derived(POLAR)


@pytest.fixture(scope="module")
def polar(polar_derivation: Derivation) -> Kernels:
    return kernels.from_text(module.render(polar_derivation, "a test"), "polar_motion")


def draws(count: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions and velocities, shape (3, count) each, over ten orders of magnitude, and gravitational parameters."""
    rng = np.random.default_rng(seed)
    sizes = 10.0 ** rng.uniform(-2, 8, count)
    strengths = 10.0 ** rng.uniform(-3, 12, count)
    positions, velocities = (rng.standard_normal((3, count)) for _ in range(2))
    return positions * sizes, velocities * np.sqrt(strengths / sizes), strengths


def changed(**more: object) -> Newton:
    return replace(TWO_BODY, **more)


def with_force(force: sp.Matrix) -> Newton:
    return changed(forces={"given": force, "thrust": TWO_BODY.forces["thrust"]})


def without(found: Derivation, *steps: str) -> Derivation:
    return replace(found, steps=tuple(s for s in found.steps if s.name not in steps))


def tampered(found: Derivation, step: str, name: str, factor: sp.Expr | int) -> Derivation:
    """A derivation with one of its right-hand sides multiplied by something."""
    right = found.step(step)
    wrong = tuple(replace(e, rhs=factor * e.rhs) if e.name == name else e for e in right.equations)
    assert wrong != right.equations
    return replace(found, steps=tuple(replace(s, equations=wrong) if s is right else s for s in found.steps))


def _refused(before: Derivation, take: Callable[[Derivation], Step | None], wrong: Derivation) -> None:
    """A step that is taken from something wrong fails its own check."""
    step = take(wrong)
    assert step is not None
    with pytest.raises(DerivationError, match="failed its check"):
        before.extended(step)


# Kernels.


def test_jacobian_equals_complex_steps_of_the_dynamics(model: Kernels) -> None:
    count, h = 300, 1e-30
    positions, velocities, strengths = draws(count, 1)
    states, thrust = np.vstack([positions, velocities]), np.full((3, count), 1e-3)
    found = model.jacobian_x_batch(0.0, states, thrust, (strengths,))
    for column in range(6):
        moved = states.astype(complex)
        moved[column] += 1j * h * np.linalg.norm(states[:3], axis=0)
        slopes = model.dynamics_batch(0.0, moved, thrust, (strengths,)).imag / (h * np.linalg.norm(states[:3], axis=0))
        size = strengths / np.linalg.norm(positions, axis=0) ** 3 if column < 3 else 1.0
        assert (np.abs(found[:, column] - slopes) <= 1e-13 * size).all()


def test_jacobian_is_that_of_the_block_form(model: Kernels) -> None:
    positions, velocities, strengths = draws(300, 2)
    found = model.jacobian_x_batch(0.0, np.vstack([positions, velocities]), np.zeros((3, 300)), (strengths,))
    distance = np.linalg.norm(positions, axis=0)
    outer = np.einsum("ik,jk->ijk", positions, positions)
    gradient = strengths * (3.0 * outer / distance**5 - np.eye(3)[:, :, None] / distance**3)
    assert (np.abs(found[3:, :3] - gradient) <= 1e-14 * strengths / distance**3).all()
    assert not np.concatenate([found[:3, :3], found[3:, 3:]]).any()
    assert (found[:3, 3:] == np.eye(3)[:, :, None]).all()


def test_thrust_is_an_acceleration_along_the_axes(model: Kernels) -> None:
    state, p = (1.0, -2.0, 0.5, 0.1, 0.2, 0.3), (1.3,)
    pushed = np.subtract(model.dynamics(0.0, state, (0.1, 0.2, 0.3), p), model.dynamics(0.0, state, (0, 0, 0), p))
    np.testing.assert_allclose(pushed, [0, 0, 0, 0.1, 0.2, 0.3], atol=1e-15)
    np.testing.assert_array_equal(np.reshape(model.jacobian_u(0.0, state, (0, 0, 0), p), (6, 3)), np.eye(6)[:, 3:])


def test_invariants_are_energy_and_the_angular_momentum_vector(model: Kernels) -> None:
    positions, velocities, strengths = draws(100, 3)
    found = model.invariants_batch(0.0, np.vstack([positions, velocities]), (strengths,))
    assert names(model.spec.invariants) == ("energy", *(f"angular_momentum_{axis}" for axis in "xyz"))
    energy = 0.5 * (velocities**2).sum(axis=0) - strengths / np.linalg.norm(positions, axis=0)
    momentum = np.cross(positions, velocities, axis=0)
    np.testing.assert_allclose(found[0], energy, rtol=1e-12, atol=0)
    np.testing.assert_allclose(found[1:], momentum, rtol=1e-9)


def test_the_centre_itself_is_no_place_to_start_from(model: Kernels) -> None:
    with np.errstate(all="ignore"):
        assert not np.isfinite(model.dynamics_batch(0.0, np.zeros(6), np.zeros(3), (1.0,))).all()
    with pytest.raises(ZeroDivisionError):
        model.dynamics(0.0, (0.0,) * 6, (0.0,) * 3, (1.0,))


# The inertial state.


def test_inertial_state_of_the_cartesian_model_is_its_state(model: Kernels) -> None:
    assert model.spec.keplerian
    assert model.inertial_state(0.0, (1, 2, 3, 4, 5, 6), (7.0,)) == (1, 2, 3, 4, 5, 6, 7.0)


def test_inertial_state_of_the_polar_model_moves_as_its_position_does(polar: Kernels) -> None:
    rng, h = np.random.default_rng(4), 1e-30
    states = rng.uniform(0.5, 2.0, (4, 50)) * [[1.0], [-1.0], [3.0], [1.0]]
    p = (1.3, 0.7, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    found = polar.inertial_state_batch(0.0, states, p)
    rates = polar.dynamics_batch(0.0, states, np.zeros((2, 50)), p)
    moved = polar.position_batch(0.0, states + 1j * h * rates, p)
    np.testing.assert_allclose(found[:2], moved.real, rtol=1e-15)
    np.testing.assert_allclose(found[3:5], moved.imag / h, rtol=1e-13)
    assert not found[[2, 5]].any()
    np.testing.assert_allclose(found[6], 1.3**3 * 0.7**2, rtol=1e-15)
    one = polar.inertial_state(0.0, tuple(states[:, 0]), p)
    np.testing.assert_allclose(one, found[:, 0], rtol=1e-15)


def test_inertial_states_of_both_models_obey_one_law(polar: Kernels, model: Kernels) -> None:
    """The polar motion, differentiated twice in inertial axes, against the Cartesian right-hand side."""
    rng, h = np.random.default_rng(5), 1e-30
    states = rng.uniform(0.5, 2.0, (4, 50))
    p = (1.3, 0.7, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    seen = polar.inertial_state_batch(0.0, states, p)
    rates = polar.dynamics_batch(0.0, states, np.zeros((2, 50)), p)
    moved = polar.inertial_state_batch(0.0, states + 1j * h * rates, p)
    expected = model.dynamics_batch(0.0, seen[:6], np.zeros((3, 50)), (seen[6],))
    np.testing.assert_allclose(moved[:6].imag / h, expected, rtol=1e-12, atol=1e-14)


# What the machine recognises, and what it does not.


def test_attraction_by_a_centre_is_recognised_in_the_polar_model(polar_derivation: Derivation) -> None:
    law = polar_derivation.equation("central_attraction.law").rhs
    assert sp.simplify(law + sp.Symbol("mu", real=True, positive=True) * sp.Symbol("r_vector") / _distance() ** 3) == 0
    assert "gravity_gradient" not in polar_derivation  # its coordinates are not the inertial ones


@pytest.mark.parametrize(
    "force",
    [
        -mu * place,  # a spring
        -mu * place / place.norm() ** 4,  # another power
        mu * place / place.norm() ** 3,  # repulsion
        -mu * (1 + t**2) * place / place.norm() ** 3,  # a centre that grows
        -mu * place / place.norm() ** 3 - mu * velocity,  # drag
        -mu * (place - sp.Matrix([1, 0, 0])) / (place - sp.Matrix([1, 0, 0])).norm() ** 3,  # the centre elsewhere
        -mu * place / place.norm() ** 3 - mu * sp.Matrix([x, y, 3 * z]) / place.norm() ** 5,  # an oblate centre
        sp.zeros(3, 1),
    ],
    ids=["spring", "power", "repulsion", "growth", "drag", "elsewhere", "oblate", "nothing"],
)
def test_other_forces_are_not_taken_for_kepler(force: sp.Matrix) -> None:
    assert central_force.recognised(with_force(force)) is None


@pytest.mark.parametrize(
    "force",
    [
        -mu * place / place.norm() ** 3 - mu * sp.Matrix([x, y, 3 * z]) / place.norm() ** 5,
        (-mu / place.norm() ** 3 + sp.exp(-place.dot(place) / (1 + v_x**2))) * place,
    ],
    ids=["across", "along"],
)
def test_other_forces_are_told_by_numbers(force: sp.Matrix, monkeypatch: pytest.MonkeyPatch) -> None:
    """Simplifying them may take minutes."""
    model = with_force(force)
    monkeypatch.setattr(sp, "simplify", lambda _: pytest.fail("simplified"))
    assert central_force.recognised(model) is None


def test_a_model_that_is_not_keplers_has_none_of_the_steps() -> None:
    """A centre and a force towards a plane: still an energy, and a symmetry about one axis."""
    flattened = -mu * place / place.norm() ** 3 - mu * sp.Matrix([0, 0, z])
    plain = {
        kind: tuple(replace(v, unit="1") for v in getattr(TWO_BODY, kind))
        for kind in ("states", "controls", "parameters")
    }
    found = derive(replace(with_force(flattened), **plain))
    assert not {"central_attraction", "gravity_gradient", "conic", "point_spectrum"} & {s.name for s in found.steps}
    assert central_force.strength_of(found) is None
    assert not module.spec(found, "a test").keplerian
    assert {e.name for e in found.step("conserved").equations} == {"energy", "angular_momentum_z"}


def test_gravity_gradient_is_recognised(derivation: Derivation) -> None:
    outer, identity, distance = sp.Symbol("r_outer"), sp.Symbol("identity"), _distance()
    found = derivation.equation("gravity_gradient.G").rhs
    assert sp.expand(found - mu * (3 * outer / distance**5 - identity / distance**3)) == 0
    assert derivation.equation("gravity_gradient.A").rhs == sp.ImmutableMatrix(
        [[0, identity], [sp.Symbol("gravity_gradient"), 0]]
    )


@pytest.mark.parametrize("entry", ["A_v_z_z", "A_v_y_x", "A_v_z_y"])
def test_a_wrong_entry_of_the_jacobian_is_noticed(derivation: Derivation, entry: str) -> None:
    """With one entry changed, the blocks that are read off the others must fail their check."""
    before = without(derivation, "gravity_gradient", "no_equilibrium", "point_spectrum")
    _refused(before, central_force.gravity_gradient, tampered(before, "linearisation", entry, sp.Rational(101, 100)))


@pytest.mark.parametrize("take", [central_force.no_equilibrium, central_force.conic], ids=lambda f: f.__name__)
def test_a_wrong_law_is_noticed_by_what_builds_on_it(
    derivation: Derivation, take: Callable[[Derivation], Step | None]
) -> None:
    before = without(derivation, take.__name__)
    _refused(before, take, tampered(before, "central_attraction", "law", 2))


def test_a_wrong_energy_is_noticed_by_the_conic(derivation: Derivation) -> None:
    before = without(derivation, "conic")
    _refused(before, central_force.conic, tampered(before, "conserved", "energy", 2))


def test_a_wrong_strength_is_noticed(derivation: Derivation, monkeypatch: pytest.MonkeyPatch) -> None:
    before = without(derivation, "central_attraction")
    right = central_force.recognised(TWO_BODY)
    assert right is not None
    monkeypatch.setattr(central_force, "recognised", lambda _: replace(right, strength=2 * right.strength))
    _refused(before, central_force.central_force, before)


def test_wrong_eigenvalues_are_noticed(derivation: Derivation, monkeypatch: pytest.MonkeyPatch) -> None:
    before = without(derivation, "point_spectrum")
    spectrum = central_force.spectrum
    monkeypatch.setattr(central_force, "spectrum", lambda a: spectrum(2 * a))
    _refused(before, central_force.point_spectrum, before)


def test_a_jacobian_with_other_blocks_is_not_called_one_of_gravity(derivation: Derivation) -> None:
    linear = derivation.step("linearisation")
    damped = tuple(replace(e, rhs=-mu) if e.name == "A_v_x_v_x" else e for e in linear.equations)
    steps = tuple(replace(s, equations=damped) if s is linear else s for s in derivation.steps)
    assert central_force.gravity_gradient(replace(derivation, steps=steps)) is None


def test_units_that_do_not_fit_are_refused() -> None:
    wrong = changed(parameters=tuple(replace(v, unit="km**2/s**2") for v in TWO_BODY.parameters))
    with pytest.raises(DerivationError, match="gravity"):
        derive(wrong)


def test_every_step_was_checked_for_its_dimensions(derivation: Derivation) -> None:
    assert all("dimensions agree" in [check.claim for check in step.checks] for step in derivation.steps)


# A point of an orbit.


def test_eigenvalues_at_a_point_are_exact(derivation: Derivation) -> None:
    step = derivation.step("point_spectrum")
    distance = _distance()
    pull = mu / distance**3
    assert (
        sp.expand(step_value(step, "characteristic_polynomial") - (LAMBDA**2 - 2 * pull) * (LAMBDA**2 + pull) ** 2) == 0
    )
    expected = [sp.sqrt(2 * pull), -sp.sqrt(2 * pull), sp.I * sp.sqrt(pull), -sp.I * sp.sqrt(pull)]
    found = list(step_value(step, "distinct"))
    assert all(sp.simplify(a - b) == 0 for a, b in zip(found, expected, strict=True))
    assert list(step_value(step, "algebraic")) == list(step_value(step, "geometric")) == [1, 1, 2, 2]


def test_numeric_eigenvalues_are_those_whatever_the_velocity(model: Kernels) -> None:
    positions, velocities, strengths = draws(50, 6)
    for k in range(50):
        state = (*positions[:, k], *velocities[:, k])
        rate = math.sqrt(strengths[k] / np.linalg.norm(positions[:, k]) ** 3)
        scale = np.diag([1.0] * 3 + [1.0 / rate] * 3)
        a = np.reshape(model.jacobian_x(0.0, state, (0.0,) * 3, (strengths[k],)), (6, 6))
        found = np.linalg.eigvals(scale @ a @ np.linalg.inv(scale)) / rate
        expected = np.array([math.sqrt(2), -math.sqrt(2), 1j, 1j, -1j, -1j])
        gaps = np.abs(found[:, None] - expected).min(axis=1), np.abs(found[:, None] - expected).min(axis=0)
        assert max(gaps[0].max(), gaps[1].max()) <= 1e-12


def test_the_rule_of_the_signs_tells_no_orbit_from_another() -> None:
    """At the start, where the three orbits pass through one point: one ellipse, a longer one, and a hyperbola."""
    cases = [instance.load(name) for name in EARTHS]
    jacobians = [np.array(c.model.jacobian_x(0.0, c.initial, (0.0,) * 3, c.parameters)) for c in cases]
    assert all((a == b).all() for a, b in pairwise(jacobians))
    energies = [c.model.invariants(0.0, c.initial, c.parameters)[0] for c in cases]
    assert energies[0] < energies[1] < 0.0 < energies[2]
    eigenvalues = np.linalg.eigvals(np.reshape(jacobians[0], (6, 6)))
    assert eigenvalues.real.max() > 0.99 * math.sqrt(2) * 1.99e-7


def test_the_rule_of_the_signs_depends_on_the_coordinates(polar_derivation: Derivation) -> None:
    """On a circular orbit, polar coordinates have no eigenvalue with a positive real part, Cartesian ones have."""
    sigma, omega = (s for s in symbols_of(POLAR.parameters) if s.name in ("sigma", "omega"))
    circle = {
        **POLAR.reference,
        sp.Symbol("mu", real=True, positive=True): sigma**3 * omega**2,
        **dict.fromkeys(symbols_of(POLAR.controls), 0),
    }
    entries = [e.rhs for e in polar_derivation.step("linearisation").equations if e.name.startswith("A_")]
    polynomial = sp.Matrix(4, 4, entries).subs(circle).charpoly(LAMBDA).as_expr()
    assert sp.expand(polynomial - LAMBDA**2 * (LAMBDA**2 + omega**2)) == 0


def test_no_point_is_an_equilibrium(derivation: Derivation, model: Kernels) -> None:
    assert derivation.equation("no_equilibrium.acceleration").rhs == mu / _distance() ** 2
    positions, _, strengths = draws(100, 7)
    rates = model.dynamics_batch(0.0, np.vstack([positions, np.zeros((3, 100))]), np.zeros((3, 100)), (strengths,))
    np.testing.assert_allclose(
        np.linalg.norm(rates[3:], axis=0), strengths / np.linalg.norm(positions, axis=0) ** 2, rtol=1e-14
    )


def test_conic_has_the_eccentricity_of_vis_viva(derivation: Derivation) -> None:
    """At the nearest point of an orbit the eccentricity is r v^2 / mu - 1."""
    expression = derivation.equation("conic.eccentricity").rhs
    values = {"energy": 1.2**2 / 2 - 1 / 0.9, "angular_momentum_norm": 0.9 * 1.2, "mu": 1.0}
    found = float(expression.subs({s: values[s.name] for s in expression.free_symbols}))
    assert math.isclose(math.sqrt(found), 0.9 * 1.2**2 - 1.0, rel_tol=1e-12)


def step_value(step: Step, name: str) -> sp.Expr:
    return next(e.rhs for e in step.equations if e.name == name)


def _distance() -> sp.Symbol:
    return sp.Symbol("r_norm", positive=True)
