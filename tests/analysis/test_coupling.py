"""What drives the pitch axis reaches roll, yaw and panels only through offsets; roll and yaw held and turned."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from satsym import instance, kernels, solvers
from satsym.analysis.comparison import case_of, compare, reached, undriven
from satsym.analysis.linear.ranks import controllability
from satsym.analysis.regulator.feedback import designed
from satsym.analysis.subject import analyse
from satsym.status import BadInput

PITCH = {"theta", "w_y", "eta_y", "eta_y_dot", "wheel_speed"}


@pytest.fixture(scope="module")
def driver():
    return case_of(instance.load("lapan-minimum-time"))


@pytest.mark.slow
def test_from_rest_nothing_reaches_roll_yaw_and_their_modes_and_offsets_let_it_in(driver):
    given = instance.load("lapan-coupling")
    names = given.model.spec.state_names
    aligned = tuple(-7.26e-5 if name == "w_y" else 0.0 for name in names)
    offset = tuple(0.5 * a + 0.5 * b for a, b in zip(given.initial, aligned, strict=True))
    cases = [replace(given, initial=x, tf=130.0) for x in (aligned, offset, given.initial)]
    found = [reached(case, driver, undriven(case)).metrics for case in cases]
    for name in names:
        assert (found[0][f"{name}_driven"] == 0.0) == (name not in PITCH)
    assert found[0]["theta_driven"] == pytest.approx(0.025, rel=0.01)
    for name in ("phi", "psi", "eta_x", "eta_z"):  # in proportion to the offsets
        assert found[2][f"{name}_driven"] == pytest.approx(2 * found[1][f"{name}_driven"], rel=0.02)


def test_a_control_that_is_none_and_drivers_without_it_are_refused(tmp_path):
    text = (instance.load("lapan-coupling").path).read_text()
    path = tmp_path / "other.toml"
    path.write_text(text.replace('control = "motor_torque"', 'control = "motor"'))
    with pytest.raises(BadInput, match=r"\[driven\] control"):
        instance.load(path)
    path.write_text(text.replace('"lapan-classical", "lapan-minimum-time", "lapan-minimum-energy"', '"soft-return"'))
    with pytest.raises(BadInput, match="has no motor_torque"):
        compare([instance.load(path)])


def test_the_gimbal_actuators_move_all_but_the_momentum_which_gravity_alone_changes():
    given = instance.load("lapan-roll-yaw-lqr")
    exact = analyse(given)
    assert exact.controllability.rank == 12  # gravity does change it, by little
    found = controllability(replace(exact.about.system, exact=None))
    assert found.rank == 10
    lost = [each.value for each in found.lost]
    assert np.abs(np.imag(lost)) == pytest.approx([7.26e-5, 7.26e-5], rel=0.02)  # at rest in space, seen from the orbit
    assert designed(given).regulator.eigenvalues.real.max() < 0.0
    stronger = dict(zip(given.model.spec.parameter_names, given.parameters, strict=True)) | {"w0": 0.05}
    assert analyse(replace(given, parameters=tuple(stronger.values()))).controllability.rank == 12


def test_springs_without_damping_do_not_damp_the_nutation():
    model = kernels.load("roll_yaw")
    defaults = {v.symbol: v.default for v in model.spec.parameters}

    def slowest(**given):
        p = tuple({**defaults, "zeta_x": 0.0, "zeta_z": 0.0, **given}.values())
        values = np.linalg.eigvals(np.reshape(model.state_matrix(0.0, p), (12, 12)))
        return values.real.min(), values.real.max()

    assert slowest()[0] < -1e-3
    assert max(map(abs, slowest(D_x=0.0, D_z=0.0))) < 1e-8


def test_the_roll_and_yaw_manoeuvre_is_certified_and_costs_what_the_gramian_says():
    given = instance.load("lapan-roll-yaw")
    found = solvers.solve(given)
    assert found.certificate.verdict.value == "certified"
    model, p, x0 = given.model, given.parameters, np.array(given.initial)
    a = np.reshape(model.jacobian_x(0.0, (0.0,) * 4, (0.0,) * 2, p), (4, 4))
    b = np.reshape(model.jacobian_u(0.0, (0.0,) * 4, (0.0,) * 2, p), (4, 2))
    block = expm(np.block([[-a, b @ b.T], [np.zeros((4, 4)), a.T]]) * given.tf)
    gramian = block[4:, 4:].T @ block[:4, 4:]
    end = expm(a * given.tf) @ x0
    assert found.objective == pytest.approx(end @ np.linalg.solve(gramian, end) / 2, rel=1e-8)
