"""The table of the bench: what came of each class, and the rates that have goals."""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.judge import Judgement, Outcome

HEADS = ("cases", "agreed", "ours", "theirs", "none", "unjudged", "WRONG", "answered", "certified", "median s")
ANSWERED, CERTIFIED = 0.97, 0.95
"""Goals: of what the independent side solves, and of what converged where it should."""
WIDTH = 9


@dataclass(frozen=True)
class Entry:
    """One instance with both answers."""

    family: str
    number: int
    truth: Answer
    ours: dict[str, Any]
    judgement: Judgement


def text(entries: Iterable[Entry]) -> str:
    """The table, as wide as COLUMNS allows: names are cut, numbers never."""
    rows: dict[str, list[Entry]] = {}
    for entry in entries:
        rows.setdefault(entry.family, []).append(entry)
    everything = [entry for own in rows.values() for entry in own]
    room = shutil.get_terminal_size((140, 24)).columns - len(HEADS) * (WIDTH + 1)
    names = max(10, min(room, max((len(name) for name in rows), default=10)))
    lines = [" " * names + "".join(f" {head:>{WIDTH}}" for head in HEADS)]
    lines += [_line(name, own, names) for name, own in rows.items()]
    lines += [_line("all", everything, names), "", *_goals(everything)]
    return "\n".join(lines)


def wrong(entries: Iterable[Entry]) -> str:
    """One line for each thing that was said and is not true, the same ones together."""
    lines = []
    for entry in sorted(
        (e for e in entries if e.judgement.wrong), key=lambda e: (e.judgement.wrong, e.family, e.number)
    ):
        excess = entry.judgement.excess
        by = "" if excess is None else f" by {excess:.2e}"
        lines.append(f"{entry.family} {entry.number}: {entry.judgement.wrong.value}{by}")  # type: ignore[union-attr]
    return "\n".join(lines)


def rates(entries: list[Entry]) -> tuple[float, float]:
    """Answered, of what the independent side solves; certified, of what converged where there is a minimum."""
    solved = [e for e in entries if e.truth.truth is not Truth.UNKNOWN]
    answered = [e for e in solved if e.judgement.outcome is not Outcome.NONE]
    converged = [e for e in answered if e.ours["status"] == "converged" and e.truth.truth is not Truth.UNBOUNDED]
    certified = [e for e in converged if e.ours.get("verdict") == "certified"]
    return _fraction(len(answered), len(solved)), _fraction(len(certified), len(converged))


def _fraction(part: int, whole: int) -> float:
    return part / whole if whole else float("nan")


def _line(name: str, entries: list[Entry], names: int) -> str:
    counts = Counter(entry.judgement.outcome for entry in entries)
    answered, certified = rates(entries)
    walls = sorted(entry.ours.get("processor", 0.0) for entry in entries)
    cells = [
        *(str(count) for count in (len(entries), *(counts[outcome] for outcome in Outcome))),
        str(sum(entry.judgement.wrong is not None for entry in entries)),
        f"{answered:.0%}",
        f"{certified:.0%}",
        f"{walls[len(walls) // 2]:.2f}" if walls else "",
    ]
    return f"{name[:names]:<{names}}" + "".join(f" {cell:>{WIDTH}}" for cell in cells)


def _goals(entries: list[Entry]) -> list[str]:
    answered, certified = rates(entries)
    mistakes = Counter(e.judgement.wrong.value for e in entries if e.judgement.wrong)
    lines = [
        f"answered, of what the independent side solves: {answered:.1%} (goal: at least {ANSWERED:.0%})",
        f"certified, of what converged: {certified:.1%} (goal: at least {CERTIFIED:.0%})",
        f"wrong: {sum(mistakes.values())} (goal: none)",
    ]
    return lines + [f"  {count:>4}  {words}" for words, count in mistakes.most_common()]
