"""A final state that follows from the others, because the motion conserves a quantity for all controls.

For example, three components of a quaternion at the end determine the fourth, up to its sign. Such a condition makes
the equations for the costates singular. It is found from the effect of controls on the final state, which vanishes in
one direction. The condition on the state with the largest component in this direction is left out, and tested again in
the answer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet, Row
from satsym.instance import Guess, Instance
from satsym.kernels import Kernels
from satsym.solution import Solution

SPANNED, MOVED = 1e-9, 1e-9
"""Singular values, relative to the largest, below which rates at the end, and responses to controls, do not span a
direction."""

DRAWN = 6
"""Number of random controls whose rates at the end are compared."""

MORE, STEPS = 3, 16
"""Number of knots at which controls are varied, in addition to those needed to move the end in all directions, and
number of steps between knots."""

STEP = 1e-4
"""Variation of the controls, relative to their magnitude."""

SEEN = 1e-5
"""Minimum effect of a control variation on the final state, relative to the states. If the effect is smaller, the
variation is increased."""

OFF = (0.3, 0.7)
"""Range of the random distance of a free final state from the initial one, relative to the latter."""

EQUAL_DIRECTIONS = 1e-4
"""Largest difference between the directions without effect of two random controls, for a direction that belongs to the
motion."""

LARGE_ENOUGH = 0.1
"""Component of a direction, relative to the largest, above which the state follows from the others accurately
enough."""

HORIZON = 0.25
"""Time in which controls are varied, as a fraction of the time scale of the motion."""

DRIFTING = 1e-3
"""Eigenvalues of the motion, relative to its largest derivative, below which they count as zero."""

MET = 1e-6
"""Miss of a final state that was left out, relative to its largest magnitude, up to which it counts as satisfied."""


@dataclass(frozen=True)
class Redundant:
    """An instance without one of its given final states, which follows from the others."""

    instance: Instance
    state: str
    given: float
    others: tuple[Redundant, ...] = ()
    """Alternatives with another final state left out, which may differ in signs that the remaining states leave
    open."""

    @property
    def towards(self) -> Instance:
        """The instance with the straight line to its end as initial guess, as a sign of the end may be open."""
        names, whole = self.instance.model.spec.state_names, {**self.instance.final, self.state: self.given}
        line = {
            name: (x, float(whole[name]) if isinstance(whole.get(name), float | int) else x)
            for name, x in zip(names, self.instance.initial, strict=True)
        }
        return replace(self.instance, guess=Guess(state=line))

    def met(self, solution: Solution) -> bool:
        """Return whether a solution has an answer that satisfies the condition that was left out."""
        size = float(np.abs(solution.x[self._row]).max())
        return solution.status.answered and abs(self.reached(solution) - self.given) <= MET * max(size, abs(self.given))

    @property
    def _row(self) -> int:
        return self.instance.model.spec.state_names.index(self.state)

    def reached(self, solution: Solution) -> float:
        """Return the value with which the state ends in a solution."""
        return float(solution.x[self._row, -1])

    def missed(self, solution: Solution) -> str:
        """Return the message for an answer that does not satisfy the condition that was left out."""
        return (
            f"a function of the states that no control changes ties the final {self.state} to the others: what was "
            f"found with these as asked ends at {self.reached(solution):.6g} instead of {self.given:.6g}; leave it out"
        )

    @property
    def note(self) -> str:
        """Return a message that says which condition was left out, and why."""
        return (
            f"the other final states already determine the final {self.state}, because no control changes a "
            "certain function of them: this condition was therefore left out"
        )


def redundant(instance: Instance) -> Redundant | None:
    """Return the instance without a final state that follows from the others; ``None`` if there is none."""
    names = instance.model.spec.state_names
    fixed = np.array([isinstance(instance.final.get(name), float | int) for name in names])
    if instance.guess or instance.model.spec.multipliers or fixed.sum() < 2:
        return None
    end = _end(instance, fixed)
    with np.errstate(all="ignore"):
        if not _spans_less(instance, end):
            return None
        rng = np.random.default_rng(0)
        one = _still(instance, end, rng)
        other = None if one is None else _still(instance, end, rng)
    if one is None or other is None or min(np.abs(one - other).max(), np.abs(one + other).max()) > EQUAL_DIRECTIONS:
        return None
    if np.abs(one[~fixed]).max(initial=0.0) > EQUAL_DIRECTIONS:
        return None  # a state that is free makes up for it
    share = np.abs(one)
    most, *rest = (_without(instance, names[i]) for i in np.argsort(-share, kind="stable") if share[i] >= LARGE_ENOUGH)
    return replace(most, others=tuple(rest))


def _without(instance: Instance, state: str) -> Redundant:
    """Return the instance with one final state left out."""
    final = {name: value for name, value in instance.final.items() if name != state}
    return Redundant(replace(instance, final=final), state, float(instance.final[state]))


@lru_cache
def _shares(count: int) -> Array:
    """Return random relative distances of free final states from the initial ones."""
    return np.random.default_rng(1).uniform(*OFF, count)


def _end(instance: Instance, fixed: Array) -> Array:
    """Return the required final states, with values away from the initial state for the free ones."""
    start, names = np.array(instance.initial), instance.model.spec.state_names
    off = curve = start + np.where(start != 0.0, np.abs(start), 1.0) * _shares(len(start))
    referred = [instance.final.get(name) == "reference" for name in names]
    if any(referred) and instance.tf is not None:
        curve = np.array(instance.model.reference(instance.tf, instance.parameters))
    stated = [float(instance.final[name]) if fixed[i] else off[i] for i, name in enumerate(names)]
    return np.where(referred, curve, stated)


def _sizes(instance: Instance, end: Array) -> Array:
    """Return magnitudes of the states at both ends; 1 if both are zero."""
    size = np.maximum(np.abs(end), np.abs(np.array(instance.initial)))
    return np.where(size > 0.0, size, 1.0)


def _controls(instance: Instance, rng: np.random.Generator, count: int) -> Array:
    """Return random admissible controls, shape (m, count)."""
    return np.asarray(instance.control_set.project(rng.normal(size=(len(instance.model.spec.controls), count))))


def _spans_less(instance: Instance, end: Array) -> bool:
    """Return whether rates at the end and their commutators span less than all directions.

    Otherwise no quantity is conserved, and no further tests are needed.
    """
    place = _last(instance), instance.tf is None, tuple(end.tolist())
    rounded = np.exp2(np.rint(np.log2(_sizes(instance, end))))  # known again where only the start differs
    return _dependent(instance.model, instance.parameters, instance.control_set, *place, tuple(rounded.tolist()))


@lru_cache(maxsize=32)
def _dependent(model: Kernels, p: Row, within: ControlSet, t: float, free_time: bool, end: Row, sizes: Row) -> bool:
    """Return whether rates and commutators at the end leave out a direction, relative to the states' magnitudes."""
    columns, made_of = _directions(model, p, within, t, free_time, end)
    size = np.array(sizes)[:, None]
    # what cancels but for rounding must not count: each column is relative to what it is made of
    table = columns / size / np.maximum((made_of / size).max(axis=0), 1e-300)
    if not np.isfinite(table).all():
        return False
    values = np.linalg.svd(table, compute_uv=False)
    return bool(values[-1] <= SPANNED * values[0])


