"""The table of known optima: what satsym finds from a cold start beside what is known, and a direct method's time.

`make bench-optima` prints it and writes docs/optima.md. The optima stand in optima.toml with the route by which each
was found, none of them by satsym. Both solve in this process, one after the other, without a guess; satsym's time is
told without and with the certificate, of which the direct method has none; its time is that of the first mesh which is
accurate enough, and nothing for finding it.
"""

from __future__ import annotations

import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from time import perf_counter
from typing import Any

import direct
from machine import described
from peers import Missing

from satsym import instance, methods
from satsym.solution import Solution
from satsym.solvers import solve

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "optima.md"
WITHIN, PATIENCE = 1e-7, 60.0
"""Relative error that is allowed of either, and seconds after which the direct method's mesh is refined no more."""

INTRODUCTION = """# Known optima

Shipped instances whose optimum is known, as `make bench-optima` finds them: each from a cold start, without a guess.
The *independent optimum* has nothing of satsym in it; below the table stands how it was found. *Direct* is CasADi's
collocation with Ipopt, built from the same statement of the problem on the first mesh that has a relative error of at
most 1e-7 in the objective; trying coarser ones costs it nothing here. It proves nothing, so its *ratio* is to our time
without the certificate, unless it is the certificate that led to the answer. Times are in seconds.

"""
HEADS = tuple("instance source independent satsym difference verdict time certified direct ratio".split())


@dataclass(frozen=True)
class Row:
    """One problem.

    Attributes
    ----------
    seconds, whole
        Until the answer was there, and with the certificate; the same where it is the certificate that led to it.
    """

    name: str
    entry: Mapping[str, Any]
    found: Solution
    seconds: float
    whole: float
    peer: direct.Direct | None

    @property
    def difference(self) -> float:
        """Relative to the optimum."""
        return abs(self.objective / self.entry["optimum"] - 1.0)

    @property
    def objective(self) -> float:
        """Ours, in the sense of the statement."""
        return self.found.instance.model.spec.objective(self.found.objective)

    @property
    def cells(self) -> tuple[str, ...]:
        """As the table has them."""
        proof, peer = self.found.certificate, self.peer
        theirs = "not tried" if peer is None else f"{peer.seconds:.2f}"
        if peer and not peer.reached:
            theirs = f"not reached: {peer.objective:.8g} on {peer.intervals} intervals"
        return (
            self.name,
            self.entry["source"],
            f"{self.entry['optimum']:.11g}",
            f"{self.objective:.11g}" if self.found.status.answered else self.found.status.value,
            f"{self.difference:.0e}",
            proof.verdict.value if proof else "none",
            f"{self.seconds:.2f}",
            f"{self.whole:.2f}",
            theirs,
            f"{peer.seconds / self.seconds:.2g}" if peer and peer.reached else "",
        )


def entries() -> dict[str, dict[str, Any]]:
    """The optima that are known, by instance."""
    return tomllib.loads((HERE / "optima.toml").read_text(encoding="utf-8"))


def row(name: str, entry: Mapping[str, Any]) -> Row:
    """Solve one problem by both."""
    began = perf_counter()
    case = instance.load(name)
    first = method(case)
    seconds = perf_counter() - began
    found = solve(instance.load(name))
    whole = perf_counter() - began - seconds
    same = abs(first.objective - found.objective) <= WITHIN * abs(found.objective)
    try:
        peer = direct.solve(case, case.model.spec.objective(entry["optimum"]), WITHIN, PATIENCE)
    except Missing:
        peer = None
    return Row(name, entry, found, seconds if same else whole, whole, peer)


def method(case: instance.Instance) -> Solution:
    """By the method that suits it, without the certificate and what that leads to."""
    module, _, function = methods.automatic(case.model.spec).solver.partition(":")
    found: Solution = getattr(import_module(module), function)(case)
    return found


def page(rows: list[Row]) -> str:
    """The page of the documentation."""
    table = [HEADS, ("---",) * len(HEADS), *(one.cells for one in rows)]
    routes = [f"- {one.name}: {one.entry['route']}." + _reason(one.entry) for one in rows]
    lines = [f"| {' | '.join(cells)} |" for cells in table]
    return INTRODUCTION + "\n".join([*lines, "", summary(rows), "", "## How the optima are known", "", *routes, ""])


def summary(rows: list[Row]) -> str:
    """How many are right, how many quicker, and what all of them took."""
    right = sum(one.difference <= WITHIN for one in rows)
    ahead = sum(one.peer is not None and (not one.peer.reached or one.peer.seconds > one.seconds) for one in rows)
    took = sum(one.whole for one in rows)
    return f"{right} of {len(rows)} within {WITHIN:.0e}, {ahead} quicker than the direct method; {took:.0f} s in all."


def _reason(entry: Mapping[str, Any]) -> str:
    return f" {entry['verdict'].capitalize()}: {entry['reason']}." if "reason" in entry else ""


def main() -> int:
    """All entries, or those that are named; exit code 1 where one is not what it must be. The page has all of them."""
    known = entries()
    solve(instance.load("return-to-orbit"))  # so that nobody pays for what is imported
    print(described(), flush=True)
    rows = []
    for name in sys.argv[1:] or known:
        rows.append(row(name, known[name]))
        print("  ".join(rows[-1].cells), flush=True)
    print(summary(rows))
    if len(rows) == len(known):
        PAGE.write_text(page(rows), encoding="utf-8")
    wrong = [one.name for one in rows if not one.difference <= WITHIN or one.cells[5] != one.entry["verdict"]]
    print(f"not as known: {', '.join(wrong)}" if wrong else "all as known")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
