"""What keeps a row from being judged, as one line that names it: bad input, or more work than a row may take."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from satsym.auditing.judge.bench import Bench
from satsym.auditing.ledger.contents import Row
from satsym.formula import field
from satsym.formula.budget import Limit
from satsym.status import BadInput
from satsym.wording import printable

T = TypeVar("T")


class Refused(BadInput):
    """A row cannot be judged; the message names it."""


def named(bench: Bench, row: Row, limit: Limit, work: Callable[[], T], where: str = "") -> T:
    """Do some work for a row, within a limit; refused with its line and name, and the key that is to blame.

    Where the work met another row that is refused, it is that one which is named.
    """
    try:
        return bench.allowance.within(limit, work)
    except Refused:
        raise
    except (BadInput, field.Undecided) as error:
        why = str(error)
    except (RecursionError, MemoryError):
        why = "is nested too deep, or too large; split it into rows"
    raise Refused(f"{row.place}: row {printable(row.key)}: {f'{where}: ' if where else ''}{why}")
