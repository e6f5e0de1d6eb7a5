"""The visible lists of steps, and deriving as running them in order."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from satsym.symbolic import mechanics, motion, pontryagin
from satsym.symbolic.derivation import Derivation, Step
from satsym.symbolic.model import FirstOrder, Model, Newton, Problem
from satsym.symbolic.notation import begin

MaybeStep: TypeAlias = Callable[[Derivation], Step | None]
"""A step function; ``None`` from it means that the step does not apply to this model."""

ANY_MOTION: tuple[MaybeStep, ...] = (motion.reference, motion.conserved, motion.linearisation)

NEWTON: tuple[MaybeStep, ...] = (
    mechanics.unit_vectors,
    mechanics.position,
    mechanics.velocity,
    mechanics.acceleration,
    mechanics.forces,
    mechanics.newton,
    mechanics.equations_of_motion,
    mechanics.first_order,
    *ANY_MOTION,
)

FIRST_ORDER: tuple[MaybeStep, ...] = (motion.given_rates, *ANY_MOTION)

MINIMUM_PRINCIPLE: tuple[MaybeStep, ...] = (
    pontryagin.hamiltonian,
    pontryagin.stationarity,
    pontryagin.second_derivative,
    pontryagin.control_law,
    pontryagin.minimised_hamiltonian,
    pontryagin.state_equations,
    pontryagin.costate_equations,
    pontryagin.boundary_conditions,
)

MODEL_STEPS: dict[type[Model], tuple[MaybeStep, ...]] = {Newton: NEWTON, FirstOrder: FIRST_ORDER}


def derive(subject: Problem | Model) -> Derivation:
    """Derive everything that follows from a problem, or from a model without a cost.

    Returns
    -------
    Derivation
        Ordered steps, every one of which passed its machine checks.

    Raises
    ------
    DerivationError
        If what was declared is inconsistent, the conditions cannot be solved for the controls, or a check
        failed.
    """
    problem, model = (subject, subject.model) if isinstance(subject, Problem) else (None, subject)
    derivation = begin(model, problem)
    for step_function in (*MODEL_STEPS[type(model)], *(MINIMUM_PRINCIPLE if problem else ())):
        step = step_function(derivation)
        if step is not None:
            derivation = derivation.extended(step)
    return derivation