@lru_cache(maxsize=8)
def _directions(model: Kernels, p: Row, within: ControlSet, t: float, free_time: bool, end: Row) -> tuple[Array, Array]:
    """Return rates at the end under random controls and their commutators as columns, and magnitudes of their terms."""
    drawn = np.random.default_rng(0).normal(size=(len(model.spec.controls), DRAWN))
    given = np.full(DRAWN, t), np.repeat(np.array(end)[:, None], DRAWN, axis=1), within.project(drawn), p
    rates, slopes = model.dynamics_batch(*given), model.jacobian_x_batch(*given)
    later, earlier = np.tril_indices(DRAWN, -1)
    carried, terms = np.einsum("abj,bi->aij", slopes, rates), np.einsum("abj,bi->aij", np.abs(slopes), np.abs(rates))
    moved = rates if free_time else rates - rates[:, :1]
    columns = np.concatenate([moved, carried[:, later, earlier] - carried[:, earlier, later]], axis=1)
    own = np.repeat(np.abs(rates).max(axis=1, keepdims=True), DRAWN, axis=1)
    return columns, np.concatenate([own, terms[:, later, earlier] + terms[:, earlier, later]], axis=1)


def _last(instance: Instance) -> float:
    """Return the final time, or a possible one."""
    if instance.tf is not None:
        return instance.tf
    return instance.t0 + 1.0 if instance.tf_guess is None else instance.tf_guess


