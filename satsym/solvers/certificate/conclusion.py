"""Construction of a certificate from the checks that were made."""

from __future__ import annotations

from collections.abc import Sequence

from satsym.solution import Certificate, Check, Kind
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.status import Verdict

BOUNDARY, STATIONARITY, HAMILTONIAN = "boundary residual", "stationarity", "hamiltonian drift"
OF_FLOW, OF_SEGMENTS, OF_NODES = "dynamics defect", "junction defect", "node defect"
"""Names of checks. The last three are distances of the solution from a flow: the flow from the initial costates, the
flow from the beginning of each segment to the next one, and the flow from each node to the next one."""

MISSING = float("nan")


def concluded(
    first: Sequence[Check],
    second: Sequence[Check],
    legendre: float,
    others: Comparison | None = None,
    *,
    compared: bool = True,
    conjugate_time: float | None = None,
) -> Certificate:
    """Return the certificate of an extremal.

    Parameters
    ----------
    first, second
        Checks of necessary conditions, and checks that together with these are sufficient.
    legendre
        Smallest eigenvalue of H_uu, see :attr:`satsym.solution.Certificate.legendre_clebsch`.
    others
        Comparison with competitors, ``None`` if there was none.
    compared
        Whether competitors were looked for.
    conjugate_time
        First conjugate time, ``None`` if there is none.
    """
    others, measured = others or Comparison(), {check.name: check.value for check in first}
    second = [*second, *others.checks]
    return Certificate(
        Verdict.of(all(check.passed for check in first), all(check.passed for check in second), compared),
        boundary_residual=measured[BOUNDARY],
        dynamics_defect=measured[OF_FLOW] if OF_FLOW in measured else measured[OF_SEGMENTS],
        stationarity=measured[STATIONARITY],
        hamiltonian_drift=measured.get(HAMILTONIAN),
        legendre_clebsch=legendre,
        conjugate_time=conjugate_time,
        checks=(*first, *second),
        competitors=tuple(kind.summary for kind in others.kinds),
        not_checked=others.not_checked,
    )


def unmeasured(name: str, verdict: Verdict = Verdict.FAILED, not_checked: tuple[Kind, ...] = ()) -> Certificate:
    """Return the certificate of a solution for which no condition could be measured.

    Parameters
    ----------
    name
        Name of the check that fails.
    """
    check = Check(name, 1.0, 0.0)
    return Certificate(verdict, MISSING, MISSING, MISSING, None, MISSING, None, (check,), not_checked=not_checked)
