"""Eigenvalues with multiplicities and Jordan blocks, decided exactly or by the distance from other matrices.

Rational matrices are decided exactly (:mod:`satsym.analysis.linear.rational`). So are floats, as the fractions that
they are; but each of their entries may have been rounded, which splits a multiple eigenvalue into several close ones.
Neighbours are therefore tried as one, and real parts as zero, by how large the relative changes of the entries must be
for that (:mod:`satsym.analysis.linear.nearby`): up to ``ROUNDING`` they are taken as one or as zero, from ``KNOWN`` on
they are not, and in between it is undecided.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.linear import rational
from satsym.analysis.linear.nearby import BITS, Group, group
from satsym.analysis.linear.system import LinearSystem, scaled, system
from satsym.arrays import Array

ROUNDING, KNOWN = 2e-15, 1e-12
"""Relative changes of all entries together: up to the first they may come from rounding, from the second on they do
not."""

SMALLEST_ENTRY = 1e-15
"""An entry that is smaller than this may be rounding of zero: relative to the largest in suitable units, or, in the
units as given, to both entries of the diagonal beside it."""

DISTANT = 1e-4
"""Its m-th root, times the size of the matrix, is the distance from which numbers are not tried as one."""

LARGEST_CHANGE, MOST_MIXED = 1e-5, 7
"""Relative change, and number of eigenvalues, up to which parts of a group are tried as one, too."""

Values = NDArray[np.complexfloating]


@dataclass(frozen=True)
class Eigenvalue:
    """An eigenvalue of a matrix, with the sizes of its Jordan blocks."""

    value: complex
    """The eigenvalue, exactly real, or exactly on the imaginary axis, where that is decided."""
    blocks: tuple[int, ...]
    """Sizes of the eigenvalue's Jordan blocks, the largest first."""

    @property
    def algebraic(self) -> int:
        """Return the multiplicity as a root of the characteristic polynomial."""
        return sum(self.blocks)

    @property
    def geometric(self) -> int:
        """Return the number of independent eigenvectors."""
        return len(self.blocks)


def spectrum(A: Array, noise: float = 0.0) -> tuple[Eigenvalue, ...]:
    """Return the eigenvalues of a real square matrix, the largest real part first.

    Parameters
    ----------
    A
        Shape (n, n), in any units.
    noise
        Errors of all entries alike, beside rounding.
    """
    return spectra(system(A), noise)[0]


def spectra(given: LinearSystem, noise: float = 0.0) -> tuple[tuple[Eigenvalue, ...], ...]:
    """Return the possible spectra of a system: one, or more where its entries are not known precisely enough.

    The first one takes all values for equal, or zero, that may be so.
    """
    if given.exact is not None:
        return (of_roots(rational.roots(given.exact.A)),)
    from flint import ctx

    fitted = scaled(given)
    A, size = fitted.A, np.abs(fitted.A)
    errors = noise * fitted.states / fitted.states[:, None] / fitted.rate
    with ctx.workprec(BITS):
        known = _Tried(A, np.maximum(size, errors / ROUNDING))
        possible = [one for change in (KNOWN, ROUNDING) for one in known.within(change, fitted.rate)]
        faint = (size > 0.0) & ((size <= SMALLEST_ENTRY * size.max()) | _faint_as_given(np.abs(given.A)))
        if faint.any():
            doubtful = _Tried(A, np.where(faint, size / (ROUNDING / 2), known.entries), known)
            more = [one for change in (KNOWN, ROUNDING) for one in doubtful.within(change, fitted.rate)]
            possible = more + possible
    told = [[(each.blocks, np.sign(each.value.real)) for each in one] for one in possible]
    return tuple(one for k, one in enumerate(possible) if told[k] not in told[:k])


def _faint_as_given(size: Array) -> NDArray[np.bool_]:
    """Tell whether entries, in the units of rounding, are negligible beside both entries of the diagonal.

    Other units can make such an entry as large as any, for example 1e-16 above the diagonal of a unit matrix.
    """
    diagonal = size.diagonal()
    return size <= SMALLEST_ENTRY * np.minimum(diagonal[:, None], diagonal)


def of_roots(found: Sequence[rational.Root]) -> tuple[Eigenvalue, ...]:
    """Return exact eigenvalues rounded to floats."""
    return _sorted([Eigenvalue(root.rounded, root.blocks) for root in found])


def _sorted(found: list[Eigenvalue]) -> tuple[Eigenvalue, ...]:
    return tuple(sorted(found, key=lambda each: (-each.value.real, abs(each.value.imag), -each.value.imag)))


