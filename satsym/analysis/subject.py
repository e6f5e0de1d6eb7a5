"""What an analysis is about: an instance, or a model with its default parameters."""

from __future__ import annotations

from pathlib import Path

from satsym import instance, kernels
from satsym.analysis.linear.structure import Analysis, analyse
from satsym.analysis.orbits.survey import Survey, survey
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.status import BadInput
from satsym.wording import printable, suggestion


def find(name: str) -> Instance | Kernels:
    """The instance, or else the model, of this name or at this path.

    Raises
    ------
    BadInput
        If there is neither, or it cannot be read.
    """
    if name in instance.shipped() or name.endswith(".toml"):
        found = instance.load(name)
        found.require_numbers()
        return found
    if name in kernels.shipped() or Path(f"{name}.py").is_file():
        return kernels.load(name)
    instead = suggestion(name, [*instance.shipped(), *kernels.shipped()])
    raise BadInput(
        f"{printable(name)}: no instance and no model of this name; {instead} (`satsym instances` and `satsym models` "
        "list all; or give the path of a TOML file)"
    )


def examined(given: Instance | Kernels) -> tuple[Analysis | None, Survey | None]:
    """The linear analysis, and that of the orbit; one of them may be missing.

    A body that is only attracted rests nowhere, so that without a reference there is nothing to linearise about.

    Raises
    ------
    BadInput
        If neither has a meaning.
    """
    spec = given.spec if isinstance(given, Kernels) else given.model.spec
    if isinstance(given, Kernels):
        if spec.keplerian and not spec.has_reference:
            raise BadInput(
                f"{spec.name}: has neither an equilibrium nor a reference, and a model alone has no initial state to "
                f"start an orbit from; write an "
                "instance with its initial state"
            )
        return analyse(given), None
    orbit = survey(given) if spec.keplerian else None
    return analyse(given) if orbit is None or spec.has_reference else None, orbit
