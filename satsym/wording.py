"""Pieces of one-line messages: values from outside made printable and short, names that come near.

Text from a file or an argument may hold line breaks, terminal escapes, right-to-left marks or a
megabyte of anything. Nothing of it reaches a message except through here.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Sequence
from difflib import get_close_matches

from satsym.status import BadInput

LIMIT = 60
"""Characters of a foreign value that a message repeats."""


def printable(text: str, limit: int = LIMIT) -> str:
    """The text on one line: other than printable characters escaped, the middle of a long text left out."""
    if len(text) > limit:
        head = (limit - 3) * 2 // 3
        text = text[:head] + "..." + text[len(text) - (limit - 3 - head) :]
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "backslashreplace").decode() for c in text)


def shown(value: object) -> str:
    """A value read from TOML, as a message repeats it: printable, short, whatever it is."""
    if isinstance(value, str):
        return f'"{printable(value)}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        # str() of a huge int is slow, and refused by Python beyond 4300 digits
        return str(value) if value.bit_length() < 64 else "a whole number of more than 64 bits"
    if isinstance(value, float):
        return repr(value).removesuffix(".0")
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return "a table"
    return f"a {type(value).__name__}"


def counted(number: int, one: str, several: str = "") -> str:
    """A number of things: 1 iteration, 2 iterations."""
    return f"{number} {one if number == 1 else several or f'{one}s'}"


MOST_NAMES = 12
"""Known names that a message lists."""

LONGEST_LIST = 140
"""Characters that it takes for them; one name is listed however long it is."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """What to write instead of an unknown name: the nearest known one, else what there is."""
    known = list(known)
    near = get_close_matches(name[:LIMIT], known, n=1)
    if near:
        return f'did you mean "{near[0]}"?'
    return f"known here: {some(known)}" if known else "remove it; no entry is allowed here"


def refuse_unknown(what: str, name: str, known: Collection[str]) -> None:
    """Refuse a name that is none of those known, after some words on what it is the name of."""
    if name not in known:
        raise BadInput(f"{what} {shown(name)}; {suggestion(name, known)}")


def unlike(wanted: Iterable[object], given: Iterable[object], missing: str, foreign: str) -> str:
    """What of two collections of names is in one of them alone: ``missing: a; foreign: b, c``."""
    one, other = ([str(each) for each in group] for group in (wanted, given))
    lacking, odd = [name for name in one if name not in other], [name for name in other if name not in one]
    parts = ((f"{missing}: {some(names)}") for missing, names in ((missing, lacking), (foreign, odd)) if names)
    return "; ".join(parts)


def some(known: Sequence[str]) -> str:
    """Known names, as many as a message has room for."""
    ends = itertools.accumulate(len(name) + 2 for name in known[:MOST_NAMES])
    count = max(1, sum(end <= LONGEST_LIST for end in ends))
    return ", ".join(known[:count]) + (", ..." if len(known) > count else "")