class _Tried:
    """A matrix of floats with its exact eigenvalues, and the groups of them that were tried as one."""

    def __init__(self, A: Array, entries: Array, other: _Tried | None = None) -> None:
        self.A, self.entries = A, entries
        self.roots: list[rational.Root] = other.roots if other else rational.roots(rational.matrix(A))
        self.exact = [root.value for root in self.roots for _ in range(sum(root.blocks))]
        self.which = [k for k, root in enumerate(self.roots) for _ in range(sum(root.blocks))]
        self.numbers: Values = np.array([rational.nearest(value) for value in self.exact])
        self.size = float(np.linalg.norm(A, 2)) or 1.0
        self.groups: dict[tuple[int, ...], tuple[Group, float]] = {}

    def within(self, change: float, rate: float) -> list[tuple[Eigenvalue, ...]]:
        """Return the possible spectra if relative changes of this size are neglected.

        Two groups may both be zero, and yet not a single eigenvalue: then the spectrum in which they are one comes
        second.
        """
        parts = list(self._told_apart(tuple(range(len(self.exact))), change))
        resting = [members for members in parts if self._one(members, change)[0] == 0.0]
        possible = [self._shown(parts, change, rate)]
        if len(resting) > 1:
            together = tuple(sorted(k for members in resting for k in members))
            others = self._shown([members for members in parts if members not in resting], change, rate)
            possible.append(_sorted([*others, Eigenvalue(0j, self._tried(together)[0].blocks(change))]))
        return possible

    def _shown(self, parts: list[tuple[int, ...]], change: float, rate: float) -> tuple[Eigenvalue, ...]:
        found = []
        for members in parts:
            value, blocks = self._one(members, change)
            found.append(Eigenvalue(value * rate, blocks))
            if not self._closed(members):
                found.append(Eigenvalue(value.conjugate() * rate, blocks))
        return _sorted(found)

    def _one(self, members: tuple[int, ...], change: float) -> tuple[complex, tuple[int, ...]]:
        same = len({self.which[k] for k in members}) == 1
        exact = self.roots[self.which[members[0]]]
        if same and (exact.value.real == 0 or abs(exact.rounded.real) > DISTANT * self.size) and len(members) == 1:
            return exact.rounded, exact.blocks
        tried, off_axis = self._tried(members)
        value = rational.nearest(tried.mean)
        value = complex(0.0 if off_axis <= change else value.real, 0.0 if self._closed(members) else value.imag)
        return value, tried.blocks(change) if len(members) > 1 else (1,)

    def _told_apart(self, members: tuple[int, ...], change: float) -> Iterator[tuple[int, ...]]:
        """Return the members of each distinct eigenvalue; of two conjugate ones only the upper one."""
        if self._one_sided(members) < 0:
            return
        if self._single(members, change):
            yield members
        elif part := self._largest_part(members, change):
            yield part
            yield from self._told_apart(tuple(k for k in members if k not in part), change)
        else:
            for half in _halves(self.numbers, members):
                yield from self._told_apart(half, change)

    def _single(self, members: tuple[int, ...], change: float) -> bool:
        if len({self.which[k] for k in members}) == 1:
            return True
        return self._plausible(members) and self._tried(members)[0].single(change)

    def _largest_part(self, members: tuple[int, ...], change: float) -> tuple[int, ...]:
        """Return the largest set of eigenvalues that may be a single one, where all nearly are; else nothing.

        Where a multiple eigenvalue is spread as far as the distance to the next one, nearest neighbours need not belong
        together.
        """
        if not 2 < len(members) <= MOST_MIXED or not self._plausible(members):
            return ()
        if self._tried(members)[0].apart > LARGEST_CHANGE:
            return ()
        for count in range(len(members) - 1, 1, -1):
            parts = [part for part in combinations(members, count) if self._single(part, change)]
            if parts:
                return min(parts, key=lambda part: self._tried(part)[0].apart)
        return ()

    def _plausible(self, members: tuple[int, ...]) -> bool:
        together = self.numbers[list(members)]
        near = np.abs(together - together.mean()).max() <= DISTANT ** (1.0 / len(members)) * self.size
        return bool(near) and (self._closed(members) or self._one_sided(members) > 0)

    def _one_sided(self, members: Sequence[int]) -> int:
        signs = np.sign(self.numbers[list(members)].imag)
        return int(signs[0]) if (signs == signs[0]).all() else 0

    def _closed(self, members: Sequence[int]) -> bool:
        """Tell whether each of these eigenvalues is real, or has its conjugate among them."""
        return abs(sum(np.sign(self.numbers[list(members)].imag))) == 0

    def _tried(self, members: tuple[int, ...]) -> tuple[Group, float]:
        """Return the group of some eigenvalues, and how far its mean is off the imaginary axis."""
        if members not in self.groups:
            inside = [self.exact[k] for k in members]
            outside = [self.exact[k] for k in range(len(self.exact)) if k not in members]
            found = group(self.A, self.entries, inside, outside)
            self.groups[members] = found, found.off_axis()
        return self.groups[members]


