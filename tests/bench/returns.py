"""Random returns to an orbit, from nothing: how many are solved and certified, and whether other starts end lower.

`make bench-returns` takes all 10,000 easy and 2,000 hard ones in two processes, which is a matter of hours;
`python tests/bench/returns.py hard 100` the first hundred hard ones. Easy ones are solved and integrated again, hard
ones certified as well; `eight` compares hard ones with the best that eight other starts lead to. What is done is
kept below results/returns/: the same command goes on where it was broken off.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np
import records
from samples import EASY, HARD

from satsym.instance import Instance
from satsym.solvers import two_point
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.conditions import boundary_residual
from satsym.solvers.certificate.jacobi import conjugate
from satsym.solvers.certificate.reintegration.flow import flow
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point as scaled
from satsym.solvers.iteration import Limits, computed
from satsym.solvers.two_point import from_path

POPULATIONS = {"easy": EASY, "hard": HARD, "eight": HARD}
WORKERS = min(2, os.cpu_count() or 1)
STEPS, SECONDS = 100, 30.0
CHUNK = 5
COST_MARGIN = 1e-4
"""Relative difference of costs that counts: those of the eight starts are as rough as their meshes."""


@dataclass(frozen=True)
class Outcome:
    """Of one case: its number, what is wrong (nothing: solved), the residual, seconds, cost over the best of eight."""

    number: int
    fault: str
    residual: float
    seconds: float
    ratio: float


@np.errstate(all="ignore")
def solved(what: str, number: int) -> Outcome:
    """Solve one case and look at it."""
    case = POPULATIONS[what].case(number)
    begun = time.process_time()
    found = two_point.solve(case)
    seconds = time.process_time() - begun
    if not found.status.answered:
        return Outcome(number, f"{found.status.value}: {found.message}", float("inf"), seconds, float("nan"))
    again = flow(found)
    if again is None or again.x[0].min() <= 0.0:
        return Outcome(number, "leaves the domain", float("inf"), seconds, float("nan"))
    residual = boundary_residual(found, again)
    fault = "" if residual < 1e-9 else f"residual {residual:.0e}"
    field = conjugate(found, segments(found))
    if not fault and (field.time is not None or not field.resolved):
        fault = "conjugate time"
    ratio = float("nan")
    if what == "hard":
        certificate = certify(found)
        if not fault and (certificate is None or certificate.verdict != "certified"):
            fault = "not certified"
    if what == "eight":
        ratio = found.objective / best_of_eight(case)
    return Outcome(number, fault, residual, seconds, ratio)


def best_of_eight(case: Instance) -> float:
    """The least cost to which eight starts lead, each minimised for itself; infinite if none leads anywhere."""
    assert case.tf is not None
    problem = scaled(case, case.tf - case.t0).relaxed(float("inf"))
    best = float("inf")
    for start in eight(problem):
        found = from_path(problem, start, Limits(STEPS, computed() + SECONDS), STEPS)
        if found.minimum:
            best = min(best, found.cost * problem.scale.cost)
    return best


def eight(problem: TwoPoint) -> Iterator[Callable[[np.ndarray], np.ndarray]]:
    """The straight line and seven bent ones."""
    line = paths.first(problem)
    for waves, bend in ((1, 0.0), (1, -0.3), (1, -0.6), (1, 0.3), (1, 0.6), (2, -0.4), (2, 0.4), (3, 0.4)):
        yield partial(_bent, line, waves, bend)


def _bent(line: Callable[[np.ndarray], np.ndarray], waves: int, bend: float, tau: np.ndarray) -> np.ndarray:
    states = line(tau)
    states[0] *= np.exp(bend * np.sin(waves * np.pi * tau))
    return states


def recorded(path: Path) -> list[Outcome]:
    """The outcomes of cases looked at before."""
    return [
        Outcome(int(row["number"]), row["fault"], *(float(row[name]) for name in ("residual", "seconds", "ratio")))
        for row in records.read(path)
    ]


def run(what: str, count: int) -> None:
    """Solve the first cases in two processes, and print what came of it."""
    path = records.place(what)
    outcomes = [outcome for outcome in recorded(path) if outcome.number < count]
    left = sorted(set(range(count)) - {outcome.number for outcome in outcomes})
    with ProcessPoolExecutor(WORKERS) as pool:
        for outcome in pool.map(partial(solved, what), left, chunksize=CHUNK):
            outcomes.append(outcome)
            records.add(path, asdict(outcome))
            if sys.stderr.isatty():
                print(f"\r{what}: {len(outcomes)} of {count}", end="", file=sys.stderr, flush=True)
    for outcome in outcomes:
        if outcome.fault:
            print(f"{what} {outcome.number}: {outcome.fault}")
    seconds = np.array([o.seconds for o in outcomes])
    residuals = np.array([o.residual for o in outcomes])
    faultless = sum(not o.fault for o in outcomes)
    print(f"{what}: {faultless} of {count} faultless ({faultless / count:.2%})")
    print(f"  residual on re-integration: median {np.median(residuals):.0e}, worst {residuals.max():.0e}")
    worst = f"99 % below {np.quantile(seconds, 0.99):.2f} s, worst {seconds.max():.1f} s"
    print(f"  seconds of processor time: median {np.median(seconds):.3f}, mean {seconds.mean():.3f}, {worst}")
    ratios = np.array([o.ratio for o in outcomes])
    if not np.isnan(ratios).all():
        known = ratios[~np.isnan(ratios)]
        good, better = (known < 1.0 + COST_MARGIN).mean(), (known < 1.0 - COST_MARGIN).mean()
        print(f"  no costlier than the best of eight starts: {good:.2%} (cheaper: {better:.2%})")


def main() -> None:
    """What the command line says, and how many; or everything."""
    arguments = sys.argv[1:] or ["easy", str(EASY.size), "hard", str(HARD.size), "eight", str(HARD.size)]
    for what, count in zip(arguments[::2], arguments[1::2], strict=True):
        run(what, int(count))


if __name__ == "__main__":
    main()
