"""Certificates as text: the verdict in a sentence, and each condition as a statement with its limit."""

from __future__ import annotations

import re

from satsym.report.said import each, message, say
from satsym.report.terminal.table import figure, table, wrapped
from satsym.solution import Certificate, Check, Kind
from satsym.spec import ProblemSpec
from satsym.status import Scope, Verdict

_HOLDS = {
    "boundary residual": "boundary conditions satisfied",
    "dynamics defect": "equations of motion satisfied",
    "node defect": "equations of motion satisfied between nodes",
    "junction defect": "arcs joined without gaps",
    "hamiltonian drift": "Hamiltonian constant",
    "stationarity": "control minimises the Hamiltonian",
    "cost": "cost confirmed by integration",
    "legendre-clebsch": "strict Legendre-Clebsch condition holds",
    "generalised legendre-clebsch": "generalised Legendre-Clebsch condition holds",
    "switching times": "switching times confirmed by integration",
    "stated times of events": "events occur at the stated times",
    "stated switching times, to the spacing of the nodes": (
        "each switch lies between the two nodes adjacent to its stated time"
    ),
    "stated times of saturation": "controls reach their bounds at the stated times",
    "the two minimisers of H are still equally good after a jump": (
        "the two minimisers of H are equally good only at the jump itself"
    ),
    "coinciding switching times": "switching times distinct",
    "conjugate points: none": "no conjugate points",
    "correction of the nodes": "nodes lie on the recomputed trajectory",
    "cost interval too narrow": "cost interval covers the duality gap",
    "domain violation": "states inside the domain of the model",
    "gaps where the integration restarts": "trajectory continuous where integration restarts",
    "jump of the costates that is not along the constraint's gradient": (
        "costates jump along the gradient of the constraint"
    ),
    "jump of the costates": "costates jump along the gradient of the constraint",
    "kernels contradict each other": "generated kernels agree",
    "a terminal limit is violated": "terminal limits satisfied",
    "the multiplier of a terminal limit vanishes": "multipliers of terminal limits nonzero",
    "a multiplier vanishes on a boundary arc": "multipliers positive along boundary arcs",
    "negative multiplier of a terminal limit": "multipliers of terminal limits nonnegative",
    "negative multiplier": "multipliers of path constraints nonnegative",
    "multiplier on a boundary is negative": "multipliers of path constraints nonnegative",
    "multiplier at a junction is negative": "multipliers at junctions nonnegative",
    "no cheaper competitor": "no control can be cheaper",
    "no proof of a minimum along singular arcs: the problem is not convex": (
        "problem convex, so singular arcs are optimal"
    ),
    "not convex": "problem convex, so there is no other minimum",
    "deviation from tangency at junctions": "tangency conditions at junctions satisfied",
    "distance from the boundary on a boundary arc": "boundary arcs lie on the boundary",
    "off the boundary on its arcs": "boundary arcs lie on the boundary",
    "path constraint violated": "path constraints satisfied",
    "distance of the motion from its waypoints": "waypoints passed",
    "derivative of the cost with respect to the times at the waypoints": (
        "cost stationary with respect to the times at the waypoints"
    ),
    "second variation along singular arcs": "second variation positive along singular arcs",
    "second variation along singular and boundary arcs": "second variation positive along singular and boundary arcs",
    "second variation with respect to arc lengths and directions": "second variation positive with respect to arc "
    "lengths and directions",
    "second variation with respect to the switching times": "second variation positive with respect to the switching "
    "times",
    "second variation with fixed active arcs": "second variation positive with fixed active arcs",
    "second-order condition at the free endpoint": "second-order condition at the free endpoint holds",
    "second-order condition at the free initial point": "second-order condition at the free initial point holds",
    "control continuous at a junction": "control jumps at the ends of singular arcs",
    "singular control at its bound": "singular control strictly within its bounds",
    "strict bang-bang condition": "strict bang-bang condition holds",
    "switching function on singular arcs": "switching function zero on singular arcs",
    "switching function vanishes on an arc": "switching functions zero at switching times only",
    "width of the cost interval": "cost interval narrow",
}
"""Check -> what is true if it passes; checks that are reported only when they fail are not listed."""

_FAILS = {
    "another minimiser of H remains equally good": "another minimiser of H remains equally good",
    "boundary residual": "boundary conditions not satisfied",
    "no comparison: no competitor was solved": "no competing solution was found",
    "cost": "cost not confirmed by integration",
    "correction of the nodes": "nodes do not lie on the recomputed trajectory",
    "derivative of the cost with respect to the times at the waypoints": (
        "cost not stationary with respect to the times at the waypoints"
    ),
    "dynamics defect": "equations of motion not satisfied",
    "gaps where the integration restarts": "trajectory not continuous where integration restarts",
    "hamiltonian drift": "Hamiltonian not constant",
    "junction defect": "arcs joined with gaps",
    "kernels contradict each other": "generated kernels do not agree with each other",
    "a terminal limit is violated": "terminal limits violated",
    "the two minimisers of H are still equally good after a jump": (
        "the minimisers of H on both sides of a jump are equally good"
    ),
    "the multiplier of a terminal limit vanishes": "a multiplier of a terminal limit is zero",
    "negative multiplier of a terminal limit": "a multiplier of a terminal limit is negative",
    "no proof of a minimum along singular arcs: the problem is not convex": "minimum along singular arcs not proved",
    "node defect": "equations of motion not satisfied between nodes",
    "not strict: the same arcs at a later time have the same cost": (
        "minimum not strict: the same arcs at a later time have the same cost"
    ),
    "deviation from tangency at junctions": "tangency conditions at junctions not satisfied",
    "control continuous at a junction": "control continuous at the end of a singular arc",
    "singular control at its bound": "singular control reaches its bound",
    "stationarity": "control does not minimise the Hamiltonian",
    "switching function vanishes on an arc": "switching function zero within an arc",
    "width of the cost interval": "cost interval too wide",
}
"""Check -> what is wrong if it fails; the names of the other checks say it themselves."""

