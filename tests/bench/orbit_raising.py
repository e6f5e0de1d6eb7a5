"""From a transfer orbit to the geostationary one in least time at 60 N, in modified equinoctial elements.

Lengths are in thousands of kilometres, times in hours, masses in kilograms. The mass falls steadily, for the thrust is
always full; the final longitude is free.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from sympy import cos, sin, sqrt

import satsym
from satsym.symbolic import Ball, FirstOrder, Problem, Variable, symbols_of, t

STATES = (
    Variable("p", "p", meaning="semilatus rectum", positive=True),
    Variable("ex", "e_x", meaning="eccentricity along the first axis"),
    Variable("ey", "e_y", meaning="eccentricity along the second axis"),
    Variable("hx", "h_x", meaning="half inclination about the first axis, as a tangent"),
    Variable("hy", "h_y", meaning="half inclination about the second axis, as a tangent"),
    Variable("Lo", r"\ell", meaning="true longitude"),
)
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}", meaning="direction of the thrust") for k in (1, 2, 3))
PARAMETERS = (
    Variable("mu", r"\mu", meaning="gravitational parameter", default=5165.8620912, positive=True),
    Variable("Tm", "T_m", meaning="thrust", default=777.6, positive=True),
    Variable("beta", r"\beta", meaning="mass flow per thrust", default=1.42e-2, positive=True),
    Variable("m0", "m_0", meaning="initial mass", default=1500.0, positive=True),
)
START = {"p": 11.625, "ex": 0.75, "ey": 0.0, "hx": 0.0612, "hy": 0.0, "Lo": 3.141592653589793}
END = {"p": 42.165, "ex": 0.0, "ey": 0.0, "hx": 0.0, "hy": 0.0}


@cache
def problem() -> Problem:
    """The problem: Gauss's equations, radial, transverse and normal."""
    p, ex, ey, hx, hy, lo = symbols_of(STATES)
    u1, u2, u3 = symbols_of(CONTROLS)
    mu, thrust, beta, m0 = symbols_of(PARAMETERS)
    a, pace, c, s = thrust / (m0 - beta * thrust * t), sqrt(p / mu), cos(lo), sin(lo)
    w, z, tilt = 1 + ex * c + ey * s, hx * s - hy * c, (1 + hx**2 + hy**2) / 2
    rates = {
        p: a * u2 * pace * 2 * p / w,
        ex: a * (u1 * pace * s + u2 * pace * (c + (ex + c) / w) - u3 * pace / w * z * ey),
        ey: a * (-u1 * pace * c + u2 * pace * (s + (ey + s) / w) + u3 * pace / w * z * ex),
        hx: a * u3 * pace / w * tilt * c,
        hy: a * u3 * pace / w * tilt * s,
        lo: w**2 / (p * pace) + a * u3 * pace / w * z,
    }
    motion = FirstOrder(
        name="elements",
        title="Modified equinoctial elements",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates=rates,
    )
    return Problem(
        name="orbit_raising",
        title="To the geostationary orbit in least time",
        model=motion,
        running_cost=1,
        control_sets={"thrust": Ball("u1", "u2", "u3")},
    )


def stated() -> Any:
    """The instance."""
    return satsym.Instance.of(problem(), initial=START, final=END, tf="free", control={"max_norm": 1.0})
