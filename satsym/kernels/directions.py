"""What functions of a problem must have to do with each other whose control set is a product of sets.

Where controls are directions the canonical equations are those of the regularised problem, in which an angle is a
vector that may be shorter than one. What depends on an angle is linear in its cosine and sine, so that its values at
three angles tell what it is there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.kernels.evaluation import Evaluation, Relation, size


def of_sets(of: Evaluation) -> Iterator[Relation]:
    """Relations of the law, set by set, and of what the regularised problem costs."""
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
    """H_u under the law, and sizes of what it consists of: H_u without controls, and what each of these adds."""
    slope, idle = (of.slope("hamiltonian", "u", u=u) for u in (law, np.zeros_like(law)))
    added = np.abs(of("control_hessian", u=law) * law).sum(axis=1)
    return slope, np.abs(idle) + np.abs(slope) + np.where(np.isfinite(added), added, 0.0)


def _longest(of: Evaluation, rows: list[int], part: ControlSet, within: ControlSet) -> Array:
    """The vector against the slope of H, as long as that slope, less what the norm adds, and the smoothing make it."""
    unit = np.zeros_like(of.at["u"])
    unit[rows[0]] = 1.0
    ahead, back = (of("stationarity", u=side * unit)[rows] for side in (1.0, -1.0))
    slope, weight = (ahead + back) / 2.0, np.asarray(within.fraction) * (ahead - back)[0] / 2.0
    size = np.maximum(np.linalg.norm(slope, axis=0), 1e-300)
    shortest = part.inner if part.throttled else 0.0
    return np.asarray(-slope / size * np.clip((size - weight) / np.asarray(within.smoothing), shortest, part.radius))


def _at_levels(of: Evaluation, rows: list[int], part: ControlSet, within: ControlSet) -> Array:
    """The single control in a box against the slope of H, as far as the smoothing and its bounds let it."""
    law = of("control_law")
    slope = of("stationarity", u=law)[rows]
    if part.turned_by is not None:  # of what does not turn only a share counts
        against = of("stationarity", u=_turned(law, part.turned_by, law[part.turned_by] + np.pi))[rows]
        slope = (slope - against) / 2.0 + np.asarray(within.fraction) * (slope + against) / 2.0
    return np.asarray(np.clip(-slope / np.asarray(within.smoothing), *part.levels))


def outside_box(slope: Array, law: Array, low: Array, high: Array, curved: Array) -> Array:
    """H_u but for what a bound that is met may hold; which sign that has where H_uu says which way is down."""
    held = np.where(law <= low, np.minimum(slope, 0.0), np.where(law >= high, np.maximum(slope, 0.0), slope))
    free = np.where((law <= low) | (law >= high), 0.0, slope)
    return np.asarray(np.where(low == high, 0.0, np.where(curved, held, free)))


def outside_ball(slope: Array, law: Array, norm: Array, limit: Array, inner: Array | float = 0.0) -> Array:
    """H_u but for a part that points from a control at the limit straight into the ball; or out of a hole in it."""
    outward = law / np.where(norm > 0.0, norm, 1.0)
    along = (slope * outward).sum(axis=0)
    at_limit = norm >= limit * (1.0 - 1e-12)
    at_inner = (norm <= inner * (1.0 + 1e-12)) & ~at_limit
    held = np.where(at_limit, np.minimum(along, 0.0), np.where(at_inner, np.maximum(along, 0.0), 0.0))
    return np.asarray(slope - held * outward)


def relaxed(of: Evaluation, name: str) -> Array:
    """A function of the controls under the law of the regularised problem."""
    law, within = of("control_law"), _within(of)
    angles = [(places[0], part) for places, part in within.parts if part.kind == "angle" and part.directed]
    flat = np.array(law)
    for row, _ in angles:
        flat[row] = 0.0
    whole = total = of(name, u=flat)
    for (row, _), (along, across) in zip(angles, _short(of, flat, angles), strict=True):
        back, side = (of(name, u=_turned(flat, row, turn)) for turn in (np.pi, np.pi / 2.0))
        middle = (whole + back) / 2.0
        total = total + (whole - middle) * along + (side - middle) * across + middle - whole
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
    """Half the squares of directions in the regularised problem, times the smoothing."""
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
    """What takes the place of cosine and sine of each angle: against the slope of H, as long as that allows."""
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
