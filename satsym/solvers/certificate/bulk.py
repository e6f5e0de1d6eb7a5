"""Many solutions certified at once: the same conditions, with what is integrated in common on arrays.

For problems that are smooth and have both ends given, so that first-order conditions, Legendre's and Jacobi's make a
strict local minimum. Here that is only ever confirmed: whatever is not clear beyond doubt is left to :func:`certify`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate import conditions
from satsym.solvers.certificate.conclusion import OF_NODES, concluded
from satsym.solvers.certificate.corners import positive
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, TOLERANCE, Flow, typical, unit_sizes
from satsym.solvers.certificate.reintegration.node_defect import Parameters, joined, missed, stretches
from satsym.solvers.certificate.reintegration.segments import balanced
from satsym.solvers.certificate.verdict import certify
from satsym.solvers.simulation.extrapolation import leap_and_error
from satsym.status import Verdict

LEAPS = range(20, 51)
"""Numbers of leaps of the flow from the initial costates, of which one must divide the steps of the solutions."""

FINER = (1, 2, 4)
"""Into how many parts leaps are taken until their errors are small enough."""

COLUMNS, UNDRIVEN = 6, 4
"""How many the extrapolation table has, and for the uncontrolled motion, of which only the size matters."""

SEGMENTS = (16, 20, 25, 40, 50, 64, 80, 100, 125)
"""Numbers of segments of the variational equations that are tried, one after the other."""

LOOKS = range(100, 201)
"""Numbers of times at which it is looked how quickly phases turn."""

VARIATIONS, ROUGH = 5, 0.01
"""Columns of the extrapolation table of these equations, and the relative error that is small enough."""

WHOLE = 0.9 * 2.0 * np.pi
"""Turn of a phase in a segment: below a full turn, so that it has no conjugate point of its own."""

TOGETHER = 4
"""Solutions from whose nodes it is integrated at once."""

SAME_TIME = 1e-12
"""Share of the duration by which a node may miss an even one that it is."""


def certify_all(solutions: Sequence[Solution]) -> list[Certificate | None]:
    """Certificates of answers to instances of one model that differ in initial states and parameters, not competitors.

    Parameters
    ----------
    solutions
        By one method, with as many steps; others than this is made for are certified one by one.

    Returns
    -------
    list
        As ``certify(solution, compared=False)`` gives them, whose verdict a clear case has without all of its checks.
    """
    fit = [k for k, one in enumerate(solutions) if fits(one) and _alike(one.instance, solutions[0].instance)]
    found: dict[int, Certificate | None] = {}
    if len(fit) > 1:
        with np.errstate(all="ignore"):
            found = dict(zip(fit, _confirmed([solutions[k] for k in fit]), strict=True))
        unit_sizes.cache_clear()  # it keeps solutions alive
    return [found.get(k) or certify(solution, compared=False) for k, solution in enumerate(solutions)]


def fits(solution: Solution) -> bool:
    """Whether a solution is of a kind that is certified here."""
    instance, spec = solution.instance, solution.instance.model.spec
    smooth = not (spec.switching or spec.throttled or spec.stationary or spec.directional)
    smooth = smooth and not (spec.multipliers or spec.in_arcs)
    given = instance.tf is not None and len(instance.final) == len(instance.initial)
    steps = instance.solver.steps
    divided = _divisor(steps, LEAPS) is not None and _divisor(steps, LOOKS) is not None
    met = any(map(len, solution.switching_times))
    plain = not (instance.free or instance.solver.free_angles)
    suited = solution.status.answered and smooth and given and divided and plain and not met
    return suited and _places(solution) is not None


def _alike(one: Instance, other: Instance) -> bool:
    """Whether two instances can be columns of the same arrays."""
    same = one.model is other.model and one.solver.steps == other.solver.steps
    return same and one.control_set.arguments == other.control_set.arguments


def _places(solution: Solution) -> NDArray[np.intp] | None:
    """Where the even nodes are among those of a solution; ``None`` where some are not."""
    times, steps = solution.times, solution.instance.solver.steps
    even, slack = np.linspace(times[0], times[-1], steps + 1), SAME_TIME * float(times[-1] - times[0])
    found = np.minimum(np.searchsorted(times, even - slack), len(times) - 1)
    return found if (np.abs(times[found] - even) <= slack).all() else None


def _divisor(steps: int, among: range) -> int | None:
    """The largest of some numbers that divides the steps."""
    return next((k for k in reversed(among) if steps % k == 0), None)


@dataclass(frozen=True, eq=False)
class _Together:
    """Solutions as columns."""

    solutions: Sequence[Solution]
    instance: Instance
    """The first; what all share is taken from it."""
    parameters: tuple[Array, ...]
    """The model's parameters of each solution, shapes (M,)."""
    start: Array
    """Initial states and costates, shape (2n, M)."""
    sizes: Array
    """To which errors of these are held, shape (2n, M)."""
    times: Array
    """Times of the even nodes, shape (M, N+1)."""
    nodes: Array
    """States and costates there, shape (2n, M, N+1)."""

    @classmethod
    def of(cls, solutions: Sequence[Solution]) -> _Together:
        picked = [found for s in solutions if (found := _places(s)) is not None]
        both = list(zip(solutions, picked, strict=True))
        return cls(
            solutions,
            solutions[0].instance,
            tuple(np.array([s.instance.parameters for s in solutions]).T.copy()),
            np.array([[*s.instance.initial, *s.lam[:, 0]] for s in solutions]).T.copy(),
            np.array([np.concatenate(typical(s, FAINT_COSTATE)) for s in solutions]).T.copy(),
            np.array([s.times[k] for s, k in both]),
            np.array([np.concatenate([s.x[:, k], s.lam[:, k]]) for s, k in both]).transpose(1, 0, 2).copy(),
        )

    @property
    def begin(self) -> Array:
        return np.asarray(self.times[:, 0])

    @property
    def lasting(self) -> Array:
        return np.asarray(self.times[:, -1] - self.times[:, 0])


