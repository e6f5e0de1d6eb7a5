"""Options of pictures: file formats, size, titles. This module loads nothing else, since --help uses it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from satsym.status import BadInput
from satsym.wording import shown, suggestion

FORMATS = ("png", "pdf", "svg")
SIZES = {
    "screen": "10 inches wide, the default",
    "page": "a journal page, 7 inches wide",
    "column": "a journal column, 3.5 inches wide, with the panels below each other",
    "slide": "13.3 inches wide and at most 7.5 inches high",
}


@dataclass(frozen=True)
class Look:
    """Format, size and titles of all pictures of a result.

    Parameters
    ----------
    formats
        Of :data:`FORMATS`; each picture is written as each of them.
    titled
        Whether a page carries its title; what is printed has a caption below instead.
    size
        Of :data:`SIZES`: how wide a page is, and how large its letters are.
    """

    formats: tuple[str, ...] = ("png",)
    titled: bool = True
    size: str = "screen"

    def __post_init__(self) -> None:
        if self.size not in SIZES:
            raise BadInput(f"there is no picture size {shown(self.size)}; {suggestion(str(self.size), SIZES)}")
        for each in self.formats:
            if each not in FORMATS:
                raise BadInput(f"there is no picture format {shown(each)}; {suggestion(str(each), FORMATS)}")

    @classmethod
    def of(cls, formats: str | Sequence[str], titled: bool = True, size: str = "screen") -> Look:
        """Return the options for one file format, or several.

        Raises
        ------
        BadInput
            For one that is not known here.
        """
        return cls((formats,) if isinstance(formats, str) else tuple(formats), titled, size)


SCREEN = Look()


WIDTH = 10.0
"""Width of a page on a screen, in inches."""
HIGHEST = 40.0
"""Largest height of a page, in inches, to which a page may grow with its content."""


@dataclass(frozen=True)
class Sheet:
    """The width of pages and the size of letters of one page size."""

    width: float
    """Width of the widest page, in inches."""
    letters: float
    """Size of letters, lines and heights, relative to those on a screen."""
    across: int = 3
    """Largest number of panels in a row."""
    highest: float = HIGHEST
    """Largest height, in inches."""


SHEETS = {
    "screen": Sheet(WIDTH, 1.0),
    "page": Sheet(7.0, 0.74),
    "column": Sheet(3.5, 0.68, across=1),
    "slide": Sheet(13.33, 1.3, across=6, highest=7.5),
}
