"""Which names a ledger may use for derived things, told from the text of the derivation files alone.

Deriving takes a second; a misspelt name is refused before that. What passes here and is no name of the derivation
after all is refused once it has been derived.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from satsym.auditing.ledger.scopes import CONSTANTS, Scope, self_named
from satsym.formula.reading import MAX_NAME
from satsym.formula.tree import Call, Equality, Node, Sym, Text, walk
from satsym.status import BadInput
from satsym.wording import shown, suggestion

ADDRESS = re.compile(r"[A-Za-z][A-Za-z0-9_]*:[A-Za-z][A-Za-z0-9_]*\.[A-Za-z][A-Za-z0-9_.]*\Z")
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_PREFIXES = ("d_", "lambda_", "residual_", "given_", "on_reference_", "target_", "momentum_", "nu_")
_SUFFIXES = ("_hat", "_star", "_0", "_min", "_max", "_dot", "_ddot")
_FIXED = frozenset(
    "t t_f H H_star L S u_max energy angular_momentum jacobi_integral r_vector v_vector a_vector F_vector "
    "residual_t_f".split()
)
_ENTRY = re.compile(r"[A-Z][A-Za-z]*_")


def is_address(text: str) -> bool:
    """Whether a text is ``model:step.equation``."""
    return ADDRESS.match(text.strip()) is not None


@dataclass(frozen=True)
class Vocabulary:
    """Names that may occur in expressions over derived things."""

    words: Collection[str]
    own: Collection[str]

    def knows(self, name: str) -> bool:
        """Whether a derivation may have this name, or the ledger declares it."""
        if name in self.own or name in self.words:
            return True
        if len(name) > MAX_NAME:
            return False
        if any(name.startswith(prefix) and self.knows(name.removeprefix(prefix)) for prefix in _PREFIXES):
            return True
        if any(name.endswith(suffix) and self.knows(name.removesuffix(suffix)) for suffix in _SUFFIXES):
            return True
        entry = _ENTRY.match(name)
        parts = name[entry.end() :].split("_") if entry else []
        return any(self.knows("_".join(parts[:i])) and self.knows("_".join(parts[i:])) for i in range(1, len(parts)))

    def check(self, tree: Node | Equality) -> None:
        """Refuse unknown names and malformed addresses.

        Raises
        ------
        BadInput
            For the first of them.
        """
        for side in (tree.lhs, tree.rhs) if isinstance(tree, Equality) else (tree,):
            for _, part in walk(side):
                if isinstance(part, Sym) and not self.knows(part.name):
                    hint = suggestion(
                        part.name, sorted(self.own | _FIXED if isinstance(self.own, frozenset) else self.own)
                    )
                    raise BadInput(
                        f"{shown(part.name)} is no name of a derivation; {hint} (a symbol of your own: [symbols])"
                    )
                if isinstance(part, Call) and part.function == "at":
                    self.check_address(part)
                elif isinstance(part, Text) and part is side:
                    self._address(part.value)

    def check_address(self, call: Call) -> None:
        """Refuse ``at(...)`` of what is no address."""
        (argument,) = call.arguments
        if not isinstance(argument, Text):
            raise BadInput("at(...) takes an address in quotes, such as at('polar_orbit:first_order.r')")
        self._address(argument.value)

    def _address(self, address: str) -> None:
        if not is_address(address):
            raise BadInput(f"{shown(address)} is not an address; write model:step.equation")
        check_model(address.partition(":")[0])


def check_model(name: str) -> None:
    """Refuse the name of a model that no derivation file has.

    Raises
    ------
    BadInput
        If none has it.
    """
    if name not in _words():
        raise BadInput(f"no derivation {shown(name)}; `satsym models` lists the models")


def vocabulary(symbols: Mapping[str, object], scopes: Mapping[str, Scope]) -> Vocabulary:
    """The names of the shipped derivations and those that a ledger declares."""
    return Vocabulary(_words(), frozenset({*symbols, *self_named(scopes), *CONSTANTS}))


@cache
def _words() -> frozenset[str]:
    """Every word in the derivation files, which any declared name is."""
    found: set[str] = set(_FIXED)
    for entry in files("satsym.derivations").iterdir():
        if entry.name.endswith(".py"):
            found.update(_WORD.findall(entry.read_text(encoding="utf-8")))
    return frozenset(found)
