"""The certificate of a solution as an object for JSON, and back."""

from __future__ import annotations

import math
from typing import Any

import msgspec

from satsym.solution import Certificate, Check, Competitors, Kind
from satsym.status import Verdict


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
    """A certificate in result.json."""

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

    def certificate(self) -> Certificate:
        """The same as solving handed it back, but for infinite numbers, which JSON lacks."""
        return Certificate(
            verdict=self.verdict,
            boundary_residual=absent(self.boundary_residual),
            dynamics_defect=absent(self.dynamics_defect),
            stationarity=absent(self.stationarity),
            hamiltonian_drift=self.hamiltonian_drift,
            legendre_clebsch=absent(self.legendre_clebsch),
            conjugate_time=self.conjugate_time,
            checks=tuple(Check(c.name, absent(c.value), absent(c.limit)) for c in self.checks),
            competitors=tuple(Competitors(c.kind, c.tried, c.solved, absent(c.cheapest)) for c in self.competitors),
            not_checked=tuple(self.not_checked),
        )


def certificate_object(certificate: Certificate) -> dict[str, Any]:
    """The certificate of a solution, as JSON has it."""
    return {
        "verdict": certificate.verdict.value,
        "boundary_residual": number(certificate.boundary_residual),
        "dynamics_defect": number(certificate.dynamics_defect),
        "stationarity": number(certificate.stationarity),
        "hamiltonian_drift": number(certificate.hamiltonian_drift),
        "legendre_clebsch": number(certificate.legendre_clebsch),
        "conjugate_time": number(certificate.conjugate_time),
        "checks": [
            {"name": c.name, "value": number(c.value), "limit": number(c.limit), "passed": c.passed}
            for c in certificate.checks
        ],
        "competitors": [
            {
                "kind": c.kind.value,
                "tried": c.tried,
                "solved": c.solved,
                "unanswered": c.unanswered,
                "cheapest": number(c.cheapest),
            }
            for c in certificate.competitors
        ],
        "not_checked": [kind.value for kind in certificate.not_checked],
    }


def number(value: float | None) -> float | None:
    """A finite float, without the sign of a zero; ``None`` for anything else."""
    value = math.nan if value is None else float(value)
    return value + 0.0 if math.isfinite(value) else None


def absent(value: float | None) -> float:
    """A number that may be missing: NaN then."""
    return math.nan if value is None else value
