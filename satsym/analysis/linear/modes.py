"""Modes of a linear system: their states, frequency, damping and names.

How much a state takes part in a mode is the product of its entries in the right and the left eigenvector: the diagonal
of the projector on the mode, which does not depend on units (Perez-Arriaga, Verghese and Schweppe, IEEE Trans. PAS 101,
1982). A model may name a mode by the states that have the largest part in it, and may distinguish two modes by whether
they become infinitely slow with one of its parameters: eigenvalues are then followed while it shrinks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.linear.equilibrium import Linearisation, jacobians
from satsym.analysis.linear.spectrum import Eigenvalue
from satsym.analysis.linear.system import scaled, system
from satsym.arrays import Array
from satsym.spec import ModeGroup

Numbers = NDArray[np.complexfloating]

SHRUNK = 1e-4
"""Factor by which a parameter is reduced to see which eigenvalues vanish with it."""
LARGEST_STEP, SMALLEST_STEP = 0.5, 1e-4
"""Logarithms of the factors of one reduction: the largest, and the one below which eigenvalues count as meeting."""
SMALLEST_SEPARATION = 4.0
"""Least distance of other eigenvalues from one that is followed, relative to the distance of its continuation."""


@dataclass(frozen=True, eq=False)
class Mode:
    """A mode of a linear system: an eigenvalue, with its conjugate if it is not real."""

    eigenvalue: Eigenvalue
    participation: Mapping[str, float]
    """The part of each state in the mode, by name; the parts add up to 1."""
    name: str
    """The name of the mode; empty where the model states none."""

    @property
    def frequency(self) -> float:
        """Return the natural frequency, the magnitude of the eigenvalue."""
        return abs(self.eigenvalue.value)

    @property
    def damping_ratio(self) -> float | None:
        """Return damping relative to critical damping; negative if the mode grows; ``None`` for real eigenvalues."""
        value = self.eigenvalue.value
        return -value.real / abs(value) + 0.0 if value.imag else None

    @property
    def period(self) -> float | None:
        """Return the time of one oscillation; ``None`` for real eigenvalues."""
        value = self.eigenvalue.value
        return 2.0 * math.pi / abs(value.imag) if value.imag else None

    @property
    def time_constant(self) -> float | None:
        """Return the time in which the mode decays, or grows, by a factor e; ``None`` where it does neither."""
        return 1.0 / abs(self.eigenvalue.value.real) if self.eigenvalue.value.real else None

    def carried_by(self) -> list[tuple[str, float]]:
        """Return the states that have the largest parts in the mode, which add up to half or more."""
        found: list[tuple[str, float]] = []
        for name, share in sorted(self.participation.items(), key=lambda pair: -pair[1]):
            # equal parts are shown together
            if sum(s for _, s in found) >= 0.5 and share < 0.9 * found[-1][1]:
                break
            found.append((name, share))
        return found


def modes(about: Linearisation, eigenvalues: Sequence[Eigenvalue]) -> tuple[Mode, ...]:
    """Return the modes of a linearisation, in the order of its eigenvalues."""
    chosen = [each for each in eigenvalues if each.value.imag >= 0.0]
    parts = [dict(zip(about.system.states, row, strict=True)) for row in participation(about.system.A, chosen)]
    groups = [_group(about.model.spec.mode_groups, each) for each in parts]
    slow = _slow(about, [each.value for each in chosen], groups)
    return tuple(
        Mode(value, part, _name(group, value, vanishes))
        for value, part, group, vanishes in zip(chosen, parts, groups, slow, strict=True)
    )


def participation(A: Array, eigenvalues: Sequence[Eigenvalue]) -> Array:
    """Return the part of each state in each eigenvalue's mode; shape (eigenvalues, n), rows add up to 1."""
    from scipy.linalg import schur, solve_sylvester

    fitted, n = scaled(system(A)), len(A)
    found = np.zeros((len(eigenvalues), n))
    numbers = np.linalg.eigvals(fitted.A)
    for row, each in enumerate(eigenvalues):
        count = each.algebraic
        near = np.sort(np.abs(numbers - each.value / fitted.rate))
        bound = (near[count - 1] + near[count]) / 2 if count < n else math.inf
        value = each.value / fitted.rate
        form, basis, _ = schur(fitted.A, output="complex", sort=partial(_within, value, bound))
        # the rows that belong to the first columns, orthogonal to all other eigenvectors
        left = basis[:, :count].conj().T
        if count < n:
            across = solve_sylvester(form[:count, :count], -form[count:, count:], form[:count, count:])
            left = left + across @ basis[:, count:].conj().T
        share = np.abs(np.einsum("ki,ik->k", basis[:, :count], left))
        found[row] = share / share.sum()
    return found


