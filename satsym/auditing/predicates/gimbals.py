"""Roll and yaw of a satellite whose wheel hangs in two gimbals: the linear equations, from angular momenta."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.auditing.predicates import Finding, predicate
from satsym.status import BadInput
from satsym.wording import shown, suggestion

Complex = NDArray[np.complex128]

_ANGLES = ("phi", "psi", "g_x", "g_z")
_AXES = ("roll", "yaw", "roll gimbal", "yaw gimbal")
_SEED = 53
_TRIES = 4
_STEP = 1e-4
_TINY = 1e-30
_EQUAL = 1e-6
_Y: Complex = np.array([0.0, 1.0, 0.0], dtype=complex)


def _about_x(angle: complex) -> Complex:
    """Components of a vector in a frame that is turned about x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]], dtype=complex)


def _about_z(angle: complex) -> Complex:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]], dtype=complex)


def _turned(x: complex, z: complex, rate_x: complex, rate_z: complex, outside: Complex) -> tuple[Complex, Complex]:
    """A frame turned about z, then about x: its rotation, and its angular velocity in its own components."""
    first, second = _about_z(z), _about_x(x)
    spin = second @ (first @ outside + np.array([0.0, 0.0, rate_z])) + np.array([rate_x, 0.0, 0.0])
    return second @ first, spin


def _momenta(q: Complex, rates: Complex, speed: complex, values: dict[str, float]) -> tuple[Complex, ...]:
    """Angular velocity and momentum of the satellite in its frame, and of the wheel in that of the inner gimbal.

    Orbital motion and wheel turn about -y. Gimbals have no inertia; I_x, I_y, I_z are those of the whole satellite.
    """
    _, spin = _turned(q[0], q[1], rates[0], rates[1], (-values["w0"] + 0j) * _Y)
    to_wheel, wheel_spin = _turned(q[2], q[3], rates[2], rates[3], spin)
    of_wheel = np.diag([values["I_wx"], values["I_wy"], values["I_wx"]])
    of_body = np.diag([values["I_x"], values["I_y"], values["I_z"]]) - of_wheel
    momentum = of_wheel @ wheel_spin - values["I_wy"] * speed * _Y
    return spin, of_body @ spin + to_wheel.T @ momentum, wheel_spin, momentum


def _torques(moved: dict[str, float], values: dict[str, float]) -> NDArray[np.float64]:
    """Torques that go with angles, rates and accelerations: dh/dt + w x h for the satellite, and for its wheel."""
    q, rates, pushes = (np.array([moved.get(a + end, 0.0) for a in _ANGLES]) for end in ("", "_dot", "_ddot"))
    speed, change = values["H_b"] / values["I_wy"], values["d_Omega"]

    def later(time: complex) -> tuple[Complex, ...]:
        return _momenta(q + rates * time + pushes * time**2 / 2.0, rates + pushes * time, speed + change * time, values)

    now, soon = later(0.0), later(1j * _TINY)
    found = [soon[k + 1].imag / _TINY + np.cross(now[k].real, now[k + 1].real) for k in (0, 2)]
    return np.array([found[0][0], found[0][2], found[1][0], found[1][2]])


def _coefficient(axis: str, term: str, values: dict[str, float]) -> float:
    """By how much a torque grows with an angle, a rate or an acceleration."""
    ends = [_torques({term: sign * _STEP}, values)[_AXES.index(axis)] for sign in (1.0, -1.0)]
    return float(ends[0] - ends[1]) / (2.0 * _STEP)


def _drawn() -> list[dict[str, float]]:
    """Numbers for all letters; the wheel has two equal moments of inertia across its axis."""
    rng = np.random.default_rng(_SEED)
    names = ("I_x", "I_y", "I_z", "I_wx", "I_wy", "w0", "H_b", "d_Omega")
    drawn = [dict(zip(names, map(float, line), strict=True)) for line in rng.uniform(0.5, 2.0, (_TRIES, len(names)))]
    return [{**values, "I_wz": values["I_wx"]} for values in drawn]


def _known(axis: str) -> None:
    if axis not in _AXES:
        raise BadInput(f"no axis {shown(axis)}; {suggestion(axis, _AXES)}")


@predicate
def wheel_couples(axes: tuple[str, ...]) -> Finding:
    """Whether an acceleration of the wheel turns these axes as well, its gimbals being out of line."""
    gains = {}
    for axis in axes:
        _known(axis)
        slopes = []
        for values in _drawn():
            with_wheel = [_coefficient(axis, term, values) for term in ("g_x", "g_z")]
            without = [_coefficient(axis, term, values | {"d_Omega": 0.0}) for term in ("g_x", "g_z")]
            slopes.append(max(abs(a - b) for a, b in zip(with_wheel, without, strict=True)))
        gains[axis] = min(slopes)
    return Finding(
        min(gains.values()) > _EQUAL,
        "its rate stands in the equations of " + " and ".join(axes) + ", times I_wy and the angle of a gimbal",
        {f"least coefficient, {axis}": gain for axis, gain in gains.items()},
    )
