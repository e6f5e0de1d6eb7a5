"""Linearisation of a model on its reference or at an equilibrium, and the resulting linear system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from satsym.analysis.linear.rational import exact_matrices
from satsym.analysis.linear.system import LinearSystem, Scaled, scaled, system
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.kernels.contract import BATCH
from satsym.kernels.core import Function
from satsym.spec import names
from satsym.status import BadInput

AT_REST = 1e-9
"""Rates below this value, relative to the terms they consist of, are zero."""
POLISHING = 3
"""Number of steps of Newton's method after the search for an equilibrium."""
ENTRY_TOLERANCE = 1e-9
"""Largest difference of equal entries of A and B, in suitable units."""
LOOKED_AT = (0.0, 0.37, 1.21, 2.9)
"""Times at which coefficients are compared to decide whether they are constant, in units of 1/|A|."""
EXACT = "deviation_dynamics"
"""Name of the generated function of a linear model with the exact motion in its variables."""
SHIFTS = (-0.3, 0.1, 0.7)
"""Displacements from the motion at which exact and linear rates are compared, relative to the size of the states."""


@dataclass(frozen=True, eq=False)
class Linearisation:
    """A model linearised about a known motion without control."""

    model: Kernels
    parameters: tuple[float, ...]
    t0: float
    """The linearised model, its parameters, and the initial time."""
    point: Array
    """The reference at t0, or the equilibrium; shape (n,)."""
    on_reference: bool
    """Whether the point lies on the model's reference; otherwise it is an equilibrium."""
    system: LinearSystem
    """The linear system at t0, whose states, inputs and outputs are deviations."""
    constant: bool
    """Whether the coefficients of the linear system are constant."""
    nonlinear: bool
    """Whether the exact motion is known, too, and is not linear."""

    def at(self, t: float) -> Array:
        """Return the states of the reference motion at a time, shape (n,)."""
        return np.array(self.model.reference(t, self.parameters)) if self.on_reference else self.point

    def along(self, times: Array) -> Array:
        """Return the states of the reference motion at several times, shape (n, M)."""
        if not self.on_reference:
            return np.repeat(self.point[:, None], len(times), axis=1)
        return self.model.reference_batch(times, self.parameters)

    @property
    def rates(self) -> Function:
        """Return the exact rates of change of the states, a function of t, x, u and p on plain floats."""
        return self.model.functions[_exact(self.model)]

    @property
    def rates_batch(self) -> Function:
        """Return the rates of change for arrays of states and controls whose last axis counts instances."""
        return self.model.functions[_exact(self.model) + BATCH]


def linearise(subject: Kernels | Instance) -> Linearisation:
    """Linearise a model, and return the linear system of small deviations.

    Parameters
    ----------
    subject
        An instance; or a model, for which its parameters take their defaults and the time is 0.

    Raises
    ------
    BadInput
        If the model has no reference, and no equilibrium is found from the initial state (or from zero), or it rests
        there for an instant only.
    """
    if isinstance(subject, Kernels):
        model, p, t0, where = subject, _defaults(subject), 0.0, subject.spec.name
        start = np.array([1.0 if state.positive else 0.0 for state in model.spec.states])
    else:
        model, p, t0, where = subject.model, subject.parameters, subject.t0, subject.name
        start = np.array(subject.initial)
    on_reference = model.spec.has_reference
    if on_reference:
        point = np.array(model.reference(t0, p))
    elif model.spec.linear:
        point = np.zeros(len(start))
    else:
        point = equilibrium(model, p, start, t0, where)
    spec, (A, B) = model.spec, jacobians(model, p, t0, point)
    found = Linearisation(
        model=model,
        parameters=p,
        t0=t0,
        point=point,
        on_reference=on_reference,
        system=system(
            A,
            B,
            *_outputs(model, p, t0),
            states=spec.state_names,
            inputs=spec.control_names,
            outputs=names(spec.outputs),
            name=spec.name,
            exact=exact_matrices(model, p, t0, point),
        ),
        constant=True,
        nonlinear=False,
    )
    unit = scaled(found.system)
    times = [t0 + ahead / (unit.rate * unit.size) for ahead in LOOKED_AT]
    if not (on_reference or spec.linear or all(_rests(model, p, unit, t, point) for t in times)):
        raise BadInput(
            f"{where}: the rates of the model vanish at ({', '.join(f'{v:.6g}' for v in point)}) only at t = "
            f"{t0:.6g}, so this point is not an equilibrium; declare a reference in the model, that is, an "
            "uncontrolled motion"
        )
    aside = [point + shift * (unit.states + np.abs(point)) for shift in SHIFTS]
    return replace(
        found,
        constant=all(_same(unit, found, t, found.at(t)) for t in times),
        nonlinear=_exact(model) == EXACT or not all(_same(unit, found, t, x) for t in times for x in aside),
    )


