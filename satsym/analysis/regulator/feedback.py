"""Motions under the linear law u = -K (deviation), of the nonlinear and of the linear equations.

These are simulations of instances, responses to a disturbance without control and with the gain, and motions from many
deviations, which estimate the region of attraction.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.linear.equilibrium import Linearisation, linearise
from satsym.analysis.linear.system import LinearSystem, scaled
from satsym.analysis.regulator.lqr import Regulator, regulator, required
from satsym.arrays import Array
from satsym.choices import FEEDBACKS
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solution import Simulation
from satsym.solvers import simulate as simulated
from satsym.solvers.simulation import closed_loop
from satsym.solvers.simulation.closed_loop import Law
from satsym.status import BadInput, Status

GAINS_PER_TIME = 50.0
"""Number of gains of a finite horizon for each time constant of the closed loop's fastest motion."""
MOST_GAINS = 20000

STEPS = 1000
"""Intervals of the time grid on which responses are given."""
TOLERANCE = 1e-9

DIRECTIONS = 64
"""Number of directions in addition to those of single states."""
SIZES = np.geomspace(1e-4, 1e2, 25)
"""Sizes of deviations that are tried first, relative to the size of the motion itself."""
REFINED = 10
"""Number of sizes between the last deviation that returns and the first that does not, in each of two refinements."""
RETURNED = 1e-6
"""Fraction of the initial cost to go x'Px below which a motion counts as returned."""
PATIENCE = 25.0
"""Time allowed for the return, in time constants of the closed loop's slowest motion."""
STEP = 0.1
"""Step of RK4, relative to the time constant of the fastest motion."""
MOST_STEPS = 20000


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


@dataclass(frozen=True, eq=False)
class Response:
    """One response to a disturbance: deviations x, shape (n, N+1), and active inputs u, shape (m, N+1)."""

    x: Array
    u: Array

    def cost(self, found: Regulator, times: Array) -> Array:
        """Return the integral of x'Qx + 2x'Nu + u'Ru from the first time to each, shape (N+1,)."""
        rate = running_cost(found, self.x, self.u)
        steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(times)
        return np.concatenate([[0.0], np.cumsum(steps)])


@dataclass(frozen=True, eq=False)
class Responses:
    """Responses to one disturbance, of the linear and the exact equations, with and without feedback."""

    times: Array
    """Times of the responses, shape (N+1,)."""
    free: Response
    steered: Response
    """Responses of the linear system, without control and with the gain."""
    exact_free: Response | None
    exact_steered: Response | None
    """Responses of the exact motion, within the instance's bounds; ``None`` where only the linear one is known."""


def responses(design: Design, case: Instance) -> Responses:
    """Compute the responses to the initial deviation of an instance, from its initial to its final time."""
    assert case.tf is not None
    times, start = Grid.uniform(case.t0, case.tf, STEPS).nodes, np.array(case.initial) - design.about.point
    system, rest = design.regulator.system, np.zeros((len(design.regulator.system.inputs), STEPS + 1))
    return Responses(
        times=times,
        free=Response(linear_motion(system, start, times), rest),
        steered=_steered(design, start, times),
        exact_free=_exact(design, case, times, steered=False) if design.about.nonlinear else None,
        exact_steered=_exact(design, case, times, steered=True) if design.about.nonlinear else None,
    )


def linear_motion(system: LinearSystem, start: Array, times: Array) -> Array:
    """Solve x' = A x at evenly spaced times, shape (n, N+1)."""
    step = system.transition(float(times[1] - times[0]))
    path = [np.asarray(start, dtype=float)]
    for _ in times[1:]:
        path.append(step @ path[-1])
    return np.array(path).T


def _steered(design: Design, start: Array, times: Array) -> Response:
    found = design.regulator
    if found.horizon is None:
        x = linear_motion(found.closed_loop, start, times)
        return Response(x, -found.K @ x)
    from scipy.integrate import solve_ivp

    system, K = found.system, gain(design.about, found)
    x = solve_ivp(
        lambda t, x: system.A @ x - system.B @ (np.array(K(t)) @ x),
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=TOLERANCE,
        atol=TOLERANCE * np.abs(linear_motion(system, start, times)).max(axis=1),
    ).y
    return Response(x, -np.einsum("kij,jk->ik", np.array([K(t) for t in times]), x))


def _exact(design: Design, case: Instance, times: Array, steered: bool) -> Response:
    """Simulate the exact motion, with the law acting or not."""
    acting = law(design.about, design.regulator)
    nothing = [0.0] * len(case.model.spec.controls)
    driven = acting if steered else replace(acting, control=lambda t, x: nothing)
    run = closed_loop.simulate(case, driven, times, TOLERANCE, design.about.rates)
    places = [design.about.system.inputs.index(name) for name in design.regulator.system.inputs]
    return Response(run.x - np.array([design.about.at(t) for t in times]).T, run.u[places])


