"""Jacobi's condition: conjugate times with their multiplicities, and the second-order condition at the free end.

Neighbouring extremals from the same initial state span, in states X and costates Lambda, a Lagrangian plane. The matrix
W = -(X + i Lambda)(X - i Lambda)^-1, unitary and symmetric, does not depend on the basis of the plane: X is singular if
an eigenvalue of W is one, with the same multiplicity. Under Legendre's condition eigenphases cross zero in the positive
direction only, so that the number of conjugate times equals the number of full turns of all phases (Arnold, On a
characteristic class entering into conditions of quantization, 1967; Agrachev and Sachkov, Control Theory from the
Geometric Viewpoint, 21). All phases start from zero; phases of uncontrollable directions stay there. Unlike the sign of
a determinant, phases also show two crossings at the same time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.lapack import lapack
from satsym.solution import Check, Solution
from satsym.solvers.certificate.end_form import EndForm, end_form
from satsym.solvers.certificate.reintegration.segments import Segments, between

TURN = 2.0 * np.pi

TOUCHED = 1e-7
"""Distance of a phase from a full turn, in rad, below which it cannot be told whether the phase has completed the
turn."""

HALF, FULL = 0.5, 1.0 - 1e-9
"""Largest forward change of the sum of all phases in a step, as a fraction of a turn: without and with a jump of the
control. The remainder to a full turn is left for rounding, which can move phases at rest backwards."""

AFRESH = 8
"""Number of steps after which the basis is orthonormalised; the basis stays well-conditioned for this many steps."""

INDEPENDENT = 1e-9
"""Minimum singular value, relative, of linearly independent constraints at the end. Smaller values count as zero."""

MIXTURES = (0.4, 1.0, 2.1)
"""Angles, in rad, at which real and imaginary parts of a matrix are combined before their eigenvectors are computed."""

OFF_DIAGONAL = 1e-10
"""Largest off-diagonal element for which the eigenvectors of a combination serve for both parts; the error of the
phases is its square. Above it, phases are computed by the general eigenvalue routine."""

PARTS, ROUNDS = 16, 6
"""Number of parts into which a step with a conjugate time is divided, and number of such divisions."""


@dataclass(frozen=True, eq=False)
class Phases:
    """Eigenphases of the field of neighbouring extremals."""

    values: Array
    """Phases in rad, continuous along the motion from zero, in ascending order, shape (K, n)."""
    frames: Array
    """Orthonormal bases of the Lagrangian planes, shape (K, 2n, n)."""

    @property
    def passed(self) -> NDArray[np.intp]:
        """Return the number of conjugate times up to each station, with their multiplicities, shape (K,)."""
        return _passed(self.values)

    @property
    def touching(self) -> bool:
        """Return whether a final phase is so close to a full turn that it cannot be told whether it is complete."""
        turns = np.round(self.values[-1] / TURN)
        return bool(((turns >= 1.0) & (np.abs(self.values[-1] - turns * TURN) <= TOUCHED)).any())


def followed(transition: Array, jumped: Collection[int] = ()) -> Phases | None:
    """Return the phases at all stations, the times between which transition matrices are given.

    Parameters
    ----------
    transition
        Symplectic matrices from each station to the next, shape (K-1, 2n, 2n), in each of which the sum of the phases
        turns by less than pi.
    jumped
        Indices of the steps in which the control jumps. The minimum of H over all controls has a concave edge there, so
        that no phase decreases; since its slopes differ in one direction only, the sum of phases grows by less than a
        turn.

    Returns
    -------
    Phases
        Continuous phases; ``None`` if the computation fails numerically.
    """
    n, frames = transition.shape[1] // 2, _frames(transition)
    if not np.isfinite(frames).all():
        return None
    every = np.linalg.qr(frames)[0]
    angles = np.concatenate([np.zeros((1, n)), _angles(every)[1:]])
    onwards = np.where(np.isin(np.arange(len(transition)), list(jumped)), FULL, HALF)
    steps = _turned(angles[:-1].sum(axis=1), angles[1:].sum(axis=1), onwards)
    return Phases(_ordered(angles, np.append(0.0, np.cumsum(steps))), every)


def _frames(transition: Array) -> Array:
    """Return bases of the plane at all stations, shape (K, 2n, n), well-conditioned but not orthonormal."""
    count, size = len(transition), transition.shape[1]
    padded = np.broadcast_to(np.eye(size), (-(-count // AFRESH), AFRESH, size, size)).copy()
    padded.reshape(-1, size, size)[:count] = transition
    for k in range(1, AFRESH):  # from where the basis is made orthonormal to each of the stations after
        padded[:, k] = padded[:, k] @ padded[:, k - 1]
    frames = np.empty((padded.shape[0] * AFRESH + 1, size, size // 2))
    frames[0] = np.eye(size)[:, size // 2 :]
    for k, whole in enumerate(padded):
        begin = _orthonormal(frames[AFRESH * k])
        np.matmul(whole, begin, out=frames[AFRESH * k + 1 : AFRESH * (k + 1) + 1])
    return frames[: count + 1]


def _orthonormal(frame: Array) -> Array:
    """Return an orthonormal basis of the plane of a given one, by the LAPACK routines of :func:`numpy.linalg.qr`."""
    reflectors, factors, _, _ = lapack().dgeqrf(frame)
    found: Array = lapack().dorgqr(reflectors, factors, overwrite_a=True)[0]
    return found


def _angles(frames: Array) -> Array:
    """Return eigenphases modulo a turn, in ascending order, shape (M, n), from orthonormal bases."""
    n = frames.shape[2]
    upper, lower = frames[:, :n], frames[:, n:]
    across = upper @ lower.transpose(0, 2, 1)
    # X - i Lambda is unitary, so that its inverse is its adjoint.
    real, imaginary = lower @ lower.transpose(0, 2, 1) - upper @ upper.transpose(0, 2, 1), -across
    imaginary -= across.transpose(0, 2, 1)
    # The two commute: a mixture has the eigenvectors of both, if it keeps phases apart.
    axes = np.linalg.eigh(real * np.cos(MIXTURES[0]) + imaginary * np.sin(MIXTURES[0]))[1]
    turned = real @ axes, imaginary @ axes
    cosine, sine = ((axes * part).sum(axis=1) for part in turned)
    angles = np.arctan2(sine, cosine)
    off = (np.abs(part - axes * own[:, None]) for part, own in zip(turned, (cosine, sine), strict=True))
    mixed = np.flatnonzero(~(np.maximum(*off).max(axis=(1, 2)) <= OFF_DIAGONAL))
    if len(mixed):
        angles[mixed] = np.angle(np.linalg.eigvals(real[mixed] + 1j * imaginary[mixed]))
    found: Array = np.sort(angles % TURN, axis=1)
    return found


def _turned(before: Array, after: Array, onwards: Array | float = HALF) -> Array:
    """Return how many phases complete a full turn in each step, shape (M,).

    ``before`` and ``after`` are the sums of the phases modulo a turn at both ends of each step, shape (M,). In a step,
    the true sum changes by less than a turn, of which at most the fraction ``onwards`` is in the positive direction.
    """
    found: Array = np.ceil((before - after) / TURN - (1.0 - onwards))
    return found


def _ordered(angles: Array, passed: Array) -> Array:
    """Return phases in ascending order, shape (M, n), with full turns added for the phases that have completed them.

    ``passed``, shape (M,), is the total number of completed turns; the smallest angles have the most turns.
    """
    n = angles.shape[1]
    places = passed[:, None].astype(np.intp) + np.arange(n)
    found: Array = np.take_along_axis(angles, places % n, axis=1) + TURN * (places // n)
    return found


def first_passage(times: Array, phases: Phases, between: Callable[[int, Array], Array]) -> float | None:
    """Return the first conjugate time, or ``None`` if there is none.

    Parameters
    ----------
    times
        Times of the stations, shape (K,).
    between
        Function that returns transition matrices from a station to given times before the next one, shape (M, 2n, 2n).
    """
    after = np.flatnonzero(phases.passed > 0)
    if not len(after):
        return float(times[-1]) if phases.touching else None
    station = int(after[0]) - 1
    early, late = float(times[station]), float(times[station + 1])
    for _ in range(ROUNDS):
        inner = np.linspace(early, late, PARTS + 1)[1:]
        angles = _angles(np.linalg.qr(between(station, inner) @ phases.frames[station])[0])
        values = _ordered(angles, _turned(phases.values[station].sum(), angles.sum(axis=1)))
        met = np.append(_passed(values)[:-1] > 0, True)  # at the end it has been met
        first = int(np.argmax(met))
        early, late = (float(inner[first - 1]) if first else early), float(inner[first])
    return (early + late) / 2.0


def _passed(values: Array) -> NDArray[np.intp]:
    """Return the total number of full turns of all phases, shape (K,)."""
    found: NDArray[np.intp] = np.maximum(np.floor(values / TURN), 0.0).sum(axis=1).astype(np.intp)
    return found


def second_order_at_end(frame: Array, end: EndForm) -> float:
    """Return the smallest curvature of the cost along the free directions of the final state; infinite if it is fixed.

    The curvatures are those of the quadratic form whose diagonal is scaled to 1. Along an eigenvector of the unitary
    matrix of ``frame``, whose phase is the argument of the eigenvalue, the cost of reaching a final state has the
    curvature cot(phase / 2), as long as no conjugate time has passed. This cost also sets the unit of directions that
    are hardly controllable.

    Parameters
    ----------
    frame
        Basis of the plane of neighbouring extremals at the end, shape (2n, n), orthonormal.
    end
        Quadratic form and constraints of the end, in the same units.
    """
    n = frame.shape[1]
    phases, axes = _eigen(frame)
    within = np.clip(phases, 0.0, TURN)
    weight = np.where(within < np.pi / 2.0, np.sqrt(np.tan(np.minimum(within, np.pi / 2.0) / 2.0)), 1.0)
    # weight^2 cot(phase / 2), without the quotient of small numbers
    along = np.where(within < np.pi / 2.0, 1.0, 1.0 / np.tan(np.clip(within, 1.0, TURN - 1e-12) / 2.0))
    size = len(end.form)
    turn = np.eye(size)
    turn[:n, :n] = axes * weight
    form = turn.T @ end.form @ turn
    form[:n, :n] += np.diag(along)
    free = kernel(end.ties @ turn)
    if not free.shape[1]:
        return float("inf")
    reduced = free.T @ form @ free
    unit = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(reduced)), 1e-300))
    return float(np.linalg.eigvalsh(reduced * np.outer(unit, unit)).min())


def _eigen(frame: Array) -> tuple[Array, Array]:
    """Return eigenphases in [0, 2 pi), up to rounding, and real orthonormal eigenvectors."""
    n = frame.shape[1]
    upper, lower = frame[:n], frame[n:]
    plane = -np.linalg.solve((upper - 1j * lower).T, (upper + 1j * lower).T).T
    plane = (plane + plane.T) / 2.0
    # Real and imaginary part commute: a mixture of both has the eigenvectors of both, if it keeps phases apart.
    mixed = [np.linalg.eigh(plane.real * np.cos(fraction) + plane.imag * np.sin(fraction))[1] for fraction in MIXTURES]
    turned = [axes.T @ plane @ axes for axes in mixed]
    best = int(np.argmin([np.abs(one - np.diag(np.diag(one))).max() for one in turned]))
    phases = np.angle(np.diag(turned[best])) % TURN
    return np.where(phases > TURN - TOUCHED, 0.0, phases), mixed[best]


def kernel(ties: Array) -> Array:
    """Return an orthonormal basis of the directions that satisfy linear constraints, shape (k, f).

    Parameters
    ----------
    ties
        Rows of the constraints, shape (c, k).
    """
    if not ties.size:
        return np.eye(ties.shape[1])
    _, values, rows = np.linalg.svd(ties)
    rank = int((values > INDEPENDENT * max(float(values.max(initial=0.0)), 1e-300)).sum())
    found: Array = rows[rank:].T
    return found


FLAT = 1e-9
"""Relative curvature in the free end below which its sign cannot be determined."""

NOT_STRICT = "not strict: other controls have the same cost"


@dataclass(frozen=True)
class Conjugate:
    """Result of the field of neighbouring extremals from the same initial state."""

    resolved: bool
    """Whether the field could be computed."""
    passed: int = 0
    """Number of conjugate times after the initial time, with their multiplicities."""
    time: float | None = None
    """First conjugate time, ``None`` if there is none."""
    touching: bool = False
    """Whether the final time may be conjugate within the accuracy of the phases."""
    curvature: float = float("inf")
    """Minimum relative curvature of the cost in the free final states; infinite if no final state is free."""

    @property
    def checks(self) -> list[Check]:
        """Return checks of Jacobi's condition, each with a value that is positive if it fails."""
        if not self.resolved:
            return [Check("conjugate points not resolved", 1.0, 0.0)]
        found = [Check("conjugate points: none", float(self.passed), 0.0)]
        if self.curvature < float("inf"):
            found.append(Check("second-order condition at the free endpoint", float(not self.curvature > -FLAT), 0.0))
        if self.passed == 0 and (self.touching or abs(self.curvature) <= FLAT):
            found.append(Check(NOT_STRICT, 1.0, 0.0))
        return found


def conjugate(solution: Solution, along: Segments | None) -> Conjugate:
    """Count conjugate times and measure the curvature of the cost in the free final states.

    Parameters
    ----------
    along
        Linearisation of the canonical equations along the solution, ``None`` if it could not be computed.
    """
    phases = None if along is None else followed(along.transition, along.jumped)
    if along is None or phases is None:
        return Conjugate(resolved=False)
    time = first_passage(along.times, phases, lambda station, t: between(solution, along, station, t))
    curvature = second_order_at_end(phases.frames[-1], end_form(solution, along.scale))
    passed = int(phases.passed[-1])
    return Conjugate(curvature == curvature, passed, time, phases.touching, curvature)
