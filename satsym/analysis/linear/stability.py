"""Stability of a linear system, with the reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from satsym.analysis.linear.spectrum import Eigenvalue

ASYMPTOTIC, MARGINAL, UNSTABLE = "asymptotically stable", "marginally stable", "unstable"
UNDECIDED = "undecided"


@dataclass(frozen=True)
class Stability:
    """A verdict on x' = A x."""

    verdict: str | None
    """``"asymptotically stable"``, ``"marginally stable"`` or ``"unstable"``; ``"undecided"`` where the entries of the
    matrix are not known well enough, and ``None`` where eigenvalues decide nothing."""
    reason: str
    """In a sentence: the eigenvalue that decides, and why."""
    decides: bool
    """Whether the same holds for small deviations from the equilibrium of a nonlinear system that this is the
    linearisation of (Lyapunov's indirect method): not where eigenvalues on the imaginary axis had to decide."""


def stability(eigenvalues: Sequence[Eigenvalue], *others: Sequence[Eigenvalue]) -> Stability:
    """The verdict that eigenvalues and Jordan blocks give.

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
    return Stability(UNDECIDED, f"the entries are not known well enough to decide. Either {listed}", False)


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
            f"so that deviations grow like {growth}"
        )
        return Stability(UNSTABLE, reason, False)
    listed = ", ".join(shown(each.value) for each in axis if each.value.imag >= 0.0)
    reason = (
        f"on the imaginary axis lie {listed}, in Jordan blocks of size 1 only, and no eigenvalue lies in the right "
        "half-plane"
    )
    return Stability(MARGINAL, reason, False)


def shown(value: complex) -> str:
    """An eigenvalue, or the pair that a complex one forms with its conjugate, in a sentence."""
    if value.imag == 0.0:
        return f"{value.real + 0.0:.6g}"
    real = f"{value.real:.6g} " if value.real else ""
    return f"{real}\N{PLUS-MINUS SIGN}{' ' if real else ''}{abs(value.imag):.6g}i"
