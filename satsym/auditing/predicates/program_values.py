"""Values that a printed program comes to: where it starts, when it looks, what it solves and what it leaves out."""

from __future__ import annotations

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.programs import function, printed_program, walked
from satsym.auditing.program import text as programs

_ROUNDING = 1e-12


@predicate
def starts_from(row: Question, program: str, rates: str) -> Finding:
    """Whether ``y0`` has the position first and the velocity after it, as the listed rates take it."""
    found = walked(row, program)
    start, r0, v0 = (np.asarray(found.values[name]) for name in ("y0", "r0", "v0"))
    moved = np.array(function(found, rates)(0.0, start))
    pull = float(moved[3:] @ r0 / (np.linalg.norm(moved[3:]) * np.linalg.norm(r0)))
    return Finding(
        bool(np.array_equal(moved[:3], v0) and np.isclose(pull, -1.0)),
        f"the position moves by v0, and the pull is against r0 (cosine {pull:.3f})",
        {"cosine of pull and r0": pull, "entries": int(start.size)},
    )


@predicate
def samples_evenly(row: Question, program: str, points: int) -> Finding:
    """Whether ``t_eval`` is so many moments, evenly spaced, from one end of ``t_span`` to the other."""
    found = walked(row, program)
    t, (first, last) = np.asarray(found.values["t_eval"]), found.values["t_span"]
    gaps = np.diff(t)
    even = bool(np.ptp(gaps) < 1e-9 * (last - first))
    return Finding(
        len(t) == points and t[0] == first and t[-1] == last and even,
        f"{len(t)} moments, {gaps.mean():.6g} s apart, from {t[0]:g} to {t[-1]:g} s",
        {"moments": len(t), "apart, s": float(gaps.mean())},
    )


@predicate
def unpacks(row: Question, program: str, source: str, target: tuple[str, ...]) -> Finding:
    """Whether names get the rows of the solution that belong to them: they move at the rates of the other rows."""
    found = walked(row, program)
    solution = found.values[source].attributes
    t, y = solution["t"], solution["y"]
    gaps = []
    for k, name in enumerate(target):
        rate = np.gradient(np.asarray(found.values[name]), t, edge_order=2)
        gaps.append(float(np.abs(rate - y[k + 3]).max()))
    speed = float(np.abs(y[3:]).max())
    return Finding(
        max(gaps) < 1e-3 * speed,
        f"their slopes are the velocities, but for {max(gaps) / speed:.0e} of the largest",
        {"largest difference, share of the speed": max(gaps) / speed},
    )


@predicate
def eigenvalues_listed(row: Question, program: str) -> Finding:
    """Whether what the program calls eigenvalues and eigenvectors of its matrix are so; and which of them it uses."""
    found, whole = walked(row, program), printed_program(row, program)
    matrix, values, vectors = (np.asarray(found.values[k]) for k in ("jacobian", "eigenvalues", "eigenvectors"))
    scale = float(np.abs(values).max())
    gap = max(
        float(np.abs(matrix @ vectors[:, k] - values[k] * vectors[:, k]).max()) / scale for k in range(len(values))
    )
    used = [s for s in whole.statements if "eigenvectors" in programs.names_in(s)]
    return Finding(
        gap < 1e-9,
        f"A v = lambda v but for {gap:.0e}; lambda in 1/s: {', '.join(f'{v:.4g}' for v in values)}",
        {
            "largest difference, share of the largest eigenvalue": gap,
            "largest real part, 1/s": float(values.real.max()),
            "statements that use the eigenvectors": len(used),
        },
    )


@predicate
def only_attraction(row: Question, program: str, rates: str, model: str) -> Finding:
    """Whether the program knows no force but the attraction of one centre: its rates along its own orbit."""
    found = walked(row, program)
    y, mu = found.values["solution"].attributes["y"], float(found.values["mu"])
    system, worst = kernels.load(model), 0.0
    for state in y.T[:: max(1, y.shape[1] // 50)]:
        listed = np.array(function(found, rates)(0.0, state))[3:]
        derived = np.array(system.dynamics(0.0, tuple(state), (0.0,) * len(system.spec.controls), (mu,)))[3:]
        worst = max(worst, float(np.abs(listed - derived).max() / np.linalg.norm(derived)))
    return Finding(
        worst < _ROUNDING,
        f"its acceleration and that of one centre differ by {worst:.0e}: nothing else acts",
        {"largest relative difference": worst},
    )
