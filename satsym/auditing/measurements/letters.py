"""Printed programs, letter by letter: names they use, signs they hold, what libraries give back."""

from __future__ import annotations

import re
from typing import Any

from satsym.auditing.measurements import linear, measurement, regulators, value
from satsym.auditing.propositions.values import Record

_CALL = re.compile(r"([A-Za-z_]\w*)\s*\(")


@value
def maple_linalg() -> list[str]:
    """Names of Maple's package linalg for eigenvalues and -vectors (its help page, "linalg: Overview")."""
    return ["eigenvals", "eigenvalues", "eigenvectors", "eigenvects"]


@measurement
def count(text: str, sign: str) -> int:
    """How often a sign stands in a text."""
    return text.count(sign)


@measurement
def calls(text: str) -> list[str]:
    """The names of what a line calls, in order."""
    return _CALL.findall(text)


@measurement
def matlab_lqr(A: Any, B: Any, Q: Any, R: Any) -> list[Any]:
    """What MATLAB's lqr(A, B, Q, R) gives back, in its order [K, S, e] (Control System Toolbox, page of lqr)."""
    system = Record("the system", {"A": linear.numbers(A), "B": linear.numbers(B)})
    found = regulators.regulator(system, Q=Q, R=R)
    return [found.part("K"), found.part("P"), linear.eigenvalues(found)]
