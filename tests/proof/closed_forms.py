"""A problem whose extremals, conjugate and focal points are known in closed form: L = (u^2 - q^2)/2, q' = u."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import sympy

import satsym
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.status import Status


@cache
def problem() -> Any:
    q, u = sympy.symbols("q u", real=True)
    motion = satsym.FirstOrder(
        name="soft_motion",
        title="A point that is moved",
        states=(satsym.Variable("q", "q"),),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: u},
    )
    return satsym.Problem(
        name="soft", title="A cost that falls with the distance", model=motion, running_cost=(u**2 - q**2) / 2
    )


def between(final: float | None, tf: float) -> tuple[Instance, Solution]:
    """From q = 1 to an end, or to a free one: the instance, and the extremal q'' = -q, lambda = -q'."""
    end = {} if final is None else {"q": final}
    case = satsym.Instance.of(problem(), initial={"q": 1.0}, final=end, tf=tf).case
    speed = np.tan(tf) if final is None else (final - np.cos(tf)) / np.sin(tf)
    return case, extremal(case, tf, speed)


def extremal(case: Instance, tf: float, speed: float) -> Solution:
    t = np.linspace(0.0, tf, 201)
    q, u = np.cos(t) + speed * np.sin(t), -np.sin(t) + speed * np.cos(t)
    return answer(case, t, q[None], u[None], -u[None])


def answer(case: Instance, t: Any, x: Any, u: Any, lam: Any) -> Solution:
    """What a solver would hand back."""
    none = tuple(() for _ in case.model.spec.controls)
    return Solution(case, "closed form", Status.CONVERGED, "", 0.0, t, x, u, lam, none, 0, (), 0.0)
