"""The contract of generated modules as a type stub, by which type checkers see their functions.

``python -m satsym.codegen.protocol`` writes the stub anew; a running program does not use it.
"""

from __future__ import annotations

from pathlib import Path

from satsym.kernels import contract
from satsym.kernels.contract import BATCH, TUPLES, Signature

FILE = Path(contract.__file__).with_name("functions.pyi")

WIDTH = 120
"""Characters in a line at most."""

HEAD = '''"""Functions of generated modules; written by ``python -m satsym.codegen.protocol`` from the contract."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array

Row = Sequence[float] | Array
Rows = Sequence[float | Array] | NDArray[np.inexact[Any]]
Table = Sequence[float] | Sequence[Array] | NDArray[np.inexact[Any]]
Times = float | NDArray[np.inexact[Any]]

class Functions(Protocol):
    """Each at one point in time, on numbers, and on arrays whose last axis counts points. Models have some of them."""

'''


def text() -> str:
    """Return the text of the whole stub."""
    return HEAD + "".join(line for one in contract.POINTWISE.items() for line in _stated(*one))


def _stated(name: str, signature: Signature) -> list[str]:
    """Return the lines that declare the types of both forms of a function."""
    of_point = ", ".join(f"{a}: {'float' if a == 't' else 'Row'}" for a in signature.arguments)
    of_many = ", ".join(f"{a}: {_of_many(a)}" for a in signature.arguments)
    value = "tuple[float, ...]" if signature.shape else "float"
    return [_line(name, of_point, value), _line(name + BATCH, f"{of_many}, out: Array | None = None", "Array")]


def _line(name: str, arguments: str, value: str) -> str:
    """Return the declaration of a method in the formatter's layout."""
    line = f"    def {name}(self, {arguments}) -> {value}: ...\n"
    return line if len(line) <= WIDTH + 1 else f"    def {name}(\n        self, {arguments}\n    ) -> {value}: ...\n"


def _of_many(argument: str) -> str:
    return "Times" if argument == "t" else "Rows" if argument in TUPLES else "Table"


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
