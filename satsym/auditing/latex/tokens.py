"""Division of LaTeX into tokens with their positions, by pylatexenc, and replacement of the document's own macros."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

from satsym.auditing.latex.words import STYLES
from satsym.formula.reading import MAX_DEPTH, MAX_DIGITS
from satsym.status import BadInput
from satsym.wording import printable

MAX_LENGTH = 20_000
"""Number of characters that one formula may have."""
MAX_TOKENS = 8000
"""Number of tokens that one formula may have after its macros are replaced; this also stops recursive macros."""
COMMA_IN_NUMBER = "this comma could separate decimals, thousands or two numbers; write 1.5, 1500 or a space behind it"
_MAX_NESTING = 30
"""Number of levels to which macros may occur within macros."""


class Unread(BadInput):
    """A formula cannot be read; contains the reason and the position of the character."""

    def __init__(self, message: str, at: int) -> None:
        super().__init__(f"{message} (character {at + 1})")
        self.message, self.at = message, at


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a LaTeX formula.

    ``kind`` is ``letter``, ``number``, ``macro``, ``sign`` (any other character), ``open``, ``close``, ``begin`` or
    ``end`` (of an environment); ``at`` is the position of its first character.
    """

    kind: str
    text: str
    at: int

    def is_macro(self, names: str | Container[str]) -> bool:
        """Return whether the token is the macro of this name, or one of several macros."""
        return self.kind == "macro" and (self.text == names if isinstance(names, str) else self.text in names)

    def is_sign(self, signs: Container[str]) -> bool:
        """Return whether the token is one of some signs."""
        return self.kind == "sign" and self.text in signs

    @property
    def group(self) -> int:
        """1 if the token opens a group or an environment, -1 if it closes one, otherwise 0."""
        return (self.kind in ("open", "begin")) - (self.kind in ("close", "end"))

    @property
    def nesting(self) -> int:
        """1 if the token opens a group, an environment or a bracket, -1 if it closes one, otherwise 0."""
        return self.group + self.is_sign("([") - self.is_sign(")]")


END = Token("nothing", "\0", sys.maxsize)
"""Token that stands for the end of a formula."""


@dataclass(frozen=True)
class Macro:
    """A macro that the document defines: its number of arguments and its replacement.

    If it has a ``default``, the first argument is optional and given in square brackets. A star after a ``starred``
    macro changes only sizes.
    """

    arguments: int
    body: tuple[Token, ...]
    default: tuple[Token, ...] | None = None
    starred: bool = False


UNKNOWN = Macro(0, ())
"""A macro whose definition could not be read."""
Macros = Mapping[str, Macro]
_GAP = r"(?:\\,| )"
_NUMBER = re.compile(
    rf"(?:[0-9]{{1,3}}(?:{_GAP}[0-9]{{3}})+(?![0-9])|[0-9]+)"
    rf"(?:\.(?:(?:[0-9]{{3}}{_GAP})+[0-9]{{1,3}}(?![0-9])|[0-9]+))?|\.[0-9]+"
)
"""Pattern of a number, whose digits may be parted into groups of three."""
_DECIMAL_COMMA = re.compile(r"(?<=[0-9])\{,\}(?=[0-9])")
_POWER_OF_TEN = re.compile(r"\s*\\(?:times|cdot)\s*10\s*\^")
BROKEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffd]")
"""Pattern of the characters that no formula may contain."""
_SUBSTITUTES = {
    "\u2212": "-",
    "\u00b7": r"\cdot ",
    "\u22c5": r"\cdot ",
    "\u00d7": r"\times ",
    "\u2032": "'",
    "\u00b0": r"^\circ ",
    "\u00b2": "^2",
    "\u00b3": "^3",
    "\u00bd": "(1/2)",
    "\u2202": r"\partial ",
    "\u2260": r"\ne ",
    "\u2264": r"\le ",
    "\u2265": r"\ge ",
}
_GREEK = dict(
    zip(
        "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩ",
        "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi "
        "omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega".split(),
        strict=True,
    )
)


