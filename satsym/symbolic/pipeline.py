"""The visible lists of steps, and deriving as running them in order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeAlias

from satsym.symbolic import (
    dimensions,
    linearised,
    lqr,
    mechanics,
    motion,
    outputs,
    pontryagin,
    stability_steps,
    structure_steps,
    transversality,
)
from satsym.symbolic.declared import refuse_foreign_symbols, refuse_misfits
from satsym.symbolic.derivation import Derivation, DerivationError, Step
from satsym.symbolic.model import FirstOrder, Linearised, Model, Newton, Problem
from satsym.symbolic.notation import begin

MaybeStep: TypeAlias = Callable[[Derivation], Step | None]
"""A step function; ``None`` from it means that the step does not apply to this model."""

ANY_MOTION: tuple[MaybeStep, ...] = (motion.reference, motion.conserved, motion.linearisation)

NEWTON_MOTION: tuple[MaybeStep, ...] = (
    mechanics.unit_vectors,
    mechanics.position,
    mechanics.velocity,
    mechanics.acceleration,
    mechanics.forces,
    mechanics.newton,
    mechanics.equations_of_motion,
    mechanics.first_order,
)

FIRST_ORDER_MOTION: tuple[MaybeStep, ...] = (motion.given_rates,)

LINEARISED_MOTION: tuple[MaybeStep, ...] = (
    linearised.original_equations,
    linearised.reference_condition,
    linearised.reference,
    linearised.deviations,
    linearised.original_states,
    linearised.deviation_equations,
    linearised.linearisation,
    linearised.first_order,
)

NEWTON: tuple[MaybeStep, ...] = (*NEWTON_MOTION, *ANY_MOTION)
FIRST_ORDER: tuple[MaybeStep, ...] = (*FIRST_ORDER_MOTION, *ANY_MOTION)
LINEARISED: tuple[MaybeStep, ...] = LINEARISED_MOTION
OUTPUTS: tuple[MaybeStep, ...] = (outputs.output_matrix, outputs.output_equations)

MINIMUM_PRINCIPLE: tuple[MaybeStep, ...] = (
    pontryagin.hamiltonian,
    pontryagin.stationarity,
    pontryagin.second_derivative,
    pontryagin.control_law,
    pontryagin.minimised_hamiltonian,
    pontryagin.state_equations,
    pontryagin.costate_equations,
    pontryagin.boundary_conditions,
    transversality.boundary_residual,
)

LINEAR: tuple[MaybeStep, ...] = (
    stability_steps.stability,
    stability_steps.jordan_form,
    stability_steps.matrix_exponential,
    stability_steps.routh,
    structure_steps.controllability,
    structure_steps.observability,
    structure_steps.companion_form,
    lqr.lqr_hamiltonian,
    lqr.lqr_stationarity,
    lqr.lqr_costates,
    lqr.lqr_hamiltonian_matrix,
    lqr.lqr_differential_riccati,
    lqr.lqr,
)
"""For models without a cost that are linear with constant coefficients."""

MODEL_STEPS: dict[type[Model], tuple[MaybeStep, ...]] = {
    Newton: NEWTON,
    FirstOrder: FIRST_ORDER,
    Linearised: LINEARISED,
}
MOTION_STEPS: dict[type[Model], tuple[MaybeStep, ...]] = {
    Newton: NEWTON_MOTION,
    FirstOrder: FIRST_ORDER_MOTION,
    Linearised: LINEARISED_MOTION,
}
"""As far as the first-order form: what a linearisation needs of the motion."""


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
    try:
        return _derived(model, problem, MODEL_STEPS)
    except DerivationError as error:
        # what is refused far down, by a control set for instance, does not know of whom it speaks
        known = str(error).startswith((f"{subject.name}:", f"{model.name}:"))
        raise DerivationError(str(error) if known else f"{subject.name}: {error}") from error.__cause__


def _derived(model: Model, problem: Problem | None, lists: Mapping[type[Model], tuple[MaybeStep, ...]]) -> Derivation:
    """Run the steps in order, each with the check of its dimensions."""
    steps = next((found for kind, found in lists.items() if isinstance(model, kind)), None)
    if steps is None:
        kinds = " or ".join(kind.__name__ for kind in lists)
        raise DerivationError(f"a {type(model).__name__} has no steps of its own; state the model as {kinds}")
    refuse_misfits(model, problem)
    derivation = begin(model, problem)
    refuse_foreign_symbols(derivation)
    if isinstance(model, Linearised):
        derivation = replace(derivation, original=_derived(model.of, None, MOTION_STEPS))
    known = dimensions.declared(derivation)
    further = (*OUTPUTS, *(MINIMUM_PRINCIPLE if problem else LINEAR)) if lists is MODEL_STEPS else ()
    for step_function in (*steps, *further):
        step = step_function(derivation)
        if step is not None:
            derivation = derivation.extended(replace(step, checks=(*step.checks, dimensions.agreement(known, step))))
            known = dimensions.extended(known, step)
    return derivation