def _confirmed(solutions: Sequence[Solution]) -> list[Certificate | None]:
    """Certificates of those that are minima beyond doubt."""
    together = _Together.of(solutions)
    flows, without = _flows(together), _undriven(together)
    clear, defects = _without_conjugate_points(together), _node_defects(together)
    found: list[Certificate | None] = []
    for k, (solution, flow) in enumerate(zip(solutions, flows, strict=True)):
        found.append(_judged(solution, flow, without[:, k], defects[k]) if flow is not None and clear[k] else None)
    first = next((k for k, certificate in enumerate(found) if certificate is not None), None)
    if first is not None:  # kernels that contradict each other do so everywhere
        certificate = found[first]
        assert certificate is not None
        if with_kernels_examined(certificate, solutions[first]).verdict is Verdict.FAILED:
            return [None] * len(found)
    return found


def _judged(solution: Solution, flow: Flow, without: Array, defect: float) -> Certificate | None:
    first = [
        *conditions.first_order(solution, flow, without=without),
        Check(OF_NODES, defect, conditions.DEFECT),
    ]
    legendre = conditions.legendre_clebsch(solution)
    if not (all(check.passed for check in first) and legendre > 0.0):
        return None
    second = (Check("legendre-clebsch", 0.0, 0.0), Check("conjugate points: none", 0.0, 0.0))
    return concluded(first, second, legendre, compared=False)


