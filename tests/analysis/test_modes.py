"""Modes: what each carries, how damped it is, and what a satellite with a wheel calls it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance, kernels
from satsym.analysis.linear.equilibrium import linearise
from satsym.analysis.linear.modes import modes, participation
from satsym.analysis.linear.spectrum import characteristic, spectrum
from satsym.analysis.subject import analyse
from satsym.instance import Instance

NAMED = {
    *("pitch drift", "orbit-rate mode", "nutation", "gimbal mode"),
    *(f"flexible mode about {axis}" for axis in "xyz"),
}


def gyrostat(I_x: float, I_y: float, I_z: float, w0: float, h: float) -> Instance:
    given = instance.load("gravity-gradient")
    assert given.model.spec.parameter_names == ("I_x", "I_y", "I_z", "w0", "h")
    return replace(given, parameters=(I_x, I_y, I_z, w0, h))


def named(given: Instance) -> dict[str, complex]:
    return {each.name: each.eigenvalue.value for each in analyse(given).modes if each.eigenvalue.value.real <= 0.0}


@pytest.mark.parametrize(
    ("h", "slow", "fast"), [(91.4, 7.26829756e-5, 0.0294760313), (-91.4, 7.3158416e-5, 0.0296011706)]
)
def test_nutation_stays_and_the_orbit_rate_mode_goes_with_the_orbital_rate(h: float, slow: float, fast: float) -> None:
    found = named(gyrostat(3026.0, 440.0, 3164.0, 7.2921e-5, h))
    assert set(found) == {"nutation", "orbit-rate mode", "pitch libration"}
    assert found["nutation"] == pytest.approx(1j * fast, rel=1e-8)
    assert found["orbit-rate mode"] == pytest.approx(1j * slow, rel=1e-8)


def test_a_spherical_body_nutates_at_h_over_its_inertia_however_slowly() -> None:
    found = named(gyrostat(100.0, 100.0, 100.0, 1.0, 5.0))  # slower than the orbital rate, and yet what stays
    assert found["nutation"] == pytest.approx(0.05j)
    assert found["orbit-rate mode"] == pytest.approx(1.0j)


def test_without_a_wheel_nothing_nutates_and_what_is_neutral_all_around_has_no_name() -> None:
    found = analyse(gyrostat(120.0, 140.0, 40.0, 1.0, 0.0)).modes
    assert [each.name for each in found] == ["orbit-rate mode", "pitch libration", "orbit-rate mode"]
    assert [each.name for each in analyse(gyrostat(100.0, 100.0, 100.0, 1.0, 0.0)).modes] == ["", "orbit-rate mode"]


@pytest.mark.parametrize("model", ["gimballed_linear", "gimballed_wheel"])
def test_gimbals_and_flexible_modes_are_told_by_what_they_carry(model: str) -> None:
    found = analyse(kernels.load(model)).modes
    assert {each.name for each in found} == NAMED
    by_name = {each.name: each for each in found if each.name != "gimbal mode"}
    assert by_name["nutation"].damping_ratio == pytest.approx(0.0039087, rel=1e-4)
    assert by_name["flexible mode about y"].participation["eta_y"] == pytest.approx(0.5, abs=0.01)


def test_a_slow_motion_beside_a_fast_one_is_not_taken_for_zero() -> None:
    found = analyse(kernels.load("roll_yaw"))
    assert [each.value.imag for each in found.eigenvalues[:2]] == pytest.approx([7.2031880e-5, -7.2031880e-5], rel=1e-7)
    assert found.polynomial[-1] == pytest.approx(np.prod([e.value for e in found.eigenvalues]).real, rel=1e-9)
    blocks = {each.value: each.blocks for each in analyse(kernels.load("gimballed_linear")).eigenvalues}
    assert blocks[0.0] == (2, 1)


def test_participation_is_that_of_the_eigenvectors_in_any_units() -> None:
    rng = np.random.default_rng(3)
    A, units = rng.normal(size=(5, 5)), 10.0 ** rng.uniform(-4, 4, 5)
    values, right = np.linalg.eig(A)
    shares = np.abs(right * np.linalg.inv(right).T).T
    found = spectrum(A)
    expected = [shares[np.abs(values - each.value).argmin()] for each in found]
    for matrix in (A, A * units / units[:, None]):
        np.testing.assert_allclose(participation(matrix, found), [s / s.sum() for s in expected], rtol=1e-6, atol=1e-9)


def test_participation_in_a_multiple_eigenvalue_is_that_of_its_subspace() -> None:
    A = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -4.0, 0.0]])
    np.testing.assert_allclose(participation(A, spectrum(A)[:2]), [[0.5, 0.5, 0, 0], [0, 0, 0.5, 0.5]], atol=1e-12)


def test_frequency_and_damping_ratio_are_those_of_the_oscillator() -> None:
    about = linearise(kernels.load("clohessy_wiltshire"))
    zeta, frequency = 0.2, 3.0
    A = np.zeros((4, 4))
    A[0, 1], A[1, 0], A[1, 1], A[2, 2], A[3, 3] = 1.0, -(frequency**2), -2 * zeta * frequency, -1.0, 5.0
    found = modes(replace(about, system=replace(about.system, A=A)), spectrum(A))
    assert [each.damping_ratio for each in found] == [None, pytest.approx(zeta), None]
    assert [each.time_constant for each in found] == pytest.approx([0.2, 1 / (zeta * frequency), 1.0])
    assert found[1].frequency == pytest.approx(frequency)
    assert found[1].period == pytest.approx(2 * np.pi / (frequency * np.sqrt(1 - zeta**2)))
    assert [name for name, _ in found[0].carried_by()] == [about.system.states[3]]


def test_the_characteristic_polynomial_keeps_what_is_small_because_motions_are_slow() -> None:
    A = np.diag([-1e3, -1e-3, -1e-4, 0.0])
    np.testing.assert_allclose(characteristic(A)[1:], [1000.0011, 1.1000001, 1e-4, 0.0], rtol=1e-9)
