"""Claims about the linear-quadratic regulator: the gain, Riccati's equation and the closed loop, recomputed."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

import numpy as np

from satsym.analysis.linear import system as systems
from satsym.analysis.regulator.lqr import Regulator, lqr
from satsym.arrays import Array
from satsym.auditing import quantities
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.flows import expm
from satsym.auditing.predicates.structure import with_numbers
from satsym.status import BadInput
from satsym.wording import shown

Numbers = tuple[float, ...]

_SEED = 19
_TRIES = 20
_COMPLEX = re.compile(r"(?P<real>[-+]?[0-9.]+) *(?P<sign>[-+]) *(?P<imaginary>[0-9.]+)i\Z")


@cache
def designed(model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers) -> Regulator:
    """The regulator of a linear model with diagonal weights."""
    return lqr(with_numbers(model, controls, omega), np.diag(Q), np.diag(R))


def _within(printed: Iterable[str], values: Iterable[float]) -> tuple[bool, float]:
    """Whether numbers are what is printed to its last digit, and the largest difference in halves of that digit."""
    shares = [
        abs(value - float(number.value)) / float(number.half_unit)
        for number, value in zip(map(quantities.printed_number, printed), values, strict=True)
    ]
    return max(shares) <= 1.0 + 1e-9, max(shares)


def _matrix(found: Array) -> str:
    return "[" + ", ".join(f"[{', '.join(f'{entry:.5f}' for entry in line)}]" for line in found) + "]"


def _printed(row: Question, shape: tuple[int, ...]) -> list[str]:
    lines = [[line] if isinstance(line, str) else list(line) for line in row.printed]
    if (len(lines), len(lines[0])) != shape:
        raise BadInput(f"{len(lines)} by {len(lines[0])} is printed, {shape[0]} by {shape[1]} is found")
    return [entry for line in lines for entry in line]


def _digits(row: Question, found: Array) -> Finding:
    right, share = _within(_printed(row, found.shape), found.ravel())
    return Finding(right, _matrix(found), {"largest difference in halves of the last digit": share})


@predicate
def riccati_solution(
    row: Question, model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers
) -> Finding:
    """Whether a printed matrix is the solution of Riccati's equation that makes the loop stable."""
    return _digits(row, designed(model, controls, omega, Q, R).P)


@predicate
def regulator_gain(
    row: Question, model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers
) -> Finding:
    """Whether a printed gain is the regulator's."""
    return _digits(row, designed(model, controls, omega, Q, R).K)


@predicate
def closed_loop_polynomial(
    row: Question, model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers
) -> Finding:
    """Whether printed coefficients, highest power first, are those of the regulator's closed loop."""
    return _digits(row, designed(model, controls, omega, Q, R).polynomial[None, :])


@predicate
def closed_loop_eigenvalues(
    row: Question, model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers, gain: tuple[str, ...]
) -> Finding:
    """Whether printed eigenvalues are those of A - B K with the printed gain, or with the exact one; in any order."""
    found = designed(model, controls, omega, Q, R)
    texts = [str(text) for text in row.printed]
    matches = [_COMPLEX.match(text) for text in texts]
    if None in matches:
        raise BadInput("closed_loop_eigenvalues: write each as a + bi")
    said = [(m["real"], m["sign"] + m["imaginary"]) for m in matches if m]
    K = np.array([[float(entry) for entry in line.split(",")] for line in gain])
    cases = {"printed gain": np.linalg.eigvals(found.system.A - found.system.B @ K), "exact gain": found.eigenvalues}
    evidence: dict[str, float | int | bool | str] = {}
    right = False
    for name, values in cases.items():
        wanted = [complex(float(real), float(imaginary)) for real, imaginary in said]
        pairs = [values[int(np.abs(values - z).argmin())] for z in wanted]
        agrees, share = _within([t for p in said for t in p], [v for z in pairs for v in (z.real, z.imag)])
        evidence[f"{name}: largest difference in halves of the last digit"] = share
        right |= agrees and len(said) == len(values)
    listed = ", ".join(f"{z.real:.5f} {'+' if z.imag >= 0 else '-'} {abs(z.imag):.5f}i" for z in found.eigenvalues)
    return Finding(right, listed, evidence)


@predicate
def closed_loop_stable(
    model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers, gain: tuple[str, ...]
) -> Finding:
    """Whether the printed gain makes all real parts negative."""
    found = designed(model, controls, omega, Q, R).system
    K = np.array([[float(entry) for entry in line.split(",")] for line in gain])
    largest = float(np.linalg.eigvals(found.A - found.B @ K).real.max())
    return Finding(largest < 0.0, f"the largest real part is {largest:.4f}", {"largest real part": largest})


