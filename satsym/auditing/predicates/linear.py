"""Claims about linear systems: eigenvalues, stability, controllability, observability; exact, from a derivation."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satsym.auditing.predicates import Finding, predicate
from satsym.status import BadInput
from satsym.wording import shown

if TYPE_CHECKING:
    from satsym.symbolic.analysis import Analysis


@cache
def analysis(model: str) -> Analysis:
    """The exact analysis of a linear model with constant coefficients."""
    from satsym.symbolic.analysis import analyse
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup.library import derivation

    return analyse(system_of(derivation(model)))


def numeric(matrix: Any, values: Mapping[str, float]) -> NDArray[np.float64]:
    """A matrix of the analysis with numbers for its parameters."""
    return np.array(
        [
            [float(entry.xreplace({s: values[s.name] for s in entry.free_symbols})) for entry in matrix.row(i)]
            for i in range(matrix.rows)
        ],
        dtype=float,
    )


def _listed(found: Analysis) -> str:
    return ", ".join(str(e.value) for e in found.eigenvalues for _ in range(e.algebraic))


def _command(model: str) -> str:
    return f"satsym analyse {model}"


@predicate
def unstable(model: str, reason: str) -> Finding:
    """Whether the system is unstable, and for the reason given: ``multiplicity``, ``real parts zero`` or ``positive``.

    Zero real parts alone decide nothing: with as many eigenvectors as multiplicities the origin would be stable.
    """
    stability = analysis(model).stability
    reasons = {"multiplicity": "block on the axis", "positive": "right", "real parts zero": None}
    if reason not in reasons:
        raise BadInput(f"unstable: no reason {shown(reason)}; write one of {', '.join(reasons)}")
    remark = ""
    if reason == "real parts zero":
        remark = (
            "zero real parts alone do not make it so: x1' = x2, x2' = -x1 has the eigenvalues +-i, and stays bounded"
        )
    return Finding(
        stability.verdict == "unstable",
        f"{stability.verdict}: {stability.reason}",
        {"largest Jordan block on the axis": stability.block},
        _command(model),
        sound=stability.cause == reasons[reason],
        remark=remark,
    )
