"""What can be said of moments of inertia, of modes, and of the transform of a step."""

from __future__ import annotations

import numpy as np

from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.pitch_axis import numbers

_SAME = 1e-6


@predicate
def possible_body(row: Question) -> Finding:
    """Whether a body can have these three moments of inertia: none exceeds the sum of the others."""
    values = numbers(row)
    found = sorted(values[name] for name in ("I_x", "I_y", "I_z"))
    return Finding(
        found[2] <= found[0] + found[1] and found[0] > values["I_wy"],
        f"{found[2]:g} is no more than {found[0]:g} + {found[1]:g}",
        {"excess": found[2] - found[0] - found[1]},
    )


@predicate
def mode_rate(row: Question) -> Finding:
    """Whether a printed left-hand side is that of a free damped mode: it vanishes for the mode's own motion.

    That is, for e^(-zeta w t) cos(w sqrt(1 - zeta^2) t) with damping ratio zeta and frequency w.
    """
    printed, worst = exact.expression(str(row.printed)), 0.0
    for zeta, w, time in ((0.05, 2.0, 0.7), (0.3, 0.8, 1.9), (0.7, 1.3, 0.4)):
        root = complex(-zeta * w, w * np.sqrt(1.0 - zeta**2))
        motion = [(root**k * np.exp(root * time)).real for k in range(3)]
        values = dict(zip(("eta", "eta_dot", "eta_ddot"), motion, strict=True)) | {"zeta": zeta, "w_n": w}
        worst = max(worst, abs(exact.number(printed, values)))
    return Finding(worst < _SAME, f"it vanishes but for {worst:.0e}", {"largest value": worst})


@predicate
def transform_of_step(row: Question) -> Finding:
    """Whether a printed function of s is the transform of a step of height P_c at time 0, by quadrature."""
    from scipy.integrate import quad

    printed, worst = exact.expression(str(row.printed)), 0.0
    for s, step in ((0.5, 0.025), (2.0, 1.3)):
        found = quad(lambda t, s=s, step=step: step * np.exp(-s * t), 0.0, np.inf)[0]
        values = {"s": s, "P_c": step}
        worst = max(worst, abs(found - exact.number(printed, values)))
    return Finding(worst < _SAME, f"the same but for {worst:.0e}", {"largest difference": worst})