@predicate
def stabilising_solution(model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers) -> Finding:
    """Whether P solves Riccati's equation, is symmetric and positive definite, and makes the loop stable."""
    found = designed(model, controls, omega, Q, R)
    smallest, largest = float(np.linalg.eigvalsh(found.P).min()), float(found.eigenvalues.real.max())
    asymmetry = float(np.abs(found.P - found.P.T).max())
    return Finding(
        found.residual < 1e-10 and smallest > 0.0 > largest and asymmetry < 1e-9,
        f"its smallest eigenvalue is {smallest:.3g}, the closed loop's largest real part {largest:.3g}",
        {"relative residual": found.residual, "asymmetry": asymmetry},
    )


@predicate
def residual_is_rounding(
    model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers, P: tuple[str, ...]
) -> Finding:
    """Whether what P, rounded as printed, leaves of Riccati's equation is no more than the rounding can leave."""
    found = designed(model, controls, omega, Q, R)
    a, b = found.system.A, found.system.B
    texts = [line.split(",") for line in P]
    p = np.array([[float(entry) for entry in line] for line in texts])
    half = np.array([[float(quantities.printed_number(entry).half_unit) for entry in line] for line in texts])
    g = b @ np.linalg.solve(found.R, b.T)
    left = np.abs(a.T @ p + p @ a - p @ g @ p + found.Q)
    # to first order, a change of P by D changes the residual by (A - G P)' D + D (A - G P)
    loop = np.abs(a - g @ p)
    allowed = loop.T @ half + half @ loop
    return Finding(
        bool((left <= allowed + 1e-12).all()),
        f"the residual is {left.max():.1e} at most, rounding allows {allowed.max():.1e}",
        {"largest residual": float(left.max()), "allowed": float(allowed.max())},
    )


def _cost(system: systems.LinearSystem, Q: Array, R: Array, K: Array) -> Array:
    """The matrix of the cost of u = -K x; infinite where the loop is not stable."""
    from scipy.linalg import solve_continuous_lyapunov

    loop = system.A - system.B @ K
    if np.linalg.eigvals(loop).real.max() >= 0.0:
        return np.full_like(system.A, np.inf)
    return np.asarray(solve_continuous_lyapunov(loop.T, -(Q + K.T @ R @ K)))


@predicate
def gain_is_best(model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers) -> Finding:
    """Whether u = -R^-1 B'P x costs less than any of many other gains, by Lyapunov's equation."""
    found = designed(model, controls, omega, Q, R)
    rng, beaten = np.random.default_rng(_SEED), 0
    best = _cost(found.system, found.Q, found.R, found.K)
    for _ in range(_TRIES):
        other = _cost(found.system, found.Q, found.R, found.K + 0.1 * rng.normal(size=found.K.shape))
        x0 = rng.normal(size=len(best))
        beaten += bool(not np.isfinite(other).all() or x0 @ other @ x0 > x0 @ best @ x0)
    return Finding(
        beaten == _TRIES and bool(np.allclose(best, found.P)),
        f"it beats {beaten} of {_TRIES} gains near it",
        {"others": _TRIES, "beaten": beaten},
    )


@predicate
def cost_to_go(model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers) -> Finding:
    """Whether the integral without a factor 1/2 is what x'Px gives, along the closed loop."""
    found = designed(model, controls, omega, Q, R)
    loop, x, step, total = found.closed_loop.A, np.ones(len(found.P)), 0.01, 0.0
    advance = expm(step * loop)
    weight = found.Q + found.K.T @ found.R @ found.K
    for i in range(8001):
        share = 1.0 if i in (0, 8000) else 4.0 if i % 2 else 2.0
        total += share * step / 3.0 * float(x @ weight @ x)
        x = advance @ x
    expected = found.cost(np.ones(len(found.P)))
    return Finding(
        abs(total - expected) < 1e-6 * expected,
        f"from (1, ..., 1) the integral is {total:.6g}, x'Px {expected:.6g}",
        {"integral": total, "x'Px": expected},
    )


@predicate
def lqr_call(
    model: str, controls: tuple[str, ...], omega: float, Q: Numbers, R: Numbers, returns: tuple[str, ...]
) -> Finding:
    """Whether MATLAB's lqr gives back the gain, the solution of Riccati's equation and the eigenvalues, in this order.

    Source: Control System Toolbox, reference page of lqr, ``[K,S,e] = lqr(SYS,Q,R,N)`` and ``lqr(A,B,Q,R,N)``.
    """
    found = designed(model, controls, omega, Q, R)
    if len(returns) != 3:
        raise BadInput(f"lqr_call: {shown(returns)}: lqr gives back three things")
    shapes = (found.K.shape, found.P.shape, found.eigenvalues.shape)
    return Finding(
        returns[0] == "K" and returns[2].upper() == "E",
        "the gain, the solution of Riccati's equation, the eigenvalues",
        {"shapes": ", ".join(str(shape) for shape in shapes)},
    )
