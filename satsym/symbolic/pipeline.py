"""The lists of steps that follow a motion, and the function that runs them in order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import dimensions
from satsym.symbolic import notation as n
from satsym.symbolic.checks import drawn_from
from satsym.symbolic.convention import as_cost
from satsym.symbolic.decimals import everywhere, lengthened
from satsym.symbolic.declared import begin, refuse_foreign_symbols, refuse_misfits
from satsym.symbolic.derivation import Derivation, DerivationError, resolved
from satsym.symbolic.functions.pieces import breaks, in_pieces
from satsym.symbolic.linear import properties, regulator
from satsym.symbolic.model import MaybeStep, Model, Problem, variables_of, with_origins
from satsym.symbolic.motion import steps
from satsym.symbolic.principle import effort, pontryagin, product, transversality
from satsym.symbolic.principle.parts import as_one
from satsym.symbolic.principle.path import interior, mixed_constraints, path_constraints, stationary_controls
from satsym.symbolic.principle.path import notation as path_notation
from satsym.symbolic.switching import curve as switching_curve
from satsym.symbolic.switching import functions as switching
from satsym.symbolic.switching import singular
from satsym.symbolic.time_limit import entering

OUTPUTS: tuple[MaybeStep, ...] = (steps.output_matrix, steps.output_equations)

PATH_CONSTRAINTS: tuple[MaybeStep, ...] = (
    path_constraints.constraint_order,
    stationary_controls.control_rates,
    path_constraints.boundary_control,
    path_constraints.constraint_multiplier,
    path_constraints.constrained_costates,
    path_constraints.junction_conditions,
    mixed_constraints.mixed_constraints,
    mixed_constraints.mixed_costates,
)
"""Steps for problems with path constraints."""

MINIMUM_PRINCIPLE: tuple[MaybeStep, ...] = (
    pontryagin.hamiltonian,
    pontryagin.stationarity,
    pontryagin.second_derivative,
    pontryagin.control_law,
    pontryagin.minimised_hamiltonian,
    pontryagin.state_equations,
    pontryagin.costate_equations,
    *PATH_CONSTRAINTS,
    interior.interior_conditions,
    pontryagin.boundary_conditions,
    transversality.boundary_residual,
    effort.exact_differential,
    effort.minimum_effort,
)

PRODUCT_PRINCIPLE: tuple[MaybeStep, ...] = (
    pontryagin.hamiltonian,
    product.control_parts,
    product.control_law,
    product.smoothed_law,
    product.minimised_hamiltonian,
    pontryagin.state_equations,
    pontryagin.costate_equations,
    *PATH_CONSTRAINTS,
    pontryagin.boundary_conditions,
    transversality.boundary_residual,
)
"""Steps for problems whose control set is a product of sets, or whose H is linear in a vector of controls."""

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
    path_constraints.constraint_order,
    singular.boundary_control,
    path_constraints.constraint_multiplier,
    path_constraints.constrained_costates,
    path_constraints.junction_conditions,
    pontryagin.boundary_conditions,
    transversality.boundary_residual,
    switching_curve.switching_curve,
    switching_curve.switching_feedback,
    switching_curve.rest_to_rest,
)
"""Steps for problems whose H is linear in the controls and their magnitudes."""

LINEAR: tuple[MaybeStep, ...] = (
    properties.stability,
    properties.jordan_form,
    properties.matrix_exponential,
    properties.routh,
    properties.controllability,
    properties.observability,
    properties.companion_form,
    regulator.lqr_hamiltonian,
    regulator.lqr_stationarity,
    regulator.lqr_costates,
    regulator.lqr_hamiltonian_matrix,
    regulator.lqr_differential_riccati,
    regulator.lqr,
)
"""Steps for linear models without a cost and with constant coefficients."""


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
    subject = _in_pieces(lengthened(subject))
    problem, model = (subject, subject.model) if isinstance(subject, Problem) else (None, subject)
    try:
        with drawn_from((*variables_of(model), *_times(subject))):
            return _derived(model, problem and as_cost(problem))
    except DerivationError as error:
        # what is refused far down, by a control set for instance, does not know of whom it speaks
        known = str(error).startswith((f"{subject.name}:", f"{model.name}:"))
        message = str(error) if known else f"{subject.name}: {error}"
        raise DerivationError(message, error.named) from error.__cause__


def _in_pieces(subject: Problem | Model) -> Problem | Model:
    """Return a problem or model whose piecewise functions of time have the form that derivations use."""
    model = subject.model if isinstance(subject, Problem) else subject
    moving = {v.symbol for one in with_origins(model) for v in (*one.states, *one.controls)}
    return everywhere(subject, lambda e: in_pieces(e, n.TIME, moving))


def _times(subject: Problem | Model) -> tuple[Variable, ...]:
    """Return time with its typical range, so that random points fall on all pieces of piecewise functions."""
    stated: list[sp.Basic] = []

    def noted(e: sp.Basic) -> sp.Basic:
        stated.append(e)
        return e

    everywhere(subject, noted)
    if not (ends := breaks(stated, n.TIME)):
        return ()
    reach = max(ends[-1] - ends[0], 1.0) / 4
    return (Variable(n.TIME.name, n.TIME.name, typical=(ends[0] - reach, ends[-1] + reach)),)


def _derived(model: Model, problem: Problem | None) -> Derivation:
    """Derive the motion, then its outputs, then the consequences of the cost."""
    derivation, known = _moving(model, problem and as_one(problem), "steps")
    if problem is not None and (apart := _as_sets(derivation, problem)) is not None:
        derivation, known = _moving(model, apart, "steps")
    if problem is not None:
        _refuse_unsolved(problem.name, derivation)
    derivation = _with_quantities(derivation)
    principle = _principle(derivation)
    if problem is not None and principle is SWITCHING_PRINCIPLE:  # whose bounds are in the law
        names = path_notation.names(problem, with_bounds=False)
        derivation = replace(derivation, notation={**derivation.notation, **names})
    return _taken(derivation, known, (*OUTPUTS, *principle))[0]


def _as_sets(motion_derived: Derivation, problem: Problem) -> Problem | None:
    """Return the problem with the control sets over which H is minimised; ``None`` where it has them already."""
    so_far = _with_quantities(motion_derived)
    one = so_far.problem
    if one is not None and one.control_set == "box" and not product.applies(so_far) and switching.applies(so_far):
        return None
    apart = product.as_sets(so_far, problem)
    if apart is not None and problem.interior:
        _refuse_interior(so_far.name)
    return apart


def _moving(
    model: Model, problem: Problem | None, which: Literal["steps", "motion_steps"]
) -> tuple[Derivation, dimensions.Known]:
    """Refuse misfits, then run one of the model's lists of steps."""
    steps: tuple[MaybeStep, ...] = getattr(model, which)()
    if not steps:
        kinds = " or ".join(sorted(kind.__name__ for kind in _kinds(Model) if which in vars(kind)))
        raise DerivationError(
            f"there are no derivation steps for models of the kind {type(model).__name__}; declare the model as {kinds}"
        )
    refuse_misfits(model, problem)
    derivation = begin(model, problem)
    refuse_foreign_symbols(derivation)
    if origin := model.origin():
        derivation = replace(derivation, original=(original := _motion_of(_Same(origin))))
        if not model.along_chain:
            _refuse_unsolved(model.name, original)
    return _taken(derivation, dimensions.declared(derivation), steps)


