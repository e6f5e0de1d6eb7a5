"""Claims about simulated motions: deviations with a printed gain, and the nonlinear motion of a printed listing."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.flows import expm
from satsym.auditing.predicates.structure import with_numbers
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_STEPS = 2000
_GONE = 1e-3
"""What is left of a deviation that has died out, relative to its largest value."""
_GRAVITY = -2.0
"""The power of the distance in the law of gravitation."""


def _gain(lines: tuple[str, ...]) -> Array:
    return np.array([[float(entry) for entry in line.split(",")] for line in lines])


def _path(loop: Array, until: float) -> Array:
    """Deviations from (1, ..., 1) on, shape (n, steps + 1)."""
    advance, rows = expm(until / _STEPS * loop), [np.ones(len(loop))]
    for _ in range(_STEPS):
        rows.append(advance @ rows[-1])
    return np.array(rows).T


@predicate
def decays(model: str, state: str, controls: tuple[str, ...], gain: tuple[str, ...], until: float) -> Finding:
    """Whether a deviation dies out with the printed gain, from (1, ..., 1) on, and would from anywhere."""
    system = with_numbers(model, controls)
    if state not in system.states:
        raise BadInput(f"decays: no state {shown(state)}; {suggestion(state, system.states)}")
    loop = system.A - system.B @ _gain(gain)
    largest = float(np.linalg.eigvals(loop).real.max())
    path = _path(loop, float(until))[system.states.index(state)]
    left = float(np.abs(path[-1]) / np.abs(path).max())
    return Finding(
        left < _GONE and largest < 0.0,
        f"after {until} it is {path[-1]:.1e}, of {np.abs(path).max():.3g} at most",
        {"at the end": float(path[-1]), "largest": float(np.abs(path).max()), "largest real part": largest},
        "satsym simulate uny-lqr --feedback lqr",
    )


@predicate
def listed_motion(model: str, controls: tuple[str, ...], gain: tuple[str, ...], matrix: str) -> Finding:
    """Whether the free response of a printed system matrix is the motion under the printed control u = -K x."""
    from scipy.integrate import solve_ivp

    system, K = with_numbers(model, controls), _gain(gain)
    if matrix not in ("A", "A-B*K"):
        raise BadInput(f"listed_motion: no matrix {shown(matrix)}; write A or A-B*K")
    listed = system.A - system.B @ K if matrix == "A-B*K" else system.A
    times = np.linspace(0.0, 10.0, 11)
    moved = solve_ivp(
        lambda t, x: system.A @ x + system.B @ (-K @ x),
        (0.0, 10.0), np.ones(len(listed)), t_eval=times, rtol=1e-10, atol=1e-12,
    ).y  # fmt: skip
    gap = max(float(np.abs(expm(t * listed) @ np.ones(len(listed)) - moved[:, i]).max()) for i, t in enumerate(times))
    return Finding(gap < 1e-5, f"the two differ by {gap:.0e} at most", {"largest difference": gap})


def _orbit(power: float, start: tuple[float, ...], until: float) -> Array:
    """r, r_dot, theta, theta_dot without thrust where gravity is r^power, shape (4, steps + 1)."""
    from scipy.integrate import solve_ivp

    def rates(t: float, x: Array) -> list[float]:
        return [x[1], x[0] * x[3] ** 2 - x[0] ** power, x[3], -2.0 * x[1] * x[3] / x[0]]

    times = np.linspace(0.0, float(until), _STEPS + 1)
    found = solve_ivp(rates, (0.0, float(until)), start, t_eval=times, rtol=1e-10, atol=1e-12, method="DOP853")
    return np.asarray(found.y)


def _turns(path: Array) -> int:
    slopes = np.diff(path)
    return int((slopes[1:] * slopes[:-1] < 0.0).sum())


@predicate
def rises_and_falls(power: float, start: tuple[float, ...], until: float) -> Finding:
    """Whether the distance rises and falls from a start on, in the motion under gravity, and in the one printed.

    Parameters
    ----------
    power
        Of the distance, in the printed equations.
    start
        r, r_dot, theta, theta_dot, where mu is 1.
    until
        How long the listing integrates; the motion under gravity is followed ten times as long.
    """
    r, r_dot, _, theta_dot = start
    energy = 0.5 * (r_dot**2 + (r * theta_dot) ** 2) - 1.0 / r
    real, printed = _orbit(_GRAVITY, start, 10.0 * until), _orbit(power, start, until)
    turns = {"under gravity": _turns(real[0]), "as printed": _turns(printed[0])}
    rises = turns["under gravity"] >= 2
    return Finding(
        rises,
        f"under gravity the energy is {energy:g} and the distance turns {turns['under gravity']} times up to "
        f"t = {10 * until:g}, where it is {real[0, -1]:.3g}; with 1/r^{-power:g} for 1/r^2 it turns "
        f"{turns['as printed']} times up to {until:g}",
        {"energy": energy, **{f"turning points of r, {name}": count for name, count in turns.items()}},
        artefact=not rises and turns["as printed"] >= 2,
        remark="the swinging comes from the printed equation, whose gravity falls too slowly",
    )


@predicate
def disturbs_each(start: tuple[float, ...]) -> Finding:
    """Whether a start, where mu is 1, is off the circular orbit of radius 1 by 1 in each state."""
    orbit = np.array([1.0, 0.0, 0.0, 1.0])
    off = np.array(start, dtype=float) - orbit
    return Finding(
        bool(np.allclose(off, 1.0)),
        f"where mu = 1 the orbit of radius 1 has r = 1, r_dot = 0, theta_dot = 1, so the start is off it by "
        f"({', '.join(f'{value:g}' for value in off)})",
        {"off by": ", ".join(f"{value:g}" for value in off)},
    )


@predicate
def curves_are_rates(power: float, start: tuple[float, ...]) -> Finding:
    """Whether what an integrator gives back, the states, are the rates that a legend names: at the start."""
    x = np.array(start, dtype=float)
    rates = np.array([x[1], x[0] * x[3] ** 2 - x[0] ** power, x[3], -2.0 * x[1] * x[3] / x[0]])
    return Finding(
        bool(np.allclose(x, rates)),
        f"the curves begin at the states ({', '.join(f'{v:g}' for v in x)}); the rates there are "
        f"({', '.join(f'{v:g}' for v in rates)})",
        {"largest difference": float(np.abs(x - rates).max())},
        remark="the curves are x1 to x4, without dots",
    )
