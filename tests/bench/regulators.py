"""Regulators near a circular orbit: one, and ten thousand with other angular velocities and weights.

Everyone solves the same problems; the relative residual of the Riccati equation is printed beside each time.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from peers import Missing
from rows import Goal, Row, Table, missing
from timing import Samples, interleaved

COUNT = 10_000
LOOPED = 500
"""Of them, for those who solve one after another: a loop gets no quicker by going on."""
WITHIN = 1e-12
BATCH, LOOP = "satsym, structured doubling", "SciPy solve_continuous_are in a loop"
INPUT = np.array([[0.0], [0.0], [0.0], [1.0]])
Problems = tuple[np.ndarray, np.ndarray, np.ndarray]
Solver = Callable[[], np.ndarray]


def problems(count: int) -> Problems:
    """A, Q and R with a leading axis; the thesis's own problem comes first."""
    rng = np.random.default_rng(0)
    omega = np.exp(rng.uniform(-1.0, 1.0, count))
    Q, R = np.exp(rng.uniform(-2.0, 2.0, (count, 4))), np.exp(rng.uniform(-2.0, 2.0, (count, 1)))
    omega[0], Q[0], R[0] = 1.0, 1.0, 1.0
    A = np.zeros((count, 4, 4))
    A[:, 0, 1] = A[:, 2, 3] = 1.0
    A[:, 1, 0], A[:, 1, 3], A[:, 3, 1] = 3.0 * omega**2, 2.0 * omega, -2.0 * omega
    return A, Q[:, :, None] * np.eye(4), R[:, :, None]


def largest_residual(P: np.ndarray, given: Problems) -> float:
    """By one judge for all of them."""
    from satsym.analysis.regulator.riccati import residual

    A, Q, R = given
    return max(residual(a, INPUT @ INPUT.T / r, q, p) for a, q, r, p in zip(A, Q, R, P, strict=False))


def one(rounds: int = 15) -> Table:
    """One regulator: gain, Riccati solution and closed-loop eigenvalues, weights checked."""
    A, Q, R = (matrix[0] for matrix in problems(1))
    runs = {"satsym, lqr": _satsym(A, Q, R), "SciPy solve_continuous_are, P alone": lambda: _scipy(A, Q, R)}
    absent: dict[str, str] = {}
    try:
        runs["python-control, lqr"] = _control(A, Q, R)
    except Missing as error:
        absent["python-control, lqr"] = str(error)
    residuals = {name: largest_residual(run()[None], problems(1)) for name, run in runs.items()}
    rows = _rows(interleaved(runs, rounds), residuals, {"python-control, lqr": ("at least as long as satsym", 1.0)})
    return Table(
        "6. One linear-quadratic regulator", "microseconds", (*rows, *(missing(*each) for each in absent.items()))
    )


def many(rounds: int = 3) -> Table:
    """Ten thousand: gains, Riccati solutions and residuals."""
    from satsym.analysis.regulator import many

    given = problems(COUNT)
    A, Q, R = given
    found: dict[str, np.ndarray] = {}

    def ours() -> None:
        _, found[BATCH], _ = many.solve(A, INPUT, Q, R)

    def loop() -> None:
        found[LOOP] = np.array([_scipy(A[i], Q[i], R[i]) for i in range(LOOPED)])

    samples = interleaved({BATCH: ours, LOOP: loop}, rounds, 0.0)
    each = {name: Samples(tuple(s / len(found[name]) for s in sample.seconds)) for name, sample in samples.items()}
    residuals = {name: largest_residual(P, given) for name, P in found.items()}
    rows = _rows(each, residuals, {LOOP: ("at least 90 x satsym", 90.0)})
    return Table(f"7. {COUNT} linear-quadratic regulators", "microseconds each", rows)


def _satsym(A: np.ndarray, Q: np.ndarray, R: np.ndarray) -> Solver:
    from satsym.analysis.linear.system import system
    from satsym.analysis.regulator.lqr import lqr

    given = system(A, INPUT)
    return lambda: lqr(given, Q, R).P


def _control(A: np.ndarray, Q: np.ndarray, R: np.ndarray) -> Solver:
    try:
        import control
    except ImportError:
        raise Missing("python-control is not installed (the bench extra has it)") from None
    return lambda: control.lqr(A, INPUT, Q, R)[1]


def _scipy(A: np.ndarray, Q: np.ndarray, R: np.ndarray) -> np.ndarray:
    from scipy.linalg import solve_continuous_are

    return solve_continuous_are(A, INPUT, Q, R)


def _rows(
    samples: dict[str, Samples], residuals: dict[str, float], goals: dict[str, tuple[str, float]]
) -> tuple[Row, ...]:
    first, rows = next(iter(samples.values())), []
    for name, sample in samples.items():
        ratio = sample.times(first)
        reached: list[Goal] = []
        if sample is first:
            reached.append(Goal(f"residual at most {WITHIN:g}", residuals[name], WITHIN))
        if name in goals:
            text, limit = goals[name]
            reached.append(Goal(text, ratio, limit, least=True))
        note = "" if sample is first else f"residual {residuals[name]:.0e}"
        rows.append(Row(name, sample.least * 1e6, sample.middle * 1e6, ratio, tuple(reached), note))
    return tuple(rows)
