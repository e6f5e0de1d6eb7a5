"""The problem of a saved result: its instance file and, for a user's own model, the generated module.

They are saved beside the trajectory, so that the result can be examined from its folder alone.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import msgspec

from satsym import kernels, source_files
from satsym.instance import Instance
from satsym.instance.files import parsed, text
from satsym.instance.loading import Written
from satsym.report.results import sets
from satsym.report.results.files import Content
from satsym.report.results.files import text as as_text
from satsym.report.results.set_list import LIST, unusable
from satsym.status import BadInput
from satsym.wording import printable

FILE = "instance.toml"


class _Named(msgspec.Struct):
    """The part of result.json that names the instance and the model."""

    instance: str | None = None


def contents(instance: Instance) -> dict[str, Content]:
    """Map file names to contents for the files that state an instance; empty for one made in Python."""
    try:
        written = text(instance.path)
        model = str(tomllib.loads(written).get("model", ""))
        found: dict[str, Content] = {FILE: as_text(written)}
        if not source_files.is_model(model):
            module = (instance.path.parent / f"{model}.py").read_text(encoding="utf-8")
            found[f"{instance.model.spec.name}.py"] = as_text(module)
    except (BadInput, OSError, ValueError):
        return {}
    return found


def read(folder: Path) -> Instance:
    """Return the instance of a saved result, from the files of the result alone.

    Raises
    ------
    BadInput
        If the folder holds no result that has them, or one of them cannot be used.
    """
    listed = sets.read(folder).listed
    if FILE not in listed:
        raise unusable(folder / FILE, "is not among the files of this result, so the problem is unknown")
    found = sets.read(folder, [FILE])
    try:
        name = msgspec.json.decode(found.result, type=_Named).instance or ""
        tree = parsed(found.contents[FILE].decode())
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise unusable(folder / LIST, f"cannot be read ({printable(str(error))})") from None
    modules = [each.removesuffix(".py") for each in listed if each.endswith(".py")]
    model = kernels.load(f"./{modules[0]}", folder) if modules else None
    return Written(tree, name, folder / FILE, printable(str(folder / FILE), 120), model).instance()
