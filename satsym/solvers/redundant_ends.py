"""A final state that follows from the others, because a quantity is conserved whatever the controls do.

The components of a quaternion are an example: with three of them given at the end, and the sign, so is the fourth. Such
a condition makes all equations for costates singular. It shows in what controls do to the final state: there is a
direction in which they move it nowhere. The condition on the state that this direction has most of is left out, and
looked at again in the answer.
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
"""Share of the largest singular value below which rates at the end, and responses to controls, span a direction less.
"""

DRAWN = 6
"""Controls whose rates at the end are compared."""

MORE, STEPS = 3, 16
"""Knots at which controls are varied, more than it takes to move the end everywhere, and steps from one to the next."""

STEP = 1e-4
"""By which they are varied, relative to their size."""

SEEN = 1e-5
"""By which they then move the end at least, relative to sizes: by more where that is less."""

OFF = (0.3, 0.7)
"""By how much a final state that is free is off its start, relative to that."""

EQUAL_DIRECTIONS = 1e-4
"""Difference of the directions that two controls leave open, if it is one of the motion and none of these controls."""

LARGE_ENOUGH = 0.1
"""Share of the largest component of a direction, with which a state follows from the others well enough."""

HORIZON = 0.25
"""Share of the motion's own time scale in which controls are varied."""

DRIFTING = 1e-3
"""Share of the largest slope of the motion below which its eigenvalues are none."""

MET = 1e-6
"""Miss of a final state that was left out, relative to its largest size on the way, with which it is met."""


@dataclass(frozen=True)
class Redundant:
    """An instance without one of its final states, which follows from the others."""

    instance: Instance
    state: str
    given: float
    others: tuple[Redundant, ...] = ()
    """Instances without another final state, where the signs that the rest leaves open differ."""

    @property
    def towards(self) -> Instance:
        """The instance with the straight line to its end as a guess: the final states left may leave a sign open."""
        names, whole = self.instance.model.spec.state_names, {**self.instance.final, self.state: self.given}
        line = {
            name: (x, float(whole[name]) if isinstance(whole.get(name), float | int) else x)
            for name, x in zip(names, self.instance.initial, strict=True)
        }
        return replace(self.instance, guess=Guess(state=line))

    def met(self, solution: Solution) -> bool:
        """Whether there is an answer, and it ends there all the same."""
        size = float(np.abs(solution.x[self._row]).max())
        return solution.status.answered and abs(self.reached(solution) - self.given) <= MET * max(size, abs(self.given))

    @property
    def _row(self) -> int:
        return self.instance.model.spec.state_names.index(self.state)

    def reached(self, solution: Solution) -> float:
        """Where it ends."""
        return float(solution.x[self._row, -1])

    def missed(self, solution: Solution) -> str:
        """What an answer that does not end there means."""
        return (
            f"a function of the states that no control changes ties the final {self.state} to the others: what was "
            f"found with these as asked ends at {self.reached(solution):.6g} instead of {self.given:.6g}; leave it out"
        )

    @property
    def note(self) -> str:
        """What was done, in words."""
        return (
            f"the other final states already determine the final {self.state}, because no control changes a "
            "certain function of them: this condition was left out"
        )


def redundant(instance: Instance) -> Redundant | None:
    """The instance without a final state that follows from the others; ``None`` where none does."""
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
    """What is left where this one is not asked for."""
    final = {name: value for name, value in instance.final.items() if name != state}
    return Redundant(replace(instance, final=final), state, float(instance.final[state]))


@lru_cache
def _shares(count: int) -> Array:
    """By which states are off their start."""
    return np.random.default_rng(1).uniform(*OFF, count)


def _end(instance: Instance, fixed: Array) -> Array:
    """A final state as it is asked for, and with what is free somewhere off the start."""
    start, names = np.array(instance.initial), instance.model.spec.state_names
    off = curve = start + np.where(start != 0.0, np.abs(start), 1.0) * _shares(len(start))
    referred = [instance.final.get(name) == "reference" for name in names]
    if any(referred) and instance.tf is not None:
        curve = np.array(instance.model.reference(instance.tf, instance.parameters))
    stated = [float(instance.final[name]) if fixed[i] else off[i] for i, name in enumerate(names)]
    return np.where(referred, curve, stated)


def _sizes(instance: Instance, end: Array) -> Array:
    """Sizes of states at both ends; one where both are zero."""
    size = np.maximum(np.abs(end), np.abs(np.array(instance.initial)))
    return np.where(size > 0.0, size, 1.0)


def _controls(instance: Instance, rng: np.random.Generator, count: int) -> Array:
    """Admissible controls that are drawn, shape (m, count)."""
    return np.asarray(instance.control_set.project(rng.normal(size=(len(instance.model.spec.controls), count))))


def _spans_less(instance: Instance, end: Array) -> bool:
    """Whether rates of change at the end and how they change along each other span less than all directions.

    Where they do not, no quantity is conserved, and nothing else needs to be looked at.
    """
    place = _last(instance), instance.tf is None, tuple(end.tolist())
    rounded = np.exp2(np.rint(np.log2(_sizes(instance, end))))  # known again where only the start differs
    return _dependent(instance.model, instance.parameters, instance.control_set, *place, tuple(rounded.tolist()))


@lru_cache(maxsize=32)
def _dependent(model: Kernels, p: Row, within: ControlSet, t: float, free_time: bool, end: Row, sizes: Row) -> bool:
    """Whether rates and changes at the end leave out a direction, states being of these sizes."""
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
    """Rates at the end under drawn controls and their commutators, a column each, and what they are made of."""
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
    """The final time, or one that may be."""
    if instance.tf is not None:
        return instance.tf
    return instance.t0 + 1.0 if instance.tf_guess is None else instance.tf_guess


def _still(instance: Instance, end: Array, rng: np.random.Generator) -> Array | None:
    """The direction in which controls do not move the end of a motion that ends as it should, if there is just one."""
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
    """The largest rate of the motion about the end: by its eigenvalues, or by its slopes where these give no scale."""
    last, n = _last(instance), len(end)
    found = []
    for u in drawn.T.tolist():
        slopes = np.array(instance.model.jacobian_x(last, end.tolist(), u, instance.parameters)).reshape(n, n)
        own, largest = float(np.abs(np.linalg.eigvals(slopes)).max()), float(np.linalg.norm(slopes, 2))
        found.append(own if own > DRIFTING * largest else largest)
    return max(found)
