"""Random matrices whose Jordan form is known, exactly: T J T^-1 in units that differ by powers of ten."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from flint import fmpq, fmpq_mat

from satsym.analysis.linear.spectrum import ASYMPTOTIC, MARGINAL, UNSTABLE

Value = tuple[Fraction, Fraction]
"""Real and imaginary part, the latter not negative."""
DECADES = 10
"""Over which entries are spread."""


@dataclass(frozen=True, eq=False)
class Known:
    """A matrix, and what is true of it."""

    rows: list[list[Fraction]]
    blocks: dict[complex, tuple[int, ...]]
    """Eigenvalue, those of conjugate ones above the real axis -> sizes of its Jordan blocks, the largest first."""
    verdict: str

    @property
    def floats(self) -> np.ndarray:
        """Each entry rounded."""
        return np.array([[float(entry) for entry in row] for row in self.rows])


def known(seed: int) -> Known:
    """A matrix of one to eight states."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 9))
    blocks = _blocks(rng, size)
    J = _jordan(blocks, size)
    T = _invertible(rng, size)
    A = T * J * T.inv()
    units = _units(rng, A)
    rate = fmpq(10) ** int(rng.integers(-3, 4))
    rows = [[A[i, j] * units[j] / units[i] * rate for j in range(size)] for i in range(size)]
    found: dict[Value, list[int]] = defaultdict(list)
    for value, count in blocks:
        found[value].append(count)
    return Known(
        [[Fraction(int(e.p), int(e.q)) for e in row] for row in rows],
        {
            complex(float(re * Fraction(str(rate))), float(im * Fraction(str(rate)))): tuple(sorted(n, reverse=True))
            for (re, im), n in found.items()
        },
        _verdict(found),
    )


def _verdict(found: dict[Value, list[int]]) -> str:
    if any(re > 0 for re, _ in found):
        return UNSTABLE
    axis = [max(sizes) for (re, _), sizes in found.items() if re == 0]
    return UNSTABLE if max(axis, default=0) > 1 else MARGINAL if axis else ASYMPTOTIC


def _blocks(rng: np.random.Generator, size: int) -> list[tuple[Value, int]]:
    """Eigenvalues with block sizes; most matrices have none on the right, so that the axis decides."""
    right = rng.random() < 0.2
    found: list[tuple[Value, int]] = []
    left = size

    def number() -> Fraction:
        return Fraction(int(rng.integers(1, 40)), int(rng.integers(1, 20))) * Fraction(10) ** int(rng.integers(-2, 2))

    def real() -> Fraction:
        return number() if right and rng.random() < 0.5 else -number()

    while left:
        kind = rng.choice(["zero", "real", "complex", "imaginary", "next to another", "next to the axis", "again"])
        near = Fraction(10) ** -int(rng.integers(1, 7))
        times = int(rng.choice([1, 1, 1, 2, 3]))
        if kind == "zero":
            new = [((Fraction(0), Fraction(0)), times)]
        elif kind == "real":
            new = [((real(), Fraction(0)), times)]
        elif kind == "complex":
            new = [((real(), number()), min(times, 2))]
        elif kind == "imaginary":
            new = [((Fraction(0), number()), min(times, 2))]
        elif kind == "next to another" and found:
            (re, im), _ = found[int(rng.integers(len(found)))]
            new = [((re - near, im), 1)] if rng.random() < 0.5 or not im else [((re, im * (1 + near)), 1)]
        elif kind == "next to the axis":
            new = [((near if right else -near, number() if rng.random() < 0.5 else Fraction(0)), 1)]
        elif kind == "again" and found:
            new = [(found[int(rng.integers(len(found)))][0], times)]
        else:
            continue
        for value, count in new:
            width = count * (2 if value[1] else 1)
            if width <= left:
                found.append((value, count))
                left -= width
    return found


def _jordan(blocks: list[tuple[Value, int]], size: int) -> fmpq_mat:
    """Real Jordan form."""
    J, at = fmpq_mat(size, size), 0
    for (re, im), count in blocks:
        width = 2 if im else 1
        for k in range(count):
            for i in range(width):
                J[at + i, at + i] = fmpq(*re.as_integer_ratio())
                if k + 1 < count:
                    J[at + i, at + width + i] = 1
            if im:
                J[at, at + 1], J[at + 1, at] = (fmpq(*s.as_integer_ratio()) for s in (im, -im))
            at += width
    return J


def _invertible(rng: np.random.Generator, size: int) -> fmpq_mat:
    """Small whole numbers, some of them zero."""
    while True:
        drawn = rng.integers(-3, 4, (size, size)) * (rng.random((size, size)) < rng.choice([0.4, 0.8, 1.0]))
        T = fmpq_mat(size, size, (drawn + 2 * np.eye(size, dtype=int)).ravel().tolist())
        if T.det() != 0:
            return T


def _units(rng: np.random.Generator, A: fmpq_mat) -> list[fmpq]:
    """Powers of ten."""
    half = DECADES // 2
    return [fmpq(10) ** int(rng.integers(-half, half + 1)) for _ in range(A.nrows())]
