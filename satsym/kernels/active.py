"""Models in which some inequalities at the end are active: these are treated as constraints, the others are left out.

Inequalities have multipliers and rows of the boundary functions like constraints. Without those of the inactive ones,
the problem is that with the active ones stated as constraints.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from satsym.kernels.core import Function, Kernels


@dataclass(frozen=True, eq=False)
class Active(Kernels):
    """Kernels in which some of a model's inequalities at the end are constraints."""

    whole: Kernels | None = None
    """The kernels with all inequality constraints as they were stated, before the active ones were substituted."""
    names: frozenset[str] = frozenset()
    """Names of the constraints that are active."""

    def compiled(self) -> Kernels:
        """Return the compiled kernels; rows are left out in Python."""
        return self if self.backend == "numba" else with_active(stated(self).compiled(), self.names)


def stated(model: Kernels) -> Kernels:
    """Return the model with all of its inequalities at the end."""
    return model.whole if isinstance(model, Active) and model.whole is not None else model


def with_active(model: Kernels, names: Iterable[str]) -> Kernels:
    """Return a model with the named inequalities at the end as constraints, and no others."""
    whole, chosen = stated(model), frozenset(names)
    spec, n, c = whole.spec, len(whole.spec.states), len(whole.spec.multipliers)
    if not spec.terminal_inequalities:
        return whole
    first = c - len(spec.terminal_inequalities)
    kept = [*range(first), *(first + k for k, name in enumerate(spec.terminal_inequalities) if name in chosen)]
    rows = [*range(n), *(n + k for k in kept), n + c]
    columns = [*range(2 * n), *(2 * n + k for k in kept), 2 * n + c]
    entries = [row * (2 * n + c + 1) + column for row in rows for column in columns]
    functions = dict(whole.functions)
    for name, wanted, table in (("boundary", rows, (rows,)), ("boundary_jacobian", entries, np.ix_(rows, columns))):
        functions[name] = _with_fewer(whole.functions[name], c, kept, wanted)
        functions[f"{name}_batch"] = _with_fewer_in_batches(whole.functions[f"{name}_batch"], c, kept, table)
    return Active(
        spec=replace(spec, multipliers=tuple(spec.multipliers[k] for k in kept), terminal_inequalities=()),
        functions=functions,
        backend=whole.backend,
        whole=whole,
        names=chosen,
    )


def _with_fewer(function: Function, count: int, kept: list[int], wanted: list[int]) -> Function:
    """Return a boundary function with fewer multipliers and fewer entries."""

    def fewer(t: Any, x: Any, lam: Any, nu: Any, *others: Any) -> tuple[Any, ...]:
        found = function(t, x, lam, _padded(nu, count, kept), *others)
        return tuple(found[k] for k in wanted)

    return fewer


def _with_fewer_in_batches(function: Function, count: int, kept: list[int], wanted: tuple[Any, ...]) -> Function:
    """Leave out rows of a batch form that belong to constraints which are not active."""

    def fewer(t: Any, x: Any, lam: Any, nu: Any, *others: Any, out: Any = None) -> Any:
        found = np.asarray(function(t, x, lam, _padded(nu, count, kept), *others))[wanted]
        if out is None:
            return found
        out[...] = found
        return out

    return fewer


def _padded(nu: Any, count: int, kept: list[int]) -> tuple[Any, ...]:
    """Return multipliers of all rows, zero for the rows that are left out."""
    given = dict(zip(kept, nu, strict=True))
    return tuple(given.get(k, 0.0) for k in range(count))
