"""Runge-Kutta formulas as the ITS documents print them, stage by stage, beside the textbook's.

Each is a function of what the documents let it depend on; measured is the order of the method that has one printed
stage (or the printed sum, or all of them) in the place of the textbook's. Textbook: Hairer, Norsett and Wanner,
Solving Ordinary Differential Equations I, II.1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = NDArray[np.float64]
Field: TypeAlias = Callable[[float, Vector], Vector]
"""y' = f(t, y)."""

StageArgument: TypeAlias = Callable[[float, float, Vector, Sequence[Vector]], tuple[float, Vector]]
"""(t, h, y, earlier stages) -> where f is evaluated. The step h is negative on the way back."""


@dataclass(frozen=True)
class Method:
    """An explicit method of four stages.

    Attributes
    ----------
    arguments
        Where each stage evaluates f.
    total
        (h, stages) -> what is added to y.
    scaled
        Whether a stage is h f instead of f.
    """

    arguments: tuple[StageArgument, StageArgument, StageArgument, StageArgument]
    total: Callable[[float, Sequence[Vector]], Vector]
    scaled: bool

    def step(self, f: Field, t: float, y: Vector, h: float) -> Vector:
        """One step from (t, y)."""
        stages: list[Vector] = []
        for argument in self.arguments:
            slope = f(*argument(t, h, y, stages))
            stages.append(h * slope if self.scaled else slope)
        return y + self.total(h, stages)


TEXTBOOK = Method(
    (
        lambda t, h, y, k: (t, y),
        lambda t, h, y, k: (t + h / 2, y + h * k[0] / 2),
        lambda t, h, y, k: (t + h / 2, y + h * k[1] / 2),
        lambda t, h, y, k: (t + h, y + h * k[2]),
    ),
    lambda h, k: h / 6 * (k[0] + 2 * k[1] + 2 * k[2] + k[3]),
    scaled=False,
)
TEXTBOOK_SCALED = Method(
    (
        lambda t, h, y, k: (t, y),
        lambda t, h, y, k: (t + h / 2, y + k[0] / 2),
        lambda t, h, y, k: (t + h / 2, y + k[1] / 2),
        lambda t, h, y, k: (t + h, y + k[2]),
    ),
    lambda h, k: (k[0] + 2 * k[1] + 2 * k[2] + k[3]) / 6,
    scaled=True,
)

GENERAL = Method(
    # (2.19) of the thesis and (17) to (21) of the paper: k1 is a slope, and half of it is added to y
    (
        lambda t, h, y, k: (t, y),
        lambda t, h, y, k: (t + h / 2, y + k[0] / 2),
        lambda t, h, y, k: (t + h / 2, y + k[1] / 2),
        lambda t, h, y, k: (t + h, y + k[2]),
    ),
    lambda h, k: h / 6 * (k[0] + 2 * k[1] + 2 * k[2] + k[3]),
    scaled=False,
)
SWEEP = Method(
    # section 4.4, forwards and backwards: h is inside the stages; t stands for the node n whose states (on the way
    # back) and controls all four stages take
    (
        lambda t, h, y, k: (t, y),
        lambda t, h, y, k: (t, y + k[0] / 2),
        lambda t, h, y, k: (t, y + k[1] / 2),
        lambda t, h, y, k: (t, y + k[2]),
    ),
    lambda h, k: (k[0] + 2 * k[1] + 2 * k[2] + k[3]) / 6,
    scaled=True,
)


def replaced(textbook: Method, printed: Method, stage: int | None) -> Method:
    """The textbook's method with one stage (1 to 4) as printed, with the sum as printed (0), or with all (None)."""
    if stage is None:
        return printed
    if stage == 0:
        return Method(textbook.arguments, printed.total, textbook.scaled)
    arguments = list(textbook.arguments)
    arguments[stage - 1] = printed.arguments[stage - 1]
    return Method(tuple(arguments), textbook.total, textbook.scaled)  # type: ignore[arg-type]


def march(step: Callable[[float, Vector, float], Vector], t: float, y: Vector, h: float, count: int) -> Vector:
    """So many equal steps from (t, y)."""
    for i in range(count):
        y = step(t + i * h, y, h)
    return y


def order(error_of: Callable[[int], float], counts: Sequence[int]) -> tuple[float, list[float]]:
    """The order that the errors show at the last doubling of the number of steps, and the errors themselves."""
    errors = [error_of(n) for n in counts]
    last, before = errors[-1], errors[-2]
    if not (math.isfinite(last) and math.isfinite(before)) or last <= 0.0:
        return math.nan, errors
    return math.log(before / last) / math.log(counts[-1] / counts[-2]), errors