def _within(value: complex, bound: float, number: complex) -> bool:
    return abs(number - value) < bound


def _group(groups: Sequence[ModeGroup], part: Mapping[str, float]) -> ModeGroup | None:
    """Return the named group whose states have the largest part, if that is most of the whole."""
    shares = [(sum(part[s] for s in group.states), group) for group in groups]
    share, group = max(shares, key=lambda pair: pair[0], default=(0.0, None))
    return group if share > 0.5 else None


def _name(group: ModeGroup | None, each: Eigenvalue, vanishes: bool | None) -> str:
    if group is None or (group.slow and vanishes is None):
        return ""
    if each.value == 0.0 and group.neutral:
        return group.neutral
    return group.slow if vanishes else group.name


def _slow(about: Linearisation, values: Sequence[complex], groups: Sequence[ModeGroup | None]) -> list[bool | None]:
    """Tell whether each eigenvalue vanishes with the parameter of its group; ``None`` where this is undecided."""
    found: list[bool | None] = [None] * len(values)
    for parameter in {group.vanishing for group in groups if group and group.vanishing}:
        limits = _limits(about, parameter) if about.constant else {}
        starts = np.array(list(limits))
        for k, group in enumerate(groups):
            if group is not None and group.vanishing == parameter and limits:
                found[k] = limits[complex(starts[np.abs(starts - values[k]).argmin()])]
    return found


def _limits(about: Linearisation, parameter: str) -> dict[complex, bool | None]:
    """Return each eigenvalue, and whether it vanishes with a parameter; ``None`` where it meets one that differs."""
    place = about.model.spec.parameter_names.index(parameter)

    def numbers(factor: float) -> Numbers:
        p = (*about.parameters[:place], about.parameters[place] * factor, *about.parameters[place + 1 :])
        point = np.array(about.model.reference(about.t0, p)) if about.on_reference else about.point
        fitted = scaled(system(jacobians(about.model, p, about.t0, point)[0]))
        return np.asarray(np.linalg.eigvals(fitted.A) * fitted.rate, dtype=complex)

    if not about.parameters[place]:
        return {}
    start = numbers(1.0)
    now, before, families = start, start, np.arange(len(start))
    log, step, last = 0.0, LARGEST_STEP, LARGEST_STEP
    while log < -math.log(SHRUNK):
        guess = now + (now - before) * (step / last)
        order, clear = _continued(guess, coming := numbers(math.exp(-log - step)))
        if not clear.all() and step > SMALLEST_STEP:
            step = max(step / 2, SMALLEST_STEP)
            continue
        for i in np.flatnonzero(~clear):  # they meet: which is which afterwards has no meaning
            met = np.argsort(np.abs(coming - guess[i]))[:2]
            together = families[np.isin(order, met)]
            families[np.isin(families, together)] = together.min()
        before, now, last = now, coming[order], step
        log, step = log + step, min(2.0 * step, LARGEST_STEP)
    slow = np.abs(now) <= np.abs(start) * math.sqrt(SHRUNK)
    alike = [len({bool(s) for s in slow[families == f]}) == 1 for f in families]
    return {complex(v): bool(s) if a else None for v, s, a in zip(start, slow, alike, strict=True)}


def _continued(guess: Numbers, coming: Numbers) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Match each number with its continuation among the next numbers, and tell whether the match is clear."""
    from scipy.optimize import linear_sum_assignment

    apart = np.abs(guess[:, None] - coming)
    order = linear_sum_assignment(apart)[1]
    own = np.take_along_axis(apart, order[:, None], axis=1)[:, 0]
    others = apart + np.where(np.arange(len(coming)) == order[:, None], np.inf, 0.0)
    same = 1e-9 * np.abs(coming).max()  # numbers for one multiple eigenvalue need not be distinguished
    return order, (SMALLEST_SEPARATION * own <= others.min(axis=1)) | (own <= same)
