"""Pictures of a result: figures of matplotlib by name, shown in notebooks, written where asked."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.report import plots
from satsym.report.look import Look
from satsym.report.results.files import Content, check_writable, store, unwritable
from satsym.status import BadInput
from satsym.wording import shown, suggestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.solution import Simulation, Solution


class Pictures(Mapping[str, "Figure"]):
    """Figures by name, the overview first; matplotlib is loaded when the first is looked at.

    Parameters
    ----------
    found
        The result that they show.
    """

    def __init__(self, found: Solution | Simulation) -> None:
        self._found = found

    @cached_property
    def _figures(self) -> dict[str, Figure]:
        return plots.figures(self._found)

    def __getitem__(self, name: str) -> Figure:
        if name not in self._figures:
            raise BadInput(f"no picture {shown(name)}; {suggestion(str(name), self._figures)}")
        return self._figures[name]

    def __contains__(self, name: object) -> bool:
        return name in self._figures

    def __iter__(self) -> Iterator[str]:
        return iter(self._figures)

    def __len__(self) -> int:
        return len(self._figures)

    def contents(self, formats: Sequence[str] = ("png",)) -> dict[str, Content]:
        """Name -> content of each file.

        Raises
        ------
        BadInput
            For a format that is not known here.
        """
        return plots.pictures(self._found, Look.of(formats))

    def save(self, folder: str | Path, formats: Sequence[str] = ("png",)) -> list[Path]:
        """Write them into a folder; their paths.

        Raises
        ------
        BadInput
            If it cannot be written to.
        """
        place = Path(folder)
        check_writable(place)
        written = self.contents(formats)
        try:
            place.mkdir(parents=True, exist_ok=True)
            for name, content in written.items():
                store(place / name, content)
        except OSError as error:
            raise unwritable(place, error) from None
        return [place / name for name in written]

    def __repr__(self) -> str:
        return f"pictures: {', '.join(self) or 'none, there is no trajectory to draw'}"

    def _repr_html_(self) -> str:
        import io

        parts = []
        for name, content in self.contents().items():
            stream = io.BytesIO()
            content(stream)
            data = base64.b64encode(stream.getvalue()).decode()
            parts.append(f'<img alt="{escape(name)}" style="max-width:100%" src="data:image/png;base64,{data}">')
        return "\n".join(parts) or f"<p>{escape(repr(self))}</p>"
