"""How pictures are asked for: as which files, and with or without a title. Loads nothing, for ``--help`` asks it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from satsym.status import BadInput
from satsym.wording import shown, suggestion

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

    def __post_init__(self) -> None:
        for each in self.formats:
            if each not in FORMATS:
                raise BadInput(f"no pictures as {shown(each)}; {suggestion(str(each), FORMATS)}")

    @classmethod
    def of(cls, formats: str | Sequence[str], titled: bool = True) -> Look:
        """For one kind of files, or several.

        Raises
        ------
        BadInput
            For one that is not known here.
        """
        return cls((formats,) if isinstance(formats, str) else tuple(formats), titled)


SCREEN = Look()
