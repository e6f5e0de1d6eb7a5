"""Truth of what satsym says: random instances of all classes beside independent answers (`make bench-truth`).

What is done is kept below results/truth/: the same command goes on where it was broken off. Independent answers are
computed once, and stay when only satsym changes. ``--classes WORD`` (repeatable) takes the classes whose names contain
it, ``--first N`` the first of each, ``--only truth`` or ``--only ours`` one side, ``--show`` prints what there is,
``--any-revision`` also counts answers of earlier revisions of satsym, ``--keep-right`` solves only those again that
such a one was not right about, ``--seconds S`` stops in time, ``--write-sample`` writes the sample that the tests use.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from tests.bench.children import tell
from tests.bench.truth import classes, record, sample, table
from tests.bench.truth.answer import Answer
from tests.bench.truth.judge import Outcome, judged
from tests.bench.truth.ours import Worker


def main() -> None:
    """Answer what is not answered yet, and print the table."""
    options = _options()
    families = [name for name in classes.CLASSES if any(word in name for word in options.classes or [""])]
    pairs = [(f, n) for f, n in classes.in_turn(families) if n < options.first]
    truths, ours = record.Record("truth"), record.Record("ours")
    if not options.show:
        _run(pairs, truths, ours, options)
    entries = _entries(pairs, truths, ours, options.any_revision)
    print(table.text(entries))
    print("\n" + table.wrong(entries))
    if options.write_sample:
        print(f"\n{sample.PATH}: {sample.written(entries)} instances")


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--classes", action="append", metavar="WORD")
    parser.add_argument("--first", type=int, default=10**6, metavar="N")
    parser.add_argument("--only", choices=("truth", "ours"))
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--show", action="store_true")
    parser.add_argument("--any-revision", action="store_true")
    parser.add_argument("--keep-right", action="store_true")
    parser.add_argument("--write-sample", action="store_true")
    return parser.parse_args()


def _run(pairs: list[tuple[str, int]], truths: record.Record, ours: record.Record, options: argparse.Namespace) -> None:
    end = time.perf_counter() + options.seconds
    if options.only != "truth":
        derive()
    worker = Worker(record.FOLDER)
    try:
        for count, (family, number) in enumerate(pairs):
            if time.perf_counter() > end:
                break
            if options.only != "ours":
                independent(family, number, truths)
            if options.only != "truth" and not (options.keep_right and _right(family, number, truths, ours)):
                from_satsym(family, number, ours, worker)
            tell(f"{count + 1} of {len(pairs)}")
    finally:
        worker.end()


def derive() -> None:
    """Derive the bench's own models, once for each revision of satsym."""
    folder, stamp = record.FOLDER / "models", record.FOLDER / "models" / "revision.txt"
    if stamp.exists() and stamp.read_text() == record.of_satsym():
        return
    files = sorted(str(path) for path in (record.HERE / "models").glob("*.py"))
    command = [sys.executable, "-m", "satsym", "derive", *files, "--out", str(folder)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    stamp.write_text(record.of_satsym())


def independent(family: str, number: int, truths: record.Record) -> dict[str, Any]:
    """The independent answer, from the record or computed now."""
    case, answered = classes.drawn(family, number), classes.CLASSES[family].answered
    text, revision = case.text(False), record.of_truth(answered)
    row = truths.get(case.key, text, revision)
    if row is None:
        begun = time.process_time()
        values = answered(case).row()
        row = truths.add(case.key, text, revision, values | {"processor": round(time.process_time() - begun, 3)})
    return row


def from_satsym(family: str, number: int, ours: record.Record, worker: Worker) -> dict[str, Any]:
    """satsym's answer, from the record or computed now."""
    case = classes.drawn(family, number)
    text = case.text(False)
    row = ours.get(case.key, text, record.of_satsym())
    if row is None:
        row = ours.add(case.key, text, record.of_satsym(), worker.solve(case))
    return row


def _right(family: str, number: int, truths: record.Record, ours: record.Record) -> bool:
    """Whether an earlier revision of satsym was right about an instance, and certified what it found."""
    found = _entries([(family, number)], truths, ours, any_revision=True)
    good = (Outcome.AGREED, Outcome.OURS)
    return any(e.judgement.outcome in good and e.ours.get("verdict", "certified") == "certified" for e in found)


def _entries(
    pairs: list[tuple[str, int]], truths: record.Record, ours: record.Record, any_revision: bool
) -> list[table.Entry]:
    entries = []
    for family, number in sorted(pairs, key=lambda pair: (list(classes.CLASSES).index(pair[0]), pair[1])):
        case = classes.drawn(family, number)
        text = case.text(False)
        theirs = truths.get(case.key, text, record.of_truth(classes.CLASSES[family].answered))
        mine = ours.get(case.key, text, None if any_revision else record.of_satsym())
        if theirs is not None and mine is not None:
            answer = Answer.of(theirs)
            entries.append(table.Entry(family, number, answer, mine, judged(answer, mine)))
    return entries


if __name__ == "__main__":
    main()
