"""The optional tables [solver], [lqr] and [guess] of an instance, checked against its model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from satsym.instance import weights
from satsym.instance.resolve import known, quantity, time, value_of
from satsym.instance.schema import GuessTable, LqrTable, SolverOptions
from satsym.instance.types import Guess, LqrOptions
from satsym.methods import possible
from satsym.spec import ProblemSpec, Variable
from satsym.status import BadInput
from satsym.wording import shown

Row = tuple[float, ...]
Weights = Sequence[float | Sequence[float]]


def solver(options: SolverOptions, spec: ProblemSpec) -> SolverOptions:
    """Return the solver options after checks that they fit together and name angles of the model."""
    if options.relaxation is not None and not any(method.relaxed for method in possible(options.method)):
        raise BadInput(
            '[solver] relaxation: only the sweep method uses relaxation; remove it, or write method = "sweep"'
        )
    angles = [v for v in spec.states if v.kind == "angle"]
    for name in options.free_angles:
        if name not in [v.symbol for v in angles]:
            have = ", ".join(v.symbol for v in angles) or "none"
            raise BadInput(
                f"[solver] free_angles: {shown(name)} is not a state that is an angle; available angles: {have}"
            )
    _no_repetition(options.free_angles, "[solver] free_angles")
    refuse_too_many_steps(options, spec)
    return options


def lqr(table: LqrTable | None, spec: ProblemSpec) -> LqrOptions | None:
    """Return the weights as full matrices, after checks of shape, symmetry and the sign of R."""
    if table is None:
        return None
    inputs = spec.control_names if table.inputs is None else table.inputs
    for name in inputs:
        if name not in spec.control_names:
            have = ", ".join(spec.control_names) or "none"
            raise BadInput(f"[lqr] inputs: the model has no control {shown(name)}; available controls: {have}")
    _no_repetition(inputs, "[lqr] inputs")
    if not inputs:
        raise BadInput("[lqr] inputs: no control input remains; name at least one control")
    horizon = None if table.horizon is None else time(table.horizon, "[lqr] horizon", spec)
    if horizon is not None and horizon <= 0:
        raise BadInput(f"[lqr] horizon: {shown(table.horizon)} is not positive; give a length of time, or remove it")
    Q, R = _weights(table, spec, [spec.controls[spec.control_names.index(name)] for name in inputs])
    q, r, n = weights.checked(Q, R, table.N, len(spec.states), len(inputs))
    return LqrOptions(Q=q, R=r, inputs=tuple(inputs), horizon=horizon, relative=bool(table.allowed), N=n)


def _weights(table: LqrTable, spec: ProblemSpec, inputs: Sequence[Variable]) -> tuple[Weights, Weights]:
    """Return Q and R as written, or from allowed deviations."""
    if table.allowed:
        for name, given in (("Q", table.Q), ("R", table.R), ("N", table.N)):
            if given is not None:
                raise BadInput(f"[lqr] {name}: [lqr.allowed] already gives the weights; remove one of the two")
        return weights.from_allowed(table.allowed, spec.states, inputs)
    if table.Q is None or table.R is None:
        name, of = ("Q", "states") if table.Q is None else ("R", "inputs")
        raise BadInput(
            f"[lqr] {name}: missing; specify the weights of the {of}, or allowed deviations in [lqr.allowed]"
        )
    return table.Q, table.R


def guess(table: GuessTable, spec: ProblemSpec) -> Guess:
    """Return guessed series by name, in the model's units; costates have no unit of their own."""
    known(table.parameter, spec.parameters, "parameter", "guess.parameter")
    return Guess(
        state=_series(table.state, spec.states, "state"),
        costate=_series(table.costate, spec.states, "costate"),
        control=_series(table.control, spec.controls, "control"),
    )


def _series(
    table: Mapping[str, float | str | list[float | str]], variables: Sequence[Variable], what: str
) -> dict[str, Row]:
    known(table, variables, what, f"guess.{what}")
    return {v.symbol: _values(table[v.symbol], v, what) for v in variables if v.symbol in table}


def _values(value: float | str | list[float | str], variable: Variable, what: str) -> Row:
    key = f"[guess.{what}] {variable.symbol}"
    values = value if isinstance(value, list) else [value]
    if not values:
        raise BadInput(f"{key}: an empty list; give at least one number, or remove it")
    if what == "costate":
        for entry in values:
            if isinstance(entry, str):
                raise BadInput(f"{key}: {shown(entry)} is text; give a costate as a number without a unit")
        return tuple(quantity(entry, "1", key) for entry in values)
    return tuple(value_of(variable, entry, key) for entry in values)


def _no_repetition(names: Sequence[str], key: str) -> None:
    for name in names:
        if names.count(name) > 1:
            raise BadInput(f"{key}: {shown(name)} is listed twice; list each control only once")


MOST_BYTES = 2**31

_BYTES = 8
"""Size of a floating-point number in bytes."""


def needed_memory(options: SolverOptions, spec: ProblemSpec) -> int:
    """Estimate an upper bound of the memory in bytes, from the number of steps.

    The estimate depends on nothing but the instance, so that an instance is refused on all machines or on none. It is
    the measured maximum over solving, certifying, simulating and writing by all methods, rounded up.
    """
    return options.steps * _each(options, spec)


def refuse_too_many_steps(options: SolverOptions, spec: ProblemSpec) -> None:
    """Refuse a number of steps that needs more memory than allowed.

    Raises
    ------
    BadInput
        With the steps, the estimate and the limit.
    """
    needed = needed_memory(options, spec)
    if needed > MOST_BYTES:
        most = MOST_BYTES // _each(options, spec)
        raise BadInput(
            f"[solver] steps: {options.steps} steps of {spec.name} need about {_shown(needed)} of memory, above the "
            f"limit of {_shown(MOST_BYTES)}; use at most {most}"
        )


def _each(options: SolverOptions, spec: ProblemSpec) -> int:
    """Return the bytes for each step: flows and values at nodes, or the memory of a method."""
    n, m = len(spec.states), len(spec.controls)
    numbers = 10 * n * n + 10 * (n + m)
    if spec.has_cost:
        remembered = [method.remembers for method in possible(options.method)]
        numbers = max([numbers, *(by_state * n + by_control * m for by_state, by_control in remembered)])
    return _BYTES * numbers


def _shown(size: int) -> str:
    return f"{size / 1e9:.3g} GB"
