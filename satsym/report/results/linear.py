"""The objects that ``satsym analyse --json`` and ``satsym lqr --json`` print."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from satsym.report.results.certificate import plain

if TYPE_CHECKING:
    from satsym.analysis.linear.modes import Mode
    from satsym.analysis.linear.ranks import Reach
    from satsym.analysis.linear.routh import Routh
    from satsym.analysis.linear.spectrum import Eigenvalue
    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.regulator.feedback import Design


ANALYSIS = (
    *("equilibrium", "A", "B", "C", "eigenvalues", "modes", "jordan_blocks", "characteristic_polynomial", "routh"),
    *("stability", "controllability", "observability", "exact", "exact_omitted"),
)
"""The keys of an analysis, all ``None`` where there is nothing to linearise about."""


def analysis_object(found: Analysis | None, exact: Mapping[str, Any] | None, omitted: str = "") -> dict[str, Any]:
    """What ``satsym analyse --json`` prints; :mod:`satsym.report.results.orbit` has what it adds of an orbit.

    Parameters
    ----------
    found
        ``None`` for a motion that is near no reference and no equilibrium.
    exact
        The same by exact reckoning, as strings; ``None`` where there is none.
    omitted
        Why there is none, of a linear model.
    """
    if found is None:
        return dict.fromkeys(ANALYSIS)
    system, about = found.about.system, found.about
    blocks = [(each.value, size) for each in found.eigenvalues for size in each.blocks]
    return plain(
        {
            "equilibrium": dict(zip(system.states, about.point.tolist(), strict=True)),
            "A": system.A,
            "B": system.B,
            "C": system.C,
            "eigenvalues": [eigenvalue_object(each) for each in found.eigenvalues],
            "modes": [mode_object(each) for each in found.modes],
            "jordan_blocks": [{"eigenvalue": complex(value), "size": size} for value, size in blocks],
            "characteristic_polynomial": found.polynomial,
            "routh": routh_object(found.routh),
            "stability": {"verdict": found.stability.verdict, "reason": found.stability.reason},
            "controllability": _reach(found.controllability, "by_input"),
            "observability": _reach(found.observability, "by_output"),
            "exact": exact,
            "exact_omitted": omitted or None,
        }
    )


def regulator_object(design: Design) -> dict[str, Any]:
    """What ``satsym lqr --json`` prints; ``cost_from_initial`` is ``None`` for a model as such."""
    found, deviation = design.regulator, design.deviation
    return plain(
        {
            "inputs": found.system.inputs,
            "K": found.K,
            "P": found.P,
            "riccati_residual": found.residual,
            "riccati_error": found.error,
            "closed_loop_eigenvalues": [complex(value) for value in found.eigenvalues],
            "characteristic_polynomial": found.polynomial,
            "routh": routh_object(found.routh),
            "cost_from_initial": None if deviation is None else found.cost(deviation),
        }
    )


def routh_object(found: Routh) -> dict[str, Any]:
    """The Routh array."""
    return {"column": found.column, "sign_changes": found.sign_changes, "special_case": found.special_case}


def eigenvalue_object(found: Eigenvalue) -> dict[str, Any]:
    """An eigenvalue with its multiplicities."""
    return {"value": complex(found.value), "algebraic": found.algebraic, "geometric": found.geometric}


def mode_object(found: Mode) -> dict[str, Any]:
    """A mode: its eigenvalue (with its conjugate), what it is called, and what each state has of it.

    Times are in the unit of time of the model, the natural frequency in radians by it.
    """
    return {
        "eigenvalue": complex(found.eigenvalue.value),
        "name": found.name or None,
        "natural_frequency": found.frequency,
        "damping_ratio": found.damping_ratio,
        "period": found.period,
        "time_constant": found.time_constant,
        "participation": dict(found.participation),
    }


def _reach(found: Reach | None, key: str) -> dict[str, Any] | None:
    if found is None:
        return None
    return {"rank": found.rank, key: {name: each.rank for name, each in found.alone.items()}}
