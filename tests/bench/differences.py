"""How an answer differs from the one on record: for the better, for the worse, or so that it is only told."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tests.bench.children import ENDED, ERROR, TOO_LONG

SAME_COST, CHEAPER = 1e-9, 1e-6
"""Share of its size by which a cost may differ, and from which a lower one is another, better answer."""

SAME_COSTATES = 1e-7
"""Share of the largest on the way by which an initial costate may differ."""

SAME_TIMES = 1e-7
"""Share of the duration by which times of events and of switches may differ."""

VANISHING = 1e-20
"""Sizes below which costs and costates are zero, and their digits noise."""

NOT_DERIVED = "not derived"
"""What is said of an instance whose model could not be derived."""

BROKEN = (TOO_LONG, ENDED, ERROR, NOT_DERIVED)
"""What is said where satsym itself has no word for it: any word of its own is for the better."""

RANKS = {word: rank for rank, word in enumerate(("none", "failed", "extremal only", "local minimum", "certified"))}
"""Verdicts, from the one that says least."""

Row = Mapping[str, Any]


@dataclass(frozen=True)
class Differences:
    """What differs, a line each.

    Attributes
    ----------
    better, worse
        In the answer. A difference that is not for the better is one for the worse.
    told
        In what it was compared with, and in costates that may not be the only ones.
    """

    better: tuple[str, ...] = ()
    worse: tuple[str, ...] = ()
    told: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.better or self.worse or self.told)


def differences(old: Row, new: Row) -> Differences:
    """Compare two rows of one case."""
    if not (answered(old) and answered(new)):
        return _of_status(old, new)
    better, worse = [], []
    excess = (new["cost"] - old["cost"]) / max(size(old), size(new), VANISHING)
    change = f"cost {old['cost']!r} became {new['cost']!r}, by {excess:+.1e} of its size"
    cheaper = excess < -CHEAPER
    if cheaper:
        better.append(change)
    elif not abs(excess) <= SAME_COST:  # as NaN is not
        worse.append(change)
    if old["verdict"] != new["verdict"]:
        (better if RANKS[new["verdict"]] > RANKS[old["verdict"]] else worse).append(_change("verdict", old, new))
    told = list(_of_the_way(old, new))
    if not cheaper:  # of another answer all of this is another
        (worse if old["unique"] and new["unique"] else told).extend(_of_costates(old, new))
        worse += [*_of_events(old, new), *_of_switches(old, new)]
    return Differences(tuple(better), tuple(worse), tuple(told))


def answered(row: Row) -> bool:
    """Whether a row has an answer."""
    return "cost" in row


def size(row: Row) -> float:
    """What a difference of costs is compared with."""
    return max(abs(row["cost"]), row.get("terms", 0.0))


def described(row: Row) -> str:
    """A row in a few words."""
    return f"{row['verdict']}, cost {row['cost']!r}" if answered(row) else row["status"]


def ratio(old: Row, new: Row) -> float:
    """How many times as long it takes."""
    return float(new["seconds"] / old["seconds"]) if old["seconds"] > 0.0 else math.nan


def _of_status(old: Row, new: Row) -> Differences:
    if answered(new):
        return Differences(better=(f"{old['status']} became {described(new)}",))
    if old["status"] == new["status"]:
        return Differences()
    change = (f"{described(old)} became {new['status']}",)
    fixed = old["status"] in BROKEN and new["status"] not in BROKEN
    return Differences(better=change) if fixed else Differences(worse=change)


def _change(key: str, old: Row, new: Row) -> str:
    return f"{key} {old[key]!r} became {new[key]!r}"


def _of_costates(old: Row, new: Row) -> Iterator[str]:
    for (name, before), largest in zip(old["costates"].items(), old["sizes"], strict=True):
        after = new["costates"][name]
        share = abs(after - before) / max(largest, VANISHING)
        if not share <= SAME_COSTATES:
            yield f"costate of {name} {before!r} became {after!r}, by {share:.1e} of its size"


def _of_events(old: Row, new: Row) -> Iterator[str]:
    before, after = ([[kind, name] for kind, name, _ in row["events"]] for row in (old, new))
    if before != after:
        yield f"events {_named(old)} became {_named(new)}"
        return
    for (kind, name, then), (_, _, now) in zip(old["events"], new["events"], strict=True):
        yield from _of_times(f"{kind} of {name}", then, now, old["duration"])


def _named(row: Row) -> str:
    return ", ".join(f"{kind} of {name} at {t:.6g}" for kind, name, t in row["events"]) or "none"


def _of_switches(old: Row, new: Row) -> Iterator[str]:
    for control in sorted({*old["switches"], *new["switches"]}):
        before, after = (row["switches"].get(control, []) for row in (old, new))
        if len(before) != len(after):
            yield f"switches of {control} {before} became {after}"
            continue
        for then, now in zip(before, after, strict=True):
            yield from _of_times(f"switch of {control}", then, now, old["duration"])


def _of_times(what: str, then: float, now: float, duration: float) -> Iterator[str]:
    if not abs(now - then) <= SAME_TIMES * duration:
        yield f"{what} at {then!r} became {now!r}"


def _of_the_way(old: Row, new: Row) -> Iterator[str]:
    """What the answer was compared with, and whether its costates are the only ones."""
    for key in ("unique", "competitors", "not checked"):
        if old.get(key) != new.get(key):
            yield f"{key} {old.get(key)} became {new.get(key)}"
