"""The keys of a ledger and their types. Unknown keys are refused by name."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta

from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

FORMAT = 1
Kind = Literal["equation", "matrix", "number", "table", "algorithm", "claim", "unit"]
Role = Literal[
    "premise", "step", "result", "conclusion", "definition", "instruction", "citation", "consistency", "notation"
]

Text = Annotated[str, Meta(description="text in quotes")]
Texts = Annotated[tuple[str, ...], Meta(description='a list of strings, such as ["a", "b"]')]
Formulas = Annotated[dict[str, str], Meta(description='a table of strings, such as x1 = "r"')]
Printed = Annotated[
    str | tuple[str | tuple[str, ...], ...],
    Meta(
        description=(
            "the printed expression, in quotes; for a matrix or a table, a list of rows, each of them a list of strings"
        )
    ),
]
Whole = Annotated[int, Meta(ge=1, le=3000, description="a whole number")]
Flag = Annotated[bool, Meta(description="true or false")]


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of all tables of a ledger, which refuses unknown keys."""


class DocumentTable(Table, frozen=True):
    """Table of a ledger that describes the document.

    ``numbers`` lists the numbers of its equations etc.; ``model`` is the model whose names and units need no prefix.
    """

    key: Text
    title: Text
    authors: Text = ""
    year: Whole | None = None
    language: Text = "en"
    numbers: Texts = ()
    model: Text = ""


class SymbolTable(Table, frozen=True):
    """Table of a symbol that no derivation defines: its unit, empty if unknown, and whether it is positive."""

    unit: Text = ""
    positive: Flag = False


class RowTable(Table, frozen=True, rename={"follows": "from"}):
    """Table of one printed item, and what it is compared with.

    For a claim, ``printed`` is the proposition, ``because`` the reason that the document gives, ``from`` the rows from
    which it is concluded, and ``produced`` a proposition that is true if the claim is caused by the printed algorithm
    instead of the problem. ``why`` is an explanation for readers why the row is not confirmed, with terms to be
    evaluated in braces, and ``why_id`` the same in Indonesian. ``draft`` marks a row that no person has confirmed.
    """

    item: Text
    kind: Kind
    printed: Printed = ""
    holds: Text = ""
    part: Text = ""
    where: Text = ""
    says: Text = ""
    original: Text = ""
    scope: Text = "main"
    follows: Text | Texts = ""
    because: Text = ""
    produced: Text = ""
    why: Text = ""
    why_id: Text = ""
    role: Role = "step"
    columns: Texts = ()
    inputs: Formulas = {}
    legible: Flag = True
    draft: Flag = False


class ContentsTable(Table, frozen=True):
    """Table of the stored coverage of a text.

    For each kind it maps the name of an entry to the row that covers it, or ``none: `` and the reason why it needs no
    row.
    """

    text_digest: Text
    formulas: Formulas = {}
    figures: Formulas = {}
    tables: Formulas = {}
    sections: Formulas = {}
    sentences: Formulas = {}


KINDS: tuple[str, ...] = get_args(Kind)
_WORDS = {
    "kind": "one of " + ", ".join(f'"{kind}"' for kind in KINDS),
    "role": "one of " + ", ".join(f'"{role}"' for role in get_args(Role)),
}


class WrongKey(BadInput):
    """A key of a ledger is unknown, missing or of the wrong type; ``key`` is its name."""

    def __init__(self, key: str, message: str) -> None:
        super().__init__(f"{printable(key)}: {message}")
        self.key = key


def table(tree: Any, kind: type[Any]) -> Any:
    """Return a table of the ledger as an object, after its keys and types are checked."""
    if not isinstance(tree, dict):
        raise WrongKey("", f"got {shown(tree)}; write a table")
    fields = _fields(kind)  # type: ignore[arg-type]
    for key in tree:
        if key not in fields:
            raise WrongKey(key, f"unknown key; {suggestion(key, fields)}")
    for key, entry in fields.items():
        if entry.required and key not in tree:
            raise WrongKey(key, f"missing; give {_wanted(key, entry.type)}")
    for key, value in tree.items():
        try:
            msgspec.convert(value, fields[key].type)
        except msgspec.ValidationError:
            raise WrongKey(key, f"got {shown(value)}; give {_wanted(key, fields[key].type)}") from None
    return msgspec.convert(tree, kind)


@cache
def _fields(kind: type[Any]) -> dict[str, Any]:
    return {entry.encode_name: entry for entry in msgspec.structs.fields(kind)}


def _wanted(key: str, kind: Any) -> str:
    metas = (meta for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ()))
    return _WORDS.get(key) or next((str(meta.description) for meta in metas), "another value")
