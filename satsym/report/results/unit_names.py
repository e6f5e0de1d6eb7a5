"""Units of what results hold, as text: of time, and of what is counted in the cost."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from satsym import units as expressions
from satsym.report import display

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from satsym.spec import ProblemSpec

COST = "cost"
"""The unit of J where it does not follow from the units of the model."""


def time_unit(spec: ProblemSpec) -> str:
    """The unit of time as the model's units spell it; nothing where they do not agree on one.

    That of parameters counts where no state and no control has any. Found by the words alone: asking pint costs more
    than solving.
    """
    found = (display.time_unit(v.unit for v in each) for each in ((*spec.states, *spec.controls), spec.parameters))
    return next((unit for unit in found if unit != "1"), "")


def cost_per(unit: str, spec: ProblemSpec) -> str:
    """The unit of a costate: of the cost, per unit of the state."""
    return per(spec.objective_unit or COST, unit) or COST


def of_regulator(spec: ProblemSpec, inputs: Collection[str], relative: bool) -> str:
    """The unit of what a regulator minimises; :data:`COST` where inputs of different units share a plain weight.

    Parameters
    ----------
    inputs
        Names of the active controls.
    relative
        Whether states and inputs count relative to allowed deviations. Else R is taken for plain numbers, which
        leaves the unit of the inputs squared by time, and what Q has of units makes its terms the same.
    """
    time = time_unit(spec) or "1"
    shared = {v.unit for v in spec.controls if v.symbol in inputs}
    if relative:
        return time
    if len(shared) > 1:
        return COST
    return times(time, *2 * [*shared])


def times(*units: str) -> str:
    """The product of units, shortened."""
    total = Counter[str]()
    for unit in units:
        total.update(expressions.factors(unit))
    return expressions.expression(total)


def per(unit: str, other: str | None) -> str | None:
    """A unit by another one, shortened; ``None`` where that is not clear."""
    if other is None:
        return None
    total = Counter(expressions.factors(unit))
    total.subtract(expressions.factors(other))
    return expressions.expression(total)


def units(spec: ProblemSpec) -> dict[str, str | None]:
    """Unit of each state, control, invariant and costate by name, of the time ``t`` and of the ``objective``.

    Names are those of trajectory.csv; ``"1"`` for a plain number, ``None`` where a unit is not clear.
    """
    plain = all(v.unit == "1" for v in (*spec.states, *spec.controls))
    found: dict[str, str | None] = {"t": time_unit(spec) or ("1" if plain else None)}
    found |= {v.symbol: v.unit for v in (*spec.states, *spec.controls, *spec.invariants)}
    if spec.has_cost:
        found |= {f"lambda_{v.symbol}": cost_per(v.unit, spec) for v in spec.states}
        found["objective"] = spec.objective_unit or COST
    return found


def with_units(names: Sequence[str], known: Mapping[str, str | None]) -> list[str]:
    """Names of columns with their units in brackets, but for plain numbers and what has none that is clear."""
    return [f"{name} [{unit}]" if (unit := known.get(name)) and unit != "1" else name for name in names]
