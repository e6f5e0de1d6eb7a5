"""What ``analyse`` and ``lqr`` are about: an instance, or a model with its default parameters."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.status import BadInput, Status
from satsym.wording import printable, suggestion

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.kernels import Kernels


def find(name: str) -> Instance | Kernels:
    """The instance, or else the model, of this name or at this path.

    Raises
    ------
    BadInput
        If there is neither, or it cannot be read.
    """
    from satsym import instance, kernels

    if name in instance.shipped() or name.endswith(".toml"):
        return instance.load(name)
    if name in kernels.shipped() or Path(f"{name}.py").is_file():
        return kernels.load(name)
    instead = suggestion(name, [*instance.shipped(), *kernels.shipped()])
    raise BadInput(
        f"{printable(name)}: no instance and no model of this name; {instead} (`satsym instances` and `satsym models` "
        "list all; or give the path of a TOML file)"
    )


def begins(command: str, given: Instance | Kernels, status: Status) -> dict[str, Any]:
    """What the object of a command about it begins with."""
    from satsym.kernels import Kernels
    from satsym.report.results.objects import head

    if isinstance(given, Kernels):
        return head(command, given.spec, None, status)
    return head(command, given.model.spec, given.name, status)
