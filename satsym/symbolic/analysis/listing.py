"""An exact analysis as plain text, for JSON: the keys of ``satsym analyse``, every expression as a string."""

from __future__ import annotations

from typing import Any

import sympy as sp

from satsym.symbolic.analysis import Analysis
from satsym.symbolic.analysis.structure import Reach


def exact_object(found: Analysis) -> dict[str, Any]:
    """What ``satsym analyse --json`` holds under ``exact``.

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
