"""Hypotheses and theorems of proofs, in words."""

from __future__ import annotations

from collections.abc import Sequence

from satsym.instance.ends import Side
from satsym.proof.balls.arithmetic import Ball, NotProved
from satsym.proof.ends import End
from satsym.proof.field import Regularity
from satsym.proof.laws import AtLevels, Law, Throttled
from satsym.proof.record import Hypothesis, Theorem
from satsym.proof.signs import Shown
from satsym.proof.statement import Statement, walled

FIELD = (
    "field of extremals",
    "A. A. Agrachev and Yu. L. Sachkov, Control Theory from the Geometric Viewpoint, Springer 2004, chapter 17",
)
BROKEN = (
    "field of broken extremals",
    "J. Noble and H. Schättler, Sufficient conditions for relative minima of broken extremals in optimal control "
    "theory, Journal of Mathematical Analysis and Applications 269 (2002) 98-128",
)
CONSTRAINED = (
    "convex problem with path constraints",
    "R. F. Hartl, S. P. Sethi and R. G. Vickson, A survey of the maximum principles for optimal control problems with "
    "state constraints, SIAM Review 37 (1995) 181-218",
)
CONVEX = (
    "convex problem",
    "O. L. Mangasarian, Sufficient conditions for the optimal control of nonlinear systems, SIAM Journal on Control 4 "
    "(1966) 139-152",
)
WAITING = (
    "minimum time to a point of rest",
    "L. S. Pontryagin, V. G. Boltyanskii, R. V. Gamkrelidze and E. F. Mishchenko, The Mathematical Theory of Optimal "
    "Processes, Interscience 1962",
)

REST = Theorem(
    "zero control is optimal",
    "the running cost is a sum of squares",
    (
        "The global minimum of the cost is zero.",
        "Only the uncontrolled motion attains this minimum: every other admissible control has a higher cost.",
    ),
)


def of_rest(steps: int) -> tuple[Hypothesis, ...]:
    """State why zero control is optimal."""
    return (
        Hypothesis(
            "the cost is a positive definite quadratic form in the controls alone, and the final state is free",
            "from the second derivatives with respect to all controls",
            "exactly",
        ),
        Hypothesis("zero control is admissible", "zero lies within all bounds", "exactly"),
        Hypothesis("the uncontrolled motion exists until the final time", "by validated integration", f"{steps} steps"),
    )


def of_signs(shown: Shown) -> Hypothesis:
    """State that the laws minimise H along their arcs."""
    if not shown.conditions:
        return Hypothesis("no control reaches a bound", "there are no bounds", "no proof is needed")
    changes = f"{shown.conditions} signs and {shown.crossings} changes of the control law"
    if shown.crossings == 1:
        changes = f"{shown.conditions} signs and 1 change of the control law"
    return Hypothesis(
        "the law of each arc holds on the whole arc, and the switching function passes through zero with a "
        "nonzero slope at each change of law",
        "signs of Taylor series on every step, determined by bisection",
        changes,
    )


def of_minimiser(reason: str) -> Hypothesis:
    """State that H has a single minimiser."""
    return Hypothesis("the minimiser of H is unique", reason, "on every step")


def of_ends(statement: Statement, end: End) -> Hypothesis:
    """Show that multipliers of active range ends point outwards, and that other ends are not active.

    Raises
    ------
    NotProved
        If one does not.
    """
    n, s = end.law.n, end.terminal[1]
    spec = statement.spec
    names = statement.spec.state_names
    for i, target in statement.targets.items():
        if target.side is None:
            continue
        push = end.z[n + i] - s[i]
        if not (push > 0 if target.side is Side.UPPER else push < 0):
            raise NotProved(
                f"the multiplier of the range of {names[i]} at the final time could not be shown to be positive"
            )
    for i, (low, high) in statement.open_ranges.items():
        if not (end.z[i] > low and end.z[i] < high):
            raise NotProved(f"{names[i]} could not be shown to end inside its range")
    first = len(spec.multipliers) - len(spec.terminal_inequalities)
    for k in statement.limits:
        called = f"the inequality {spec.terminal_inequalities[k - first]} at the end"
        if k in statement.active and not end.nu[statement.active.index(k)] > 0:
            raise NotProved(f"the multiplier of {called} could not be shown to be positive")
        if k not in statement.active and not end.constraints[k][0] < 0:
            raise NotProved(f"{called} could not be shown to hold strictly")
    ranges = len(statement.open_ranges) + sum(target.side is not None for target in statement.targets.values())
    given = sum(i < statement.own for i in statement.targets)
    free = statement.own - given
    parts = [f"{given} states given"] if given else []
    parts += [f"{free} states free"] if free else []
    parts += [f"{ranges} states with final values in a range"] if ranges else []
    if spec.multipliers:
        parts += [f"{len(statement.active)} active constraints", f"{len(spec.multipliers)} constraints in all"]
        parts += [f"multiplier {v.str(6, radius=False)}" for v in end.nu]
    return Hypothesis(
        "the final conditions hold, strictly where they are inequalities",
        "by the equations of the extremal",
        "; ".join(parts),
    )


