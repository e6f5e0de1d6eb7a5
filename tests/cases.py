"""Shipped instances with other numbers, as tests need them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec

from satsym import instance
from satsym.instance import Instance


def sweeping(case: Instance, **options: Any) -> Instance:
    """The same instance, to be swept for, with other solver options."""
    return replace(case, solver=msgspec.structs.replace(case.solver, method="sweep", **options))


def shipped(name: str, **options: Any) -> Instance:
    """A shipped instance, to be swept for, with other solver options."""
    return sweeping(instance.load(name), **options)


def parameters(case: Instance) -> dict[str, float]:
    """Parameters by name."""
    return dict(zip(case.model.spec.parameter_names, case.parameters, strict=True))


def with_parameters(case: Instance, **changed: float) -> Instance:
    """The same instance with other parameters."""
    values = parameters(case)
    assert set(changed) <= set(values)
    return replace(case, parameters=tuple((values | changed).values()))
