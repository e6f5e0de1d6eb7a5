"""What an answer comes to, as a row of the record that `make parity` compares with."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.bench.unique import unique

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.solution import Certificate, Solution

NOTHING = 1e-6
"""Share of its terms below which a cost is a difference of these, and compared in their size."""

EXACT, ROUNDED, ROUGH = 15, 12, 3
"""Digits of costs, of costates and times, and of sizes."""

MESSAGE = 160
"""Letters of a message that are kept."""


def answer(loaded: Callable[[], Instance]) -> dict[str, Any]:
    """Read an instance and solve it; what came of it, and the seconds of the processor that this took.

    A message stands only where there is no answer; it is not compared.
    """
    from satsym.solvers import solve
    from satsym.status import BadInput

    began = time.process_time()
    try:
        solution = solve(loaded())
    except BadInput as error:
        return {"status": "refused", "said": str(error), "seconds": since(began)}
    seconds = since(began)
    if not solution.status.answered:
        return {"status": solution.status.value, "said": solution.message, "seconds": seconds}
    return {**row(solution), "seconds": seconds}


def since(began: float) -> float:
    """Seconds of the processor since then."""
    return rounded(time.process_time() - began, ROUGH)


def cut(message: str) -> str:
    """As much of a message as is kept, without where it is."""
    return " ".join(word for word in message.split() if "/" not in word)[:MESSAGE]


def row(solution: Solution) -> dict[str, Any]:
    """An answer. Sizes are the largest on the way, of each costate; switching times stand by control."""
    names, controls = solution.instance.model.spec.state_names, solution.instance.model.spec.control_names
    proof = solution.certificate
    cost, terms = solution.objective, size_of_terms(solution)
    found: dict[str, Any] = {
        "status": solution.status.value,
        "verdict": proof.verdict.value if proof else "none",
        "cost": rounded(cost, EXACT),
    }
    if abs(cost) <= NOTHING * terms:
        found["terms"] = rounded(terms, ROUGH)
    found["duration"] = rounded(float(solution.times[-1] - solution.times[0]), ROUNDED)
    found["unique"] = unique(solution)
    found["costates"] = {n: rounded(v, ROUNDED) for n, v in zip(names, solution.lam[:, 0].tolist(), strict=True)}
    found["sizes"] = [rounded(v, ROUGH) for v in np.abs(solution.lam).max(axis=1).tolist()]
    found["events"] = [[one.kind, one.name, rounded(one.t, ROUNDED)] for one in solution.events]
    switches = zip(controls, solution.switching_times, strict=False)
    found["switches"] = {name: [rounded(t, ROUNDED) for t in times] for name, times in switches if times}
    return found | (_compared(proof) if proof else {})


def _compared(proof: Certificate) -> dict[str, Any]:
    """What a solution was compared with: of each kind how many were solved, of how many."""
    return {
        "competitors": {one.kind.value: f"{one.solved}/{one.tried}" for one in proof.competitors},
        "not checked": [kind.value for kind in proof.not_checked],
    }


def size_of_terms(solution: Solution) -> float:
    """The cost at the end and that on the way, each without its sign."""
    case, t = solution.instance, solution.times
    with np.errstate(all="ignore"):
        running = case.model.running_cost_batch(t, solution.x, solution.u, case.parameters)
        total = float(np.trapezoid(np.abs(np.broadcast_to(running, t.shape)), t))
        end = case.model.terminal_cost(float(t[-1]), solution.x[:, -1].tolist(), case.parameters)
    return total + abs(float(end))


def rounded(value: float, digits: int) -> float:
    """A number with so many digits."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else value
