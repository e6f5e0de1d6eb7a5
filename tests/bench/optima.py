"""The table of known optima: what satsym finds from a cold start beside what is known, and a direct method's time.

`make bench-optima` prints it and writes docs/optima.md. The optima stand in optima.toml with the route by which each
was found, none of them by satsym. Both solve in this process, in turns, without a guess, after each has done so once:
neither pays for libraries, nor for functions made of the statement (satsym's generated module, the direct method's
expressions), both for reading or building their problem and for solving it. satsym's time is told without and with the
certificate, of which the direct method has none; its time is that of the first mesh which is accurate enough, and
nothing for finding it. Processor time is measured, the least of the turns: what else runs disturbs it least.
"""

from __future__ import annotations

import math
import os
import sys
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from time import process_time
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command line has it; threads only wait for each other here

import direct
from machine import asked_for, described
from peers import Missing
from timing import interleaved

from satsym import instance, methods
from satsym.solution import Solution
from satsym.solvers import solve

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "optima.md"
WITHIN, PATIENCE = 1e-7, 60.0
"""Relative error that is allowed of either, and seconds after which the direct method's mesh is refined no more."""

TURNS, LONG = 3, 5.0
"""How often both solve again, and the seconds of the first time from which once is enough."""

INTRODUCTION = """# Known optima

How accurate is satsym, and how fast? For each of these shipped instances, the optimum is known from a source other than
satsym. satsym solves each of them from a cold start, without an initial guess. The table compares the optima; the
differences are relative. The sections below it compare times with those of a direct method, and say how each optimum
was found. `make bench-optima` writes this page.

"""
TIMES = """## Times

The direct method is CasADi's collocation with Ipopt, for the same problem.

- *satsym* is the time without the certificate, because the direct method certifies nothing. Where the certificate found
  the answer, its time is included.
- *certified* is the time with the certificate.
- *direct* is the time of the direct method on the first mesh with a relative error of at most 1e-7 in the objective.
  The time for coarser meshes is not counted.
- *ratio* is the time of the direct method divided by that of satsym.

All times are in seconds of processor time. Each is the minimum of three runs after a warm-up run, so that loading
libraries is not counted.

```{raw} html
<figure class='example'><img src='_static/figures/times.svg' alt='The times of the table' loading='lazy'><figcaption>The
times of the table below. A cross at the right edge marks a problem for which the direct method did not reach this
accuracy or was not tried.</figcaption></figure>
```

"""
HEADS = tuple("instance source optimum satsym difference verdict".split())
TIMED = tuple("instance satsym certified direct ratio".split())
WORDS = frozenset({"instance", "source", "verdict", "direct"})
"""Columns that contain words."""


@dataclass(frozen=True)
class Row:
    """One problem.

    Attributes
    ----------
    seconds, whole
        Until the answer was there, and with the certificate; the same where it is the certificate that led to it.
    theirs
        The direct method's; infinite where it has no answer that is good enough.
    """

    name: str
    entry: Mapping[str, Any]
    found: Solution
    seconds: float
    whole: float
    peer: direct.Direct | None
    theirs: float

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
        theirs = "not tried" if peer is None else f"{self.theirs:.2f}"
        if peer and not peer.reached:
            objective = self.found.instance.model.spec.objective(peer.objective)
            short = "no solution" if math.isnan(objective) else f"only {objective:.8g}"
            theirs = f"{short} with {peer.intervals} intervals"
        return (
            self.name,
            self.entry["source"],
            f"{self.entry['optimum']:.11g}",
            f"{self.objective:.11g}" if self.found.status.answered else self.found.status.value,
            f"{self.difference:.0e}" if self.difference else "0",
            proof.verdict.value if proof else "none",
            f"{self.seconds:.2f}",
            f"{self.whole:.2f}",
            theirs,
            f"{self.theirs / self.seconds:.2g}" if peer and peer.reached else "",
        )


