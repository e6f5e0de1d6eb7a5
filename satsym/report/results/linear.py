"""The objects that ``satsym analyse --json`` and ``satsym lqr --json`` print."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from satsym.report.results.objects import number

if TYPE_CHECKING:
    from satsym.analysis.linear.ranks import Reach
    from satsym.analysis.linear.routh import Routh
    from satsym.analysis.linear.spectrum import Eigenvalue
    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.regulator.feedback import Design
    from satsym.arrays import Array


ANALYSIS = (
    *("equilibrium", "A", "B", "C", "eigenvalues", "jordan_blocks", "characteristic_polynomial", "routh", "stability"),
    *("controllability", "observability", "exact"),
)
"""The keys of an analysis, all ``None`` where there is nothing to linearise about."""


def analysis_object(found: Analysis | None, exact: Mapping[str, Any] | None) -> dict[str, Any]:
    """What ``satsym analyse --json`` prints; :mod:`satsym.report.results.orbit` has what it adds of an orbit.

    Parameters
    ----------
    found
        ``None`` for a motion that is near no reference and no equilibrium.
    exact
        The same by exact reckoning, as strings; ``None`` where there is none.
    """
    if found is None:
        return dict.fromkeys(ANALYSIS)
    system, about = found.about.system, found.about
    return {
        "equilibrium": dict(zip(system.states, map(number, about.point), strict=True)),
        "A": rows(system.A),
        "B": rows(system.B),
        "C": rows(system.C),
        "eigenvalues": [eigenvalue_object(each) for each in found.eigenvalues],
        "jordan_blocks": [
            {"eigenvalue": complex_object(each.value), "size": size}
            for each in found.eigenvalues
            for size in each.blocks
        ],
        "characteristic_polynomial": numbers(found.polynomial),
        "routh": routh_object(found.routh),
        "stability": {"verdict": found.stability.verdict, "reason": found.stability.reason},
        "controllability": _reach(found.controllability, "by_input"),
        "observability": _reach(found.observability, "by_output"),
        "exact": exact,
    }


def regulator_object(design: Design) -> dict[str, Any]:
    """What ``satsym lqr --json`` prints; ``cost_from_initial`` is ``None`` for a model as such."""
    found, deviation = design.regulator, design.deviation
    return {
        "inputs": list(found.system.inputs),
        "K": rows(found.K),
        "P": rows(found.P),
        "riccati_residual": number(found.residual),
        "riccati_error": None if found.error is None else number(found.error),
        "closed_loop_eigenvalues": [complex_object(value) for value in found.eigenvalues],
        "characteristic_polynomial": numbers(found.polynomial),
        "routh": routh_object(found.routh),
        "cost_from_initial": None if deviation is None else number(found.cost(deviation)),
    }


def routh_object(found: Routh) -> dict[str, Any]:
    """The Routh array."""
    return {
        "column": numbers(found.column),
        "sign_changes": found.sign_changes,
        "special_case": found.special_case,
    }


def eigenvalue_object(found: Eigenvalue) -> dict[str, Any]:
    """An eigenvalue with its multiplicities."""
    return {"value": complex_object(found.value), "algebraic": found.algebraic, "geometric": found.geometric}


def complex_object(value: complex) -> dict[str, float | None]:
    """A complex number."""
    return {"re": number(value.real), "im": number(value.imag)}


def rows(matrix: Array) -> list[list[float | None]]:
    """A matrix, row by row."""
    return [numbers(row) for row in matrix]


def numbers(values: Iterable[float]) -> list[float | None]:
    """Numbers, ``None`` for those that are not finite."""
    return [number(value) for value in values]


def _reach(found: Reach | None, key: str) -> dict[str, Any] | None:
    if found is None:
        return None
    return {"rank": found.rank, key: {name: each.rank for name, each in found.alone.items()}}
