"""Common parts of solutions and simulated trajectories; pictures are shown in notebooks and written to files."""

from __future__ import annotations

import base64
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.front import between, html, saved
from satsym.front.calls import in_one_line
from satsym.front.curves import Curve
from satsym.front.instance import Instance
from satsym.report import plots
from satsym.report.look import Look
from satsym.report.results.files import Content, check_writable, store, to_json, unwritable
from satsym.solution import Simulation, Solution
from satsym.status import BadInput, Status
from satsym.wording import printable, shown, suggestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Pictures(Mapping[str, "Figure"]):
    """Figures by name, the overview first; matplotlib is loaded when the first one is requested.

    Parameters
    ----------
    found
        The solution or simulation that the figures show.
    """

    def __init__(self, found: Solution | Simulation) -> None:
        self._found = found

    @cached_property
    def _figures(self) -> dict[str, Figure]:
        return plots.figures(self._found)

    def __getitem__(self, name: str) -> Figure:
        if name not in self._figures:
            raise BadInput(f"there is no picture {shown(name)}; {suggestion(str(name), self._figures)}")
        return self._figures[name]

    def __contains__(self, name: object) -> bool:
        return name in self._figures

    def __iter__(self) -> Iterator[str]:
        return iter(self._figures)

    def __len__(self) -> int:
        return len(self._figures)

    def contents(self, formats: Sequence[str] = ("png",)) -> dict[str, Content]:
        """Return the contents of the picture files by file name.

        Raises
        ------
        BadInput
            If a format is not supported.
        """
        return plots.pictures(self._found, Look.of(formats))

    def save(self, folder: str | Path, formats: Sequence[str] = ("png",)) -> list[Path]:
        """Write the pictures into a folder, and return their paths.

        Raises
        ------
        BadInput
            If the folder cannot be written to.
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


Found = TypeVar("Found", Solution, Simulation)


@dataclass(frozen=True, eq=False, repr=False)
class Result(ABC, Generic[Found]):
    """A solved or simulated trajectory with its instance.

    ``x`` and ``u`` are functions of time, ``x(t)``, and index like arrays of their values at the nodes, ``x[0, -1]``;
    ``x["r"]`` is the state of that name. Between nodes the equations of motion are integrated from the nodes on both
    sides, to a tenth of the instance's tolerance, so that values there are as accurate as those at the nodes.

    Parameters
    ----------
    instance
        The instance that was solved or simulated.
    found
        The result in the form that solvers return.
    """

    instance: Instance
    found: Found

    _command: ClassVar[str]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.instance, self.found)  # what is computed on demand is left out

    @property
    def status(self) -> Status:
        """Return the status, which says how the run ended."""
        return self.found.status

    @property
    def message(self) -> str:
        """Return one sentence that describes the result, with advice if there is no solution."""
        return self.status.explain(self.found.message)

    @property
    def times(self) -> Array:
        """Return the nodes (N+1,); a time at which a control jumps occurs twice."""
        return self.found.times

    @cached_property
    def x(self) -> Curve:
        """Return the states over time."""
        n = len(self.found.x)
        return self._curve("x", self.found.x, self._spec.state_names, lambda t: self._motion[0](t)[:n])

    @cached_property
    def u(self) -> Curve:
        """Return the controls over time; at the time of a jump, the values after the jump.

        Optimal controls are computed from states and costates at each time.
        """
        return self._curve("u", self.found.u, self._spec.control_names, self._controls)

    def plot(self, folder: str | Path | None = None, formats: Sequence[str] = ("png",)) -> Pictures:
        """Draw the pictures, which notebooks show; if a folder is given, write them into it.

        Returns
        -------
        Pictures
            The figures by name.

        Raises
        ------
        BadInput
            If the folder cannot be written to.
        """
        pictures = Pictures(self.found)
        if folder is not None:
            pictures.save(folder, formats)
        return pictures

    def save(self, folder: str | Path, *, plot: bool = False) -> list[Path]:
        """Write the files of ``--out`` (and ``--plot``) and the instance into a folder, and return their paths.

        An earlier result in the folder is replaced, either completely or not at all.

        Raises
        ------
        BadInput
            If the folder cannot be written to.
        """
        pictures = Pictures(self.found).contents() if plot else {}
        return saved.save(self.instance, self.found, self.to_dict(), Path(folder), pictures)

    @classmethod
    @in_one_line
    def load(cls, folder: str | Path, instance: Instance | str | Path | None = None) -> Self:
        """Load a result that :meth:`save` or the command line wrote into a folder.

        Parameters
        ----------
        folder
            Folder of the result.
        instance
            The instance of the result; by default the instance that was saved with it, or the shipped instance of the
            same name.

        Raises
        ------
        BadInput
            If the folder contains no complete result of this kind, or if the result belongs to another instance.
        """
        case, found = saved.read(Path(folder), instance)
        if isinstance(found, Solution) != (cls._command == "solve"):
            other = "simulate" if cls._command == "solve" else "solve"
            raise BadInput(f"{printable(str(folder))}: contains the result of {other}, not of {cls._command}")
        return cls(case, found)  # type: ignore[arg-type]

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Return the object that the command line prints with ``--json``."""

    def to_json(self) -> str:
        """Return the result as JSON text."""
        return to_json(self.to_dict())

    @property
    def _spec(self) -> Any:
        return self.instance.case.model.spec

    @property
    def _lam(self) -> Array | None:
        return None

    @cached_property
    def _motion(self) -> tuple[between.Motion, between.Pieces | None]:
        return between.controlled(self.found.instance, self.times, self.found.x, self.found.u, self._lam)

    def _controls(self, t: Array) -> Array:
        motion, pieces = self._motion
        left = motion.behind(t)
        now = pieces(t, left) if pieces else self._law(t, motion(t))
        node = np.where(t == self.times[left + 1], left + 1, left)
        return np.where(t == self.times[node], self.found.u[:, node], now)

    def _law(self, t: Array, z: Array) -> Array:
        raise NotImplementedError("asked only of what does not keep its controls as pieces")

    def _curve(self, what: str, values: Array, names: Sequence[str], at: Any) -> Curve:
        whole = len(self.times) > 1 and np.isfinite(self.found.x).all()
        absent = "" if whole else f"there is no trajectory ({self.status.value}); the message of the result says why"
        return Curve(what, self.times, values, names, at, absent)

    def _html(self, facts: dict[str, Any], *tables: str) -> str:
        case = self.instance
        lines = [f"{case.name}, model {case.model}: {self.status.value}", self.message]
        return html.page(case.title or self._spec.title or case.name, lines, html.facts(facts), *tables)