def _flows(together: _Together) -> list[Flow | None]:
    """The flow from the initial costates of each; ``None`` where it is not accurate or not finite."""
    model, n, bounds = together.instance.model, len(together.start) // 2, together.instance.control_set.arguments
    p = together.parameters

    def rates(t: Array, y: Array) -> Array:
        x, lam = y[:n], y[n : 2 * n]
        cost = model.running_cost_batch(t, x, model.control_law_batch(t, x, lam, p, bounds), p)
        return np.concatenate([model.canonical_batch(t, x, lam, p, bounds), np.broadcast_to(cost, t.shape)[None]])

    leaps = _divisor(together.instance.solver.steps, LEAPS)
    assert leaps is not None
    worth = np.einsum("im,im->m", together.sizes[:n], together.sizes[n:])
    sizes = np.concatenate([together.sizes, worth[None]])
    start = np.concatenate([together.start, np.zeros((1, len(worth)))])
    for finer in FINER:
        values, error = _integrated(rates, together, start, sizes, leaps, finer, COLUMNS)
        accurate = error <= TOLERANCE
        if accurate.all():
            break
    found: list[Flow | None] = []
    for k, solution in enumerate(together.solutions):
        own = values[:, :, k]
        if not (accurate[k] and np.isfinite(own).all()):
            found.append(None)
            continue
        stations = np.linspace(solution.times[0], solution.times[-1], leaps + 1)
        end = tuple(own[-1, :n].tolist())
        terminal = float(model.terminal_cost(float(stations[-1]), end, solution.instance.parameters))
        found.append(Flow(stations, own[:, :n].T, own[:, n : 2 * n].T, float(own[-1, -1]) + terminal))
    return found


def _undriven(together: _Together) -> Array:
    """Where each motion would end without control, shape (n, M)."""
    model, n, p = together.instance.model, len(together.start) // 2, together.parameters
    none = np.zeros((len(model.spec.controls), len(together.solutions)))

    def rates(t: Array, x: Array) -> Array:
        return np.asarray(model.dynamics_batch(t, x, none, p))

    leaps = _divisor(together.instance.solver.steps, LEAPS)
    assert leaps is not None
    values, _ = _integrated(rates, together, together.start[:n], together.sizes[:n], leaps, 1, UNDRIVEN)
    return np.asarray(values[-1])


def _integrated(
    rates: Callable[[Any, Array], Array],
    together: _Together,
    start: Array,
    sizes: Array,
    leaps: int,
    finer: int,
    columns: int,
) -> tuple[Array, Array]:
    """Values at the ends of leaps, shape (leaps + 1, d, M), and the largest error of a step, relative, shape (M,)."""
    h = together.lasting / (leaps * finer)
    values, now, worst = [start], start, np.zeros(start.shape[1])
    for k in range(leaps * finer):
        now, error = leap_and_error(rates, together.begin + k * h, now, h, columns)
        worst = np.maximum(worst, (error / np.maximum(sizes, np.abs(now))).max(axis=0))
        if (k + 1) % finer == 0:
            values.append(now)
    return np.array(values), np.where(np.isfinite(worst), worst, np.inf)


def _node_defects(together: _Together) -> list[float]:
    """By how much each solution misses its next nodes at most, in blocks that stay in the processor's cache."""
    model, n, bounds = together.instance.model, len(together.start) // 2, together.instance.control_set.arguments

    def rates(t: Array, z: Array, p: Parameters) -> Array:
        return np.asarray(model.canonical_batch(t, z[:n], z[n:], p, bounds))

    found: list[float] = []
    for at in range(0, len(together.solutions), TOGETHER):
        parts = [stretches(one) for one in together.solutions[at : at + TOGETHER]]
        every, ends = joined(parts), np.cumsum([len(one.begins) for one in parts])[:-1]
        found += [float(own.max()) for own in np.split(missed(rates, every), ends)]
    return found


