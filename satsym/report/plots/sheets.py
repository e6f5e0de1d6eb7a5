"""What the sizes of pages mean that people ask for."""

from __future__ import annotations

from dataclasses import dataclass

WIDTH = 10.0
"""Width of a page on a screen, in inches."""
HIGHEST = 40.0
"""Greatest height of a page, in inches; a page grows downwards with what is on it."""


@dataclass(frozen=True)
class Sheet:
    """What a size of pages means."""

    width: float
    """Width of the widest page, in inches."""
    letters: float
    """Letters and lines, and heights, relative to those on a screen."""
    across: int = 3
    """Panels side by side, at most."""
    highest: float = HIGHEST
    """In inches."""


SHEETS = {
    "screen": Sheet(WIDTH, 1.0),
    "page": Sheet(7.0, 0.74),
    "column": Sheet(3.5, 0.68, across=1),
    "slide": Sheet(13.33, 1.3, across=6, highest=7.5),
}
