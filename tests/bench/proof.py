"""What is proved of the shipped instances, in which time, and of random extremals with and without conjugate points.

The table of the former is docs/proved.md; ``make bench-proof`` writes it anew.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from satsym import instance, solvers
from satsym.instance import Instance
from satsym.proof.proving import prove
from satsym.proof.record import Outcome, Proof
from satsym.solution import Solution
from satsym.status import Status

PAGE = Path(__file__).parents[2] / "docs" / "proved.md"
BEGIN, END = "<!-- table of proved optima -->\n", "<!-- end of the table -->\n"
SEED, RANDOM = 4, 100
HORIZONS = (6.0, 9.0, 12.0)
NEAREST = 0.2
"""Extremals that come nearer to the centre are drawn again."""
LARGEST = 0.25
"""Random costates at t0 are uniform between its negative and it, horizons one of the former."""


def of_shipped(names: Sequence[str]) -> list[tuple[str, Proof, float]]:
    """Proofs of those of these shipped instances that have a cost, each with the processor time of proving."""
    found = []
    for name in names:
        case = instance.load(name)
        if not case.model.spec.has_cost:
            continue
        spent = 0.0

        def find(case: Instance = case) -> Solution:
            nonlocal spent
            solution = solvers.solve(case)
            spent = time.process_time()
            return solution

        spent = time.process_time()
        proof = prove(case, find)
        seconds = time.process_time() - spent
        print(f"{name:30s} {proof.status.value:17s} {seconds:6.1f} s  {proof.reason[:90]}", flush=True)
        found.append((name, proof, seconds))
    return found


def table(found: list[tuple[str, Proof, float]]) -> str:
    """The rows of the page."""
    lines = ["| instance | objective J | final time | theorem | s |", "| --- | --- | --- | --- | --- |"]
    for name, proof, seconds in found:
        if proof.status is Outcome.PROVED:
            assert proof.theorem
            assert proof.objective
            assert proof.t_final
            cells = [name, proof.objective.text, proof.t_final.text, proof.theorem.name, f"{seconds:.1f}"]
            lines.append("| " + " | ".join(cells) + " |")
    lines += ["", "Not proved, with the step that fails, or beyond what is proved here, with the feature:", ""]
    lines += ["| instance | status | reason |", "| --- | --- | --- |"]
    lines += [f"| {n} | {p.status.value} | {p.reason} |" for n, p, _ in found if p.status is not Outcome.PROVED]
    return "\n".join(lines) + "\n"


def drawn(rng: np.random.Generator) -> tuple[Instance, Solution, int]:
    """A random extremal of the return to an orbit, ended where it leads, and how often it is conjugate to its start.

    Motion and variations are integrated by SciPy with the model's kernels of floats; a conjugate time is a change of
    sign of the determinant of states by initial costates.
    """
    case = instance.load("return-to-orbit")
    model, p = case.model, case.parameters
    bounds = case.control_set.arguments
    lam, tf = rng.uniform(-LARGEST, LARGEST, 4), float(rng.choice(HORIZONS))

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        a = np.reshape(model.canonical_jacobian(t, y[:4], y[4:8], p, bounds), (8, 8))
        moved = model.canonical(t, y[:4], y[4:8], p, bounds)
        return np.concatenate([moved, (a @ y[8:].reshape(8, 4)).ravel()])

    def fallen(_: float, y: np.ndarray) -> float:
        return float(y[0]) - NEAREST

    fallen.terminal = True  # type: ignore[attr-defined]
    start = np.concatenate([case.initial, lam, np.eye(8)[:, 4:].ravel()])
    times = np.linspace(0.0, tf, 2001)
    run = solve_ivp(rates, (0.0, tf), start, "DOP853", times, events=fallen, rtol=1e-12, atol=1e-14)
    if run.status != 0:
        return drawn(rng)
    dets = np.linalg.det(run.y[8:].T.reshape(-1, 8, 4)[1:, :4])
    conjugate = int((dets[:-1] * dets[1:] < 0).sum())
    x, costates = run.y[:4], run.y[4:8]
    u = np.asarray(model.control_law_batch(times, x, costates, p, bounds))
    final = dict(zip(model.spec.state_names, map(float, x[:, -1]), strict=True))
    given = replace(case, final=final, tf=tf, path=Path("drawn"))
    return (
        given,
        Solution(given, "drawn", Status.CONVERGED, "", 0.0, times, x, u, costates, ((), ()), 0, (), 0.0),
        conjugate,
    )


def of_random(count: int) -> None:
    """Count what is proved of random extremals."""
    rng, counts = np.random.default_rng(SEED), dict[tuple[bool, str], int]()
    for _ in range(count):
        case, found, conjugate = drawn(rng)
        proof = prove(case, lambda found=found: found, 10)
        key = (conjugate > 0, proof.status.value)
        counts[key] = counts.get(key, 0) + 1
        if (conjugate > 0) == (proof.status is Outcome.PROVED):
            print(conjugate, case.tf, found.lam[:, 0].tolist(), proof.status.value, proof.reason, flush=True)
    for (conjugate, status), number in sorted(counts.items()):
        print(f"{'with' if conjugate else 'without'} a conjugate point: {number} {status}", flush=True)


def main() -> int:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=RANDOM, help="random extremals, by default 100")
    parser.add_argument("--only-random", action="store_true")
    parser.add_argument("--only", nargs="*", metavar="NAME", help="print the rows of these instances, write nothing")
    asked = parser.parse_args()
    if not asked.only_random:
        found = of_shipped(asked.only or instance.shipped())
        proved = [seconds for _, proof, seconds in found if proof.status is Outcome.PROVED]
        print(f"{len(proved)} proved, in {sum(proved):.0f} s together")
        if asked.only:
            print(table(found))
            return 0
        text = PAGE.read_text(encoding="utf-8")
        before, after = text.partition(BEGIN)[0], text.partition(END)[2]
        PAGE.write_text(before + BEGIN + "\n" + table(found) + "\n" + END + after, encoding="utf-8")
    of_random(asked.random)
    return 0


if __name__ == "__main__":
    sys.exit(main())