def _exact(model: Kernels) -> str:
    """Return the name of the generated function with the exact rates of a model."""
    return EXACT if EXACT in model.spec.linear else "dynamics"


def _outputs(model: Kernels, p: Sequence[float], t: float) -> tuple[Array | None, Array | None]:
    """Return C and D if the model declares outputs."""
    n, m, k = len(model.spec.states), len(model.spec.controls), len(model.spec.outputs)
    if not k:
        return None, None
    C = np.array(model.output_matrix(t, p)).reshape(k, n)
    return C, np.array(model.feedthrough_matrix(t, p)).reshape(k, m) if m else None


def _same(unit: Scaled, found: Linearisation, t: float, x: Array) -> bool:
    """Tell whether A and B at a time and state equal those of the linearisation."""
    A, B = jacobians(found.model, found.parameters, t, x)
    change = np.hstack([(A - found.system.A) * unit.states, (B - found.system.B) * unit.inputs])
    return bool((np.abs(change) / unit.states[:, None] <= ENTRY_TOLERANCE * unit.rate * unit.size).all())


def _rests(model: Kernels, p: Sequence[float], unit: Scaled, t: float, x: Array) -> bool:
    """Tell whether the model is at rest at a state at that time."""
    rates = np.array(model.dynamics(t, x.tolist(), (0.0,) * len(model.spec.controls), p))
    return bool((np.abs(rates) <= ENTRY_TOLERANCE * unit.rate * unit.size * (unit.states + np.abs(x))).all())


def equilibrium(model: Kernels, p: Sequence[float], start: Array, t: float = 0.0, where: str = "") -> Array:
    """Find a state at which the model rests without control.

    Parameters
    ----------
    start
        Initial point of the search, shape (n,).
    t
        Time, for models that depend on time.
    where
        Name of the model in messages.

    Returns
    -------
    array of shape (n,)

    Raises
    ------
    BadInput
        If none is found from there.
    """
    rest = (0.0,) * len(model.spec.controls)
    point, n = np.array(start, dtype=float), len(start)

    def rates(x: Array) -> Array:
        return np.array(model.dynamics(t, x.tolist(), rest, p))

    def slopes(x: Array) -> Array:
        return np.array(model.jacobian_x(t, x.tolist(), rest, p)).reshape(n, n)

    try:
        if rates(point).any():
            from scipy.optimize import root

            point = root(rates, point, jac=slopes, method="lm").x
            for _ in range(POLISHING):
                point = point - np.linalg.lstsq(slopes(point), rates(point), rcond=None)[0]
        A = slopes(point)
        left, size = np.abs(rates(point)), np.abs(A) @ (np.abs(point) + scaled(system(A)).states)
    except ArithmeticError:
        left, size = np.full(n, np.inf), np.zeros(n)
    if not ((left <= AT_REST * size).all() and model.in_domain(point)):
        raise BadInput(
            f"{where}: no equilibrium of {model.spec.name} was found from the initial point "
            f"({', '.join(f'{v:.6g}' for v in start)}); start near an equilibrium, or declare a reference in the model"
        )
    return point


def _defaults(model: Kernels) -> tuple[float, ...]:
    """Return the default parameters of a model."""
    missing = [v.symbol for v in model.spec.parameters if v.default is None]
    if missing:
        raise BadInput(
            f"{model.spec.name}: {', '.join(missing)} has no default; create an instance that sets this value, "
            "and use that instance in place of the model"
        )
    return tuple(float(v.default) for v in model.spec.parameters if v.default is not None)


def jacobians(model: Kernels, p: Sequence[float], t: float, x: Array) -> tuple[Array, Array]:
    """Return A = df/dx and B = df/du without control, of shapes (n, n) and (n, m).

    Raises
    ------
    BadInput
        If something is divided by zero there.
    """
    n, m = len(model.spec.states), len(model.spec.controls)
    arguments = (t, x.tolist(), (0.0,) * m, p)
    try:
        A, B = model.jacobian_x(*arguments), model.jacobian_u(*arguments)
    except ArithmeticError:
        raise BadInput(
            f"{model.spec.name}: cannot be linearised at t = {t:.6g}, because of a division by zero; "
            "create an instance with another t0"
        ) from None
    return np.array(A, dtype=float).reshape(n, n), np.array(B, dtype=float).reshape(n, m)
