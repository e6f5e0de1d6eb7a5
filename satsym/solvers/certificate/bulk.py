"""Many solutions certified at once: the same conditions, with what is integrated in common on arrays.

For problems that are smooth and have both ends given, so that first-order conditions, Legendre's and Jacobi's make a
strict local minimum. Here that is only ever confirmed: whatever is not clear beyond doubt is left to :func:`certify`.

Jacobi's condition is seen in the cost of broken extremals, whose corners lie at the ends of segments so short that none
has a conjugate point of its own: its second derivatives by the corners, a matrix with three block diagonals, are
positive definite if and only if the whole has none (Morse, The calculus of variations in the large, 1934, III).
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
from satsym.solvers.certificate.flow import FAINT, TOLERANCE, Flow, typical, unit_sizes
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.segments import balanced
from satsym.solvers.certificate.verdict import certify, first_order
from satsym.solvers.simulation.extrapolation import leap_and_error
from satsym.status import Verdict

LEAPS = range(20, 51)
"""Numbers of leaps of the flow from the initial costates, of which one must divide the steps of the solutions."""

FINER = (1, 2, 4)
"""Into how many parts leaps are taken until their errors are small enough."""

COLUMNS, UNDRIVEN = 6, 4
"""Of the extrapolation table; for the motion without control only its size matters."""

SEGMENTS, MERGED = range(24, 65), (4, 2)
"""Numbers of segments of the variational equations, eight times of which must divide the steps of the solutions, and
Runge-Kutta steps in each; half as many where phases turn too much."""

WHOLE = 0.9 * 2.0 * np.pi
"""Turn of a phase in a segment: below a full turn, so that it has no conjugate point of its own."""

CLEAR = 1e-3
"""Least eigenvalue of the second derivatives at a corner, normed, that is positive beyond doubt."""


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
    fit = [k for k, solution in enumerate(solutions) if fits(solution)]
    found: dict[int, Certificate | None] = {}
    if len(fit) > 1:
        with np.errstate(all="ignore"):
            found = dict(zip(fit, _confirmed([solutions[k] for k in fit]), strict=True))
    return [found.get(k) or certify(solution, compared=False) for k, solution in enumerate(solutions)]


def fits(solution: Solution) -> bool:
    """Whether a solution is of a kind that is certified here."""
    instance, spec = solution.instance, solution.instance.model.spec
    smooth = not (spec.switching or spec.throttled or spec.stationary or spec.directional or spec.multipliers)
    given = instance.tf is not None and len(instance.final) == len(instance.initial)
    steps = instance.solver.steps
    divided = _divisor(steps, LEAPS) is not None and _divisor(steps, SEGMENTS, 8) is not None
    met = any(map(len, solution.switching_times))
    plain = not (instance.free or instance.solver.free_angles)
    return solution.status.answered and smooth and given and divided and plain and not met


def _divisor(steps: int, among: range, by: int = 1) -> int | None:
    """The largest of some numbers of which so many times divide the steps."""
    return next((k for k in reversed(among) if steps % (by * k) == 0), None)


@dataclass(frozen=True, eq=False)
class _Together:
    """Solutions as columns."""

    solutions: Sequence[Solution]
    instance: Instance
    """The first; what all share is taken from it."""
    parameters: tuple[Array, ...]
    """Of each, shapes (M,)."""
    start: Array
    """Initial states and costates, shape (2n, M)."""
    sizes: Array
    """To which errors of these are held, shape (2n, M)."""
    times: Array
    """Of the even nodes, shape (M, N+1)."""
    nodes: Array
    """States and costates there, shape (2n, M, N+1)."""

    @classmethod
    def of(cls, solutions: Sequence[Solution]) -> _Together:
        steps = solutions[0].instance.solver.steps
        picked = []
        for s in solutions:
            even = np.linspace(s.times[0], s.times[-1], steps + 1)
            picked.append(np.clip(np.searchsorted(s.times, even - 1e-12 * (even[-1] - even[0])), 0, len(s.times) - 1))
        both = zip(solutions, picked, strict=True)
        return cls(
            solutions,
            solutions[0].instance,
            tuple(np.array([s.instance.parameters for s in solutions]).T.copy()),
            np.array([[*s.instance.initial, *s.lam[:, 0]] for s in solutions]).T.copy(),
            np.array([np.concatenate(typical(s, FAINT)) for s in solutions]).T.copy(),
            np.array([s.times[k] for s, k in zip(solutions, picked, strict=True)]),
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
    clear = _without_conjugate_points(together)
    found: list[Certificate | None] = []
    for k, (solution, flow) in enumerate(zip(solutions, flows, strict=True)):
        found.append(_judged(solution, flow, without[:, k]) if flow is not None and clear[k] else None)
    first = next((k for k, certificate in enumerate(found) if certificate is not None), None)
    if first is not None:  # kernels that contradict each other do so everywhere
        certificate = found[first]
        assert certificate is not None
        if with_kernels_examined(certificate, solutions[first]).verdict is Verdict.FAILED:
            return [None] * len(found)
    return found


def _judged(solution: Solution, flow: Flow, without: Array) -> Certificate | None:
    first = first_order(solution, flow, conditions.OF_FLOW, without)
    legendre = conditions.legendre_clebsch(solution)
    if not (all(check.passed for check in first) and legendre > 0.0):
        return None
    second = (Check("legendre-clebsch", 0.0, 0.0), Check("conjugate points: none", 0.0, 0.0))
    return Certificate(
        Verdict.LOCAL_MINIMUM,
        **conditions.headlines(first),
        legendre_clebsch=legendre,
        conjugate_time=None,
        checks=(*first, *second),
    )


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


def _without_conjugate_points(together: _Together) -> NDArray[np.bool_]:
    """Which have none beyond doubt, shape (M,)."""
    segments = _divisor(together.instance.solver.steps, SEGMENTS, 8)
    assert segments is not None
    slopes = _slopes(together, 8 * segments)
    size = slopes.shape[-1]
    norms = 2.0 * np.sqrt(np.einsum("mkij,mkij->mk", slopes, slopes))  # no phase turns more quickly
    turned = np.maximum(norms[:, 1:], norms[:, :-1]) * (together.lasting / (8 * segments))[:, None]
    for merged in MERGED:
        short = turned.reshape(len(turned), -1, 2 * merged).sum(axis=2).max(axis=1) < WHOLE
        if short.all():
            break
    transition = _transitions(slopes, together.lasting / (4 * segments))
    transition = transition.reshape(len(slopes), -1, merged, size, size)
    whole = transition[:, :, 0]
    for k in range(1, merged):
        whole = transition[:, :, k] @ whole
    finite = short & np.isfinite(whole).all(axis=(1, 2, 3))
    found = np.zeros(len(slopes), bool)
    found[finite] = _positive(whole[finite])
    return found


def _slopes(together: _Together, count: int) -> Array:
    """The canonical rates by states and costates, scaled, at so many steps' nodes, shape (M, count + 1, 2n, 2n)."""
    instance, n = together.instance, len(together.start) // 2
    every = instance.solver.steps // count
    nodes, times = together.nodes[:, :, ::every], together.times[:, ::every]
    columns = nodes.reshape(2 * n, -1)
    p = tuple(np.repeat(one, count + 1) for one in together.parameters)
    table = instance.model.canonical_jacobian_batch(
        times.ravel(), columns[:n], columns[n:], p, instance.control_set.arguments
    )
    table = np.asarray(np.broadcast_to(table, (2 * n, 2 * n, columns.shape[1])))
    first = np.abs(table[:, :, : count + 1]).max(axis=2)
    # any scale with equal products keeps transitions symplectic; that of the first does for all
    scale = balanced(unit_sizes(together.solutions[0]), first, float(together.lasting[0]))
    scaled = table * (scale / scale[:, None])[:, :, None]
    return np.ascontiguousarray(scaled.transpose(2, 0, 1)).reshape(*times.shape, 2 * n, 2 * n)


