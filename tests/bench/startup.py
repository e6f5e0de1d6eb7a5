"""Subject 4: what is paid once, before anything is computed. Each sample is a fresh interpreter."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import Row, Table, missing
from timing import Samples

IMPORTS = (
    "numpy",
    "satsym.kernels",
    "satsym.solvers",
    "sympy",
    "scipy.integrate",
    "matplotlib.pyplot",
    "numba",
    "casadi",
)

COMPILED = (("trajectory", "forward"), ("sweep", "forward and backward"))
"""Functions of generated code that are compiled, and what they do."""

_IMPORT = """
from time import process_time
start = process_time()
import {module}
print(process_time() - start)
"""

_COMPILE = """
import sys
from time import process_time
sys.path.insert(0, {here!r})
import numba
from generated_code import sweep, trajectory
from orbit import case
start = process_time()
{function}(case(10), backend="numba").run()
print(process_time() - start)
"""


def startup(rounds: int = 3) -> Table:
    """Import times, and numba's first call with and without what it cached."""
    rows = [_row(f"import {module}", _IMPORT.format(module=module), rounds) for module in IMPORTS]
    here = str(Path(__file__).resolve().parent)
    for function, what in COMPILED:
        code = _COMPILE.format(here=here, function=function)
        with tempfile.TemporaryDirectory() as cache:
            first = _row(f"numba compiles {what}", code, 1, NUMBA_CACHE_DIR=cache)
            rows += [first, _row("  loads it from its cache", code, rounds, NUMBA_CACHE_DIR=cache)]
    return Table("4. Paid once, in a fresh interpreter: imports, and compiling", "seconds, processor", tuple(rows))


def _row(name: str, code: str, rounds: int, **environment: str) -> Row:
    seconds = []
    for _ in range(rounds):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | environment
        )
        if done.returncode:
            return missing(name, done.stderr.strip().splitlines()[-1])
        seconds.append(float(done.stdout))
    samples = Samples(tuple(seconds))
    return Row(name, samples.least, samples.middle)
