"""Whether the claim of a certificate is local or global, and the theorem that supports it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Certificate, Solution
from satsym.solvers.certificate.competitors.comparing import none_conceivable
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.failures import tried
from satsym.solvers.switching.linear.linear_motion import linear_motion
from satsym.status import Scope, Verdict

NOTHING_COSTS = "no control has a lower running cost than this one, and the cost does not depend on the states"
CONVEX = "the motion is linear, the cost and the constraints are convex, and the final time is given (Mangasarian 1966)"
PRICED = "the motion is linear, the cost is convex in the controls, and the final time is given (Mangasarian 1966)"
SOONEST = (
    "the motion is linear, the cost is time alone and the final state can be maintained, so the reachable set "
    "grows with time and an extremal leads to its boundary (Lee and Markus 1967, chapter 2)"
)
"""Reasons why no admissible motion has a lower cost."""

THEOREMS = {
    "no proof of a minimum along singular arcs: the problem is not convex": (
        "convexity around the extremal (Mangasarian 1966)"
    ),
    "second variation along singular and boundary arcs": "the strict generalised Legendre-Clebsch condition, positive "
    "multipliers and a second variation that is positive after Goh's transformation (Aronna, Bonnans and Goh 2016)",
    "second variation along singular arcs": "the strict generalised Legendre-Clebsch condition and a second variation "
    "that is positive after Goh's transformation (Aronna, Bonnans, Dmitruk and Lotito 2012)",
    "second variation with respect to arc lengths and directions": "strict signs of the switching functions and a "
    "positive second variation with respect to arc lengths and directions (Chen, Caillau and Chitour 2016)",
    "second variation with fixed active arcs": "positive multipliers and a positive second variation with "
    "fixed active arcs (Maurer 1981; Bonnans and Hermant 2009)",
    "a multiplier vanishes on a boundary arc": (
        "positive multipliers, strict signs of the switching functions and a positive "
        "second variation with respect to the switching and junction times (Maurer and Vossen 2009)"
    ),
    "second variation with respect to the switching times": "the strict bang-bang condition and a positive second "
    "variation with respect to the switching times (Agrachev, Stefani and Zezza 2002; Maurer and Osmolovskii 2004)",
    "conjugate points: none": "the strict Legendre-Clebsch condition and no conjugate points (Bryson and Ho 1975, "
    "chapter 6)",
    "switching function vanishes on an arc": "signs of the switching functions in a problem that is convex around the "
    "extremal (Mangasarian 1966)",
}
"""Sufficient condition measured by a certificate -> theorem by which it proves a local minimum. The first entry that
matches a check of the certificate applies."""

INSIDE, MET = 1e-6, 1e-9
"""Minimum distance from its bounds, as a fraction of its range, of a control that maintains the final state. Largest
rate of the states under this control that counts as zero, relative to its terms."""


def with_scope(certificate: Certificate, solution: Solution) -> Certificate:
    """Return a certificate that states whether its claim is local or global, and what supports the claim.

    If a condition fails or a competitor is cheaper, nothing is claimed and the first failed check is named.
    """
    certificate = replace(certificate, scope=Scope.LOCAL, because=_first_failed(certificate))
    if certificate.verdict in (Verdict.FAILED, Verdict.EXTREMAL_ONLY):
        return certificate
    if reason := tried(lambda: _no_other(solution)) or "":
        return replace(certificate, scope=Scope.GLOBAL, because=reason)
    names = {check.name for check in certificate.checks}
    return replace(certificate, because=next((text for name, text in THEOREMS.items() if name in names), ""))


def _first_failed(certificate: Certificate) -> str:
    return next((check.name for check in certificate.checks if not check.passed), "")


def _no_other(solution: Solution) -> str:
    """Return the reason why no admissible motion costs less than an extremal; empty if none is known."""
    instance = solution.instance
    if instance.free or instance.end_limits or instance.solver.free_angles or solution.interval is not None:
        return ""
    if none_conceivable(solution):
        return NOTHING_COSTS
    if convex(instance):
        return CONVEX
    if instance.model.spec.in_arcs:  # path constraints and points on the way are no part of what follows
        return ""
    if _soonest(instance):
        return SOONEST
    return PRICED if _priced(instance) else ""


def _priced(instance: Instance) -> bool:
    """Return whether the motion is linear, its cost convex in the controls, and final time and state are given."""
    if instance.tf is None or instance.solver.free_angles or "reference" in instance.final.values():
        return False
    motion = linear_motion(instance)
    return motion is not None and motion.priced and bool((motion.weight >= 0.0).all())


def _soonest(instance: Instance) -> bool:
    """Return whether an extremal of a minimum-time problem is a global minimum.

    Let K(t) be the set of states that a linear motion x' = A x + B u + c with controls in a box reaches at the time t.
    If controls inside the box maintain the final state and (A, B) is controllable, the final state is inside K(t) at
    all times after it was first reached. An extremal whose costates do not vanish ends on the boundary of K(t), so it
    is the first to arrive.
    """
    names = instance.model.spec.state_names
    if instance.tf is not None or not all(isinstance(instance.final.get(name), float) for name in names):
        return False
    motion = linear_motion(instance)
    if motion is None or not motion.priced or not motion.rate > 0.0 or motion.slope.any() or motion.weight.any():
        return False
    end = np.array([instance.final[name] for name in names], dtype=float)
    low, high = np.array(instance.lower), np.array(instance.upper)
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    if not (half > 0.0).all():
        return False
    # of the controls that hold the end the one whose largest share of its range is about the least
    rates = motion.states @ end + motion.drift + motion.controls @ middle
    share = np.linalg.lstsq(motion.controls * half, -rates, rcond=None)[0]
    left = rates + motion.controls * half @ share
    terms = np.abs(motion.states) @ np.abs(end) + np.abs(motion.drift) + np.abs(motion.controls) @ np.abs(high - low)
    held = bool((np.abs(left) <= MET * terms).all() and (np.abs(share) < 1.0 - INSIDE).all())
    return held and _controllable(motion.states, motion.controls)


def _controllable(a: Array, b: Array) -> bool:
    """Return whether the controllability matrix has full rank, with rows and powers scaled to comparable magnitude."""
    size = float(np.abs(a).max()) or 1.0
    blocks = [b]
    for _ in range(len(a) - 1):
        blocks.append(a / size @ blocks[-1])
    table = np.concatenate(blocks, axis=1)
    rows = np.abs(table).max(axis=1, keepdims=True)
    return bool((rows > 0.0).all() and np.linalg.matrix_rank(table / rows) == len(a))