def _still(instance: Instance, end: Array, rng: np.random.Generator) -> Array | None:
    """Return the direction in which controls do not move the end of the motion, if it is unique, otherwise ``None``."""
    model, p, size = instance.model, instance.parameters, _sizes(instance, end)
    knots = -(-len(end) // len(model.spec.controls)) + MORE
    drawn, count = _controls(instance, rng, knots), (knots - 1) * STEPS
    last = _last(instance)
    lasting = HORIZON / max(_quickest(instance, end, drawn), 1e-300)
    if instance.tf is not None:
        lasting = min(lasting, instance.tf - instance.t0)
    hats = np.array(
        [np.interp(np.linspace(0.0, knots - 1.0, 2 * count + 1), range(knots), one) for one in np.eye(knots)]
    )
    times = np.linspace(last - lasting, last, count + 1)
    back = (drawn @ hats)[:, ::-1]
    start = model.forward(times[::-1], tuple(end.tolist()), back[:, ::2], back[:, 1::2], p)[0][:, -1]

    def reached(at: Array) -> Array:
        u = at @ hats
        return np.asarray(model.forward(times, tuple(start.tolist()), u[:, ::2], u[:, 1::2], p)[0][:, -1])

    def responses(step: float) -> Array:
        unit = np.eye(drawn.size).reshape(-1, *drawn.shape)
        return np.array([(reached(drawn + step * one) - reached(drawn - step * one)) / step for one in unit])

    step = STEP * max(float(np.abs(drawn).max()), 1e-6)
    columns = responses(step)
    moved = float(np.abs(columns / size).max()) * step
    if 0.0 < moved < SEEN:  # heavy bodies hardly answer to controls of size one, and rounding is all that is left
        columns = responses(step * SEEN / moved)
    if instance.tf is None:
        rate = np.array(model.dynamics(last, tuple(end.tolist()), tuple(drawn[:, -1].tolist()), p))
        columns = np.vstack([columns, rate])
    table = columns.T / size[:, None]
    if not np.isfinite(table).all():
        return None
    left, values, _ = np.linalg.svd(table, full_matrices=True)
    if len(values) < len(end) or not values[-1] <= MOVED * values[0] < values[-2]:
        return None
    direction = left[:, -1] / size
    return np.asarray(direction / np.abs(direction).max())


def _quickest(instance: Instance, end: Array, drawn: Array) -> float:
    """Return the largest rate of the motion near the end, from its eigenvalues or, if these vanish, its derivatives."""
    last, n = _last(instance), len(end)
    found = []
    for u in drawn.T.tolist():
        slopes = np.array(instance.model.jacobian_x(last, end.tolist(), u, instance.parameters)).reshape(n, n)
        own, largest = float(np.abs(np.linalg.eigvals(slopes)).max()), float(np.linalg.norm(slopes, 2))
        found.append(own if own > DRIFTING * largest else largest)
    return max(found)
