"""How fast a machine is, as plain text."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.report.results.objects import head_about
from satsym.report.said import say
from satsym.report.terminal.table import figure, table, wrapped
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.analysis.speed import Solved, Speed
    from satsym.instance import Instance
    from satsym.kernels import Kernels


BACKENDS = {"numpy": "NumPy", "numba": "numba"}


def backend_name(backend: str) -> str:
    """What computes, as it calls itself."""
    return BACKENDS[backend]


def speed_text(found: Mapping[str, Any]) -> str:
    """Summary of what ``satsym bench`` measured, from its object."""
    machine, steps, solve = found["machine"], found["steps"], found["solve"]
    first = steps[0]["per_second"]
    rows = [(say("what"), say("cores"), say("a second"), say("of the first"))]
    for one in steps:
        name = say("steps of one motion, <backend>", backend=backend_name(one["backend"]))
        rows.append((name, str(one["cores"]), figure(one["per_second"], 3), f"{one['per_second'] / first:.3g}"))
    if solve is not None:
        name = say("solutions, <method>", method=solve["method"])
        rows.append((name, "1", figure(1.0 / solve["solve_s"], 3), ""))
        if solve["certificate_s"] is not None:
            rows.append((say("certificates"), "1", figure(1.0 / solve["certificate_s"], 3), ""))
    lines = [
        f"{found['instance'] or found['model']}, {machine['system']} {machine['processor']}, "
        f"Python {machine['python']}, numpy {machine['numpy']}",
        "",
        *table(rows, right=(1, 2, 3)),
    ]
    if solve is not None and solve["certificate_s"] is None:
        lines += ["", *wrapped(say("the instance has no answer: <said_status>", said_status=found["status"]))]
    if all(one["backend"] == "numpy" for one in steps):
        lines += ["", *wrapped(say("numba is not installed: pip install 'satsym[fast]'"))]
    return "\n".join(lines)


def speed_object(given: Instance | Kernels, speeds: Sequence[Speed], solved: Solved | None) -> dict[str, Any]:
    """The machine, steps a second by each means, and the times of one solution; ``solve`` is ``None`` without one."""
    from satsym.analysis.speed import cores

    solution = None
    if solved is not None:
        solution = {
            "method": solved.method,
            "solve_s": solved.seconds,
            "certificate_s": solved.certificate_seconds,
        }
    return head_about("bench", given, Status.CONVERGED if solved is None else solved.status) | {
        "machine": {
            "system": platform.system(),
            "processor": platform.machine(),
            "cores": cores(),
            "python": platform.python_version(),
            "numpy": np.__version__,
        },
        "steps": [{"backend": one.backend, "cores": one.cores, "per_second": one.steps} for one in speeds],
        "solve": solution,
    }