def tokens(text: str, macros: Macros | None = None, start: int = 0) -> list[Token]:
    """Return the tokens of a formula.

    Parameters
    ----------
    text
        LaTeX of the formula, without the delimiters of mathematics.
    macros
        Macros that the document defines.
    start
        Position of the first character in the document.

    Raises
    ------
    Unread
        If the formula is too long, also after its macros are replaced, or if it contains an invalid character.
    """
    if len(text) > MAX_LENGTH:
        raise Unread(f"the formula is longer than {MAX_LENGTH} characters; split it", start)
    if broken := BROKEN.search(text):
        raise Unread("a character is invalid; save the file as UTF-8", start + broken.start())
    found = expanded(_pieces(text, start), macros or {})
    depth = 0
    for token in found:
        depth += token.group
        if depth > MAX_DEPTH or depth < 0:
            why = (
                f"braces are nested more than {MAX_DEPTH} levels deep"
                if depth > 0
                else "this closing brace has no opening brace"
            )
            raise Unread(why, token.at)
        refuse_long(token)
    if depth:
        raise Unread("a brace is not closed", start + len(text.rstrip()))
    return found


def refuse_long(token: Token) -> None:
    """Refuse a number that has too many digits."""
    if token.kind == "number" and len(token.text) > MAX_DIGITS:
        raise Unread(f"a number has more than {MAX_DIGITS} digits", token.at)


def expanded(found: Sequence[Token], macros: Macros, depth: int = 0) -> list[Token]:
    """Return the tokens with macros replaced, each at the position of its macro.

    Raises
    ------
    Unread
        If macros are nested too deeply, or an argument is missing.
    """
    done: list[Token] = []
    rest, i = list(found), 0
    while i < len(rest):
        token = rest[i]
        macro = macros.get(token.text) if token.kind == "macro" else None
        i += 1
        if macro is None:
            done.append(token)
        else:
            if depth >= _MAX_NESTING:
                raise Unread(f"macros are nested too deeply in \\{printable(token.text)}", token.at)
            if macro is UNKNOWN:
                raise Unread(f"the definition of \\{printable(token.text)} is not supported", token.at)
            i += macro.starred and i < len(rest) and rest[i].text == "*"
            arguments = []
            if macro.default is not None:
                argument, i = _optional(rest, i, macro.default)
                arguments.append(argument)
            for _ in range(macro.arguments - len(arguments)):
                argument, i = _argument(rest, i, token)
                arguments.append(argument)
            done += expanded(_filled(macro, arguments, token.at), macros, depth + 1)
        if len(done) > MAX_TOKENS:
            raise Unread(
                f"the formula has more than {MAX_TOKENS} symbols, with its macros expanded; split it", token.at
            )
    return done


def group_end(found: Sequence[Token], i: int) -> int:
    """Return the position after the group or token at a position; the number of tokens if a group is not closed."""
    return end_of(found, i, lambda token: (token.kind == "open") - (token.kind == "close"))


def end_of(found: Sequence[Token], i: int, nesting: Callable[[Token], int]) -> int:
    """Return the position after the part at a position; `nesting` tells by how much a token changes the depth."""
    depth = 0
    for k in range(i, len(found)):
        depth += nesting(found[k])
        if depth == 0:
            return k + 1
    return len(found)


def environment(token: Token) -> int:
    """Return 1 if a token begins an environment, -1 if it ends one, otherwise 0."""
    return (token.kind == "begin") - (token.kind == "end")


def group_at(found: Sequence[Token], i: int) -> tuple[list[Token], int]:
    """Return the contents of the group at a position, or the token there, and the position after it."""
    end = group_end(found, i)
    return list(found[i + 1 : end - 1] if i < len(found) and found[i].kind == "open" else found[i:end]), end


def braced(inside: Sequence[Token], at: int) -> list[Token]:
    """Return tokens in braces."""
    return [Token("open", "{", at), *inside, Token("close", "}", at)]


def in_tex(part: Sequence[Token]) -> str:
    """Return the LaTeX text of tokens."""
    said, after_macro = "", False
    for token in part:
        text = f"\\{token.text}" if token.kind == "macro" else token.text
        said += f" {text}" if after_macro and text[:1].isalpha() else text
        after_macro = token.kind == "macro" and token.text[-1:].isalpha()
    return said


