"""The satellite with a gimballed wheel: angular momenta by hand, known linear equations, what is kept."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
from scipy.integrate import DOP853

from satsym import instance, kernels
from satsym.status import BadInput
from satsym.symbolic import DerivationError, ModeGroup, Problem, Reduced, derive, symbols_of
from satsym.symbolic.kinds import kane

NUMBERS = {"I_x": 11.0, "I_y": 7.0, "I_z": 9.0, "w0": 0.6, "I_wx": 0.4, "I_wy": 0.7, "nominal_speed": 5.0}
NUMBERS |= {"K_x": 1.3, "K_z": 1.7, "D_x": 0.3, "D_z": 0.2, "J_x": 0.9, "J_y": 0.8, "J_z": 0.7}
NUMBERS |= {"freq_x": 1.1, "freq_y": 1.2, "freq_z": 0.9, "zeta_x": 0.1, "zeta_y": 0.05, "zeta_z": 0.2}
STEP = 1e-30


def parameters(model, **given):
    """Numbers in the model's order."""
    return tuple({**NUMBERS, **given}[name] for name in model.spec.parameter_names)


def turned(axis, angle):
    """Components of a vector in a frame that is turned about one of its axes."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(3, dtype=complex)
    i, k = (axis + 1) % 3, (axis + 2) % 3
    turn[i, i], turn[i, k], turn[k, i], turn[k, k] = c, s, -s, c
    return turn


def by_hand(x, p, t=0.0):
    """Inertial momentum of all, of wheel and of modes, and the matrices and turns that they are made of."""
    phi, psi, theta, g_x, g_z = x[:5]
    w, (g_x_dot, g_z_dot), eta_dot, speed = x[8:11], x[11:13], x[13:16], x[16]
    space_to_orbit = turned(1, -p["w0"] * t)
    to_body = turned(1, theta) @ turned(0, phi) @ turned(2, psi)
    to_outer, across = turned(2, g_z), turned(0, g_x)
    to_wheel = across @ to_outer
    w_wheel = across @ (to_outer @ w + np.array([0, 0, g_z_dot])) + np.array([g_x_dot, 0, 0])
    spin = w_wheel - (p["nominal_speed"] + speed) * np.array([0, 1, 0])
    I_w = np.array([p["I_wx"], p["I_wy"], p["I_wx"]])
    whole = np.array([p[f"I_{a}"] for a in "xyz"])
    J = np.array([p[f"J_{a}"] for a in "xyz"])
    in_body = (whole - I_w) * w + J * eta_dot + to_wheel.T @ (I_w * spin)
    energy = (((whole - I_w - J) * w**2).sum() + (J * (w + eta_dot) ** 2).sum() + (I_w * spin**2).sum()) / 2
    return {
        "to_space": (to_body @ space_to_orbit).T, "to_orbit": to_body, "body": in_body, "wheel": I_w * spin,
        "to_wheel": to_wheel, "outer": to_outer, "modes": J * (w + eta_dot), "energy": energy,
    }  # fmt: skip


def balance(model, x, u, values):
    """What Newton and Euler leave over, all by hand but the rates: nine numbers that must vanish."""
    p = values
    rates = np.array(model.dynamics(0.0, x.tolist(), u, parameters(model, **p)))
    now, later = by_hand(x + 0j, p), by_hand(x + 1j * STEP * rates, p, 1j * STEP)

    def rate(momentum, turn):
        """Inertial rate of change, along the axes of the frame."""
        moved = (turn(later).T @ later[momentum]).imag / STEP
        return turn(now).real @ moved

    def gravity(inertia, turn):
        nadir = (turn @ now["to_orbit"] @ np.array([0, 0, 1])).real
        return 3 * p["w0"] ** 2 * np.cross(nadir, inertia * nadir)

    I_w = np.array([p["I_wx"], p["I_wy"], p["I_wx"]])
    whole = np.array([p[f"I_{a}"] for a in "xyz"])
    g, g_dot, eta, eta_dot = x[3:5], x[11:13], x[5:8], x[13:16]
    frame = lambda of: of["to_wheel"] @ of["to_space"].T  # noqa: E731
    of_wheel = gravity(I_w, now["to_wheel"])
    outside = gravity(whole - I_w, np.eye(3)) + now["to_wheel"].real.T @ of_wheel
    left = [*(rate("body", lambda of: of["to_space"].T) - outside)]
    motor = (u[0] - p["K_x"] * g[0] - p["D_x"] * g_dot[0], u[1] - p["K_z"] * g[1] - p["D_z"] * g_dot[1], -u[2])
    torque = rate("wheel", frame) - of_wheel  # what the gimbals and the motor do to the wheel, along the inner gimbal
    axes = np.array([1.0, 0, 0]), now["to_wheel"].real @ np.array([0, 0, 1.0]), np.array([0, 1.0, 0])
    left += [axis @ torque - given for axis, given in zip(axes, motor, strict=True)]
    J, nu, zeta = (np.array([p[f"{n}_{a}"] for a in "xyz"]) for n in ("J", "freq", "zeta"))
    left += [*(later["modes"].imag / STEP + J * (nu**2 * eta + 2 * zeta * nu * eta_dot))]
    return np.array(left)


def test_the_rates_obey_newton_and_euler_by_hand():
    model = kernels.load("gimballed_wheel")
    rng = np.random.default_rng(3)
    for _ in range(5):
        x, u = rng.uniform(-0.9, 0.9, 17), rng.uniform(-1, 1, 3).tolist()
        assert np.abs(balance(model, x, u, NUMBERS)).max() < 1e-12


def complex_step(model, p, x, count):
    """The Jacobian of the exact rates."""
    at = np.repeat(np.array(x, complex)[:, None], len(x) + count, axis=1)
    u = np.zeros((count, len(x) + count), complex)
    at[range(len(x)), range(len(x))] += 1j * STEP
    u[range(count), range(len(x), len(x) + count)] += 1j * STEP
    found = model.dynamics_batch(0.0, at, u, p).imag / STEP
    return found[:, : len(x)], found[:, len(x) :]


@pytest.mark.parametrize(
    ("exact", "linear", "angles"),
    [("gyrostat", "gyrostat_linear", 3), ("gimballed_wheel", "gimballed_linear", 8)],
)
def test_the_linear_model_is_the_complex_step_of_the_exact_one(exact, linear, angles):
    exact, linear = kernels.load(exact), kernels.load(linear)
    p = parameters(exact, h=2.7)
    a, b = complex_step(exact, p, exact.reference(0.0, p), len(exact.spec.controls))
    n = len(a)
    change = np.eye(n)
    change[angles : 2 * angles] = a[:angles]  # rates of the coordinates in place of the speeds
    found = change @ a @ np.linalg.inv(change)
    assert np.abs(np.reshape(linear.state_matrix(0.0, p), (n, n)) - found).max() < 1e-10
    if b.size:
        assert np.abs(np.reshape(linear.input_matrix(0.0, p), b.shape) - change @ b).max() < 1e-10


def test_with_locked_gimbals_roll_yaw_and_pitch_are_as_printed():
    model = kernels.load("gyrostat_linear")
    Ix, Iy, Iz, n, h = p = (11.0, 7.0, 9.0, 0.6, 2.7)
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x = (0.3, -0.4, 0.2, 0.5, 0.7, -0.6)
    rates = model.dynamics(0.0, x, (0.0, 0.0), p)
    coupling = h - n * (Ix - Iy + Iz)
    roll = Ix * rates[3] + (4 * n**2 * (Iy - Iz) + n * h) * phi + coupling * psi_dot
    yaw = Iz * rates[4] + (n**2 * (Iy - Ix) + n * h) * psi - coupling * phi_dot
    pitch = Iy * rates[5] + 3 * n**2 * (Ix - Iz) * theta
    assert np.abs([roll, yaw, pitch]).max() < 1e-13
    assert rates[:3] == (phi_dot, psi_dot, theta_dot)


@pytest.mark.parametrize(
    ("p", "frequencies"),
    [
        ((3026.0, 440.0, 3164.0, 7.2921e-5, 91.4), (0.0294760313, 7.26829756e-5)),
        ((120.0, 140.0, 40.0, 1.0, 0.0), (1.8522643, 0.6969818, 1.3093073)),
    ],
)
def test_eigenvalues_with_locked_gimbals_are_the_published_ones(p, frequencies):
    a = np.reshape(kernels.load("gyrostat_linear").state_matrix(0.0, p), (6, 6))
    found = np.linalg.eigvals(a)
    for frequency in frequencies:
        assert np.abs(found - 1j * frequency).min() < 1e-8 * frequency * 10


def test_without_momentum_the_stable_region_is_that_of_the_gravity_gradient():
    model, rng, seen = kernels.load("gyrostat_linear"), np.random.default_rng(5), set()
    while len(seen) < 2 or rng.random() < 0.99:
        a, b, c = rng.uniform(0.05, 1, 3)
        Ix, Iy, Iz = b + c, a + c, a + b
        found = np.linalg.eigvals(np.reshape(model.state_matrix(0.0, (Ix, Iy, Iz, 1.0, 0.0)), (6, 6)))
        # DeBra and Delp: k1 roll, k3 yaw; pitch wants Ix > Iz
        k1, k3 = (Iy - Iz) / Ix, (Iy - Ix) / Iz
        sum_, product = 1 + 3 * k1 + k1 * k3, k1 * k3
        stable = Ix > Iz and product > 0 and sum_ > 4 * np.sqrt(product)
        assert (found.real.max() < 1e-6) == stable
        seen.add(stable)


def test_torque_free_the_whole_satellite_keeps_momentum_and_energy():
    undamped = dict.fromkeys(("w0", "D_x", "D_z", "zeta_x", "zeta_y", "zeta_z"), 0.0)
    model, p = kernels.load("gimballed_wheel"), NUMBERS | undamped
    row = parameters(model, **undamped)

    def rates(_, x):
        return np.array(model.dynamics(0.0, x.tolist(), (0.0, 0.0, 0.0), row))

    def kept(x):
        of, stiffness = by_hand(x + 0j, p), [p["K_x"], p["K_z"], *(p[f"J_{a}"] * p[f"freq_{a}"] ** 2 for a in "xyz")]
        return np.array([*(of["to_space"] @ of["body"]).real, of["energy"].real + (stiffness * x[3:8] ** 2).sum() / 2])

    x0 = np.random.default_rng(8).uniform(-0.3, 0.3, 17)
    run = DOP853(rates, 0.0, x0, 60.0, max_step=0.05, rtol=1e-13, atol=1e-15)
    while run.status == "running":
        run.step()
    before = kept(x0)
    assert np.abs((kept(run.y) - before) / np.array([*[np.linalg.norm(before[:3])] * 3, before[3]])).max() < 1e-11
    assert np.abs(kept(run.y * 1.001) - before).max() > 1e-3


BAD = {
    "I_x": (40.0, "exceeds the sum of the other two"),
    "I_wy": (0.9, "one moment of inertia of the wheel exceeds"),
    "J_y": (6.5, "at least as much inertia as the whole satellite"),
    "K_x": (0.0, "give a positive value"),
    "J_z": (-1.0, "give a positive value"),
}


@pytest.mark.parametrize("name", BAD)
def test_numbers_that_no_satellite_has_are_refused_with_the_reason(tmp_path, name):
    value, reason = BAD[name]
    states = kernels.load("gimballed_wheel").spec.state_names
    lines = [
        'model = "gimballed_wheel"',
        "[initial]",
        *(f"{s} = 0.0" for s in states),
        "[time]",
        "tf = 1.0",
        "[parameters]",
    ]
    lines += [f"{key} = {number}" for key, number in (NUMBERS | {name: value}).items()]
    path = tmp_path / "bad.toml"
    path.write_text("\n".join(lines))
    with pytest.raises(BadInput, match=reason):
        instance.load(path)
    path.write_text("\n".join([*lines[: -len(NUMBERS)], *(f"{key} = {number}" for key, number in NUMBERS.items())]))
    assert instance.load(path).parameters[0] == NUMBERS["I_x"]


@pytest.mark.parametrize("kind", ["problem", "reduced"])
def test_what_would_differentiate_rates_without_a_closed_form_is_refused(monkeypatch, kind):
    bodies = import_module("satsym.derivations.gimballed_wheel").gyrostat
    monkeypatch.setattr(kane, "MOST_OPERATIONS_UNNAMED", 20)  # so that a small model, too, has a chain
    declared = {"states": bodies.states, "controls": bodies.controls, "parameters": bodies.parameters}
    if kind == "problem":
        cost = sum(u**2 for u in symbols_of(bodies.controls))
        asked = Problem(name="costly", title="costly", model=bodies, running_cost=cost)
    else:
        asked = Reduced(name="costly", title="costly", of=bodies, **declared)
    with pytest.raises(DerivationError, match=r"costly: the rates of w_x, w_y, w_z have no closed form.*AboutRest"):
        derive(asked)


def test_a_mode_named_by_what_the_model_does_not_have_is_refused():
    bodies = import_module("satsym.derivations.gimballed_wheel").gyrostat
    for group in (ModeGroup("sway", ("phi", "eta")), ModeGroup("sway", ("phi",), vanishing="eta")):
        with pytest.raises(DerivationError, match="sway"):
            derive(replace(bodies, modes=(group,)))
