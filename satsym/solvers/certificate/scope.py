"""How far the claim of a certificate reaches, and the theorem that carries it."""

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
"""Why no admissible motion at all costs less."""

THEOREMS = {
    "no proof of a minimum along singular arcs: the problem is not convex": (
        "convexity around the extremal (Mangasarian 1966)"
    ),
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
"""A sufficient condition that a certificate has measured -> the theorem by which it shows a local minimum; the first
that a certificate has is meant."""

INSIDE, MET = 1e-6, 1e-9
"""Share of its range by which a control that holds the end is inside its bounds, and relative size of the rates of the
states there that are none."""


def with_scope(certificate: Certificate, solution: Solution) -> Certificate:
    """Say whether the claim of a certificate is local or global, and what carries it.

    Where a condition does not hold, or something cheaper was found, nothing is claimed: that condition is named.
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
    """Why no admissible motion costs less than an extremal; empty where that is not known."""
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
    """Whether a linear motion costs what is linear and convex in its controls, in a given time to a given state."""
    if instance.tf is None or instance.solver.free_angles or "reference" in instance.final.values():
        return False
    motion = linear_motion(instance)
    return motion is not None and motion.priced and bool((motion.weight >= 0.0).all())


def _soonest(instance: Instance) -> bool:
    """Whether an extremal of least time is the quickest motion.

    Let K(t) be what a linear motion x' = A x + B u + c with controls in a box reaches in the time t. Where controls
    inside the box hold the end and (A, B) is controllable, the end is inside K(t) at all times after it has first been
    reached. An extremal whose costates do not vanish ends on the boundary of K(t), so it is the first to arrive.
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
    """Whether the controllability matrix has full rank, with rows and powers of comparable size."""
    size = float(np.abs(a).max()) or 1.0
    blocks = [b]
    for _ in range(len(a) - 1):
        blocks.append(a / size @ blocks[-1])
    table = np.concatenate(blocks, axis=1)
    rows = np.abs(table).max(axis=1, keepdims=True)
    return bool((rows > 0.0).all() and np.linalg.matrix_rank(table / rows) == len(a))
