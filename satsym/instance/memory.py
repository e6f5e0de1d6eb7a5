"""How much memory an instance asks for by its number of steps, known before any of it is taken.

The estimate depends on nothing but the instance, so that what one machine refuses no other accepts. It is what solving,
certifying, simulating and writing were measured to take at most, by all methods, rounded up.
"""

from __future__ import annotations

from satsym.instance.schema import SolverOptions
from satsym.methods import possible
from satsym.spec import ProblemSpec
from satsym.status import BadInput

MOST_BYTES = 2**31

_BYTES = 8
"""Of a number."""


def estimated(options: SolverOptions, spec: ProblemSpec) -> int:
    """Bytes that are taken at most, by the number of steps."""
    return options.steps * _each(options, spec)


def check(options: SolverOptions, spec: ProblemSpec) -> None:
    """Refuse steps that need more memory than there may be.

    Raises
    ------
    BadInput
        With the steps, the estimate and the limit.
    """
    needed = estimated(options, spec)
    if needed > MOST_BYTES:
        most = MOST_BYTES // _each(options, spec)
        raise BadInput(
            f"[solver] steps: {options.steps} steps of {spec.name} need about {_shown(needed)} of memory, above the "
            f"limit of {_shown(MOST_BYTES)}; use at most {most}"
        )


def _each(options: SolverOptions, spec: ProblemSpec) -> int:
    """Bytes for each step: flows of the canonical equations and what belongs to nodes, or what a method remembers."""
    n, m = len(spec.states), len(spec.controls)
    numbers = 10 * n * n + 10 * (n + m)
    if spec.has_cost:
        remembered = [method.remembers for method in possible(options.method)]
        numbers = max([numbers, *(by_state * n + by_control * m for by_state, by_control in remembered)])
    return _BYTES * numbers


def _shown(size: int) -> str:
    return f"{size / 1e9:.3g} GB"