def _transitions(slopes: Array, width: Array) -> Array:
    """From the beginning to the end of each step by the classical Runge-Kutta method, shape (M, steps, 2n, 2n)."""
    begin, middle, end = slopes[:, :-2:2], slopes[:, 1::2], slopes[:, 2::2]
    h = width[:, None, None, None]
    two = middle + middle @ begin * (h / 2.0)
    three = middle + middle @ two * (h / 2.0)
    four = end + end @ three * h
    return np.asarray(np.eye(slopes.shape[-1]) + h / 6.0 * (begin + 2.0 * (two + three) + four))


def _positive(transition: Array) -> NDArray[np.bool_]:
    """Whether the second derivatives of the cost by the corners are positive definite, shape (M,).

    With (x, lambda) -> (A x + B lambda, C x + D lambda) over a segment, its cost has the derivatives lambda by where it
    begins, and -lambda by where it ends: by both ends -B^-1 A, -D B^-1, and B^-1 across.
    """
    n = transition.shape[-1] // 2
    A, B = transition[..., :n, :n], transition[..., :n, n:]
    D = transition[..., n:, n:]
    try:
        inverse = np.linalg.inv(B)
    except np.linalg.LinAlgError:
        return np.zeros(len(transition), bool)
    own = -(D[:, :-1] @ inverse[:, :-1] + inverse[:, 1:] @ A[:, 1:])
    own = (own + own.swapaxes(-1, -2)) / 2.0
    left, clear = own[:, 0], np.ones(len(transition), bool)
    for k in range(own.shape[1]):
        if k:
            across = inverse[:, k]
            left = own[:, k] - across.swapaxes(-1, -2) @ np.linalg.solve(left, across)
            left = (left + left.swapaxes(-1, -2)) / 2.0
        diagonal = np.einsum("mii->mi", left)
        clear &= (diagonal > 0.0).all(axis=1) & np.isfinite(left).all(axis=(1, 2))
        unit = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        normed = left * unit[:, :, None] * unit[:, None, :]
        normed[~clear], left[~clear] = np.eye(n), np.eye(n)
        clear &= np.linalg.eigvalsh(normed)[:, 0] > CLEAR
        left[~clear] = np.eye(n)
    return clear