def _refuse_unsolved(name: str, motion: Derivation) -> None:
    """Refuse steps after rates without a closed form, whose symbols would be differentiated as constants.

    A model without a cost needs no such steps: its kernels follow and differentiate the chain behind the rates.
    """
    rates = motion.step("first_order").equations
    unsolved = [e.name for e in rates if any(map(n.is_solved, e.rhs.free_symbols))]
    if unsolved:
        raise DerivationError(
            f"{name}: the rates of {', '.join(unsolved)} have no closed form that is short enough to "
            "differentiate; linearise the bodies first, with AboutRest(of=...), or declare fewer bodies"
        )


@dataclass(frozen=True, eq=False)
class _Same:
    """A model that compares equal only to itself, so that what was derived from it can be cached."""

    model: Model

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.model is other.model

    def __hash__(self) -> int:
        return id(self.model)


@lru_cache(maxsize=4)  # several models are derived from one motion, one after the other
def _motion_of(same: _Same) -> Derivation:
    return _moving(same.model, None, "motion_steps")[0]


def _kinds(of: type[Model]) -> list[type[Model]]:
    return [kind for child in of.__subclasses__() for kind in (child, *_kinds(child))]


def _with_quantities(derivation: Derivation) -> Derivation:
    """Return the derivation with derived quantities by states and controls, if the cost names them."""
    problem = derivation.problem
    if problem is None or "quantities" not in derivation:
        return derivation
    known = resolved(derivation.step("quantities").equations)
    cost = sp.sympify(problem.running_cost).xreplace(known)
    return replace(derivation, problem=replace(problem, running_cost=cost))


def _principle(motion_derived: Derivation) -> tuple[MaybeStep, ...]:
    """List the steps that follow the motion: the minimum principle for the cost, or linear theory without one."""
    if motion_derived.problem is None:
        return LINEAR
    if motion_derived.problem.interior and (product.applies(motion_derived) or switching.applies(motion_derived)):
        _refuse_interior(motion_derived.name)
    if product.applies(motion_derived):
        switching.refuse_magnitudes(motion_derived)
        return PRODUCT_PRINCIPLE
    if not switching.applies(motion_derived):
        switching.refuse_magnitudes(motion_derived)
        return MINIMUM_PRINCIPLE
    singular.refuse_mixtures(motion_derived)
    return SWITCHING_PRINCIPLE


def _refuse_interior(name: str) -> None:
    message = "interior: waypoints are derived where H is quadratic in the controls; weigh their squares"
    raise DerivationError(f"{name}: {message}", ("interior",))


def _taken(
    derivation: Derivation, known: dimensions.Known, steps: Iterable[MaybeStep]
) -> tuple[Derivation, dimensions.Known]:
    """Run some more steps, and return the derivation and the dimensions after them."""
    for step_function in steps:
        entering(derivation.name, step_function.__name__.replace("_", " "))
        step = step_function(derivation)
        if step is not None:
            derivation = derivation.extended(step, dimensions.agreement(known, step))
            known = dimensions.extended(known, step)
    return derivation, known
