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
    """Return the factor of L in H: one with the minimum convention, minus one with the maximum convention."""
    return -1 if problem.convention == "maximum" else 1


def worded(key: str, problem: Problem) -> str:
    """Return the key of a text that differs between the two conventions."""
    return f"{key}, maximum" if problem.convention == "maximum" else key


def in_convention(subject: Problem | Model, convention: Convention | None) -> Problem | Model:
    """Return a problem in another convention; a model without a cost, and ``None``, leave it unchanged."""
    return replace(subject, convention=convention) if convention and isinstance(subject, Problem) else subject


def as_cost(problem: Problem) -> Problem:
    """Return the problem with L and S as costs to be minimised; an objective to maximise is negated."""
    if not problem.maximise:
        return problem
    return replace(
        problem, running_cost=-sp.sympify(problem.running_cost), terminal_cost=-sp.sympify(problem.terminal_cost)
    )


def is_minimum(derivation: Derivation) -> bool:
    """Tell whether a derivation is in the minimum convention, from which kernels can be generated."""
    return derivation.problem is None or derivation.problem.convention == "minimum"
