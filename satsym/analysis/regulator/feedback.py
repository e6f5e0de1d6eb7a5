"""Simulations under the linear law u = -K (deviation), of the nonlinear and of the linear equations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from satsym.analysis.linear.equilibrium import Linearisation, linearise
from satsym.analysis.regulator.lqr import Regulator, regulator, required
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solution import Simulation
from satsym.solvers import simulate as simulated
from satsym.solvers.simulation.closed_loop import Law
from satsym.status import BadInput, Status

FEEDBACKS = ("none", "lqr", "classical", "switching", "pulses")
"""Control laws that a simulation can follow."""

GAINS_PER_TIME = 50.0
"""Number of gains of a finite horizon for each time constant of the closed loop's fastest motion."""
MOST_GAINS = 20000


@dataclass(frozen=True, eq=False)
class Design:
    """A linear-quadratic regulator, with the linearisation and the instance it was designed for."""

    about: Linearisation
    """The linearisation."""
    regulator: Regulator
    """Regulator that closes the loop."""
    instance: Instance | None
    """The instance that is regulated; ``None`` for the design of a model alone."""

    @property
    def title(self) -> str:
        """Return a line that says what the design is about."""
        spec = self.about.model.spec
        return spec.title if self.instance is None else self.instance.title or spec.title

    @property
    def relative(self) -> bool:
        """Tell whether the weights come from allowed deviations."""
        return self.instance is not None and self.instance.lqr is not None and self.instance.lqr.relative

    @property
    def deviation(self) -> Array | None:
        """Return the initial deviation of the instance from its reference or equilibrium; shape (n,)."""
        return None if self.instance is None else np.array(self.instance.initial) - self.about.point


def designed(subject: Kernels | Instance) -> Design:
    """Design the regulator of an instance's [lqr] table, or that of a model with all weights 1.

    Raises
    ------
    BadInput
        If the instance has no such table, or there is no such regulator.
    """
    if isinstance(subject, Kernels):
        about = linearise(subject)
        return Design(about, regulator(about), None)
    options = required(subject)
    about = linearise(subject)
    try:
        return Design(about, regulator(about, options), subject)
    except BadInput as error:
        raise BadInput(f"{subject.name}: {error}") from None


@np.errstate(all="ignore")  # numbers out of range are a status
def simulate(instance: Instance, feedback: str | None = None) -> Simulation:
    """Simulate an instance under a feedback.

    Parameters
    ----------
    feedback
        ``"none"``, ``"lqr"`` for the gain that the instance's [lqr] table asks for, ``"classical"`` for the law of
        its [classical] table, or with the deadband of its [switching] table ``"switching"`` for least time by the
        switching curve, and ``"pulses"`` for least time by the position alone. By default ``"classical"`` where there
        is such a table, and else none.

    Returns
    -------
    Simulation
        With ``"lqr"`` its metrics have ``lqr_cost``, the integral of x'Qx + 2x'Nu + u'Ru for the deviation x along the
        simulation, and ``lqr_cost_linear``, what the linear system would pay from the same start.

    Raises
    ------
    BadInput
        If there is no such feedback, or the instance does not suit it.
    """
    if feedback is None:
        feedback = "classical" if instance.classical else "none"
    if feedback not in FEEDBACKS:
        raise BadInput(f"--feedback {feedback}: unknown; the control laws of this model are {', '.join(FEEDBACKS)}")
    if feedback == "none":
        return simulated(instance)
    if feedback == "classical":
        from satsym.analysis.classical import law as classical

        return classical.simulate(instance)
    if feedback == "switching":
        from satsym.analysis.classical import minimum_time

        return minimum_time.by_relay(instance)
    if feedback == "pulses":
        from satsym.analysis.classical import minimum_time

        return minimum_time.by_pulses(instance)
    design = designed(instance)
    about, found = design.about, design.regulator
    simulation = simulated(instance, law(about, found))
    if simulation.status is Status.TIME_LIMIT:
        return simulation
    x = simulation.x - about.along(simulation.times)
    u = simulation.u[[about.system.inputs.index(name) for name in found.system.inputs]]
    paid = {"lqr_cost": _integral(simulation.times, running_cost(found, x, u)), "lqr_cost_linear": found.cost(x[:, 0])}
    return replace(simulation, metrics=simulation.metrics | paid)


def law(about: Linearisation, found: Regulator) -> Law:
    """Return the law u = -K (x - c(t)) about the reference or the equilibrium c."""
    model, p, point = about.model, about.parameters, about.point.tolist()
    places = [about.system.inputs.index(name) for name in found.system.inputs]
    zeros = [0.0] * len(about.system.inputs)
    on_reference, reference = about.on_reference, getattr(model, "reference", None)
    K = gain(about, found)

    def control(t: float, x: Sequence[float]) -> Sequence[float]:
        centre = reference(t, p) if on_reference and reference else point
        deviation = [y - c for y, c in zip(x, centre, strict=True)]
        u = zeros.copy()
        for place, row in zip(places, K(t), strict=True):
            u[place] = -sum(k * d for k, d in zip(row, deviation, strict=True))
        return u

    linear = found.horizon is None and not on_reference and not about.point.any()
    whole = np.zeros((len(zeros), len(point)))
    whole[places] = found.K
    return Law("lqr", control, whole if linear else None)


def gain(about: Linearisation, found: Regulator) -> Callable[[float], list[list[float]]]:
    """Return K at a time, by rows; for a finite horizon interpolated, and 0 after its end."""
    constant: list[list[float]] = found.K.tolist()
    if found.horizon is None:
        return lambda _: constant
    from scipy.interpolate import CubicSpline

    fastest = float(np.abs(found.eigenvalues).max())
    count = int(np.clip(GAINS_PER_TIME * fastest * found.horizon, 200, MOST_GAINS))
    t0, end, zeros = about.t0, about.t0 + found.horizon, np.zeros_like(found.K).tolist()
    table = CubicSpline(np.linspace(t0, end, count + 1), found.gains(count))
    return lambda t: table(t).tolist() if t < end else zeros


def running_cost(found: Regulator, x: Array, u: Array) -> Array:
    """Return x'Qx + 2x'Nu + u'Ru of deviations (n, M) and active inputs (m, M), shape (M,)."""
    terms = ((x, found.Q, x), (2.0 * x, found.N, u), (u, found.R, u))
    return np.asarray(sum(np.einsum("im,ij,jm->m", *term) for term in terms))


def _integral(times: Array, values: Array) -> float:
    """Integrate values on a fine grid over time by a spline of order six; NaN where a value is NaN."""
    from scipy.interpolate import make_interp_spline

    if not np.isfinite(values).all():
        return float("nan")
    return float(make_interp_spline(times, values, k=min(5, len(times) - 1)).integrate(times[0], times[-1]))
