"""The contents of a generated module, function by function: the contract between the generator and its users."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from satsym.control_part import SWITCHED
from satsym.spec import ProblemSpec

BATCH = "_batch"
"""Suffix of the name of a function's batch form, which also takes the argument ``out=None``."""

TUPLES = ("nu", "p", "bounds", "final")
"""Arguments that are tuples of numbers, or of arrays, also in the batch form; the batch form takes others as arrays."""

GROUPS = {"x": "n", "lam": "n", "u": "m", "p": "k", "bounds": "b", "nu": "c", "final": "f", "original": "n"}
GROUPS |= {"gain": "mn", "riccati": "nn", "state_weight": "nn", "control_weight": "mm"}
"""Argument -> its shape as letters, one for each axis, see :func:`sizes`."""


@dataclass(frozen=True)
class Signature:
    """The arguments of a function, and the shape of its result."""

    arguments: tuple[str, ...]
    """Names of the arguments, in order."""
    shape: str = ""
    """A letter for each axis, see :func:`sizes`: ``""`` for a number, ``"n"`` for a vector, ``"nm"`` for a matrix."""
    over_parameters: bool = False
    """Whether parameters count for the shape of a batch, so that each parameter may be an array."""


def _signature(arguments: str, shape: str = "") -> Signature:
    return Signature(tuple(arguments.split()), shape)


def _of_parameters(arguments: str, shape: str) -> Signature:
    return Signature(tuple(arguments.split()), shape, over_parameters=True)


_MOTION = {
    "dynamics": _signature("t x u p", "n"),
    "jacobian_x": _signature("t x u p", "nn"),
    "jacobian_u": _signature("t x u p", "nm"),
}
_REFERENCE = {"reference": _signature("t p", "n")}
_INVARIANTS = {"invariants": _signature("t x p", "i")}
_POSITION = {"position": _signature("t x p", "q")}
_QUANTITIES = {"quantities": _signature("t x u p", "a")}
_BALANCES = {"balances": _signature("t x u p", "y")}
_KEPLERIAN = {"inertial_state": _signature("t x p", "s")}
_COST = {
    "running_cost": _signature("t x u p"),
    "terminal_cost": _signature("t x p"),
    "terminal_gradient": _signature("t x p", "n"),
    "hamiltonian": _signature("t x u lam p"),
    "stationarity": _signature("t x u lam p", "m"),
    "control_hessian": _signature("t x u lam p", "mm"),
    "control_law": _signature("t x lam p bounds", "m"),
    "costate_rate": _signature("t x u lam p", "n"),
    "canonical": _signature("t x lam p bounds", "z"),
    "canonical_jacobian": _signature("t x lam p bounds", "zz"),
    "canonical_drift": _signature("t x lam p bounds", "z"),
    "boundary": _signature("t x lam nu p bounds final", "e"),
    "boundary_jacobian": _signature("t x lam nu p bounds final", "ev"),
}
_OF_REGULAR_LAWS = ("stationarity", "control_hessian")
_SWITCHING = {
    "switching_function": _signature("t x lam p", "m"),
    "switching_rate": _signature("t x u lam p", "m"),
    "magnitude_weight": _signature("t x lam p", "m"),
    "extremal_jacobian": _signature("t x u lam p", "zz"),
}
"""Functions of problems whose Hamiltonian is linear in the controls and their magnitudes.

They replace the functions of regular control laws. The functions ``canonical`` and ``boundary`` of such problems are
those of the regularised problem, see :mod:`satsym.codegen.switching`.
"""
DIRECTIONS = {"regularised_cost": _signature("t x lam p bounds")}
"""Additional functions of a problem in which some controls are directions: its ``canonical`` functions and ``boundary``
are those of the regularised problem, see :mod:`satsym.symbolic.principle.product`."""

THROTTLES = {"throttle_slope": _signature("t x lam p bounds", "r")}
"""Additional functions of a problem with directions whose vectors may vanish, as the sign of these functions
decides."""

PATH_CONSTRAINTS = {
    "path_constraints": _signature("t x u p bounds", "h"),
    "path_gradient": _signature("t x u p", "hn"),
    "path_effect": _signature("t x u p", "hm"),
    "path_rates": _signature("t x u p", "hw"),
    "path_vanishing": _signature("t x u lam p bounds", "hw"),
    "path_multiplier": _signature("t x u lam p bounds", "h"),
}
"""Additional functions of a problem with path constraints, see :mod:`satsym.symbolic.principle.path`; second rates of
constraints of order one are 0, and so are all rates of constraints of order zero, which contain a control. The controls
of the last two functions are those of the law; see :data:`BOUNDARY_CONTROLS` for where these depend on no control."""

BOUNDARY_CONTROLS = {"boundary_control": _signature("t x lam p bounds", "hm")}
"""Additional functions where H is known to be quadratic in the controls. Elsewhere Newton's method finds the controls,
with the multiplier, where the derivative by the controls of H, or of H with the constraint adjoined, vanishes."""

INTERIOR = {
    "interior": _signature("t x p", "j"),
    "interior_gradient": _signature("t x p", "jn"),
    "interior_drift": _signature("t x p", "j"),
}
"""Additional functions of a problem with waypoints, see :mod:`satsym.symbolic.principle.path.interior`."""