@dataclass(frozen=True)
class RegionOfAttraction:
    """An estimate of the deviations from which the motion returns."""

    extents: Mapping[str, tuple[float, float]]
    """By state, the most negative and the most positive deviation of this state alone, in the model's unit, up to which
    every tried one returns; infinite where all did."""
    level: float
    """The largest x'Px up to which every tried deviation returns."""
    time: float
    """The time allowed for the return."""


def region_of_attraction(about: Linearisation, found: Regulator, case: Instance | None = None) -> RegionOfAttraction:
    """Estimate the region of attraction of a linear law.

    Parameters
    ----------
    about, found
        The linearisation, and a regulator of it with an infinite horizon.
    case
        An instance whose bounds on the controls hold; by default there are no bounds.

    Raises
    ------
    BadInput
        If the horizon is finite: nothing steers after its end; or if the cost to go is not positive.
    """
    if found.horizon is not None:
        raise BadInput("a region of attraction requires an infinite horizon; leave out [lqr] horizon")
    if not found.positive:
        raise BadInput(
            "a region of attraction is measured by the cost to go x'Px, which is not positive with these weights; "
            "use a positive definite [lqr] Q"
        )
    n, names = len(about.point), about.system.states
    time = PATIENCE / float(-found.eigenvalues.real.max())
    if not about.nonlinear and (case is None or not case.control_set.bounded):
        return RegionOfAttraction(dict.fromkeys(names, (-np.inf, np.inf)), np.inf, time)
    directions = _directions(found.P, n)
    size = np.sqrt(found.cost(np.abs(about.point) + scaled(about.system).states))
    safe, unsafe = np.zeros(directions.shape[1]), np.full(directions.shape[1], np.inf)
    tried = np.repeat(size * SIZES[:, None], directions.shape[1], axis=1)
    for _ in range(3):
        back = _returns(about, found, case, directions, tried, time)
        first = np.where(back.all(axis=0), len(tried), (~back).argmax(axis=0))
        column = np.arange(len(first))
        safe = np.where(first > 0, tried[first - 1, column], safe)
        unsafe = np.where(first < len(tried), tried[np.minimum(first, len(tried) - 1), column], unsafe)
        fraction = np.arange(1, REFINED + 1)[:, None] / (REFINED + 1)
        tried = safe + fraction * np.where(np.isfinite(unsafe), unsafe - safe, 0.0)
    reach = np.where(np.isfinite(unsafe), safe, np.inf)
    alone = reach[: 2 * n] / np.sqrt(np.repeat(np.diag(found.P), 2))
    extents = {name: (-float(alone[2 * i + 1]), float(alone[2 * i])) for i, name in enumerate(names)}
    return RegionOfAttraction(extents, float(reach.min() ** 2), time)


def _directions(P: Array, n: int) -> Array:
    """Return deviations with x'Px = 1: along each state, up and down, then some others; shape (n, count)."""
    alone = np.repeat(np.eye(n), 2, axis=1) * np.tile([1.0, -1.0], n)
    unit = 1.0 / np.sqrt(np.diag(P))
    drawn = np.random.default_rng(0).normal(size=(n, DIRECTIONS))  # the same ones every time
    evenly = np.linalg.solve(np.linalg.cholesky(P * np.outer(unit, unit)).T, drawn) * unit[:, None]
    found = np.hstack([alone, evenly])
    return np.asarray(found / np.sqrt(np.einsum("im,ij,jm->m", found, P, found)))


def _returns(
    about: Linearisation, found: Regulator, case: Instance | None, directions: Array, sizes: Array, time: float
) -> NDArray[np.bool_]:
    """Tell which deviations, sizes (k, count) times directions (n, count), return in time; shape (k, count)."""
    model, p = about.model, about.parameters
    K = np.zeros((len(about.system.inputs), len(about.point)))
    K[[about.system.inputs.index(name) for name in found.system.inputs]] = found.K
    positive = [i for i, state in enumerate(model.spec.states) if state.positive]
    steps = int(min(MOST_STEPS, np.ceil(time * np.abs(found.eigenvalues).max() / STEP)))
    h, t = time / steps, about.t0

    def rates(t: float, x: Array) -> Array:
        u = -K @ (x - about.at(t)[:, None])
        return np.asarray(about.rates_batch(t, x, u if case is None else case.control_set.project(u), p))

    x = about.point[:, None] + (directions[:, None] * sizes).reshape(len(directions), -1)
    inside = np.ones(x.shape[1], bool)
    with np.errstate(all="ignore"):
        for _ in range(steps):
            k1 = rates(t, x)
            k2 = rates(t + 0.5 * h, x + 0.5 * h * k1)
            k3 = rates(t + 0.5 * h, x + 0.5 * h * k2)
            x, t = x + h / 6.0 * (k1 + 2.0 * (k2 + k3) + rates(t + h, x + h * k3)), t + h
            inside &= (x[positive] > 0.0).all(axis=0)
        left = x - about.at(t)[:, None]
        cost = np.einsum("im,ij,jm->m", left, found.P, left)
    return (inside & (cost <= RETURNED * sizes.ravel() ** 2)).reshape(sizes.shape)
