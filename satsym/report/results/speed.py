"""What ``satsym bench --json`` prints."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.report.results.objects import head_about
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.analysis.speed import Solved, Speed
    from satsym.instance import Instance
    from satsym.kernels import Kernels


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
