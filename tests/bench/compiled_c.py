"""orbit.c, compiled into a temporary folder and called through ctypes on the arrays that everyone uses."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from orbit import PARAMETERS, START, Array, Case
from peers import Missing, Runner


@dataclass(frozen=True)
class CRunner(Runner):
    """A runner that writes into ``left``: states at nodes and midpoints, shapes (4, N+1) and (4, N)."""

    left: tuple[Array, Array] = (np.empty(0), np.empty(0))


SOURCE = Path(__file__).with_name("orbit.c")


def compiler() -> str:
    """The C compiler: what CC says, or gcc, or cc."""
    found = shutil.which(os.environ.get("CC", "gcc")) or shutil.which("cc")
    if not found:
        raise Missing("no C compiler")
    return found


def handwritten(case: Case, flags: Sequence[str]) -> CRunner:
    """The trajectory by C."""
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "orbit.so"
        command = [compiler(), *flags, "-shared", "-fPIC", "-o", str(library), str(SOURCE)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Missing(f"{command[0]} {' '.join(flags)} fails: {done.stderr.strip().splitlines()[-1]}")
        forward = ctypes.CDLL(str(library)).forward
    forward.restype = ctypes.c_double
    x, x_mid = np.empty((4, case.steps + 1)), np.empty((4, case.steps))
    given = (case.times, np.array(START), case.u, case.u_mid, np.array(PARAMETERS), x, x_mid)
    arguments = [ctypes.c_long(case.steps), *(ctypes.c_void_p(a.ctypes.data) for a in given)]

    def run(_alive: object = given) -> float:  # C gets addresses only, so someone must keep the arrays
        return forward(*arguments)

    def final() -> Array:
        run()
        return x[:, -1].copy()

    return CRunner(run, final, left=(x, x_mid))
