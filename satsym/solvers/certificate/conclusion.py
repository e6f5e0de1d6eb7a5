"""From checks to a certificate."""

from __future__ import annotations

from collections.abc import Sequence

from satsym.solution import Certificate, Check, Kind
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.status import Verdict

BOUNDARY, STATIONARITY, HAMILTONIAN = "boundary residual", "stationarity", "hamiltonian drift"
OF_FLOW, OF_SEGMENTS, OF_NODES = "dynamics defect", "junction defect", "node defect"
"""What checks are called. The last three are distances of the solution from the flow from the initial costates, of
segments between nodes from the next node, and of the motion from each node from the next one."""

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
    """The certificate of an extremal.

    Parameters
    ----------
    first, second
        Necessary conditions, and those which together with them are sufficient.
    legendre
        As :attr:`satsym.solution.Certificate.legendre_clebsch`.
    others
        What competitors came to.
    compared
        Whether any were looked for.
    conjugate_time
        The first one, if there is one.
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
    """The certificate of a solution of which nothing could be measured.

    Parameters
    ----------
    name
        Of the check that does not hold.
    """
    check = Check(name, 1.0, 0.0)
    return Certificate(verdict, MISSING, MISSING, MISSING, None, MISSING, None, (check,), not_checked=not_checked)
