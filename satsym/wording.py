"""Pieces of one-line messages: foreign values made printable and short, and suggestions of similar names.

Text from a file or an argument may hold line breaks, terminal escapes, right-to-left marks or a megabyte of anything.
It reaches a message only through this module.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Sequence
from difflib import get_close_matches

from satsym.status import BadInput

LIMIT = 60
"""Largest number of characters of a foreign value that a message repeats."""


def printable(text: str, limit: int = LIMIT) -> str:
    """Return the text on one line, with unprintable characters escaped and the middle of a long text left out."""
    if len(text) > limit:
        head = (limit - 3) * 2 // 3
        text = text[:head] + "..." + text[len(text) - (limit - 3 - head) :]
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "backslashreplace").decode() for c in text)


def shown(value: object) -> str:
    """Return a value from TOML as a message repeats it: printable and short."""
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
    """Return a number with its noun, as in 1 iteration, 2 iterations."""
    return f"{number} {one if number == 1 else several or f'{one}s'}"


MOST_NAMES = 12
"""Largest number of known names that a message lists."""

LONGEST_LIST = 140
"""Largest number of characters of that list, except for a single longer name."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Suggest what to write instead of an unknown name: the nearest known one, or else all known ones."""
    known = list(known)
    near = get_close_matches(name[:LIMIT], known, n=1)
    if near:
        return f'did you mean "{near[0]}"?'
    return f"available: {some(known)}" if known else "remove it; no entry is allowed here"


def refuse_unknown(what: str, name: str, known: Collection[str]) -> None:
    """Refuse a name that is not among the known ones, after some words on what it names."""
    if name not in known:
        raise BadInput(f"{what} {shown(name)}; {suggestion(name, known)}")


def unlike(wanted: Iterable[object], given: Iterable[object], missing: str, foreign: str) -> str:
    """Describe the names that only one of two collections has: ``missing: a; foreign: b, c``."""
    one, other = ([str(each) for each in group] for group in (wanted, given))
    lacking, odd = [name for name in one if name not in other], [name for name in other if name not in one]
    parts = ((f"{missing}: {some(names)}") for missing, names in ((missing, lacking), (foreign, odd)) if names)
    return "; ".join(parts)


def some(known: Sequence[str]) -> str:
    """Return known names, as many as a message has room for."""
    ends = itertools.accumulate(len(name) + 2 for name in known[:MOST_NAMES])
    count = max(1, sum(end <= LONGEST_LIST for end in ends))
    return ", ".join(known[:count]) + (", ..." if len(known) > count else "")
