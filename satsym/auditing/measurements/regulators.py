"""Linear-quadratic regulators: gains from the Riccati equation, costs from the Lyapunov equation, costates from e^(Ht).

A system may contain its weights Q and R; otherwise they are arguments.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.arrays import Array, kept
from satsym.auditing.measurements import linear
from satsym.auditing.measurements.matrices import numeric
from satsym.auditing.propositions.values import Family, Record, Undecided, numbers, undecided_if_refused
from satsym.status import BadInput

_SEED = 19


def regulators() -> Family:
    """Return a family of controllable systems with weights: textbook examples, and random (partly unstable) ones."""
    rng = np.random.default_rng(_SEED)
    given: dict[str, tuple[Any, Any, Any, Any]] = {
        "integrator": ([[0.0]], [[1.0]], [[1.0]], [[2.0]]),
        "double integrator": ([[0.0, 1.0], [0.0, 0.0]], [[0.0], [1.0]], np.eye(2), [[1.0]]),
        "oscillator": ([[0.0, 1.0], [-1.0, 0.0]], [[0.0], [1.0]], np.diag([1.0, 0.5]), [[0.5]]),
        "pendulum upright": ([[0.0, 1.0], [1.0, 0.0]], [[0.0], [1.0]], np.diag([2.0, 1.0]), [[1.0]]),
    }
    for k in range(4):
        n, m = 2 + k % 2, 1 + k // 2
        root = rng.uniform(-1.0, 1.0, (n, n))
        weights = root @ root.T + 0.2 * np.eye(n), np.diag(rng.uniform(0.5, 2.0, m))
        given[f"system {k + 1}"] = (rng.uniform(-1.0, 1.0, (n, n)), rng.uniform(-1.0, 1.0, (n, m)), *weights)
    members = [
        Record(name, {key: np.array(part, dtype=float) for key, part in zip("ABQR", parts, strict=True)})
        for name, parts in given.items()
    ]
    return Family("REGULATORS", "systems with weights", tuple(members))


def regulator(of: Any, inputs: Sequence[str] = (), Q: Any = None, R: Any = None) -> Record:
    """Return the regulator of a system with the given inputs: gain K of u = -K x, P, and the closed-loop matrix A."""
    found = _parts(of, inputs, Q, R)
    P, K = _solved(*found)
    return Record("the regulator", {"K": K, "P": P, "A": found[0] - found[1] @ K})


def matlab_lqr(A: Any, B: Any, Q: Any, R: Any) -> list[Any]:
    """Return the result of MATLAB's lqr(A, B, Q, R) in its order [K, S, e] (Control System Toolbox, page of lqr)."""
    found = regulator(Record("the system", {"A": numbers(A), "B": numbers(B)}), Q=Q, R=R)
    return [found.part("K"), found.part("P"), linear.eigenvalues(found)]


def cost(of: Any, gain: Any, start: Any) -> float:
    """Return the infinite-horizon integral of x'Qx + u'Ru along u = -K x, from the Lyapunov equation."""
    from scipy.linalg import solve_continuous_lyapunov

    (a, b, q, r), gains = _parts(of), np.atleast_2d(numeric(gain)).astype(float)
    loop, x = a - b @ gains, np.asarray(numeric(start), dtype=float).ravel()
    if np.linalg.eigvals(loop).real.max() >= 0.0:
        raise Undecided("the loop is not stable, so its cost is infinite")
    return float(x @ solve_continuous_lyapunov(loop.T, -(q + gains.T @ r @ gains)) @ x)


def other_gains(of: Any, inputs: Sequence[str] = ()) -> list[Array]:
    """Return gains at several distances from the regulator's gain, all of which stabilise the closed loop."""
    found = _parts(of, inputs)
    K, rng, gains = regulator(of, inputs).part("K"), np.random.default_rng(_SEED), []
    for size in (0.01, 0.03, 0.1, 0.3):
        for _ in range(3):
            other = K + size * max(1.0, float(np.linalg.norm(K))) * rng.normal(size=K.shape)
            if np.linalg.eigvals(found[0] - found[1] @ other).real.max() < 0.0:
                gains.append(other)
    return gains


def hamiltonian(of: Any, Q: Any = None) -> Array:
    """Return [A, -B R^-1 B'; -Q, -A'], the matrix of the linear equations of states and costates of the optimum."""
    a, b, q, r = _parts(of, (), Q)
    return np.block([[a, -b @ np.linalg.solve(r, b.T)], [-q, -a.T]])


def riccati(of: Any, t: float) -> Array:
    """Return P(t) at time t before the end of a finite horizon, where P = 0: -P' = A'P + PA + Q - P B R^-1 B'P."""
    from scipy.integrate import solve_ivp

    a, b, q, r = _parts(of)
    n, g = len(a), b @ np.linalg.solve(r, b.T)

    def rate(_: float, entries: Array) -> Array:
        p = entries.reshape(n, n)
        return np.asarray((a.T @ p + p @ a + q - p @ g @ p).ravel())

    found = solve_ivp(rate, (0.0, t), np.zeros(n * n), rtol=1e-10, atol=1e-12, method="DOP853")
    return np.asarray(found.y[:, -1].reshape(n, n))


def costate(of: Any, start: Any, t: float) -> Array:
    """Return the initial costate of the optimum over a finite horizon, with 1/2 in the cost and final costate 0."""
    whole = linear.flow(hamiltonian(of), t)
    n = len(whole) // 2
    return -np.linalg.solve(whole[n:, n:], whole[n:, :n] @ numeric(start))


def _parts(of: Any, inputs: Sequence[str] = (), Q: Any = None, R: Any = None) -> tuple[Array, Array, Array, Array]:
    """Return A, B, Q and R as arrays of numbers."""
    whole = linear.inputs_of(of, inputs)
    a, b = numbers(whole.part("A")), numbers(whole.part("B"))
    weights = [whole.parts.get(name) if stated is None else numeric(stated) for name, stated in (("Q", Q), ("R", R))]
    if any(weight is None for weight in weights):
        raise BadInput(f"{whole.name} has no weights; give both Q and R, as in the document")
    q, r = (np.asarray(weight, dtype=float) for weight in weights)
    return a, b, q, r


@kept
def _solved(a: Array, b: Array, q: Array, r: Array) -> tuple[Array, Array]:
    from satsym.analysis.linear import system as systems
    from satsym.analysis.regulator.lqr import lqr

    with undecided_if_refused():
        found = lqr(systems.system(a, b), q, r)
    return found.P, found.K
