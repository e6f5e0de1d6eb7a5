"""Whether satsym still answers as it did: all shipped instances and many random ones, beside a record (`make parity`).

The record is parity.json beside this file: of each case status, verdict, cost, initial costates, events, switches, what
it was compared with, and seconds of the processor. Every difference is named, those for the better apart from those for
the worse; the exit code is 1 where there is one for the worse. How long a case took is told only.

    python -m tests.bench.parity [--cases DIR] [--only NAME ...] [--sample] [--record]

Each case is solved in a process of its own, so that it depends on no other, and given up after 300 s of the processor.
Shipped instances go by their names, random ones by ``random/CLASS:NUMBER``: the first that `make bench-truth` would
solve. ``--cases DIR`` adds a folder of problems, each a subfolder of derivation files and of instances, which are
``cases/SUBFOLDER/INSTANCE``; they are derived into a temporary folder. ``--only`` takes some, also by patterns such as
``'random/*'``, ``--sample`` a few quick ones. ``--record`` writes what was found into the record: lines of cases that
were not run stay, and so do those that differ in nothing but digits that do not count and in seconds by less than a
third.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import islice
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from satsym.wording import counted
from tests.bench.answers import ROUGH, answer, cut, rounded
from tests.bench.children import ROOT, Child, Said, serve, tell
from tests.bench.differences import NOT_DERIVED, Differences, answered, described, differences, ratio
from tests.bench.processors import shipped
from tests.bench.truth import classes, record, run
from tests.bench.truth.ours import written

PATH = Path(__file__).with_suffix(".json")

WORK = 300.0
"""Seconds of the processor after which a case is given up, and so is deriving its models."""

RANDOM = 200
"""How many random instances: as many as take ten minutes."""

QUICK, EVERY = 1.5, 4
"""The quick ones are every fourth of the cases that took less than these seconds."""

SLOWER = 1.3
"""Factor from which a time is another one."""

SHOWN = 10
"""Of the cases whose times differ most."""

Rows = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Case:
    """A case by its name, and what the process that solves it is told."""

    name: str
    question: dict[str, Any]


def asked(question: dict[str, Any]) -> Said:
    """What a process of its own does: derive, or solve."""
    from satsym import instance

    if "derive" in question:
        return _derived([Path(path) for path in question["derive"]], Path(question["out"]))
    if "random" in question:
        path = written(classes.drawn(*question["random"]), record.FOLDER)
        return answer(lambda: instance.load(path))
    return answer(lambda: instance.load(Path(question["file"]) if "file" in question else question["shipped"]))


def _derived(paths: list[Path], out: Path) -> Said:
    from satsym.report import artefacts
    from satsym.status import BadInput

    try:
        artefacts.write(artefacts.render(paths, out, max_seconds=WORK), out)
    except BadInput as error:
        return {"status": NOT_DERIVED, "said": str(error)}
    return {"status": "derived"}


def cases() -> list[Case]:
    """Those that need no folder: shipped ones, and random ones in the order in which `make bench-truth` has them."""
    drawn = islice(classes.in_turn(list(classes.CLASSES)), RANDOM)
    random = [Case(f"random/{family}:{number}", {"random": [family, number]}) for family, number in drawn]
    return [*(Case(name, {"shipped": name}) for name in shipped()), *random]


def in_folder(folder: Path, work: Path) -> list[Case]:
    """The problems of a folder of cases, each with the place that it is copied to in another one."""
    found = []
    for path in sorted(folder.glob("*/*.toml")):
        kind = path.parent.name
        question = {"from": str(path), "file": str(work / kind / path.name)}
        found.append(Case(f"cases/{kind}/{path.stem}", question))
    return found


def answers(todo: Sequence[Case]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Solve one case after the other."""
    if any("random" in case.question for case in todo):
        tell("deriving the models of random instances")
        run.derive()
    for number, case in enumerate(todo, 1):
        tell(f"{number} of {len(todo)}, {case.name}")
        yield case.name, _answer(case.question)
    tell("")


def _answer(question: dict[str, Any]) -> dict[str, Any]:
    if "from" in question:
        said = _ask(_copied(Path(question["from"]), Path(question["file"])))
        if said["status"] != "derived":
            return {**said, "status": NOT_DERIVED, "said": said.get("said", said["status"])}
    return _ask(question)


def _ask(question: dict[str, Any]) -> dict[str, Any]:
    with Child("tests.bench.parity", "--child", work=WORK) as child:
        said = child.ask(question)
    if "said" in said:
        said["said"] = cut(said["said"])
    return {**said, "seconds": rounded(said["seconds"], ROUGH)}


