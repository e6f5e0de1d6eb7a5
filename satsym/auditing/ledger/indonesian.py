"""Indonesian subjects of rows, from a flat table next to the ledger: ``"English subject" = "Indonesian subject"``."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from satsym.auditing.ledger.contents import Row
from satsym.auditing.ledger.positions import Part
from satsym.instance import files
from satsym.status import BadInput
from satsym.wording import printable, shown

_CLAUSE = re.compile(r"[;:] ")


def added(rows: Iterable[Row], path: Path) -> list[Row]:
    """Return the rows with their Indonesian subjects, or unchanged if the file does not exist.

    Raises
    ------
    BadInput
        If an entry is not a text, or no row has this subject; the message contains file and line.
    """
    rows = list(rows)
    if not path.exists():
        return rows
    try:
        part = Part(path, files.read(path), 0)
    except BadInput as error:
        raise BadInput(f"{printable(str(path), 200)}: {error}") from None
    said = {row.table.says for row in rows if row.table.says}
    for english, text in part.tree.items():
        place, begins = part.place("", 0, english), shown(_CLAUSE.split(english)[0])
        if not isinstance(text, str) or not text.strip():
            raise BadInput(f"{place}: got {shown(text)} for {begins}; write the Indonesian translation in quotes")
        if english not in said:
            raise BadInput(
                f"{place}: no row has the text {begins}; copy the text of a row exactly, or remove this entry"
            )
    return [replace(row, says_id=part.tree.get(row.table.says, "")) for row in rows]
