"""The certificate of a solution, converted to an object for JSON and back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import msgspec
import numpy as np

from satsym.solution import Certificate, Check, Competitors, Kind
from satsym.spec import ProblemSpec
from satsym.status import Scope, Verdict


class _Check(msgspec.Struct):
    name: str
    value: float | None
    limit: float | None


class _Competitors(msgspec.Struct):
    kind: Kind
    tried: int
    solved: int
    cheapest: float | None


class Stored(msgspec.Struct):
    """A certificate as it is stored in result.json."""

    verdict: Verdict
    boundary_residual: float | None
    dynamics_defect: float | None
    stationarity: float | None
    hamiltonian_drift: float | None
    legendre_clebsch: float | None
    conjugate_time: float | None
    checks: list[_Check]
    competitors: list[_Competitors] = []
    not_checked: list[Kind] = []
    scope: Scope = Scope.LOCAL
    because: str = ""

    def certificate(self, spec: ProblemSpec) -> Certificate:
        """Return the certificate as solving returned it, except for infinite numbers, which JSON lacks."""
        return Certificate(
            verdict=self.verdict,
            boundary_residual=absent(self.boundary_residual),
            dynamics_defect=absent(self.dynamics_defect),
            stationarity=absent(self.stationarity),
            hamiltonian_drift=self.hamiltonian_drift,
            legendre_clebsch=absent(self.legendre_clebsch),
            conjugate_time=self.conjugate_time,
            checks=tuple(Check(c.name, absent(c.value), absent(c.limit)) for c in self.checks),
            competitors=tuple(
                Competitors(c.kind, c.tried, c.solved, spec.objective(absent(c.cheapest))) for c in self.competitors
            ),
            not_checked=tuple(self.not_checked),
            scope=self.scope,
            because=self.because,
        )


def certificate_object(certificate: Certificate, spec: ProblemSpec) -> dict[str, Any]:
    """Return the certificate of a solution as JSON stores it; costs have the author's sense."""
    compared = [
        {"kind": c.kind, "tried": c.tried, "solved": c.solved, "unanswered": c.unanswered}
        | {"cheapest": spec.objective(c.cheapest)}
        for c in certificate.competitors
    ]
    checks = [plain(c) | {"passed": c.passed} for c in certificate.checks]
    return {**plain(certificate), "checks": checks, "competitors": plain(compared)}


def plain(value: Any) -> Any:
    """Convert a value to JSON types: arrays by rows, records by fields, ``None`` for numbers that are not finite."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, complex):
        return {"re": plain(value.real), "im": plain(value.imag)}
    if isinstance(value, float):
        return float(value) + 0.0 if math.isfinite(value) else None  # a zero without its sign
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    if is_dataclass(value):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    return value


def absent(value: float | None) -> float:
    """Return a number that may be missing: NaN then."""
    return math.nan if value is None else value
