"""Relations between generated functions: of a motion, of linear models, and of control sets that are products.

Where controls are directions the canonical equations are those of the regularised problem, in which an angle is a
vector that may be shorter than one. What depends on an angle is linear in its cosine and sine, so that its values at
three angles tell what it is there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.kernels.evaluation import SMALLEST_FRACTION, Evaluation, Relation, along, derivative, size

PROBES = (-1.7, -0.4, 0.9, 2.3)
"""Arguments at which characteristic polynomials are compared with determinants, in units of the matrix norm."""


def of_motion(of: Evaluation) -> Iterator[Relation]:
    """Yield relations of the dynamics, Jacobians, the reference, conserved quantities, and linear models."""
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
    """Yield relations of velocity and acceleration in space with the law of the central force."""
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
    """Return the first column of the Routh array of a polynomial without special cases."""
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


def of_sets(of: Evaluation) -> Iterator[Relation]:
    """Yield relations of the control law, set by set, and of the cost of the regularised problem."""
    law, within = of("control_law"), _within(of)
    (slope, terms), straight = slope_terms(of, law), np.zeros_like(law)
    turning = {part.turned_by for _, part in within.parts}
    for places, part in within.parts:
        if not part.directed and (part.kind == "angle" or places[0] in turning):  # what it turns may be none there
            across = _turned(law, places[0], law[places[0]] + np.pi / 2.0)
            terms += np.abs(of.slope("hamiltonian", "u", u=across))
    left = np.array(slope)
    curved = np.asarray(np.einsum("iik->ik", of("control_hessian", u=law)) >= 0.0)
    for places, part in within.parts:
        rows = list(places)
        if part.directed and part.kind != "angle":
            left[rows] = 0.0
            best = _at_levels(of, rows, part, within) if part.kind == "box" else _longest(of, rows, part, within)
            yield Relation("control_law", "against the slope of H, as long as pays", law[rows], best)
        elif part.kind == "box":
            low, high = (np.array(np.broadcast_arrays(*half, law[0])[:-1]) for half in (part.lower, part.upper))
            left[rows] = outside_box(left[rows], law[rows], low, high, curved[rows])
            nearest = np.minimum(np.maximum(law[rows], low), high)
            yield Relation("control_law", "within its box", law[rows], nearest, size(law[rows]))
        elif part.kind in ("ball", "annulus"):
            norm, radius = np.sqrt((law[rows] ** 2).sum(axis=0)), np.asarray(part.radius)
            inner = np.asarray(part.inner)
            left[rows] = outside_ball(left[rows], law[rows], norm, radius, inner)
            nearest = np.minimum(np.maximum(norm, 0.0 if part.directed else inner), radius)
            yield Relation("control_law", "within its ball", norm, nearest)
        elif part.kind == "angle":
            left[rows] = np.where(curved[rows], left[rows], np.inf)
    yield Relation("control_law", "H is minimal there", left, straight, terms)
    if of.has("regularised_cost"):
        expected = relaxed(of, "running_cost") + effort(of)
        yield Relation("regularised_cost", "running cost and half the squares", of("regularised_cost"), expected)


def slope_terms(of: Evaluation, law: Array) -> tuple[Array, Array]:
    """Return H_u under the law, and the sizes of its terms: H_u without controls, and the change by each control."""
    slope, idle = (of.slope("hamiltonian", "u", u=u) for u in (law, np.zeros_like(law)))
    added = np.abs(of("control_hessian", u=law) * law).sum(axis=1)
    return slope, np.abs(idle) + np.abs(slope) + np.where(np.isfinite(added), added, 0.0)


def _longest(of: Evaluation, rows: list[int], part: ControlSet, within: ControlSet) -> Array:
    """Return the vector against the slope of H, of the length given by that slope, norm weight and smoothing."""
    unit = np.zeros_like(of.at["u"])
    unit[rows[0]] = 1.0
    ahead, back = (of("stationarity", u=side * unit)[rows] for side in (1.0, -1.0))
    slope, weight = (ahead + back) / 2.0, np.asarray(within.fraction) * (ahead - back)[0] / 2.0
    size = np.maximum(np.linalg.norm(slope, axis=0), 1e-300)
    shortest = part.inner if part.throttled else 0.0
    return np.asarray(-slope / size * np.clip((size - weight) / np.asarray(within.smoothing), shortest, part.radius))


def _at_levels(of: Evaluation, rows: list[int], part: ControlSet, within: ControlSet) -> Array:
    """Return a single control in a box against the slope of H, as far as smoothing and bounds allow."""
    law = of("control_law")
    slope = of("stationarity", u=law)[rows]
    if part.turned_by is not None:  # of what does not turn only a share counts
        against = of("stationarity", u=_turned(law, part.turned_by, law[part.turned_by] + np.pi))[rows]
        slope = (slope - against) / 2.0 + np.asarray(within.fraction) * (slope + against) / 2.0
    return np.asarray(np.clip(-slope / np.asarray(within.smoothing), *part.levels))


def outside_box(slope: Array, law: Array, low: Array, high: Array, curved: Array) -> Array:
    """Return H_u without the part that an active bound may balance, whose sign H_uu determines."""
    held = np.where(law <= low, np.minimum(slope, 0.0), np.where(law >= high, np.maximum(slope, 0.0), slope))
    free = np.where((law <= low) | (law >= high), 0.0, slope)
    return np.asarray(np.where(low == high, 0.0, np.where(curved, held, free)))


def outside_ball(slope: Array, law: Array, norm: Array, limit: Array, inner: Array | float = 0.0) -> Array:
    """Return H_u without the part that points from a control at the limit into the ball, or out of a hole in it."""
    outward = law / np.where(norm > 0.0, norm, 1.0)
    along = (slope * outward).sum(axis=0)
    at_limit = norm >= limit * (1.0 - 1e-12)
    at_inner = (norm <= inner * (1.0 + 1e-12)) & ~at_limit
    held = np.where(at_limit, np.minimum(along, 0.0), np.where(at_inner, np.maximum(along, 0.0), 0.0))
    return np.asarray(slope - held * outward)


def relaxed(of: Evaluation, name: str) -> Array:
    """Return a function of the controls under the law of the regularised problem."""
    law, within = of("control_law"), _within(of)
    angles = [(places[0], part) for places, part in within.parts if part.kind == "angle" and part.directed]
    flat = np.array(law)
    for row, _ in angles:
        flat[row] = 0.0
    whole = total = of(name, u=flat)
    for (row, _), (cosine, sine) in zip(angles, _short(of, flat, angles), strict=True):
        back, side = (of(name, u=_turned(flat, row, turn)) for turn in (np.pi, np.pi / 2.0))
        middle = (whole + back) / 2.0
        total = total + (whole - middle) * cosine + (side - middle) * sine + middle - whole
    for places, part in within.parts:
        if part.throttled and (part.kind != "box" or part.turned_by is not None):  # a share only of what the norm adds
            back, none = np.array(flat), np.array(flat)
            if part.turned_by is None:
                back[list(places)] *= -1.0
            else:
                back[part.turned_by] += np.pi
            none[list(places)] = 0.0
            by_norm = (whole + of(name, u=back)) / 2.0 - of(name, u=none)
            total = total - (1.0 - np.asarray(within.fraction)) * by_norm
    return np.asarray(total)


def effort(of: Evaluation) -> Array:
    """Return half the squares of directions in the regularised problem, times the smoothing."""
    law, within = of("control_law"), _within(of)
    flat = np.array(law)
    angles = [(places[0], part) for places, part in within.parts if part.kind == "angle" and part.directed]
    for row, _ in angles:
        flat[row] = 0.0
    squares = sum((along**2 + across**2 for along, across in _short(of, flat, angles)), np.zeros(law.shape[-1]))
    for places, part in within.parts:
        if part.directed and part.kind != "angle":
            squares = squares + (law[list(places)] ** 2).sum(axis=0)
    return np.asarray(within.smoothing / 2.0 * squares)


def _short(of: Evaluation, flat: Array, angles: list[tuple[int, ControlSet]]) -> list[tuple[Array, Array]]:
    """Return the components that replace cosine and sine of each angle: against the slope of H, as long as allowed."""
    found: list[tuple[Array, Array]] = []
    for row, part in angles:
        # slopes have nothing in them of what does not turn, beside which the rest of H may be lost
        sine, cosine = (of.slope("hamiltonian", "u", u=_turned(flat, row, turn))[row] for turn in (0.0, -np.pi / 2.0))
        slope = np.maximum(np.hypot(cosine, sine), 1e-300)
        factor = np.minimum(1.0 / np.asarray(_within(of).smoothing), np.asarray(part.radius) / slope)
        found.append((-cosine * factor, -sine * factor))
    return found


def _turned(u: Array, row: int, angle: float | Array) -> Array:
    found = np.array(u)
    found[row] = angle
    return found


def _within(of: Evaluation) -> ControlSet:
    return ControlSet.from_arguments(of.kernels.spec, [np.asarray(b) for b in of.at["bounds"]])
