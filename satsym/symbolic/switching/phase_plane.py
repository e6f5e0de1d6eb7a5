"""Points of a phase plane: the switching curve, and trajectories that it leads to the target."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, sqrt

import sympy as sp

from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.motion.geometry import Place
from satsym.symbolic.switching import curve as switching_curve

FASTEST = 1.5
"""The largest rate in the picture."""
STARTS = ((-1.35, 0.35), (1.35, -0.35), (-0.75, -0.9), (0.75, 0.9))
"""Initial states of trajectories: positions, relative to that of the curve at the largest rate, and rates."""
POINTS = 24
"""Number of points of each arc."""


@dataclass(frozen=True)
class PhasePlane:
    """The contents of a phase plane about a target at rest, with the bounds and all parameters of size one.

    Attributes
    ----------
    position, rate, control
        Names of the states and of the control.
    rising, falling
        Names of the bounds under which the rate rises and falls, each beside the region where it applies.
    curve
        Points of the switching curve.
    trajectories
        For each trajectory, the points of its first arc and those of its second one.
    """

    position: str
    rate: str
    control: str
    rising: str
    falling: str
    curve: tuple[Place, ...]
    trajectories: tuple[tuple[tuple[Place, ...], tuple[Place, ...]], ...]


def phase_plane(derivation: Derivation) -> PhasePlane | None:
    """Follow the law of a derivation from a few states; ``None`` where it has no switching curve."""
    if switching_curve.CURVE not in derivation:
        return None
    chain = switching_curve.chain_of(derivation)
    assert chain is not None
    gain = abs(_at_one(derivation, chain.gain))
    slope = _at_one(derivation, chain.slope)

    def on_curve(rate: float) -> float:
        return -slope * rate * abs(rate) / (2 * gain)

    def arc(start: Place, push: float, until: float) -> tuple[Place, ...]:
        steps = (until * k / POINTS for k in range(POINTS + 1))
        return tuple((start[0] + slope * (start[1] * t + push * t**2 / 2), start[1] + push * t) for t in steps)

    def trajectory(share: float, rate: float) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
        start = (share * abs(on_curve(FASTEST)), rate)
        push = -copysign(gain, start[0] - on_curve(rate))
        # the first arc meets the curve at a rate w with w |w| / 2 = -(way), which is that of both arcs together
        met = copysign(sqrt(rate**2 / 2 - push * start[0] / slope), push)
        first = arc(start, push, (met - rate) / push)
        return first, arc(first[-1], -push, met / push)

    rates = (FASTEST * (k / POINTS - 1) for k in range(2 * POINTS + 1))
    return PhasePlane(
        chain.position.name,
        chain.rate.name,
        chain.control.name,
        chain.rising.name,
        chain.falling.name,
        tuple((on_curve(v), v) for v in rates),
        tuple(trajectory(*start) for start in STARTS),
    )


def _at_one(derivation: Derivation, constant: sp.Expr) -> float:
    """Return the value of a constant with all parameters of size one."""
    stated = sp.sympify(constant).xreplace(definitions_of(derivation.model))
    return float(stated.xreplace({s: sp.Integer(-1 if s.is_negative else 1) for s in stated.free_symbols}))