def _halves(numbers: Values, members: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Split numbers into two parts that are as far from each other as possible."""
    from scipy.cluster.hierarchy import linkage, to_tree

    pairs, chosen = np.triu_indices(len(members), 1), numbers[list(members)]
    tree: Any = to_tree(linkage(np.abs(chosen[:, None] - chosen)[pairs], "single"))
    return [tuple(sorted(members[k] for k in part.pre_order())) for part in (tree.left, tree.right)]


ASYMPTOTIC, MARGINAL, UNSTABLE = "asymptotically stable", "marginally stable", "unstable"
UNDECIDED = "undecided"


@dataclass(frozen=True)
class Stability:
    """A verdict on the stability of x' = A x with its reason."""

    verdict: str | None
    """``"asymptotically stable"``, ``"marginally stable"`` or ``"unstable"``; ``"undecided"`` where the entries are not
    known precisely enough, and ``None`` where eigenvalues decide nothing."""
    reason: str
    """A sentence with the eigenvalue that decides."""
    decides: bool
    """Whether the verdict holds for small deviations of the nonlinear system, too (Lyapunov's indirect method): not
    where eigenvalues on the imaginary axis decide."""


def stability(eigenvalues: Sequence[Eigenvalue], *others: Sequence[Eigenvalue]) -> Stability:
    """Decide stability from eigenvalues and Jordan blocks.

    Parameters
    ----------
    eigenvalues, *others
        What they may be, as :func:`satsym.analysis.linear.spectrum.spectra` gives it; if two of these possibilities
        have different verdicts, none is given.
    """
    found = [_one(each) for each in (eigenvalues, *others)]
    if len({each.verdict for each in found}) == 1:
        return found[0]
    listed = "; or ".join(f"{each.verdict}: {each.reason}" for each in found)
    return Stability(
        UNDECIDED, f"the entries of the matrix are not known accurately enough to decide. Either {listed}", False
    )


def _one(eigenvalues: Sequence[Eigenvalue]) -> Stability:
    rightmost = max(eigenvalues, key=lambda each: each.value.real)
    if rightmost.value.real > 0.0:
        return Stability(UNSTABLE, f"the eigenvalue {shown(rightmost.value)} has a positive real part", True)
    if rightmost.value.real < 0.0:
        return Stability(ASYMPTOTIC, f"all real parts are negative, the largest is {rightmost.value.real:.6g}", True)
    axis = [each for each in eigenvalues if each.value.real == 0.0]
    worst = max(axis, key=lambda each: each.blocks[0])
    size = worst.blocks[0]
    if size > 1:
        growth = "t" if size == 2 else f"t^{size - 1}"
        reason = (
            f"the eigenvalue {shown(worst.value)} on the imaginary axis has a Jordan block of size {size} "
            f"(multiplicity {worst.algebraic}, {worst.geometric} eigenvector{'s' * (worst.geometric > 1)}), "
            f"so deviations grow like {growth}"
        )
        return Stability(UNSTABLE, reason, False)
    listed = ", ".join(shown(each.value) for each in axis if each.value.imag >= 0.0)
    reason = (
        f"the imaginary axis contains {listed}, in Jordan blocks of size 1 only, and no eigenvalue lies in the "
        "right half-plane"
    )
    return Stability(MARGINAL, reason, False)


def shown(value: complex) -> str:
    """Write an eigenvalue, or a complex one with its conjugate, in a sentence."""
    if value.imag == 0.0:
        return f"{value.real + 0.0:.6g}"
    real = f"{value.real:.6g} " if value.real else ""
    return f"{real}\N{PLUS-MINUS SIGN}{' ' if real else ''}{abs(value.imag):.6g}i"


CANCELLED_COEFFICIENT = 1e-13
"""Largest coefficient that is zero, relative to its size if none of its terms cancelled."""


def characteristic(A: Array) -> Array:
    """Return the coefficients of det(s - A), highest power first, the first one 1; shape (n + 1,)."""
    values = np.array([each.value for each in spectrum(A) for _ in range(each.algebraic)])
    rate = float(np.abs(values).max()) or 1.0
    coefficients, largest = np.poly(values / rate).real, np.poly(-np.abs(values / rate))
    coefficients[np.abs(coefficients) <= CANCELLED_COEFFICIENT * largest] = 0.0
    return np.asarray(coefficients * rate ** np.arange(len(values) + 1))


def companion_matrix(coefficients: Sequence[float] | Array) -> Array:
    """Return the companion matrix of a monic polynomial: negated coefficients in the last row, lowest first."""
    n = len(coefficients) - 1
    found = np.eye(n, k=1)
    found[-1] = -np.asarray(coefficients)[:0:-1]
    return found
