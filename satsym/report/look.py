"""How pictures are asked for: as which files, and with or without a title. Loads nothing, for ``--help`` asks it."""

from __future__ import annotations

from dataclasses import dataclass

FORMATS = ("png", "pdf", "svg")


@dataclass(frozen=True)
class Look:
    """Of all pictures of a result.

    Parameters
    ----------
    formats
        Of :data:`FORMATS`; each picture is written as each of them.
    titled
        Whether a page carries its title; what is printed has a caption below instead.
    """

    formats: tuple[str, ...] = ("png",)
    titled: bool = True


SCREEN = Look()
