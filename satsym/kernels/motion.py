"""What the functions of a motion must have to do with each other, and those of linear models besides."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from satsym.arrays import Array
from satsym.kernels.evaluation import SMALLEST_FRACTION, Evaluation, Relation, along, derivative, size

PROBES = (-1.7, -0.4, 0.9, 2.3)
"""Where polynomials are compared with determinants, in units of the matrix."""


def of_motion(of: Evaluation) -> Iterator[Relation]:
    """Relations of the dynamics, its Jacobians, the reference, what is conserved, and of linear models."""
    x = ("x",)
    yield from derivative(of, "jacobian_x", "dynamics", x)
    yield from derivative(of, "jacobian_u", "dynamics", ("u",))
    rest = np.zeros_like(of.at["u"])
    drift = of("dynamics", u=rest)
    if of.has("reference"):
        curve = of("reference")
        rates, pace = of("dynamics", x=curve, u=rest), of.slope("reference", "t")[..., 0, :]
        terms = np.abs(of.slope("dynamics", "x", x=curve, u=rest) * curve).sum(axis=-2)
        yield Relation("reference", "uncontrolled motion", pace, rates, SMALLEST_FRACTION * terms)
    if of.has("invariants"):
        left, terms = along(of, "invariants", drift)
        yield Relation("invariants", "constant along the uncontrolled motion", left, np.zeros_like(left), terms)
    if of.has("balances"):
        rates, terms = along(of, "balances", of("dynamics"))
        stated = of("balances")[1::2]
        yield Relation("balances", "each followed by its rate of change", stated, rates[::2], terms[::2])
    if of.has("inertial_state"):
        yield from _of_attraction(of, drift)
    if of.kernels.spec.linear:
        yield from _of_linear_models(of)


def _of_attraction(of: Evaluation, drift: Array) -> Iterator[Relation]:
    """Velocity and acceleration in space, and the law of attraction."""
    name = "inertial_state"
    state = of(name)
    rates, terms = along(of, name, drift)
    place, mu = state[:3], state[6]
    distance = np.sqrt((place * place).sum(axis=0))
    yield Relation(name, "velocity is the rate of change of place", state[3:6], rates[:3], terms[:3])
    yield Relation(name, "acceleration is that of Kepler motion", rates[3:6], -mu * place / distance**3, terms[3:6])
    if of.has("position"):
        found = of("position")
        yield Relation("position", "place in space", found, place[: len(found)], distance * SMALLEST_FRACTION)


def _of_linear_models(of: Evaluation) -> Iterator[Relation]:
    """Relate matrices, changes of variables, polynomials, closed forms and Riccati solutions of linear models."""
    columns = of.at["t"].shape[-1]
    a, at_rest = of("state_matrix"), {"x": np.zeros_like(of.at["x"]), "u": np.zeros_like(of.at["u"])}
    b = of("input_matrix") if of.has("input_matrix") else np.zeros((len(a), 0, columns))
    exact = "deviation_dynamics" if of.has("deviation_dynamics") else "dynamics"
    for name, function, by in (
        ("state_matrix", "dynamics", "x"),
        ("state_matrix", exact, "x"),
        ("input_matrix", "dynamics", "u"),
        ("input_matrix", exact, "u"),
    ):
        if of.has(name):
            slopes = of.slope(function, by, **at_rest)
            terms = SMALLEST_FRACTION * size(slopes).max()
            yield Relation(name, f"derivative of {function} at rest", of(name), slopes, terms)
    if of.has("original_state", "deviation_state"):
        back = of("deviation_state", original=of("original_state"))
        yield Relation(
            "deviation_state", "inverse of original_state", back, of.at["x"], size(of("original_state")).max()
        )
    yield from _of_polynomials(of, a, b)
    yield from _of_closed_forms(of, a)
    if of.has("riccati_residual"):
        yield _of_riccati(of, a, b)


def _of_polynomials(of: Evaluation, a: Array, b: Array) -> Iterator[Relation]:
    n, columns = len(a), a.shape[-1]
    matrices = {"characteristic_polynomial": a}
    if of.has("closed_loop_polynomial"):
        matrices["closed_loop_polynomial"] = a - np.einsum("imk,mjk->ijk", b, of.at["gain"].reshape(-1, n, columns))
    for name, matrix in matrices.items():
        if not of.has(name):
            continue
        coefficients = np.broadcast_to(of(name), (n + 1, columns))
        unit = np.abs(matrix).sum(axis=1).max(axis=0)
        for probe in PROBES:
            s = probe * unit
            powers = s ** np.arange(n, -1, -1)[:, None]
            value = (coefficients * powers).sum(axis=0)
            exact = np.linalg.det(s[:, None, None] * np.eye(n) - np.moveaxis(matrix, -1, 0))
            yield Relation(name, "determinant of s minus the matrix", value, exact, (3.0 * unit) ** n)
    if of.has("closed_loop_routh"):  # the column of the open loop may hold special cases
        found, expected = of("closed_loop_routh"), _routh_column(of("closed_loop_polynomial"))
        yield Relation("closed_loop_routh", "first column of the Routh array", found, expected)


def _routh_column(coefficients: Array) -> Array:
    """First column of the Routh array of a polynomial, without special cases."""
    above, row = list(coefficients[0::2]), list(coefficients[1::2])
    found = [above[0]]
    while row:
        found.append(row[0])
        padded = [*row, *[np.zeros_like(row[0])] * (len(above) - len(row))]
        below = [above[k] - above[0] * padded[k] / row[0] for k in range(1, len(above))]
        above, row = row, below[: max(len(above) - 1, 0)]
    return np.array(found)


def _of_closed_forms(of: Evaluation, a: Array) -> Iterator[Relation]:
    n, columns = len(a), a.shape[-1]
    if of.has("eigenvalues"):
        real, imaginary = np.moveaxis(np.broadcast_to(of("eigenvalues"), (n, 2, columns)), 1, 0)
        unit = np.abs(a).sum(axis=1).max(axis=0)
        for probe in PROBES:
            value = np.prod(probe * unit - real - 1j * imaginary, axis=0)
            exact = np.linalg.det((probe * unit)[:, None, None] * np.eye(n) - np.moveaxis(a, -1, 0))
            for part, other in ((value.real, exact), (value.imag, np.zeros_like(exact))):
                yield Relation("eigenvalues", "roots of the determinant of s - A", part, other, (3.0 * unit) ** n)
    if of.has("transition_matrix"):
        name, now = "transition_matrix", of("transition_matrix")
        onward = np.einsum("imk,mjk->ijk", a, now)
        terms = np.einsum("imk,mjk->ijk", np.abs(a), np.abs(now))
        yield Relation(name, "changes at the rate A", of.slope(name, "t")[..., 0, :], onward, terms)
        start = of(name, t=np.zeros(columns))
        yield Relation(name, "one at the start", start, np.broadcast_to(np.eye(n)[..., None], start.shape), 1.0)


def _of_riccati(of: Evaluation, a: Array, b: Array) -> Relation:
    n, m, columns = *b.shape[:2], b.shape[-1]
    p, q = (np.moveaxis(of.at[name].reshape(n, n, columns), -1, 0) for name in ("riccati", "state_weight"))
    r = np.moveaxis(of.at["control_weight"].reshape(m, m, columns), -1, 0)
    a, b = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    paid = p @ b @ np.linalg.solve(r, np.swapaxes(b, 1, 2) @ p)
    exact = np.swapaxes(a, 1, 2) @ p + p @ a - paid + q
    terms = np.moveaxis(np.abs(paid), 0, -1)
    return Relation(
        "riccati_residual", "A'P + PA - P B R^-1 B' P + Q", of("riccati_residual"), np.moveaxis(exact, 0, -1), terms
    )
