"""Shipped instances with other numbers, as tests need them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
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


TWO_BODY = """
model = "two_body"
[parameters]
mu = {mu}
[initial]
x = {x}
y = 0.0
z = 0.0
v_x = {v_x}
v_y = {v_y}
v_z = 0.0
[time]
tf = {tf}
"""


def two_body_case(
    folder: Path, mu: object = 1.0, x: object = 1.0, v_x: object = 0.0, v_y: object = 1.0, tf: object = 2.0
) -> Path:
    """The file of an instance of two bodies, with values as they are written."""
    path = folder / "case.toml"
    path.write_text(TWO_BODY.format(mu=mu, x=x, v_x=v_x, v_y=v_y, tf=tf), encoding="utf-8")
    return path
