"""Division of formulas in plain notation, such as ``2n*x_dot``, into the tokens of their LaTeX."""

from __future__ import annotations

import re
from collections.abc import Callable

from satsym.auditing.latex.letters import Letter, of_word
from satsym.auditing.latex.tokens import (
    BROKEN,
    MAX_LENGTH,
    MAX_TOKENS,
    Token,
    Unread,
    braced,
    characters,
    placed,
    refuse_long,
)
from satsym.auditing.latex.words import FUNCTIONS, NUMBERED_FUNCTIONS

_PLAIN = re.compile(
    r"\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][-+]?[0-9]{1,2}(?![A-Za-z0-9_.]))?)"
    r"|(?P<above>d(?:\^?(?P<order>[2-4]))?(?P<of>[A-Za-z]\w*)?(?= */ *d[A-Za-z]))"
    r"|(?P<word>[A-Za-z](?:[A-Za-z0-9]|_(?=[A-Za-z0-9]))*)(?P<primes>'*)"
    r"|(?P<power>(?:\*\*|\^)\s*[-+]?)|(?P<sign>[^\sA-Za-z0-9]))"
)
"""Pattern of the pieces of plain notation; ``d2x`` is a differential only before a slash and another differential."""
_BELOW = re.compile(r"d(?:(?P<time>t)(?P<times>[2-4])|(?P<by>[A-Za-z]\w*))")
"""Pattern of the denominator of a quotient of differentials; ``dt2`` is the square of ``dt``."""


def plain_tokens(text: str, is_known: Callable[[Letter], bool]) -> list[Token]:
    """Return the tokens of a formula in plain notation, ``2n*x_dot`` or ``2 n x_dot``.

    Names, which may have several letters, functions and quotients of differentials are replaced by their LaTeX. An
    unknown word whose letters are all known becomes the product of its letters.

    Raises
    ------
    Unread
        If the formula is too long, or contains an invalid character.
    """
    if len(text) > MAX_LENGTH:
        raise Unread(f"the formula is longer than {MAX_LENGTH} characters; split it", 0)
    if broken := BROKEN.search(text):
        raise Unread("a character is invalid; save the text as UTF-8", broken.start())
    found: list[Token] = []
    text = text.replace("!=", "\u2260 ")
    for match in _PLAIN.finditer(text.rstrip()):
        kind = next(name for name in ("number", "above", "word", "power", "sign") if match[name] is not None)
        value, at = match[kind], match.start(kind)
        if kind == "above":
            found += placed(f"d{_order(match['order'])} {of_word(match['of']).latex if match['of'] else ''}", at)
        elif kind == "word" and found and found[-1].text == "/" and (below := _BELOW.fullmatch(value)):
            found += placed(f"d {of_word(below['time'] or below['by']).latex}{_order(below['times'])}", at)
        elif kind == "word":
            found += _word(value, len(match["primes"]), at, text[match.end() :].lstrip()[:1], is_known)
        elif kind == "sign":
            found += [Token("macro", "cdot", at)] if value == "*" else characters(value, at)
        elif kind == "power":
            found += [Token("sign", "^", at), *([Token("sign", value[-1], at)] if value[-1] in "+-" else [])]
        else:
            found.append(Token("number", value, at))
            refuse_long(found[-1])
    if len(found) > MAX_TOKENS:
        raise Unread(f"the formula has more than {MAX_TOKENS} symbols; split it", found[MAX_TOKENS].at)
    return _exponents_grouped(found)


def _order(digit: str | None) -> str:
    return f"^{digit}" if digit else ""


def _exponents_grouped(found: list[Token]) -> list[Token]:
    """Return the tokens with braces around exponents that have a sign or brackets."""
    for i in [k for k, token in enumerate(found[:-1]) if token.text == "^"][::-1]:
        last = first = i + 1 + (found[i + 1].text in "+-")
        depth = 0
        while last < len(found):
            depth += (found[last].text == "(") - (found[last].text == ")")
            last += 1
            if depth <= 0:
                break
        bracketed = first == i + 1 and found[first].text == "("
        if first > i + 1 or bracketed:
            inside = found[first + 1 : last - 1] if bracketed else found[i + 1 : last]
            found[i + 1 : last] = braced(inside, found[i].at)
    return found


def _word(word: str, primes: int, at: int, behind: str, is_known: Callable[[Letter], bool]) -> list[Token]:
    """Return the tokens of a name or function in plain notation."""
    if word in FUNCTIONS and (behind == "(" or word in NUMBERED_FUNCTIONS):
        return placed(rf"\operatorname{{{word}}}", at) if word == "sqrt" else [Token("macro", word, at)]
    letter = of_word(word).dotted(primes)
    if letter is None:
        raise Unread("there are too many primes here", at)
    singles = [Letter(one) for one in word]
    if not primes and word.isalpha() and not is_known(letter) and all(map(is_known, singles)):
        return [Token("letter", one, at + k) for k, one in enumerate(word)]
    return placed(letter.latex, at)
