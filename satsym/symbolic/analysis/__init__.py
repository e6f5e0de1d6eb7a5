"""Exact analysis of linear systems with constant coefficients: numbers, or expressions in positive parameters.

Results hold for all values of the parameters, except those at which an expression listed under ``assumed`` vanishes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from satsym.symbolic.analysis.components import (
    CompanionForm,
    JordanBlock,
    JordanForm,
    companion_form,
    companion_matrix,
    jordan_form,
)
from satsym.symbolic.analysis.exponential import matrix_exponential
from satsym.symbolic.analysis.field import NotExact
from satsym.symbolic.analysis.routh import RouthArray, routh
from satsym.symbolic.analysis.spectrum import Eigenvalue, Spectrum, spectrum
from satsym.symbolic.analysis.stability import Stability, stability
from satsym.symbolic.analysis.structure import (
    KalmanForm,
    LinearSystem,
    Mode,
    Reach,
    controllability,
    linear_system,
    observability,
)

__all__ = [
    "Analysis",
    "CompanionForm",
    "Eigenvalue",
    "JordanBlock",
    "JordanForm",
    "KalmanForm",
    "LinearSystem",
    "Mode",
    "NotExact",
    "Reach",
    "RouthArray",
    "Spectrum",
    "Stability",
    "analyse",
    "companion_form",
    "companion_matrix",
    "controllability",
    "jordan_form",
    "linear_system",
    "matrix_exponential",
    "observability",
    "routh",
    "spectrum",
    "stability",
]


@dataclass(frozen=True)
class Analysis:
    """The exact results on a linear system: spectrum, Jordan form, stability, Routh array and ranks."""

    system: LinearSystem
    """The system's matrices, with the names of its variables."""
    characteristic_polynomial: tuple[sp.Expr, ...]
    """Coefficients of det(s I - A): monic, highest power first."""
    eigenvalues: tuple[Eigenvalue, ...]
    """The distinct eigenvalues that have a closed form, with multiplicities and block sizes."""
    jordan: JordanForm | None
    exponential: sp.ImmutableMatrix | None
    """Jordan form and e^(At); ``None`` if an eigenvalue has no closed form."""
    stability: Stability
    """Stability verdict with its reason."""
    routh: RouthArray
    """The Routh array of the characteristic polynomial."""
    controllability: Reach | None
    by_input: Mapping[str, Reach]
    """Controllability by all inputs (``None`` without inputs), and by each input alone (empty without inputs)."""
    observability: Reach | None
    by_output: Mapping[str, Reach]
    """Observability by all outputs (``None`` without outputs), and by each output alone (empty without outputs)."""
    companion_forms: Mapping[str, CompanionForm]
    """Companion form for each input by which alone the system is controllable."""
    assumed: tuple[sp.Expr, ...]
    """Expressions that are assumed not to vanish because that could not be decided."""


def analyse(system: LinearSystem) -> Analysis:
    """Analyse a linear system with constant coefficients exactly.

    Parameters
    ----------
    system
        From :func:`linear_system`; that of a model from :func:`satsym.symbolic.linear.matrices.system_of`.

    Raises
    ------
    NotExact
        If an entry is not a rational function of parameters and of roots of positive ones.
    """
    of = spectrum(system.a)
    columns = {name: system.b[:, k] for k, name in enumerate(system.inputs)}
    rows = {name: system.c[k, :] for k, name in enumerate(system.outputs)}
    by_input = {name: controllability(of, column) for name, column in columns.items()}
    by_output = {name: observability(of, row) for name, row in rows.items()}
    whole = controllability(of, system.b) if columns else None
    seen = observability(of, system.c) if rows else None
    forms = {name: companion_form(of, column) for name, column in columns.items()}
    assumed = [*of.assumed]
    for reach in (whole, seen, *by_input.values(), *by_output.values()):
        assumed += reach.assumed if reach else ()
    return Analysis(
        system,
        of.coefficients,
        of.eigenvalues,
        jordan_form(of),
        matrix_exponential(of),
        stability(of),
        routh(of.coefficients),
        whole,
        by_input,
        seen,
        by_output,
        {name: form for name, form in forms.items() if form},
        tuple(dict.fromkeys(assumed)),
    )


def exact_object(found: Analysis) -> dict[str, Any]:
    """Return the exact results as the object that ``satsym analyse --json`` holds under ``exact``.

    Returns
    -------
    dict
        Keys in a fixed order. Expressions as Python would read them; matrices as lists of rows. ``None`` where an
        eigenvalue has no closed form, where there are no inputs or outputs, or where the parameters decide.
    """
    return {
        "A": _rows(found.system.a),
        "B": _rows(found.system.b),
        "C": _rows(found.system.c),
        "eigenvalues": [
            {"value": str(e.value), "algebraic": e.algebraic, "geometric": e.geometric} for e in found.eigenvalues
        ],
        "jordan_blocks": None
        if found.jordan is None
        else [{"eigenvalue": str(b.eigenvalue), "size": b.size} for b in found.jordan.blocks],
        "matrix_exponential": None if found.exponential is None else _rows(found.exponential),
        "characteristic_polynomial": [str(c) for c in found.characteristic_polynomial],
        "routh": {
            "column": [str(e) for e in found.routh.column],
            "sign_changes": found.routh.sign_changes,
            "special_case": found.routh.special_case,
        },
        "stability": {"verdict": found.stability.verdict, "reason": found.stability.reason},
        "controllability": _reach(found.controllability, "by_input", found.by_input),
        "observability": _reach(found.observability, "by_output", found.by_output),
        "assumed_not_zero": [str(e) for e in found.assumed],
    }


def _reach(whole: Reach | None, key: str, alone: Any) -> dict[str, Any] | None:
    if whole is None:
        return None
    lost = {
        name: [{"eigenvalue": str(m.eigenvalue), "vector": [str(e) for e in m.vector]} for m in reach.lost]
        for name, reach in alone.items()
        if not reach.full
    }
    return {"rank": whole.rank, key: {name: reach.rank for name, reach in alone.items()}, "lost": lost}


def _rows(matrix: sp.MatrixBase) -> list[list[str]]:
    return [[str(e) for e in matrix.row(i)] for i in range(matrix.rows)]