def _copied(path: Path, to: Path) -> dict[str, Any]:
    """Copy an instance and the derivation files beside it; the question by which these are derived."""
    to.parent.mkdir(exist_ok=True)
    files = [shutil.copy(one, to.parent) for one in sorted(path.parent.glob("*.py"))]
    shutil.copy(path, to)
    model = tomllib.loads(to.read_text(encoding="utf-8"))["model"]
    return {"derive": [str(file) for file in files], "out": str((to.parent / model).parent)}


def recorded() -> Rows:
    """The record: cases by name."""
    if not PATH.exists():
        return {}
    rows: Rows = json.loads(PATH.read_text(encoding="utf-8"))["cases"]
    return rows


def write(rows: Rows, revision: str) -> None:
    """Write the record, a line for each case in order of names."""
    lines = (f"{json.dumps(name)}: {json.dumps(rows[name])}" for name in sorted(rows))
    head = f'{{"revision": {json.dumps(revision)}, "cases": {{\n'
    PATH.write_text(head + ",\n".join(lines) + "\n}}\n", encoding="utf-8")


def revision() -> str:
    """The last change of what solves."""
    command = ["git", "log", "-1", "--format=%H", "--", "satsym", "generated"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def renewed(old: Rows, new: Rows, known: frozenset[str]) -> Rows:
    """The record with what was found, without cases that there are no more; lines that differ in nothing stay."""
    kept = {name: row for name, row in old.items() if name in known or name.startswith("cases/")}
    return kept | {name: row for name, row in new.items() if not _same(old.get(name), row)}


def _same(old: Mapping[str, Any] | None, new: Mapping[str, Any]) -> bool:
    if old is None or differences(old, new) or old.get("said") != new.get("said"):
        return False
    return 1.0 / SLOWER < ratio(old, new) < SLOWER


def chosen(everything: Sequence[Case], only: Sequence[str], sample: bool, known: Rows) -> list[Case]:
    """The cases that are asked for; ends where a name is of none."""
    for pattern in only:
        if not any(fnmatchcase(case.name, pattern) for case in everything):
            sys.exit(f"{pattern}: there is no such case")
    found = [case for case in everything if not only or any(fnmatchcase(case.name, pattern) for pattern in only)]
    if not sample:
        return found
    return [case for case in found if known.get(case.name, {}).get("seconds", math.inf) < QUICK][::EVERY]


def report(old: Rows, new: Rows) -> bool:
    """Print what differs; whether anything does for the worse."""
    found = {name: differences(old[name], row) for name, row in new.items() if name in old}
    for word in ("told", "better", "worse"):
        lines = [f"  {name}: {line}" for name, one in found.items() for line in getattr(one, word)]
        if lines:
            print("\n".join([f"{word}:", *lines]))
    for name, row in new.items():
        if name not in old:
            print(f"not in the record: {name}: {described(row)}")
    print(f"{math.fsum(row['seconds'] for row in new.values()):.0f} s of the processor")
    if found:
        print(times({name: (old[name], new[name]) for name in found}))
    print(summary(found, new))
    return any(one.worse for one in found.values())


def times(pairs: Mapping[str, tuple[Mapping[str, Any], Mapping[str, Any]]]) -> str:
    """The seconds of all, and the cases whose times differ most."""
    before, after = (math.fsum(pair[k]["seconds"] for pair in pairs.values()) for k in (0, 1))
    apart = {name: ratio(*pair) for name, pair in pairs.items() if max(one["seconds"] for one in pair) > QUICK}
    most = sorted(apart, key=lambda name: -abs(math.log(apart[name])))[:SHOWN]
    lines = [f"  {name}: {apart[name]:.2f} of {pairs[name][0]['seconds']:g} s" for name in most]
    return "\n".join([f"{after / before if before else math.nan:.2f} of what the record has, most apart:", *lines])


def summary(found: Mapping[str, Differences], new: Rows) -> str:
    """How many are better, worse and the same, and how many have which answer."""
    worse, better = sum(bool(one.worse) for one in found.values()), sum(bool(one.better) for one in found.values())
    verdicts = [row["verdict"] if answered(row) else row["status"] for row in new.values()]
    counts = ", ".join(f"{verdicts.count(word)} {word}" for word in sorted(set(verdicts)))
    return f"{counted(len(new), 'case')}: {counts}\n{worse} worse, {better} better"


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=Path, metavar="DIR")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--record", action="store_true")
    return parser.parse_args()


def main() -> int:
    """Run what is asked for; 1 where something is worse than the record, and that is not written anew."""
    options, old = _options(), recorded()
    with tempfile.TemporaryDirectory() as work:
        added = in_folder(options.cases, Path(work)) if options.cases else []
        everything = [*cases(), *added]
        new = dict(answers(chosen(everything, options.only, options.sample, old)))
    worse = report(old, new)
    if options.record:
        write(renewed(old, new, frozenset(case.name for case in everything)), revision())
    return int(worse and not options.record)


if __name__ == "__main__":
    if sys.argv[1:] == ["--child"]:
        serve(asked)
    else:
        sys.exit(main())