CURVE = {
    "beyond_switching_curve": _signature("t x p bounds final"),
    "feedback_law": _signature("t x p bounds final", "m"),
    "transition_time": _signature("t x p bounds final"),
    "first_arc_time": _signature("t x p bounds final"),
}
"""Additional functions of a minimum-time problem whose switching curve is known in closed form."""
LINEAR = {
    "state_matrix": _of_parameters("t p", "nn"),
    "input_matrix": _of_parameters("t p", "nm"),
    "output_matrix": _of_parameters("t p", "on"),
    "feedthrough_matrix": _of_parameters("t p", "om"),
    "deviation_dynamics": _signature("t x u p", "n"),
    "original_state": _signature("t x p", "n"),
    "deviation_state": _signature("t original p", "n"),
    "characteristic_polynomial": _of_parameters("p", "g"),
    "routh_column": _of_parameters("p", "g"),
    "eigenvalues": _of_parameters("p", "nw"),
    "transition_matrix": _of_parameters("t p", "nn"),
    "closed_loop_polynomial": _of_parameters("gain p", "g"),
    "closed_loop_routh": _of_parameters("gain p", "g"),
    "riccati_residual": _of_parameters("riccati state_weight control_weight p", "nn"),
}
"""Functions of linear models; ``MODEL["linear"]`` names those that a model has.

Matrices among the arguments (``gain`` K, shape (m, n); ``riccati`` P; ``state_weight`` Q; ``control_weight`` R) are
given as sequences of their entries, row by row; in the batch form as arrays whose first axis counts the entries.
Eigenvalues are rows of a real and an imaginary part.
"""

POINTWISE = {
    **(_MOTION | _REFERENCE | _INVARIANTS | _POSITION | _QUANTITIES | _BALANCES | _KEPLERIAN | _COST),
    **(_SWITCHING | DIRECTIONS | THROTTLES | PATH_CONSTRAINTS | BOUNDARY_CONTROLS | INTERIOR | CURVE | LINEAR),
}
"""All functions of a single time that a model may have."""

_FORWARD = {"forward": _signature("times x0 u u_mid p x x_mid")}
_BACKWARD = {"backward": _signature("times lam_f x x_mid u u_mid p lam lam_mid")}
_SYMPLECTIC = {"symplectic": _signature("times x0 p x")}

LOOPS = _FORWARD | _BACKWARD | _SYMPLECTIC
"""Loops over the time steps of a trajectory.

Controls, states and costates are tables, with a sequence over time for each component.
"""


def pointwise(spec: ProblemSpec) -> dict[str, Signature]:
    """Return the signatures of all functions of one point in time for a model with this description."""
    found = dict(_MOTION)
    found |= _REFERENCE if spec.has_reference else {}
    found |= _INVARIANTS if spec.invariants else {}
    found |= _POSITION if spec.position else {}
    found |= _KEPLERIAN if spec.keplerian else {}
    found |= _QUANTITIES if spec.quantities else {}
    found |= _BALANCES if spec.balances else {}
    found |= {name: LINEAR[name] for name in spec.linear}
    found |= _COST if spec.has_cost else {}
    found |= DIRECTIONS if spec.directional else {}
    found |= THROTTLES if spec.throttled else {}
    found |= PATH_CONSTRAINTS if spec.path_constraints else {}
    found |= BOUNDARY_CONTROLS if spec.path_constraints and not spec.control_parts else {}
    found |= INTERIOR if spec.interior else {}
    if spec.switching:
        found = {name: signature for name, signature in found.items() if name not in _OF_REGULAR_LAWS} | _SWITCHING
        found |= CURVE if spec.switching_curve else {}
    return found


def loops(spec: ProblemSpec) -> dict[str, Signature]:
    """Return the signatures of the trajectory loops for a model with this description."""
    return _FORWARD | (_BACKWARD if spec.has_cost else {}) | (_SYMPLECTIC if spec.separable else {})


def sizes(spec: ProblemSpec) -> dict[str, int]:
    """Return the number that each letter of a shape stands for.

    States (n), controls (m), parameters (k), bounds (b; with what regularises a switching problem or directions),
    invariants (i), position components (q), constraints at the final time (c), choices and targets there (f), states
    and costates (z), residuals at the final time (e) and unknowns there (v); outputs (o), coefficients of the
    characteristic polynomial (g), parts of a complex number (w); position, velocity and gravitational parameter in
    space (s); quantities (a), balances with their rates (y); vectors that may be none (r),
    constraints along the way (h), conditions at points on the way (j).
    """
    n, m, c = len(spec.states), len(spec.controls), len(spec.multipliers)
    counts = {"n": n, "m": m, "k": len(spec.parameters), "i": len(spec.invariants), "q": len(spec.position), "c": c}
    counts["b"] = {"box": 2 * m, "ball": 1}.get(spec.control_set or "free", 0) + spec.regularising
    counts["b"] += sum(part.bounds for part in spec.control_parts)
    counts["r"] = sum(part.branch in SWITCHED for part in spec.control_parts)
    counts["h"] = len(spec.path_constraints)
    counts["j"] = sum(point.conditions for point in spec.interior)
    counts |= {"o": len(spec.outputs), "g": n + 1, "w": 2, "s": 7}
    counts |= {"a": len(spec.quantities), "y": 2 * len(spec.balances)}
    return counts | {"f": 3 * n, "z": 2 * n, "e": n + c + 1, "v": 2 * n + c + 1}


def missing(spec: ProblemSpec, present: Collection[str]) -> list[str]:
    """Return the names of functions that a module with this description must have but lacks."""
    functions = pointwise(spec)
    return [name for name in (*functions, *loops(spec), *(f + BATCH for f in functions)) if name not in present]
