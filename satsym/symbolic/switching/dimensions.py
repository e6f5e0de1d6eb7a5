"""Dimensions of what the derivation of a switching problem introduces."""

from __future__ import annotations

from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.switching import notation as s


def declare(known: dict[str, Dimension | None], problem: Problem, running: Dimension | None) -> None:
    """Enter the dimensions of switching functions, weights and smoothed or singular controls.

    Parameters
    ----------
    known
        Dimensions of declared variables, which are added to.
    problem
        Anything is entered only where its running cost is affine in the controls.
    running
        Dimension of the running cost.
    """
    if not s.names(problem):
        return
    controls = symbols_of(problem.model.controls)
    known[s.SHARE.name] = PLAIN
    known[s.UNSWITCHED.name] = known[s.SMOOTHED.name] = running
    for u in controls:
        known[s.switching_of(u).name] = known[s.weight_of(u).name] = over(running, known[u.name])
        known[s.smoothed(u).name] = known[u.name]
        known.update({s.singular(u, branch).name: known[u.name] for branch in s.BRANCHES})
    efforts = [over(over(running, known[u.name]), known[u.name]) for u in controls]
    # one number smooths all controls: where their units differ it has none that would suit them all
    known[s.SMOOTHING.name] = efforts[0] if all(e == efforts[0] for e in efforts) else None
