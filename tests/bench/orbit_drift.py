"""What integrators do to an orbit over many revolutions: energy, angular momentum and place, against the closed form.

A method that is not symplectic loses or gains energy with every revolution; one that is lets it swing about what it
should be, with a swing that the step size sets. Both are reported: the trend, by a straight line through the samples,
and what is left about it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from satsym.analysis.orbits import kepler
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.simulation import closed_loop
from satsym.solvers.simulation.closed_loop import Law
from satsym.status import BadInput

SAMPLES = 97
"""A prime, so that samples fall on other places of the orbit each time: swings show."""
WORK = 1100
"""Evaluations of the acceleration a revolution, of methods with steps of one size."""
TOLERANCE = 1e-12

Integrator = Callable[[Instance, float, int], Array]
"""From an instance, a duration and a number of evaluations to the state at the end, shape (n,)."""


def by_rk4(start: Instance, duration: float, evaluations: int) -> Array:
    """With the generated loop: four evaluations a step."""
    times = np.linspace(0.0, duration, max(1, ceil(evaluations / 4)) + 1)
    u = np.zeros((len(start.model.spec.controls), len(times)))
    return start.model.forward(times, start.initial, u, u[:, 1:], start.parameters)[0][:, -1]


def by_symplectic(start: Instance, duration: float, evaluations: int) -> Array:
    """With the generated loop of kicks and drifts: eleven evaluations a step."""
    times = np.linspace(0.0, duration, max(1, ceil(evaluations / 11)) + 1)
    return start.model.symplectic(times, start.initial, start.parameters)[:, -1]


def by_dop853(start: Instance, duration: float, evaluations: int) -> Array:
    """With SciPy's DOP853, to a tolerance; a fresh start where that takes many evaluations."""
    coast = Law("none", lambda t, x: (0.0,) * len(start.model.spec.controls))
    f = start.model.dynamics

    def dynamics(t: float, x: Sequence[float], u: Sequence[float], p: Sequence[float]) -> Sequence[float]:
        return f(t, tuple(x), tuple(u), p)  # compiled code takes no lists

    pieces = ceil(evaluations / (0.5 * closed_loop.MOST_EVALUATIONS))
    for _ in range(pieces):
        run = closed_loop.simulate(start, coast, np.array([0.0, duration / pieces]), TOLERANCE, dynamics)
        start = replace(start, initial=tuple(run.x[:, -1].tolist()))
    return np.array(start.initial)


INTEGRATORS: Mapping[str, Integrator] = {"RK4": by_rk4, "DOP853": by_dop853, "symplectic": by_symplectic}
CLOSED_FORM = "closed form"


@dataclass(frozen=True, eq=False)
class Drift:
    """What one integrator did to an orbit."""

    revolutions: Array
    """When it was looked at, shape (S+1,); the first is the start."""
    energy: Array
    momentum: Array
    """Change since the start, relative to the size of the energy and of the angular momentum (the vector's change)."""
    position: Array
    """Distance from the closed form, relative to that from the centre."""

    @property
    def trend(self) -> float:
        """Change of the energy from start to end by the line of least squares."""
        return float(np.polyfit(self.revolutions, self.energy, 1)[0] * self.revolutions[-1])

    @property
    def swing(self) -> float:
        """Largest departure of the energy from that line."""
        return float(
            np.abs(self.energy - np.polyval(np.polyfit(self.revolutions, self.energy, 1), self.revolutions)).max()
        )


def drift(
    instance: Instance,
    revolutions: float,
    work: int = WORK,
    integrators: Mapping[str, Integrator] = INTEGRATORS,
    samples: int = SAMPLES,
) -> dict[str, Drift]:
    """Follow an orbit for many revolutions with each integrator, and in closed form.

    Parameters
    ----------
    instance
        Whose initial state is on an ellipse; ``replace(instance, model=instance.model.compiled())`` for compiled code.
    revolutions
        How many.
    work
        Evaluations of the acceleration a revolution, where the method lets one choose.
    integrators
        By name.
    samples
        How often energy, angular momentum and position are compared.

    Returns
    -------
    dict
        By name; the closed form comes last, compared with itself from sample to sample, which shows its rounding.

    Raises
    ------
    BadInput
        If the model's motion is not Kepler's, or the orbit not an ellipse.
    """
    if not instance.model.spec.keplerian:
        raise BadInput(f"{instance.name}: its motion is not Kepler's; take a model of Kepler motion")
    state = instance.model.inertial_state(0.0, instance.initial, instance.parameters)
    start, mu = np.array(state[:6]), float(state[6])
    radius = float(np.linalg.norm(start[:3]))
    binding = 2.0 / radius - float(start[3:] @ start[3:]) / mu
    if not binding > 0.0:
        raise BadInput(f"{instance.name}: not an ellipse, so it has no revolutions; take one that is bound")
    times = np.linspace(0.0, revolutions, samples + 1)
    seconds = times * 2.0 * np.pi / np.sqrt(mu * binding**3)
    exact = np.vstack(kepler.propagate(start[:3], start[3:], mu, seconds))

    found = {}
    for name, advance in integrators.items():
        here, states = replace(instance, t0=0.0), [instance.initial]
        for turns, duration in zip(np.diff(times), np.diff(seconds), strict=True):
            states.append(tuple(advance(here, float(duration), ceil(turns * work)).tolist()))
            here = replace(here, initial=states[-1])
        rows = instance.model.inertial_state_batch(0.0, np.array(states).T, instance.parameters)
        found[name] = _compared(times, rows[:6], exact, mu)
    steps = [start]
    for duration in np.diff(seconds):
        steps.append(np.concatenate(kepler.propagate(steps[-1][:3], steps[-1][3:], mu, duration)))
    return found | {CLOSED_FORM: _compared(times, np.array(steps).T, exact, mu)}


def _compared(times: Array, states: Array, exact: Array, mu: float) -> Drift:
    r, v = states[:3], states[3:]
    energy = 0.5 * np.sum(v * v, axis=0) - mu / np.linalg.norm(r, axis=0)
    momentum = np.cross(r, v, axis=0)
    turned = np.linalg.norm(momentum - momentum[:, :1], axis=0) / np.linalg.norm(momentum[:, 0])
    apart = np.linalg.norm(r - exact[:3], axis=0) / np.linalg.norm(exact[:3], axis=0)
    return Drift(times, energy / energy[0] - 1.0, turned, apart)