def _without_conjugate_points(together: _Together) -> NDArray[np.bool_]:
    """Which have none beyond doubt, shape (M,)."""
    steps, found = together.instance.solver.steps, np.zeros(len(together.solutions), bool)
    slopes, scale = _slopes(together)
    rates = 2.0 * np.sqrt(np.einsum("mkij,mkij->mk", slopes, slopes))  # no phase turns more quickly
    turned = np.maximum(rates[:, 1:], rates[:, :-1]) * (together.lasting / (rates.shape[1] - 1))[:, None]
    for segments in (count for count in SEGMENTS if steps % count == 0 and turned.shape[1] % count == 0):
        left = ~found & (turned.reshape(len(turned), segments, -1).sum(axis=2).max(axis=1) < WHOLE)
        if left.any():
            places = np.flatnonzero(left)
            transition, rough = _transitions(together, places, segments, scale)
            sound = places[rough < ROUGH]
            found[sound] = positive(transition[rough < ROUGH].transpose(2, 3, 1, 0))
        if found.all():
            break
    return found


def _slopes(together: _Together) -> tuple[Array, Array]:
    """The canonical rates by states and costates at even times, scaled, shape (M, K, 2n, 2n), and their scale.

    Any scale in which states and their costates have equal products keeps transitions symplectic: that of the first
    solution does for all.
    """
    instance, n = together.instance, len(together.start) // 2
    every = instance.solver.steps // (_divisor(instance.solver.steps, LOOKS) or instance.solver.steps)
    nodes, times = together.nodes[:, :, ::every], together.times[:, ::every]
    columns = nodes.reshape(2 * n, -1)
    p = tuple(np.repeat(one, times.shape[1]) for one in together.parameters)
    bounds = instance.control_set.arguments
    table = np.asarray(instance.model.canonical_jacobian_batch(times.ravel(), columns[:n], columns[n:], p, bounds))
    first = np.abs(table[:, :, : times.shape[1]]).max(axis=2)
    scale = balanced(unit_sizes(together.solutions[0]), first, float(together.lasting[0]))
    scaled = table * (scale / scale[:, None])[:, :, None]
    return scaled.transpose(2, 0, 1).reshape(*times.shape, 2 * n, 2 * n), scale


def _transitions(together: _Together, places: NDArray[np.intp], segments: int, scale: Array) -> tuple[Array, Array]:
    """Over each segment, scaled, shape (M, segments, 2n, 2n), and their errors, shape (M,).

    The latter are those of how the ends follow the costates, relative to that itself: where a control acts through
    several states this is small.
    """
    model, bounds = together.instance.model, together.instance.control_set.arguments
    every, size = together.instance.solver.steps // segments, len(scale)
    n, ratio = size // 2, (scale / scale[:, None])[:, :, None]
    p = tuple(np.repeat(one[places], segments) for one in together.parameters)

    def rates(t: Array, y: Array) -> Array:
        found = np.empty_like(y)
        found[:size] = model.canonical_batch(t, y[:n], y[n:size], p, bounds)
        slopes = np.asarray(model.canonical_jacobian_batch(t, y[:n], y[n:size], p, bounds)) * ratio
        varied = slopes.transpose(2, 0, 1) @ y[size:].reshape(size, size, -1).transpose(2, 0, 1)
        found[size:] = varied.transpose(1, 2, 0).reshape(size * size, -1)
        return found

    begins = together.nodes[:, places, :-1:every].reshape(size, -1)
    unity = np.repeat(np.eye(size).reshape(-1, 1), begins.shape[1], axis=1)
    h = np.repeat(together.lasting[places] / segments, segments)
    start = np.concatenate([begins, unity])
    reached, error = leap_and_error(rates, together.times[places, :-1:every].ravel(), start, h, VARIATIONS)
    shape = (size, size, len(places), segments)
    whole, off = (one[size:].reshape(shape).transpose(2, 3, 0, 1) for one in (reached, error))
    try:
        rough = (np.abs(np.linalg.inv(whole[..., :n, n:])) @ off[..., :n, n:]).max(axis=(1, 2, 3))
    except np.linalg.LinAlgError:
        rough = np.full(len(places), np.inf)
    return whole, np.where(np.isfinite(rough), rough, np.inf)
