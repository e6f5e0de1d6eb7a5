"""Instances created in Python from the tables of an instance file, with the same checks and messages."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from satsym import instance as instances
from satsym.front import tables
from satsym.front.calls import in_one_line
from satsym.instance import Written
from satsym.status import BadInput
from satsym.wording import shown

if TYPE_CHECKING:
    from satsym.front.derivation import Derivation
    from satsym.kernels import Kernels
    from satsym.solvers.repeated import Repeated
    from satsym.symbolic import Model, Problem

Table: TypeAlias = Mapping[Any, Any]
"""A table of numbers or texts such as ``"5 km"``, ``"reference"``, ``"free"``, by names or symbols."""

TIMES = ("tf", "t0", "tf_guess", "t0_guess")
_NAME = re.compile(r"[^\W_][\w.-]{0,99}\Z")


@in_one_line
def load(name_or_path: str | Path) -> Instance:
    """Load an instance from a file.

    Parameters
    ----------
    name_or_path
        Name of a shipped instance (`satsym instances` lists them), or path of a TOML file.

    Raises
    ------
    BadInput
        If the instance cannot be used. The message is one line, ``FILE: KEY: what is wrong; what to do``.
    """
    return Instance.of_written(instances.read(name_or_path))


@dataclass(frozen=True, eq=False, repr=False)
class Instance:
    """A problem with its numerical data; made by :func:`load` or :meth:`of`, and immutable.

    Parameters
    ----------
    written
        The tables of the instance file.
    case
        The data of the instance after checks against the model, in the form that the solvers use.
    """

    written: Written
    case: instances.Instance

    @classmethod
    def of_written(cls, written: Written) -> Instance:
        """Return the instance that the given tables describe, after checking them."""
        return cls(written, written.instance())

    @classmethod
    @in_one_line
    def of(
        cls,
        model: str | Path | Problem | Model | Derivation,
        *,
        initial: Table | None = None,
        tf: float | str | None = None,
        final: Table | None = None,
        t0: float | str | None = None,
        tf_guess: float | str | None = None,
        t0_guess: float | str | None = None,
        parameters: Table | None = None,
        control: Table | None = None,
        name: str | None = None,
        **more: Any,
    ) -> Instance:
        """Make an instance of a model.

        Parameters
        ----------
        model
            A shipped name, a generated file as ``"DIR/NAME"``, or a problem (or model), which is derived and generated
            in memory, once.
        initial
            Initial value of each state, as in the table ``[initial]`` of an instance file; ``"free"`` if the value is
            to be found.
        tf
            Final time in the unit of the model, a text such as ``"1 day"``, or ``"free"``.
        final
            Required final values of states, or ranges ``(lower, upper)``; states that are left out are free.
        t0
            Initial time, or ``"free"``; zero by default.
        tf_guess
            Initial guess of a free final time.
        t0_guess
            Initial guess of a free initial time.
        parameters
            Values of parameters that replace the defaults of the model.
        control
            Bounds ``(lower, upper)`` of each control, or ``max_norm`` for a bound on the norm.
        name
            Name of the instance in results; by default that of the model.
        more
            Other tables and keys of an instance file: ``title``, ``solver``, ``lqr``, ``guess``, ``classical``,
            ``limits``, ``switching``, ``orbit``.

        Raises
        ------
        BadInput
            If the instance cannot be used, with the same message as for an instance file.

        Examples
        --------
        ::

            Instance.of(
                "polar_orbit",
                initial={"r": 1.1, "r_dot": 0, "theta": "5 deg", "theta_dot": 0.9},
                final={"r": 1, "r_dot": 0},
                tf=6.28,
            )
        """
        kernels, called = _kernels(model), _called(model)
        given = {"initial": initial, "final": final, "parameters": parameters, "control": control}
        given["time"] = {"tf": tf, "t0": t0, "tf_guess": tf_guess, "t0_guess": t0_guess}
        tree = tables.merged({"model": called}, tables.plain(given))
        last = called.rpartition("/")[2]
        chosen = _checked(name) if name is not None else last if _NAME.match(last) else "instance"
        written = Written(tables.merged(tree, more), chosen, Path(f"{chosen}.toml"), model=kernels)
        return cls.of_written(written)

    @in_one_line
    def with_(self, **changes: Any) -> Instance:
        """Return the instance with changes, checked anew.

        Parameters
        ----------
        changes
            As for :meth:`of`. Tables are merged, name by name; ``None`` removes an entry, such as in
            ``with_(final={"theta": None})``. ``model`` may also be changed.

        Raises
        ------
        BadInput
            As for :meth:`of`.
        """
        written = self.written
        if (name := changes.pop("name", None)) is not None:
            written = replace(written, name=_checked(name), given="")
        if (model := changes.pop("model", None)) is not None:
            written = replace(written, model=_kernels(model))
            changes["model"] = _called(model)
        if times := {key: changes.pop(key) for key in TIMES if key in changes}:
            changes["time"] = times
        return self.of_written(replace(written, tree=tables.merged(written.tree, changes)))

    @property
    def name(self) -> str:
        """Return the name of the instance in results."""
        return self.case.name

    @property
    def title(self) -> str:
        """Return the title of the instance, which may be empty."""
        return self.case.title

    @property
    def model(self) -> str:
        """Return the name of the model."""
        return self.case.model.spec.name

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym instances --json`` prints for the instance."""
        from satsym.report.results.objects import instance_object

        return instance_object(self.case)

    def to_toml(self) -> str:
        """Return the text of an instance file for this instance."""
        return tables.toml(self.written.tree)

    def repeated(self, compiled: bool | None = None) -> Repeated:
        """Return an object that solves the instance repeatedly, for other initial states or parameters.

        Parameters
        ----------
        compiled
            See :class:`~satsym.solvers.repeated.Repeated`.
        """
        from satsym.solvers.repeated import Repeated

        return Repeated(self.case, compiled)

    def __repr__(self) -> str:
        return f"# {self.name}\n{self.to_toml()}".rstrip()


def as_case(given: Instance | str | Path) -> Instance:
    """Return an instance from an instance, or from its name or path."""
    if isinstance(given, Instance):
        return given
    if isinstance(given, str | Path):
        return load(given)
    raise BadInput(
        f"{shown(given)} is not an instance; make one with Instance.of(model, initial=..., tf=...) or load(...)"
    )


def _called(model: Any) -> str:
    """Return the name by which the tables of an instance refer to a model."""
    return str(model) if isinstance(model, str | Path) else model.name


def _kernels(model: Any) -> Kernels | None:
    """Return the kernels of a model that is given as an object; ``None`` for a model that is given by name."""
    if isinstance(model, str | Path):
        return None
    from satsym.front.derivation import derive
    from satsym.kernels.loading import check_name

    derivation = derive(model)
    check_name(derivation.name)
    return derivation.kernels


def _checked(name: str) -> str:
    """Return a name after checking that result files can have this name."""
    if not isinstance(name, str) or not _NAME.match(name):
        raise BadInput(f"name: {shown(name)} is not a valid name of an instance; use letters, digits, hyphens and dots")
    return name
