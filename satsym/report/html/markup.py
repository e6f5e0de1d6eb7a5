"""HTML from pieces: what is no markup already is escaped, whoever wrote it."""

from __future__ import annotations

from html import escape

_VOID = frozenset({"meta", "input"})


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def tag(name: str, /, *inside: str, **attributes: str | bool) -> Markup:
    """An element; attributes that are false are left out, and underscores at the end or inside are for Python."""
    given = "".join(_attribute(key, value) for key, value in attributes.items() if value is not False)
    if name in _VOID:
        return Markup(f"<{name}{given}>")
    return Markup(f"<{name}{given}>{joined(*inside)}</{name}>")


def joined(*pieces: str, by: str = "") -> Markup:
    """Pieces one after the other."""
    return Markup(by.join(piece if isinstance(piece, Markup) else escape(piece) for piece in pieces))


def _attribute(key: str, value: str | bool) -> str:
    name = key.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{escape(str(value))}"'
