"""A few instances with stored independent answers, for tests that have neither the peers nor the time.

Written by ``python -m tests.bench.truth.run --write-sample``: of each class the first that is right and quickly
solved, and some more. It tells of words that cease to be true, not of how many are.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from tests.bench.truth import classes, record
from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.judge import Outcome
from tests.bench.truth.table import Entry

PATH = record.HERE / "sample.json"
SIZE, QUICK = 45, 0.8
NOTE = (
    "Independent answers as tests/bench/truth/ stored them, with the means by which each was obtained under how: "
    "closed forms, dual problems, linear programs, or CasADi and Ipopt from many starts, simulated again to 1e-12. "
    "Written by: python -m tests.bench.truth.run --write-sample"
)


def written(entries: Iterable[Entry]) -> int:
    """Write the sample; how many it has."""
    good = [entry for entry in entries if _good(entry)]
    firsts = {entry.family: entry for entry in reversed(good)}
    others = [entry for entry in good if entry is not firsts[entry.family]]
    rows = [
        _row(entry) for entry in sorted([*firsts.values(), *others[:: max(1, len(others) // SIZE)]][:SIZE], key=_key)
    ]
    PATH.write_text(json.dumps({"note": NOTE, "answers": rows}, indent=1) + "\n", encoding="utf-8")
    return len(rows)


def _good(entry: Entry) -> bool:
    right = entry.judgement.wrong is None and entry.judgement.outcome in (Outcome.AGREED, Outcome.OURS)
    return right and entry.truth.truth is not Truth.UNKNOWN and entry.ours.get("processor", QUICK) < QUICK


def _key(entry: Entry) -> tuple[str, int]:
    return entry.family, entry.number


def _row(entry: Entry) -> dict[str, Any]:
    case = classes.drawn(entry.family, entry.number)
    return {"case": asdict(case), "answer": entry.truth.row()}


def read() -> list[tuple[Case, Answer]]:
    """The sample."""
    rows = json.loads(PATH.read_text(encoding="utf-8"))["answers"]
    return [(Case.of(row["case"]), Answer.of(row["answer"])) for row in rows]
