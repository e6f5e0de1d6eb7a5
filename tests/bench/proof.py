"""What is proved of the shipped instances, in which time, and of random extremals with and without conjugate points.

Both tables are in docs/proved.md; ``make bench-proof`` writes them anew. A transfer in orbital elements is proved by
``python -m tests.bench.proof --transfer``, in some ten minutes.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from satsym import instance, solvers
from satsym.instance import Instance
from satsym.proof.proving import prove
from satsym.proof.record import Outcome, Proof
from satsym.solution import Solution
from tests.bench import orbit_raising
from tests.bench.extremals import KINDS, drawn

PAGE = Path(__file__).parents[2] / "docs" / "proved.md"
SHIPPED, RANDOM = "table of proved optima", "table of random extremals"
SEED, COUNT, DIGITS = 11, 100, 10
OF_TRANSFER = 8
"""Digits of the transfer in orbital elements."""


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


def linked(name: str) -> str:
    """Return a link to the page of an instance."""
    return f"[{name}](gallery/{name}.md)"


def table(found: list[tuple[str, Proof, float]]) -> str:
    """The rows of the page."""
    lines = ["| instance | objective J | final time | theorem | seconds |", "| --- | --- | --- | --- | --- |"]
    for name, proof, seconds in found:
        if proof.status is Outcome.PROVED:
            assert proof.theorem
            assert proof.objective
            assert proof.t_final
            known = [
                one.text.replace("+/- ", "\N{PLUS-MINUS SIGN}\N{NO-BREAK SPACE}")
                for one in (proof.objective, proof.t_final)
            ]
            cells = [linked(name), *known, proof.theorem.name, f"{seconds:.1f}"]
            lines.append("| " + " | ".join(cells) + " |")
    lines += [
        "",
        "The following instances were not proved. "
        "The reason is the step of the proof that fails, or a feature that is not covered:",
        "",
    ]
    lines += ["| instance | status | reason |", "| --- | --- | --- |"]
    lines += [f"| {linked(n)} | {p.status.value} | {p.reason} |" for n, p, _ in found if p.status is not Outcome.PROVED]
    return "\n".join(lines) + "\n"


def of_random(count: int) -> str:
    """Prove random extremals; a table of what is proved of those with and without a conjugate point."""
    rng, kinds = np.random.default_rng(SEED), list(KINDS)
    rows = {kind: Counter[tuple[bool, bool]]() for kind in kinds}
    for k in range(count):
        kind = kinds[k % len(kinds)]
        one = drawn(kind, rng)
        proof = prove(one.case, lambda one=one: one.found, DIGITS)
        key = (one.conjugate > 0, proof.status is Outcome.PROVED)
        rows[kind][key] += 1
        if key[0] == key[1]:
            print(f"{kind}, {one.conjugate} conjugate: {proof.status.value}: {proof.reason}", flush=True)
    lines = [
        "| motion | with a conjugate point | of these proved | without | of these proved |",
        "| --- |" + " --- |" * 4,
    ]
    for name, row in (*rows.items(), ("together", sum(rows.values(), Counter()))):
        with_one, without = (row[there, True] + row[there, False] for there in (True, False))
        lines.append(f"| {name} | {with_one} | {row[True, True]} | {without} | {row[False, True]} |")
    return "\n".join(lines) + "\n"


def of_transfer() -> str:
    """Prove the transfer in orbital elements; what is known of it, in lines."""
    case = orbit_raising.stated().case
    solution = solvers.solve(case)
    spent = time.process_time()
    proof = prove(case, lambda: solution, OF_TRANSFER)
    lines = [f"{proof.status.value} {proof.reason}, in {time.process_time() - spent:.0f} s"]
    lines += [f"{h.name}: {h.value}" for h in proof.hypotheses]
    lines += [f"final time {proof.t_final.text}"] if proof.t_final else []
    lines += [f"lambda_{name}(t0) {v.text}" for name, v in proof.costate_initial.items()]
    return "\n".join(lines)


def write(called: str, text: str) -> None:
    """Put a table in the place of the former one on the page."""
    begin, end = f"<!-- {called} -->\n", f"<!-- end of the {called} -->\n"
    page = PAGE.read_text(encoding="utf-8")
    before, after = page.partition(begin)[0], page.partition(end)[2]
    PAGE.write_text(f"{before}{begin}\n{text}\n{end}{after}", encoding="utf-8")


def main() -> int:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, metavar="N", help="N random extremals alone, and write nothing")
    parser.add_argument("--only", nargs="*", metavar="NAME", help="print the rows of these instances, write nothing")
    parser.add_argument("--part", choices=("shipped", "random"), help="write one of the two tables alone")
    parser.add_argument("--transfer", action="store_true", help="the transfer in orbital elements, and write nothing")
    asked = parser.parse_args()
    if asked.transfer:
        print(of_transfer())
        return 0
    if asked.random is not None:
        print(of_random(asked.random))
        return 0
    if asked.part != "random":
        found = of_shipped(asked.only or instance.shipped())
        proved = [seconds for _, proof, seconds in found if proof.status is Outcome.PROVED]
        print(f"{len(proved)} proved, in {sum(proved):.0f} s together")
        if asked.only:
            print(table(found))
            return 0
        write(SHIPPED, table(found))
    if asked.part != "shipped":
        write(RANDOM, of_random(COUNT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
