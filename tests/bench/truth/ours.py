"""satsym's answer to an instance, in a process of its own that can be ended when it takes too long."""

from __future__ import annotations

import math
import time
import traceback
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tests.bench.children import Child, serve
from tests.bench.truth.case import OWN, Case
from tests.bench.truth.physics import MODELS

SECONDS, PATIENCE = 600.0, 900.0
"""satsym's limit, generous so that an answer shows; and after how long an instance is given up, of the processor."""


class Worker:
    """A process that solves one instance after the other; ended and begun anew when it takes too long."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.child = Child("tests.bench.truth.ours", work=PATIENCE)

    def solve(self, case: Case) -> dict[str, Any]:
        """The row of one instance for the record."""
        row = self.child.ask([asdict(case), str(written(case, self.folder))])
        if "said" in row:
            row["message"] = row.pop("said")
        return row

    def end(self) -> None:
        """End the process."""
        self.child.end()


def written(case: Case, folder: Path) -> Path:
    """The instance file of a case, in a folder that has the bench's own models in ``models``."""
    path = folder / f"{case.family.replace(' ', '_').replace(',', '').replace(':', '')}-{case.number}.toml"
    path.write_text(case.text(case.model.startswith(OWN), SECONDS), encoding="utf-8")
    return path


def asked(question: list[Any]) -> dict[str, Any]:
    """The answer to a case and its file, as :class:`Worker` asks."""
    fields, path = question
    return answer(Case.of(fields), Path(path))


def answer(case: Case, path: Path) -> dict[str, Any]:
    """Solve an instance file with satsym; what came of it, with costs in the units of the case."""
    from satsym import instance
    from satsym import solvers as solve
    from satsym.status import BadInput

    wall, processor = time.perf_counter(), time.process_time()
    try:
        solution = solve.solve(instance.load(path))
    except BadInput as error:
        return {"status": "refused", "message": str(error)}
    except Exception:
        return {"status": "error", "message": traceback.format_exc()[-600:]}
    row: dict[str, Any] = {
        "status": solution.status.value,
        "message": solution.message[:300],
        "wall": round(time.perf_counter() - wall, 3),
        "processor": round(time.process_time() - processor, 3),
    }
    if not solution.status.answered:
        return row
    row |= {"cost": solution.objective / case.cost_unit, "duration": float(solution.times[-1]) / case.time - case.t0}
    certificate = solution.certificate
    if certificate is not None:
        row |= {
            "verdict": certificate.verdict.value,
            "failing": [f"{c.name}: {c.value:.2e} > {c.limit:.0e}" for c in certificate.checks if not c.passed],
            "kinds": [f"{c.kind.value} {c.solved}/{c.tried}" for c in certificate.competitors],
            "not checked": [kind.value for kind in certificate.not_checked],
        }
    return row | violations(case, solution)


def violations(case: Case, solution: Any) -> dict[str, float]:
    """How far its control, simulated once more by other equations, is from the end, the cost and the bounds."""
    physics = MODELS[case.model]
    p = physics.given(case.parameters)
    units = np.array([case.unit(name) for name in physics.states])
    thrust = np.array([case.unit(name) for name in physics.controls])
    times = np.asarray(solution.times) / case.time
    u = np.asarray(solution.u) / thrust[:, None]
    y = [*(case.initial[name] for name in physics.states), 0.0]
    with np.errstate(all="ignore"):
        try:
            for k in np.flatnonzero(np.diff(times) > 0.0):
                y = _step(physics, p, float(times[k]), float(times[k + 1] - times[k]), y, u[:, k], u[:, k + 1])
        except (ZeroDivisionError, OverflowError, ValueError):
            y = [math.nan] * len(y)
    x, tf = y[:-1], float(times[-1])
    sizes = np.maximum(1.0, np.abs(np.asarray(solution.x) / units[:, None]).max(axis=1))
    curve, missed = physics.reference(math, tf, p), 0.0
    for i, name in enumerate(physics.states):
        if name in case.final:
            value = case.final[name]
            off = x[i] - (curve[i] if isinstance(value, str) else value)
            if name in case.free_angles:
                off = math.remainder(off, 2.0 * math.pi)
            missed = max(missed, abs(off) / float(sizes[i])) if math.isfinite(off) else math.inf
    missed = max([missed, *(abs(end) for end in physics.ends(math, tf, x, p))])
    cost = y[-1] + physics.terminal(math, tf, x, p)
    stated = solution.objective / case.cost_unit
    return {
        "missed": missed,
        "off cost": abs(cost - stated) / max(abs(stated), 1e-6) if math.isfinite(cost) else math.inf,
        "out": max(_outside(case, u), _beyond(case, solution)),
    }


def _beyond(case: Case, solution: Any) -> float:
    """By how much its states leave what they must keep to, relative to their size."""
    physics = MODELS[case.model]
    p = physics.given(case.parameters)
    kept = [physics.kept(math, t, x, p) for t, x in zip(solution.times.tolist(), solution.x.T.tolist(), strict=True)]
    return max([g for row in kept for g in row], default=0.0) / max(1.0, float(np.abs(solution.x).max()))


def _step(physics: Any, p: Any, t: float, h: float, y: list[float], before: Any, after: Any) -> list[float]:
    """One step of RK4 with a control that is straight in between."""
    first, last = before.tolist(), after.tolist()
    middle = [(a + b) / 2.0 for a, b in zip(first, last, strict=True)]

    def rate(t: float, y: list[float], u: list[float]) -> list[float]:
        return [*physics.rate(math, t, y, u, p), physics.running(math, t, y, u, p)]

    k1 = rate(t, y, first)
    k2 = rate(t + h / 2.0, [a + h / 2.0 * b for a, b in zip(y, k1, strict=True)], middle)
    k3 = rate(t + h / 2.0, [a + h / 2.0 * b for a, b in zip(y, k2, strict=True)], middle)
    k4 = rate(t + h, [a + h * b for a, b in zip(y, k3, strict=True)], last)
    return [a + h / 6.0 * (b + 2.0 * c + 2.0 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4, strict=True)]


def _outside(case: Case, u: np.ndarray) -> float:
    """By how much the control leaves its set, relative to its size."""
    worst = 0.0
    for k, name in enumerate(MODELS[case.model].controls):
        low, high = case.bounds.get(name, (-math.inf, math.inf))
        worst = max(worst, float(low - u[k].min()), float(u[k].max() - high))
    if case.max_norm is not None:
        worst = max(worst, float(np.linalg.norm(u, axis=0).max()) - case.max_norm)
    return worst / max(float(np.abs(u).max()), 1e-12)


if __name__ == "__main__":
    serve(asked)
