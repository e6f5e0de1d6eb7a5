"""Results in folders: the files of the command line are written and read together with the instance of the result."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from satsym.front import tables
from satsym.front.instance import Instance, as_case, load
from satsym.instance import shipped
from satsym.instance.numbers import find
from satsym.report.results import sets, trajectory
from satsym.report.results.files import Content, check_writable, text
from satsym.report.results.set_list import LIST, may_hold, unusable
from satsym.solution import Simulation, Solution
from satsym.wording import printable

ASKED = (
    *("parameters", "initial", "final", "t0", "tf", "lower", "upper", "max_norm", "norms"),
    *("lqr", "classical", "limits", "deadband"),
)
"""Fields of an instance that determine its results; options of solvers are not among them."""


def save(
    instance: Instance,
    found: Solution | Simulation,
    result: Mapping[str, Any],
    folder: Path,
    pictures: Mapping[str, Content],
) -> list[Path]:
    """Replace the result in a folder, either completely or not at all, and return the paths of the written files.

    The files are those of ``satsym solve --out``, the instance as NAME.toml, and the generated module if the model is
    not a shipped one.

    Raises
    ------
    BadInput
        If the folder cannot be written to.
    """
    check_writable(folder)
    sets.keep_apart(folder, str(result["command"]))
    return sets.write(folder, result, trajectory.contents(found) | dict(pictures) | origin(instance))


def origin(instance: Instance) -> dict[str, Content]:
    """Return the files from which the instance can be read again, by file name."""
    model, tree, place = instance.case.model, dict(instance.written.tree), f"{instance.name}.toml"
    if not may_hold(place):
        return {}
    if model.text is None:
        return {place: text(tables.toml(tree))}
    tree["model"] = f"./{model.spec.name}"
    return {place: text(tables.toml(tree)), f"{model.spec.name}.py": text(model.text)}


def read(folder: Path, instance: Instance | str | Path | None) -> tuple[Instance, Solution | Simulation]:
    """Return a saved result and its instance: the given one, the one saved with the result, or the shipped one.

    Raises
    ------
    BadInput
        If the folder contains no complete result, or if the result belongs to another instance.
    """
    given = None if instance is None else as_case(instance)
    listed = sets.read(folder)
    name = str(msgspec.json.decode(listed.result).get("instance"))
    own = load(folder / f"{name}.toml") if f"{name}.toml" in listed.listed else None
    case = given or own or (load(name) if name in shipped() else None)
    if case is None:
        raise unusable(
            folder / LIST,
            f"was computed from {printable(name)}, which is neither an existing file nor a shipped instance; "
            f'give its file as well, as in Solution.load(FOLDER, "{printable(name)}.toml")',
        )
    case = _with(case, msgspec.json.decode(listed.result).get("set", {}))
    found, _ = trajectory.read(case.case, folder)
    if given and own and (changed := [part for part in ASKED if _part(given, part) != _part(own, part)]):
        raise unusable(folder / LIST, f"was computed from a different {given.name}: {', '.join(changed)} differ")
    return case, found


def _with(case: Instance, settings: Mapping[str, float]) -> Instance:
    """Return an instance with the values set on the command line.

    A continuation in a key ends at the value of that key.
    """
    changes: dict[str, dict[str, Any]] = {}
    for name, value in settings.items():
        key = find(name, case.case)
        changes.setdefault(key.table.value, {})[key.name] = value
        for one in case.case.continuation:
            if one.key == key:
                ends = None if one.begin == value else [one.begin, value]
                changes.setdefault("continuation", {})[key.short] = ends
    return case.with_(**changes.pop("time", {}), **changes) if changes else case


def _part(instance: Instance, name: str) -> object:
    found = getattr(instance.case, name)
    return dict(found) if isinstance(found, Mapping) else found
