"""What checking a formula found, for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from satsym.auditing.check.answers import Answer
from satsym.auditing.document.drafting import Draft
from satsym.auditing.sentences import in_indonesian
from satsym.report.said import language, message, say


def checked_text(answers: Sequence[Answer]) -> str:
    """A line for how letters were understood, where there was a doubt, and one for each equation."""
    understood = dict.fromkeys(filter(None, map(_understood, answers)))
    return "\n".join([*understood, *map(_line, answers)])


def _understood(answer: Answer) -> str:
    letters = ", ".join(f"{printed} = {ours}" for printed, ours in answer.letters.items())
    parts = [letters, say("the uncontrolled motion") if answer.free else ""]
    said = ", ".join(filter(None, parts))
    return say("understood: <letters> (to correct it: --let LETTER=NAME)", letters=said) if said else ""


def _line(answer: Answer) -> str:
    if answer.verdict == "right":
        if answer.address:
            return say("right: <address>", address=answer.address)
        return say("right: it follows from the equations of <model>", model=answer.model)
    if answer.verdict == "undecided":
        return say("undecided: <said_why>", said_why=message(answer.diagnosis))
    why = in_indonesian(answer.diagnosis) if language() == "id" else answer.diagnosis
    if not answer.correct:
        return say("wrong: <diagnosis> (<address>)", diagnosis=why, address=answer.address)
    right = answer.correct
    return say("wrong: <diagnosis>; right is <right> (<address>)", diagnosis=why, right=right, address=answer.address)


def drafted_text(ledger: Path, found: Draft) -> str:
    """How many rows were drafted, and what was not read or understood, with the places."""
    counted = Counter(row["verdict"] for row in found.rows)
    lines = [
        say(
            "<ledger>: <rows> rows drafted, <kept> confirmed ones kept",
            ledger=ledger,
            rows=len(found.rows),
            kept=found.kept,
        ),
        say("judged at once: <right> right, <wrong> wrong", right=counted["right"], wrong=counted["wrong"]),
    ]
    lines += [say("<place>: not read: <said_why>", place=place, said_why=message(why)) for place, why in found.unread]
    lines += [
        say("<place>: not understood: <said_why>", place=place, said_why=message(why)) for place, why in found.undecided
    ]
    return "\n".join([*lines, say("confirm the rows, then: satsym audit <ledger>", ledger=ledger)])
