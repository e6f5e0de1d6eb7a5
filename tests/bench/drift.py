"""Energy over many revolutions, for each integrator: ``python tests/bench/drift.py [REVOLUTIONS]``, by default 10,000.

RK4 and the symplectic loop have as many evaluations a revolution as each other; DOP853 has its tolerance. That one
takes some minutes for 10,000 revolutions, because SciPy's steps are Python's.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from time import process_time

from orbit_drift import CLOSED_FORM, INTEGRATORS, TOLERANCE, WORK, Drift, drift

from satsym import instance

REVOLUTIONS = 10_000.0
INSTANCES = ("itb-earth", "molniya")
HEAD = f"  {'':<12}  {'trend':>8}  {'swing':>8}  {'momentum':>8}  {'position':>8}  {'seconds':>8}"


def main() -> None:
    """Print a table an orbit."""
    revolutions = float(sys.argv[1]) if len(sys.argv) > 1 else REVOLUTIONS
    print(f"{revolutions:g} revolutions; RK4 and symplectic: {WORK} evaluations each; DOP853: tolerance {TOLERANCE:g}")
    print("trend: relative change of the energy, by the line of least squares; swing: the most it is off that line")
    print("momentum: relative change of the vector; position: off the closed form at the end, relative to the distance")
    print("closed form: from sample to sample, against the whole way at once")
    for name in INSTANCES:
        case = instance.load(name)
        case = replace(case, model=case.model.compiled())
        print(f"\n{name}: {case.title}\n{HEAD}", flush=True)
        for integrator, advance in INTEGRATORS.items():
            begun = process_time()
            found = drift(case, revolutions, integrators={integrator: advance})
            seconds = process_time() - begun
            _print(integrator, found[integrator], f"{seconds:8.1f}")
        _print(CLOSED_FORM, found[CLOSED_FORM], "")


def _print(name: str, run: Drift, seconds: str) -> None:
    numbers = f"{run.trend:>+8.0e}  {run.swing:>8.0e}  {run.momentum.max():>8.0e}  {run.position[-1]:>8.0e}"
    print(f"  {name:<12}  {numbers}  {seconds}".rstrip(), flush=True)


if __name__ == "__main__":
    main()
