"""The visible lists of steps, and deriving as running them in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TypeAlias

import sympy as sp

from satsym.symbolic import dimensions
from satsym.symbolic.declared import refuse_foreign_symbols, refuse_misfits
from satsym.symbolic.derivation import Derivation, DerivationError, Step
from satsym.symbolic.kepler import attraction, conic
from satsym.symbolic.kepler import points as point_steps
from satsym.symbolic.kinds import closed_loop, gyrostat, linearised, reduced, scaled, step_answers
from satsym.symbolic.kinds import newton as mechanics
from satsym.symbolic.kinds.rotation_models import ClosedLoop, Gyrostat, Reduced, Scaled
from satsym.symbolic.linear import regulator as lqr
from satsym.symbolic.linear import stability as stability_steps
from satsym.symbolic.linear import structure as structure_steps
from satsym.symbolic.model import FirstOrder, Linearised, Model, Newton, Problem
from satsym.symbolic.motion import outputs
from satsym.symbolic.motion import steps as motion
from satsym.symbolic.notation import begin
from satsym.symbolic.principle import effort, pontryagin, transversality
from satsym.symbolic.switching import curve as switching_curve
from satsym.symbolic.switching import functions as switching
from satsym.symbolic.switching import singular

MaybeStep: TypeAlias = Callable[[Derivation], Step | None]
"""A step function; ``None`` from it means that the step does not apply to this model."""

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

NEWTON: tuple[MaybeStep, ...] = (
    *NEWTON_MOTION,
    attraction.central_attraction,
    motion.reference,
    motion.conserved,
    conic.conic,
    motion.linearisation,
    attraction.gravity_gradient,
    point_steps.no_equilibrium,
    point_steps.point_spectrum,
)
GYROSTAT_MOTION: tuple[MaybeStep, ...] = (
    gyrostat.momenta,
    gyrostat.euler,
    gyrostat.first_order,
    gyrostat.balance,
    gyrostat.quantities,
)

SCALED_MOTION: tuple[MaybeStep, ...] = (
    linearised.original_equations,
    scaled.scales,
    scaled.original_states,
    scaled.first_order,
    scaled.quantities,
)

REDUCED_MOTION: tuple[MaybeStep, ...] = (
    linearised.original_equations,
    reduced.special_case,
    reduced.first_order,
    reduced.quantities,
)

CLOSED_LOOP: tuple[MaybeStep, ...] = (
    linearised.original_equations,
    closed_loop.small_motions,
    closed_loop.control_law,
    closed_loop.transfer_functions,
    closed_loop.poles_and_zeros,
    closed_loop.critical_damping,
    step_answers.step_response,
    step_answers.control_response,
    step_answers.extremes,
    closed_loop.first_order,
    motion.linearisation,
)

FIRST_ORDER: tuple[MaybeStep, ...] = (*FIRST_ORDER_MOTION, motion.reference, motion.linearisation)
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
    effort.exact_differential,
    effort.least_effort,
)

SWITCHING_PRINCIPLE: tuple[MaybeStep, ...] = (
    pontryagin.hamiltonian,
    switching.switching_function,
    switching.control_law,
    switching.smoothed_law,
    pontryagin.state_equations,
    pontryagin.costate_equations,
    switching.switching_rate,
    singular.singular_arcs,
    singular.generalised_legendre_clebsch,
    pontryagin.boundary_conditions,
    transversality.boundary_residual,
    switching_curve.switching_curve,
)
"""Where H is linear in the controls and their magnitudes."""

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
    Gyrostat: (*GYROSTAT_MOTION, motion.reference, motion.linearisation),
    Scaled: (*SCALED_MOTION, motion.reference, motion.linearisation),
    Reduced: (*REDUCED_MOTION, motion.reference, motion.linearisation),
    ClosedLoop: CLOSED_LOOP,
}
MOTION_STEPS: dict[type[Model], tuple[MaybeStep, ...]] = {
    Newton: NEWTON_MOTION,
    FirstOrder: FIRST_ORDER_MOTION,
    Linearised: LINEARISED_MOTION,
    Gyrostat: GYROSTAT_MOTION,
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
    if isinstance(model, Linearised | Scaled | Reduced | ClosedLoop):
        derivation = replace(derivation, original=_derived(model.of, None, MOTION_STEPS))
    known = dimensions.declared(derivation)
    derivation, known = _taken(derivation, known, steps)
    derivation = _with_quantities(derivation)
    if lists is MODEL_STEPS:
        derivation, _ = _taken(derivation, known, (*OUTPUTS, *_principle(derivation)))
    return derivation


def _with_quantities(derivation: Derivation) -> Derivation:
    """The same, the cost in terms of states and controls where it names quantities that were derived."""
    problem = derivation.problem
    if problem is None or "quantities" not in derivation:
        return derivation
    known = gyrostat.resolved(derivation.step("quantities").equations)
    cost = sp.sympify(problem.running_cost).xreplace(known)
    return replace(derivation, problem=replace(problem, running_cost=cost))


def _principle(motion_derived: Derivation) -> tuple[MaybeStep, ...]:
    """What follows from the motion: the principle that suits the cost, or linear theory where there is none."""
    if motion_derived.problem is None:
        return LINEAR
    return SWITCHING_PRINCIPLE if switching.applies(motion_derived) else MINIMUM_PRINCIPLE


def _taken(
    derivation: Derivation, known: dimensions.Known, steps: Iterable[MaybeStep]
) -> tuple[Derivation, dimensions.Known]:
    """The derivation and the dimensions after some more steps."""
    for step_function in steps:
        step = step_function(derivation)
        if step is not None:
            derivation = derivation.extended(replace(step, checks=(*step.checks, dimensions.agreement(known, step))))
            known = dimensions.extended(known, step)
    return derivation, known
