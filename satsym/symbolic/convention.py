"""The two conventions of Pontryagin's principle, and how they differ.

With the *minimum* convention H = lambda' f + L is minimised over the controls, with the *maximum* convention
H = lambda' f - L is maximised. The costates of the one are those of the other with the sign reversed, and so is H;
states, controls and cost are the same. Either way dx/dt = H_lambda and d lambda/dt = -H_x. What is printed follows the
convention of the problem; kernels are always generated from the minimum form, so that solvers know one.

Another thing is an objective that the author wants maximised: derived is what minimises its negative, by either
convention, and L and S are those of the negative. Costates are derivatives of the least cost, hence of minus the
largest objective.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import Convention, Model, Problem


def sign(problem: Problem) -> int:
    """What L is multiplied by in H: one with the minimum convention, minus one with the maximum convention."""
    return -1 if problem.convention == "maximum" else 1


def worded(key: str, problem: Problem) -> str:
    """The key of a text that differs between the conventions."""
    return f"{key}, maximum" if problem.convention == "maximum" else key


def in_convention(subject: Problem | Model, convention: Convention | None) -> Problem | Model:
    """Return a problem with a convention; a model without a cost stays as it is, and so does anything for ``None``."""
    return replace(subject, convention=convention) if convention and isinstance(subject, Problem) else subject


def as_cost(problem: Problem) -> Problem:
    """The problem with L and S as costs, which are minimised, where the author has an objective to maximise."""
    if not problem.maximise:
        return problem
    return replace(
        problem, running_cost=-sp.sympify(problem.running_cost), terminal_cost=-sp.sympify(problem.terminal_cost)
    )


def is_minimum(derivation: Derivation) -> bool:
    """Whether kernels can be generated from a derivation."""
    return derivation.problem is None or derivation.problem.convention == "minimum"
