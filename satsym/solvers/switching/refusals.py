"""Instances that are no switching problem that could be solved, each refused in a line."""

from __future__ import annotations

import numpy as np

from satsym.instance import Instance
from satsym.status import BadInput


def refuse(instance: Instance) -> None:
    """Look at an instance before anything is solved.

    Raises
    ------
    BadInput
        If a bound is missing, if no control is left to choose, if nothing costs anything, or if the motion starts
        where it is to end.
    """
    names = instance.model.spec.control_names
    for name, low, high in zip(names, instance.lower, instance.upper, strict=True):
        if not np.isfinite([low, high]).all():
            raise BadInput(
                f"{instance.called}: [control] {name}: the cost has no term in the square of this control, so "
                f"it needs both bounds; write {name} = [lower, upper]"
            )
    if instance.lower == instance.upper:
        raise BadInput(
            f"{instance.called}: [control]: the lower and upper bounds of every control are equal, so there is "
            "nothing to choose; widen the bounds of one control"
        )
    if instance.tf is not None and _free_of_charge(instance):
        raise BadInput(
            f'{instance.called}: [time] tf: with a given final time, all controls have the same cost; write tf = "free"'
        )
    if instance.tf is None and instance.final and _there(instance):
        raise BadInput(
            f"{instance.called}: [initial]: the initial state satisfies the final conditions, so the best "
            "final time is zero; change the initial state, or give a final time"
        )


def _free_of_charge(instance: Instance) -> bool:
    """Whether neither control nor state cost anything, as far as random states show."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    rng = np.random.default_rng(0)
    assert instance.tf is not None
    x = np.array([value or 1.0 for value in instance.initial])[:, None] * rng.uniform(0.5, 2.0, (n, 20))
    t = rng.uniform(instance.t0, instance.tf, 20)
    none, u = np.zeros((n, 20)), np.array(instance.upper)[:, None] * rng.uniform(0.0, 1.0, (len(instance.upper), 20))
    ends = [model.terminal_gradient(instance.tf, tuple(column), p) for column in x.T]
    costs = (
        model.switching_function_batch(t, x, none, p),
        model.magnitude_weight_batch(t, x, none, p),
        model.costate_rate_batch(t, x, u, none, p),
        ends,
    )
    return not any(np.any(cost) for cost in costs)


def _there(instance: Instance) -> bool:
    """Whether every given final state is the initial one."""
    for name, x in zip(instance.model.spec.state_names, instance.initial, strict=True):
        wanted = instance.final.get(name)
        if isinstance(wanted, str) or (wanted is not None and abs(wanted - x) > 1e-12 * max(abs(wanted), abs(x))):
            return False
    return True