def entries() -> dict[str, dict[str, Any]]:
    """The optima that are known, by instance."""
    return tomllib.loads((HERE / "optima.toml").read_text(encoding="utf-8"))


def row(name: str, entry: Mapping[str, Any]) -> Row:
    """Solve one problem by both."""
    began, case = process_time(), instance.load(name)
    first = method(case)
    lasted = process_time() - began
    began = process_time()
    found = solve(instance.load(name))
    whole = process_time() - began
    same = abs(first.objective - found.objective) <= WITHIN * abs(found.objective)
    try:
        peer = direct.solve(case, case.model.spec.objective(entry["optimum"]), WITHIN, PATIENCE)
    except Missing:
        peer = None
    both: dict[str, Callable[[], object]] = {"ours": lambda: method(instance.load(name))} if same else {}
    if peer and peer.reached:
        both["theirs"] = peer.again
    least = {who: one.least for who, one in interleaved(both, 1 if lasted > LONG else TURNS, 0.0).items()}
    return Row(name, entry, found, least.get("ours", whole), whole, peer, least.get("theirs", math.inf))


def method(case: instance.Instance) -> Solution:
    """By the method that suits it, without the certificate and what that leads to."""
    module, _, function = methods.automatic(case.model.spec).solver.partition(":")
    found: Solution = getattr(import_module(module), function)(case)
    return found


def page(rows: list[Row]) -> str:
    """The page of the documentation."""
    routes = {one.name: one.entry["route"] + "." + _reason(one.entry) for one in rows}
    return page_of([one.cells for one in rows], routes, *summary(rows))


def page_of(cells: list[tuple[str, ...]], routes: Mapping[str, str], agreement: str, speed: str) -> str:
    """The page with these rows, routes and summaries."""
    linked = [(f"[{name}](gallery/{name}.md)", *others) for name, *others in cells]
    known = _table(HEADS, [one[: len(HEADS)] for one in linked])
    times = _table(TIMED, [(one[0], *one[len(HEADS) :]) for one in linked])
    found = "\n".join(f"- **[{name}](gallery/{name}.md)**: {route}" for name, route in routes.items())
    return (
        f"{INTRODUCTION}{known}\n{agreement}\n\n{TIMES}{times}\n{speed}\n\n## Where the optima come from\n\n{found}\n"
    )


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table whose columns of numbers are aligned at the right."""
    rule = ["---" if head in WORDS else "---:" for head in heads]
    return "".join(f"| {' | '.join(line)} |\n" for line in (heads, rule, *rows))


def summary(rows: list[Row]) -> tuple[str, str]:
    """How many are right; how many quicker, and what all of them took."""
    right = sum(one.difference <= WITHIN for one in rows)
    ahead = sum(one.peer is not None and one.theirs > one.seconds for one in rows)
    took = sum(one.whole for one in rows)
    agree = f"{right} of {len(rows)} optima agree to within {WITHIN:.0e}."
    quicker = f"satsym is quicker than the direct method in {ahead} cases."
    return agree, f"{quicker} All solutions with their certificates took {took:.0f} s."


def _reason(entry: Mapping[str, Any]) -> str:
    return f" {entry['verdict'].capitalize()}: {entry['reason']}." if "reason" in entry else ""


def main() -> int:
    """All entries, or those that are named; exit code 1 where one is not what it must be. The page has all of them."""
    known = entries()
    solve(instance.load("return-to-orbit"))  # so that nobody pays for what is imported
    print(described(), flush=True)
    rows = []
    for name in asked_for(known):
        rows.append(row(name, known[name]))
        print("  ".join(rows[-1].cells), flush=True)
    print(*summary(rows))
    if len(rows) == len(known):
        PAGE.write_text(page(rows), encoding="utf-8")
    wrong = [one.name for one in rows if not one.difference <= WITHIN or one.cells[5] != one.entry["verdict"]]
    print(f"not as known: {', '.join(wrong)}" if wrong else "all as known")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
