"""Equilibria of an attitude in orbit, from the derivation of its model: found, and as an object for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satsym.report.results.certificate import plain

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.symbolic import Derivation
    from satsym.symbolic.equilibria.attitude import Continuum
    from satsym.symbolic.equilibria.momenta import Attitudes, Change


def attitudes(given: Instance | Kernels, derivation: Derivation | None = None) -> Attitudes | None:
    """Find them; ``None`` for a model that is not one attitude in orbit, or whose derivation is not at hand."""
    from satsym.kernels import Kernels

    model = given if isinstance(given, Kernels) else given.model
    shipped = model.origin is not None and model.origin[1] is None
    if not model.spec.equilibria or not (shipped or derivation):
        return None
    from satsym.symbolic.equilibria.momenta import survey
    from satsym.symbolic.lookup import library

    values = [v.default for v in model.spec.parameters] if isinstance(given, Kernels) else given.parameters
    numbers = {name: float(v) for name, v in zip(model.spec.parameter_names, values, strict=True) if v is not None}
    return survey(derivation or library.derivation(model.spec.name), numbers)


def attitudes_object(found: Attitudes) -> dict[str, Any]:
    """The key ``equilibria`` of ``satsym analyse --json``."""
    whole, over = found.continuum, found.followed
    circles = None if whole is None or whole.circles is None else len(whole.circles)
    changes = [] if over is None else over.changes
    followed = None if over is None else {"parameter": found.parameter, "changes": [_change(c) for c in changes]}
    if followed is not None and over is not None:
        followed |= {"from": over.values[0], "to": over.values[-1]}
    said: dict[str, Any] = plain(
        {
            "count": found.count,
            "complex": found.complex,
            "continuum": whole and {"dimension": whole.dimension, "axis": axis(whole), "circles": circles},
            "attitudes": [
                {"cosines": each.cosines, "kind": each.kind, "eigenvalues": [complex(v) for v in each.eigenvalues]}
                for each in found.equilibria
            ],
            "followed": followed,
        }
    )
    return said


def axis(found: Continuum) -> str | None:
    """The name of the axis of the body about which a turn changes nothing."""
    return None if found.axis is None else "xyz"[found.axis]


def _change(found: Change) -> dict[str, Any]:
    kinds = [{kind.value: count for kind, count in each.items()} for each in found.kinds]
    return {"below": found.below, "above": found.above, "counts": found.counts, "kinds": kinds}
