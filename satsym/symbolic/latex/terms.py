"""Sums in print, as signed terms, and the places where a long one may be broken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Piece:
    """Something a line may be broken before, and within how many parentheses that is."""

    tex: str
    depth: int = 0


@dataclass(frozen=True)
class Term:
    """One signed term of a sum."""

    negative: bool
    """Whether a minus stands before it."""
    tex: str
    """The term without its sign."""
    pieces: tuple[Piece, ...]
    """The term in pieces without its sign, for one that is too long for a line."""

    def signed(self, *, first: bool) -> str:
        """With its sign, as the first term of a sum or a later one."""
        return _signed(self.negative, self.tex, first)

    def signed_pieces(self, *, first: bool) -> tuple[Piece, ...]:
        """Likewise in pieces."""
        head, *rest = self.pieces
        return (Piece(_signed(self.negative, head.tex, first), head.depth), *rest)


def whole_term(negative: bool, tex: str) -> Term:
    """A term that is never broken."""
    return Term(negative, tex, (Piece(tex),))


def plain(tex: str) -> tuple[Term, ...]:
    """A sum of one term that is never broken."""
    return (whole_term(False, tex),)


def joined(terms: Sequence[Term]) -> str:
    """A sum on one line."""
    return " ".join(t.signed(first=k == 0) for k, t in enumerate(terms))


def _signed(negative: bool, tex: str, first: bool) -> str:
    if first:
        return f"-{tex}" if negative else tex
    return f"- {tex}" if negative else f"+ {tex}"
