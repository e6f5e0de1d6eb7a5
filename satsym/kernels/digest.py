"""The digest that a generated module carries, so that one that was edited by hand is known from one that was not.

It guards against accidents, not against malice: whoever recomputes it meets :mod:`satsym.kernels.consistency`.
"""

from __future__ import annotations

import re
from hashlib import sha256

_LINE = re.compile(r"^Digest: ([0-9a-f]{64})\n", re.MULTILINE)
_PLACE = "    satsym derive "


def sealed(text: str) -> str:
    """The text of a module with its digest in the docstring, below the command that writes it.

    A digest that it has already is replaced.
    """
    bare = _without(text)
    end = bare.index("\n", bare.index(_PLACE)) + 1
    return f"{bare[:end]}Digest: {_of(bare)}\n{bare[end:]}"


def intact(text: str) -> bool:
    """Whether a module says of itself what it is; one without a digest does not. Ends of lines do not count."""
    text = text.replace("\r\n", "\n")
    found = _LINE.search(text)
    return found is not None and found[1] == _of(_without(text))


def _without(text: str) -> str:
    return _LINE.sub("", text, count=1)


def _of(bare: str) -> str:
    return sha256(bare.encode()).hexdigest()