_NAMED = {
    re.compile(r"cheaper by: (.*)"): "no cheaper competitor: <said_kind>",
    re.compile(r"transversality at the initial time: (.*)"): (
        "transversality condition at the initial time holds: <said_kind>"
    ),
}

_MISSING = {
    Kind.NEIGHBOURS: "neighbouring motions",
    Kind.REVOLUTIONS: "other numbers of revolutions",
    Kind.DURATIONS: "other durations",
    Kind.STARTS: "motions from other starts",
    Kind.FURTHER: "motions from further starts",
    Kind.ARCS: "other sequences of boundary arcs",
    Kind.TIMES: "other times at waypoints",
    Kind.ENDS: "other limits of the final state",
    Kind.UNKNOWNS: "other values of the free quantities",
}
"""What a solution was not compared with, by the kind of competitor that is missing."""
"""Patterns of checks whose names contain a name -> what is true if they pass."""

_MEANINGS = {
    Verdict.CERTIFIED: "strict local minimum",
    Verdict.LOCAL_MINIMUM: "strict local minimum; no competing solutions were computed",
    Verdict.EXTREMAL_ONLY: "first-order conditions hold; not proved to be a strict local minimum",
    Verdict.FAILED: "an optimality condition is violated",
}
"""Verdict -> its meaning, in the words that solve, study and compare have in common."""


def meaning(verdict: Verdict) -> str:
    """Return the claim of a verdict in a few words."""
    return say(_MEANINGS[verdict])


def certificate_lines(certificate: Certificate, spec: ProblemSpec) -> list[str]:
    """Return the verdict, the conditions with values and limits, and the competitors by kind."""
    compared = competitor_rows(certificate, spec)
    return [
        *wrapped(say("certificate: <verdict>", verdict=verdict_text(certificate, spec.maximise))),
        *theorem_lines(certificate),
        "",
        *table(condition_rows(certificate), right=(1, 2)),
        *(["", *table(compared, right=(1, 2, 3))] if len(compared) > 1 else []),
    ]


def condition_rows(certificate: Certificate) -> list[tuple[str, str, str, str]]:
    """Return a table of conditions: statement, measured value, limit, and whether it failed."""
    failed = say("FAILED")
    condition, measured, limit = each("condition", "measured", "limit")
    return [(condition, measured, limit, "")] + [
        (
            statement(check),
            figure(abs(check.value), 2) if check.limit else "",
            figure(check.limit, 2) if check.limit else "",
            "" if check.passed else failed,
        )
        for check in certificate.checks
    ]


def competitor_rows(certificate: Certificate, spec: ProblemSpec) -> list[tuple[str, str, str, str]]:
    """Return a table of competitors by kind: how many were tried and solved, and the best of them."""
    kind, tried, solved = each("competitors", "tried", "solved")
    best = say("highest objective" if spec.maximise else "lowest cost")
    return [(kind, tried, solved, best)] + [
        (message(c.kind.value), str(c.tried), str(c.solved), figure(spec.objective(c.cheapest), 10))
        for c in certificate.competitors
        if c.tried
    ]


def claim(certificate: Certificate) -> str:
    """Return the claim of a certificate in a few words."""
    return meaning(certificate.verdict) if certificate.scope is Scope.LOCAL else say("global minimum")


def theorem_lines(certificate: Certificate) -> list[str]:
    """Return the theorem that proves a certificate's claim; none where no theorem does."""
    if certificate.verdict is Verdict.FAILED or any(check.name == certificate.because for check in certificate.checks):
        return []
    return wrapped(say("shown by: <theorem>", theorem=message(certificate.because))) if certificate.because else []


def verdict_text(certificate: Certificate, maximise: bool = False) -> str:
    """Return the verdict with its claim, the number of competitors, and what was not compared."""
    words, solved = claim(certificate), sum(c.solved for c in certificate.competitors)
    if certificate.verdict is Verdict.CERTIFIED and solved:
        one = "the one competing solution is no better" if maximise else "the one competing solution is not cheaper"
        many = (
            "none of <number> competing solutions is better"
            if maximise
            else "none of <number> competing solutions is cheaper"
        )
        words = f"{words}; {say(one) if solved == 1 else say(many, number=solved)}"
    text = f"{message(certificate.verdict.value)} ({words})"
    missing = ", ".join(say(_MISSING[kind]) for kind in certificate.not_checked)
    return say("<verdict>; not compared: <kinds>", verdict=text, kinds=missing) if missing else text


def statement(check: Check) -> str:
    """Return the statement of a check: what holds where it passed, else what is wrong."""
    if not check.passed:
        return say(_FAILS[check.name]) if check.name in _FAILS else message(check.name)
    for pattern, text in _NAMED.items():
        if found := pattern.fullmatch(check.name):
            return say(text, said_kind=message(found[1]))
    return say(_HOLDS[check.name]) if check.name in _HOLDS else message(check.name)
