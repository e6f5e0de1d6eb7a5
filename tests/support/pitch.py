"""The paper's pitch manoeuvre, and instances of it with other numbers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec

from satsym import instance
from satsym.instance import Instance

STEP, DAMPING, BODY, WHEEL, NOMINAL = 0.025, 0.01, 678.0, 0.09, 104.71976
"""Command, damping, moments of inertia of body and wheel, and nominal speed, in SI units."""


def classical(tf: float = 1500.0, **options: Any) -> Instance:
    """The shipped instance with other options of its law, and fewer steps."""
    case = instance.load("lapan-classical")
    assert case.classical is not None
    steps = msgspec.structs.replace(case.solver, steps=200)
    return replace(case, tf=tf, classical=replace(case.classical, **options), solver=steps)