def of_jumps(jumps: Sequence[Ball]) -> Hypothesis:
    """Show that multipliers of path constraints at junctions are not negative.

    Raises
    ------
    NotProved
        If one may be negative.
    """
    if not all(jump >= 0 for jump in jumps):
        raise NotProved("a jump of the costates at a path constraint could not be shown to be nonnegative")
    return Hypothesis(
        "multipliers of path constraints are nonnegative",
        "on boundary arcs, and at entries, exits and touch points",
        f"{len(jumps)} jumps of the costates",
    )


def of_field(found: Regularity) -> Hypothesis:
    """State that there is no focal point."""
    parts = [f"{found.pieces} pieces"]
    if found.ratios:
        parts.append(f"smallest ratio of determinants {min(float(v.mid()) for v in found.ratios):.3g}")
    return Hypothesis(
        "a field of extremals about this one is regular on the closed interval, and its quadratic form at the final "
        "time is positive",
        f"W(t0) = {found.start}; no conjugate or focal point",
        "; ".join(parts),
    )


def theorem(statement: Statement, laws: Sequence[Law], radius: float, convexity: str, waits: str) -> Theorem:
    """State the theorem that follows when all hypotheses are shown.

    Parameters
    ----------
    radius
        The radius of the box that holds one extremal only, relative to the sizes.
    convexity, waits
        Why the problem is convex, and why no motion arrives earlier, in words; empty if that is not known.
    """
    one = (
        f"There is exactly one extremal of this structure within a distance of {radius:g}, relative to the sizes of "
        "its components."
    )
    if walled(statement):
        return Theorem(
            *CONSTRAINED,
            (
                one,
                f"It is a global minimum of the cost: {convexity}, and path constraints that are met are linear in the "
                "states.",
            ),
        )
    jumping = len(laws) > 1 and isinstance(laws[0], AtLevels | Throttled)
    name, source = BROKEN if jumping else FIELD
    claimed: tuple[str, ...] = (one, _best(statement))
    for (also, where), reason in ((CONVEX, convexity), (WAITING, waits)):
        if reason and not statement.spec.path_constraints:
            name, source = f"{name}; {also}", f"{source}; {where}"
            claimed = (*claimed, f"The optimum is global: {reason}.")
    return Theorem(name, source, claimed)


def _best(statement: Statement) -> str:
    """State the set of motions among which an extremal is the best."""
    more = [i for i in statement.free if i >= statement.own]
    free = [
        ("whose initial time is near", statement.clock in more),
        ("whose final time is near", statement.tf is None and statement.clock not in statement.targets),
        ("whose free parameters are near", any(i != statement.clock for i in more)),
    ]
    near = ["whose states stay near it", *(said for said, holds in free if holds)]
    listed = " and ".join([", ".join(near[:-1]), near[-1]]) if len(near) > 1 else near[0]
    return (
        f"This extremal is strictly better than all other admissible motions {listed}, however different their "
        "controls are "
        "(a strict strong local optimum)."
    )


def scope(statement: Statement) -> str:
    """State which problem is proved, and what is not claimed."""
    path = statement.source.path
    numbers = (
        f"decimals in {path} and in the generated module are taken as exact rational numbers, and degrees as "
        "rational multiples of pi."
        if path
        else "numbers given in Python are taken as exact binary fractions, and the defaults of the model as exact "
        "decimals."
    )
    compared = (
        "The derivatives and laws of the generated kernel were compared with its motion and costs at random points."
    )
    near = "The theorem does not say how large this neighbourhood is."
    model = f"The theorem concerns the problem of the model {statement.spec.name} with the values listed here:"
    return f"{model} {numbers} {compared} {near}"