def has_bold(part: Sequence[Token]) -> bool:
    """Return whether the tokens contain a letter that is typeset as a vector."""
    return any(token.kind == "macro" and STYLES.get(token.text) == "vector" for token in part)


def _argument(found: Sequence[Token], i: int, macro: Token) -> tuple[list[Token], int]:
    if i >= len(found):
        raise Unread(f"\\{printable(macro.text)} has too few arguments", macro.at)
    return group_at(found, i)


def _optional(found: Sequence[Token], i: int, default: Sequence[Token]) -> tuple[Sequence[Token], int]:
    """Return the optional argument of a macro at a position, or its default, and the position after it."""
    depth = 0
    for k in range(i, len(found)) if i < len(found) and found[i].text == "[" else ():
        opens, closes = found[k].text == "[", found[k].text == "]"
        depth += (opens or found[k].kind == "open") - (closes or found[k].kind == "close")
        if depth == 0:
            return found[i + 1 : k], k + 1
    return default, i


def _filled(macro: Macro, arguments: Sequence[Sequence[Token]], at: int) -> list[Token]:
    filled: list[Token] = []
    body = macro.body
    for k, token in enumerate(body):
        before = body[k - 1] if k else None
        if before is not None and before.is_sign("#") and token.kind == "number":
            filled.pop()
            place = int(token.text[0]) - 1
            if place < len(arguments):
                filled += arguments[place]
            if token.text[1:]:
                filled.append(Token("number", token.text[1:], at))
        else:
            filled.append(replace(token, at=at))
    return filled


def _pieces(text: str, start: int) -> list[Token]:
    """Return the tokens that pylatexenc finds, with digits joined to numbers and without comments."""
    from pylatexenc.latexwalker import LatexWalker, LatexWalkerEndOfStream, LatexWalkerParseError

    walker = LatexWalker(text, tolerant_parsing=False)
    found: list[Token] = []
    position = 0
    while position < len(text):
        number = _NUMBER.match(text, position)
        if number:
            value, position = re.sub(_GAP, "", number[0]), number.end()
            while (comma := _DECIMAL_COMMA.match(text, position)) and "." not in value:
                digits = _NUMBER.match(text, comma.end())
                assert digits is not None
                if len(digits[0]) == 3 and value != "0" and not _POWER_OF_TEN.match(text, digits.end()):
                    raise Unread(COMMA_IN_NUMBER, start + position)
                value, position = f"{value}.{digits[0]}", digits.end()
            found.append(Token("number", value, start + number.start()))
            continue
        try:
            token = walker.get_token(position, environments=True)
        except LatexWalkerEndOfStream:
            break
        except (LatexWalkerParseError, RecursionError, IndexError):
            raise Unread("a command, a group or an environment is incomplete here", start + position) from None
        if token.pos > position and _NUMBER.match(text, token.pos):
            position = token.pos
            continue
        if token.pos + token.len <= position:
            break
        position = token.pos + token.len
        at = start + token.pos
        kind, argument = token.tok, token.arg
        if kind == "macro":
            found.append(Token("macro", argument, at))
        elif kind in ("brace_open", "brace_close"):
            sort = ("open" if kind == "brace_open" else "close") if argument in "{}" else "sign"
            found.append(Token(sort, argument, at))
        elif kind in ("begin_environment", "end_environment"):
            found.append(Token(kind.partition("_")[0], argument, at))
        elif kind in ("mathmode_inline", "mathmode_display"):
            found.append(Token("sign", "$", at))
        elif kind == "specials":
            found += characters(argument.specials_chars, at)
        elif kind == "char":
            found += characters(argument, at)
    return found


def characters(text: str, at: int) -> list[Token]:
    """Return the tokens of characters that stand for themselves, all at one given position."""
    found = []
    for character in text:
        if character in _SUBSTITUTES:
            found += placed(_SUBSTITUTES[character], at)
        elif character in _GREEK:
            found.append(Token("macro", _GREEK[character], at))
        elif character.isascii() and character.isalpha():
            found.append(Token("letter", character, at))
        elif not character.isspace():
            found.append(Token("sign", character, at))
    return found


def placed(latex: str, at: int) -> list[Token]:
    """Return the tokens of some LaTeX, all at one given position."""
    return [replace(token, at=at) for token in _pieces(latex, 0)]
