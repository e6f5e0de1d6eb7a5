"""How wide a formula will be in print, estimated from its LaTeX, so that long ones are broken before TeX sees them.

In em of the main font. The estimate errs on the wide side; a test holds it against what TeX measures.
"""

from __future__ import annotations

import re

SCRIPT = 0.82
"""Size of sub- and superscripts."""

_TOKEN = re.compile(r"\\[A-Za-z]+\*?|\\.|.", re.DOTALL)
_ACCENTS = frozenset(rf"\{name}" for name in "dot ddot dddot hat bar tilde vec check breve".split())
_FONTS = frozenset(
    rf"\{name}" for name in "mathbf mathrm mathit mathcal mathsf text boldsymbol bm operatorname".split()
)
_SIZES = {r"\bigl": 0.46, r"\bigr": 0.46, r"\Bigl": 0.6, r"\Bigr": 0.6, r"\biggl": 0.74, r"\biggr": 0.74}
_SIZES |= {r"\Biggl": 0.8, r"\Biggr": 0.8}
_WORDS = {name: 0.5 * len(name) + 0.2 for name in "sin cos tan cot sec csc sinh cosh tanh ln exp min max".split()}
_COMMANDS = {r"\,": 0.17, r"\:": 0.23, r"\;": 0.28, r"\quad": 1.0, r"\qquad": 2.0, r"\!": -0.17, r"\ ": 0.33}
_COMMANDS |= {r"\{": 0.5, r"\}": 0.5, r"\_": 0.5, r"\cdot": 0.72, r"\partial": 0.56, r"\int": 1.0}
_COMMANDS |= {rf"\{word}": width for word, width in _WORDS.items()}
_CHARACTERS = {"+": 1.23, "-": 1.23, "=": 1.34, "(": 0.39, ")": 0.39, ",": 0.45, "/": 0.5, " ": 0.0, "^": 0.0, "&": 0.0}


def width(tex: str) -> float:
    """Estimated width of a formula in display style."""
    return _Reader(tex).sequence()


class _Reader:
    def __init__(self, tex: str) -> None:
        self._tokens = _TOKEN.findall(tex)
        self._next = 0

    def sequence(self, closing: str = "") -> float:
        """Width up to the closing token, or to the end."""
        total = 0.0
        while self._next < len(self._tokens):
            if self._tokens[self._next] == closing:
                self._next += 1
                return total
            total += self._item()
        return total

    def _item(self) -> float:
        token = self._take()
        if token in "_^":
            return self._scripts(token)
        if token == "{":
            return self.sequence("}")
        if token in (r"\frac", r"\dfrac"):
            return max(self._argument(), self._argument()) + 0.3
        if token == r"\tfrac":
            return SCRIPT * max(self._argument(), self._argument()) + 0.3
        if token == r"\sqrt":
            return self._argument() + 0.9
        if token in _ACCENTS:
            return self._argument()
        if token in _FONTS:
            return 1.05 * self._argument()
        if token in _SIZES:
            self._take()
            return _SIZES[token]
        if token.startswith("\\"):
            return _COMMANDS.get(token, 0.62)
        return _CHARACTERS.get(token, 0.76 if token.isupper() else 0.56)

    def _scripts(self, first: str) -> float:
        """Sub- and superscript of one nucleus stand above each other."""
        widest = SCRIPT * self._argument()
        if self._next < len(self._tokens) and self._tokens[self._next] in "_^" and self._tokens[self._next] != first:
            self._take()
            widest = max(widest, SCRIPT * self._argument())
        return widest + 0.05

    def _argument(self) -> float:
        while self._next < len(self._tokens) and self._tokens[self._next] == " ":
            self._take()
        return self._item() if self._next < len(self._tokens) else 0.0

    def _take(self) -> str:
        token = self._tokens[self._next]
        self._next += 1
        return token
