"""Which names a ledger may use for derived things, told from the text of the derivation files alone.

Deriving takes a second; a misspelt name is refused before that. What passes here and is no name of the derivation
after all is refused once it has been derived.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache
from importlib.resources import files

from satsym.formula.cells import Formula, cells
from satsym.formula.reading import MAX_NAME
from satsym.formula.tree import Call, Sym, Text, walk
from satsym.status import BadInput
from satsym.wording import shown, suggestion

ADDRESS = re.compile(r"[A-Za-z][A-Za-z0-9_]*:[A-Za-z][A-Za-z0-9_]*\.[A-Za-z][A-Za-z0-9_.]*\Z")
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_FIXED = (
    "t t_f H H_star L S u_max energy angular_momentum jacobi_integral r_vector v_vector a_vector F_vector residual_t_f"
).split()
_PARTS = "d lambda residual given on reference target momentum nu hat star 0 min max dot ddot".split()
"""What names are made with in deriving, beside words of the derivation files."""
_ENTRY = re.compile(r"^[A-Z][A-Za-z]*_")
"""What the name of an entry of a matrix begins with."""


def is_address(text: str) -> bool:
    """Whether a text is ``model:step.equation``."""
    return ADDRESS.match(text.strip()) is not None


def knows(name: str, own: Collection[str]) -> bool:
    """Whether a derivation may have this name, or the ledger declares it as its own."""
    made = len(name) <= MAX_NAME and all(part in _words() for part in _ENTRY.sub("", name).split("_"))
    return made or name in own or name in _words()


def check(tree: Formula, own: Collection[str]) -> None:
    """Refuse unknown names and malformed addresses."""
    for cell in cells(tree):
        for _, part in walk(cell):
            if isinstance(part, Sym) and not knows(part.name, own):
                hint = suggestion(part.name, sorted({*own, *_FIXED}))
                raise BadInput(
                    f"{shown(part.name)} is no name of a derivation; {hint} (a symbol of your own: [symbols])"
                )
            if isinstance(part, Call) and part.function == "at":
                (argument,) = part.arguments
                if not isinstance(argument, Text):
                    raise BadInput("at(...) takes an address in quotes, such as at('polar_orbit:first_order.r')")
                _check_address(argument.value)
            elif isinstance(part, Text) and part is cell:
                _check_address(part.value)


def _check_address(address: str) -> None:
    if not is_address(address):
        raise BadInput(f"{shown(address)} is not an address; write model:step.equation")
    check_model(address.partition(":")[0])


def check_model(name: str) -> None:
    """Refuse the name of a model that no derivation file has."""
    if name not in _words():
        raise BadInput(f"no derivation {shown(name)}; `satsym models` lists the models")


@cache
def _words() -> frozenset[str]:
    """Every word in the derivation files, which any declared name is."""
    names = {*_FIXED, *_PARTS}
    for entry in files("satsym.derivations").iterdir():
        if entry.name.endswith(".py"):
            names.update(_WORD.findall(entry.read_text(encoding="utf-8")))
    return frozenset(names | {part for name in names for part in name.split("_")})
