r"""Decision whether a bracket behind a letter is a factor for sure, or could be the argument of a function.

``k(x - y)`` and ``V(x - y)`` look the same. A bracket is a factor only if its contents or the usual meaning of the
letter say so; any other bracket that does not show clearly that it is an argument is refused.
"""

from __future__ import annotations

from collections.abc import Sequence

from satsym.auditing.latex.letters import GREEK, Letter
from satsym.auditing.latex.rows import split
from satsym.auditing.latex.tokens import Token, has_bold
from satsym.auditing.latex.words import COUNTERS, DECORATIONS, FUNCTIONS, RECIPROCALS, SHIFTED, UPRIGHT

_FUNCTIONS = frozenset("f F phi varphi Phi varPhi psi Psi chi Gamma zeta delta Delta d".split())
"""Letters of functions and operators, behind which no bracket is a factor for sure."""
_OFTEN_FUNCTIONS = frozenset("g G h p u w D E J L P T U V W Theta rho theta vartheta eta mu N S".split())
"""Letters of functions and quantities alike, behind which a bracket of plain letters is no factor for sure."""
_OF_MATRICES = frozenset("D L N P S T W".split())
"""Letters of functions that are often matrices or lengths."""
_VARIABLES = frozenset("x y z q s u v w r X Y Z theta vartheta phi varphi psi xi eta zeta omega".split())
"""Letters of which functions are functions."""
_TIMES, _STEPS = frozenset(("t", "tau")), frozenset("k n i j l".split())
"""Letters of times, and of the numbers of steps."""
_RATES = frozenset(("n",))
"""Letters that are multiplied by any time that has passed, as the mean motion."""
_STEADY = frozenset("a b c g k m n v A B C F K M N omega Omega lambda mu alpha beta gamma nu sigma kappa".split())
"""Letters that are multiplied by the time since an instant with an index, as in ``a(t - t_0)``."""
_COORDINATES = frozenset("x y z q r s theta phi varphi xi".split())
_STEPS_OF_VARIABLES = frozenset("h epsilon varepsilon delta Delta d".split())
"""Letters of small steps, or before the letter of one."""
_MASSES = frozenset("m M rho varrho".split())
_WORKED = frozenset(("frac", "dfrac", "tfrac", "sqrt", *(FUNCTIONS.keys() - {"d"}), *RECIPROCALS))
"""Macros of quotients, roots and functions."""
_OF_VECTORS = frozenset("Omega Xi Lambda Theta Sigma Pi Upsilon".split())
"""Letters of matrices that depend on a vector."""
_SCALARS = frozenset("a b c d e k l m n q r s v".split())
"""Letters that are seldom functions of anything but the time."""
_TURNS = frozenset("c s C S R".split())
"""Letters of abbreviated sines and cosines, and of rotations."""


def may_be_argument(letter: Letter, inside: Sequence[Token], raised: bool) -> bool:
    """Return whether a bracket behind a letter could be its argument; `raised` says that a power follows it."""
    terms = [part for part in split(inside, lambda t: t.is_sign("+-")) if part]
    if not terms:
        return False
    heads = [_head(term) for term in terms]
    plain = not any(map(_is_worked, terms))
    if letter.base in _FUNCTIONS and not letter.dots:
        return True
    if len(terms) == 1:
        return _may_be_single(letter, inside, terms[0], plain, raised)
    timed = set(heads) <= {*_TIMES, "T"} and not _TIMES.isdisjoint(heads) and not any(t.is_sign("-") for t in inside)
    return (
        (timed and letter.base not in _RATES)
        or _may_be_in_time(letter, terms, heads)
        or (plain and _may_be_next(letter, terms, heads))
        or _may_be_varied(letter, terms, heads)
        or (plain and letter.base in _TURNS and all(head in GREEK or not head for head in heads))
        or _may_be_of_variables(letter, terms, plain)
    )


def may_be_squared(letter: Letter, argument: Letter) -> bool:
    """Return whether a single letter in brackets with a power behind them could be a factor, as in m (v)^2."""
    return bool(argument.before) or letter.base in _SCALARS


def is_single(inside: Sequence[Token]) -> bool:
    """Return whether a bracket holds one term, which is neither a number nor a quotient nor a function."""
    if len(split(inside, lambda t: t.is_sign("+-,;"))) > 1 or any(t.kind == "begin" for t in inside):
        return False
    return (
        bool(inside) and inside[0].kind != "number" and inside[0].text not in _WORKED | {"-", "dot", "ddot", "partial"}
    )


def is_varied(inside: Sequence[Token]) -> bool:
    """Return whether a bracket holds a place near another one, such as x + h, or another time, such as t - T."""
    terms = [part for part in split(inside, lambda t: t.is_sign("+-")) if part]
    heads = [_head(term) for term in terms]
    unknown = Letter("x")
    return len(terms) > 1 and (_may_be_in_time(unknown, terms, heads) or _may_be_varied(unknown, terms, heads))


def is_step(part: Sequence[Token]) -> bool:
    """Return whether the tokens are a letter with a number or counter added or subtracted, like a later step."""
    counts = len(part) == 3 and (part[2].kind == "number" or part[2].text in COUNTERS)
    return counts and part[0].kind == "letter" and part[1].text in ("+", "-")


def is_lapse(part: Sequence[Token]) -> bool:
    """Return whether the tokens are a difference of two times."""
    named = [t.text for k, t in enumerate(part) if t.kind in ("letter", "macro") and part[k - 1].text not in "_{"]
    return len(named) == 2 and set(named) <= {"t", "tau", "s", "T"} and "-" in {t.text for t in part}


def _may_be_single(letter: Letter, inside: Sequence[Token], term: Sequence[Token], plain: bool, raised: bool) -> bool:
    """Return whether a bracket with one term, such as -x, 2x or x/2, could be an argument."""
    if raised:
        return False
    if term[0].is_sign("(") and len(term) > 2 and not term[-1].is_sign(")"):
        return True
    counted = term[0].kind == "number" and len(term) > 1 and (term[1].kind == "letter" or term[1].text in GREEK)
    negative = inside[0].is_sign("-") and _head(term) in _VARIABLES | _TIMES and len(term) == 1
    divided = any(t.text in ("/", "frac", "dfrac", "tfrac") for t in term)
    divided &= letter.base in _OFTEN_FUNCTIONS | SHIFTED | {"sigma"} and not letter.dots
    return (counted and plain) or negative or (divided and bool(_named(term) & (_VARIABLES | _TIMES)))


def _may_be_in_time(letter: Letter, terms: Sequence[Sequence[Token]], heads: Sequence[str]) -> bool:
    """Return whether a sum with a time in it could be the time at which something is taken, as with a delay."""
    times = [head for term, head in zip(terms, heads, strict=True) if head in _TIMES and len(term) == 1]
    if not times or letter.base in _RATES:
        return False
    since = [term for term in terms if _head(term) == "t" and len(term) > 1]
    elapsed = len(terms) == 2 and len(since) == 1
    steady = letter.base in _STEADY or letter.index[:1].isdigit() or (letter.dots > 0 and letter.base not in SHIFTED)
    return not (elapsed and steady)


def _may_be_next(letter: Letter, terms: Sequence[Sequence[Token]], heads: Sequence[str]) -> bool:
    """Return whether a sum like k + 1 or s + 1 could be the number of a step, or the variable of a transform."""
    if not all(len(term) == 1 for term in terms):
        return False
    counted = heads[0] in _STEPS and (terms[1][0].kind == "number" or set(heads) <= _STEPS)
    counted &= letter.base not in _STEPS and letter.base != heads[0]
    return counted or (heads[0] == "s" and letter.base.isupper() and letter.base != "K")


def _may_be_varied(letter: Letter, terms: Sequence[Sequence[Token]], heads: Sequence[str]) -> bool:
    """Return whether a sum like x + h or x - ct could be a place near another one, or one that moves."""
    placed = any(head in _COORDINATES and len(term) == 1 for term, head in zip(terms, heads, strict=True))
    if not placed:
        return False
    stepped = any(
        head in _STEPS_OF_VARIABLES and (len(term) == 1 or head not in "hd")
        for term, head in zip(terms, heads, strict=True)
    )
    moving = any(len(term) == 2 and term[-1].text == "t" for term in terms)
    return (stepped or moving) and letter.base not in ("m", "k")


def _may_be_of_variables(letter: Letter, terms: Sequence[Sequence[Token]], plain: bool) -> bool:
    """Return whether a sum of variables could be the argument of a letter that is often a function."""
    named = set[str]().union(*map(_named, terms))
    if letter.base in _OF_VECTORS and has_bold(terms[0]):
        return True
    dotted = any(t.text in ("dot", "ddot") for term in terms for t in term)
    if letter.base == "sigma":  # an activation
        return any(len(term) > 1 and term[0].text.isupper() and term[1].kind == "letter" for term in terms)
    if letter.base not in _OFTEN_FUNCTIONS or dotted or letter.dots:
        return False
    if letter.base in "gG":
        return not named & _MASSES and bool(named & _VARIABLES) and plain
    numbered = terms[0][0].kind == "number"
    if letter.base == "E":
        return plain
    if letter.base in _OF_MATRICES:
        return plain and not numbered and all(len(term) == 1 for term in terms) and bool(named & _COORDINATES)
    if not plain and not numbered:
        squares = not any(t.text in _WORKED for term in terms for t in term)
        return squares and bool(named) and named <= _COORDINATES
    return bool(named & _VARIABLES) and not numbered


def _head(term: Sequence[Token]) -> str:
    """Return the letter with which a term begins, without its decorations; empty if it begins with something else."""
    for token in term:
        if token.kind == "letter" or token.text in GREEK:
            return token.text
        if not (token.kind == "open" or token.is_macro(DECORATIONS | UPRIGHT)):
            return ""
    return ""


def _named(term: Sequence[Token]) -> set[str]:
    """Return the letters of a term, without those of indices."""
    found: set[str] = set()
    depth = index = 0
    for k, token in enumerate(term):
        scripted = k > 0 and term[k - 1].is_sign("_^")
        depth += token.group
        if index and depth < index:
            index = 0
        if token.kind == "open" and scripted:
            index = depth
        elif not index and not scripted and (token.kind == "letter" or token.text in GREEK):
            found.add(token.text)
    return found


def _is_worked(term: Sequence[Token]) -> bool:
    """Return whether a term contains a function, quotient or power, unlike a variable or a product of variables."""
    powers = any(
        t.is_sign("^") and k + 1 < len(term) and (term[k + 1].kind == "number" or term[k + 1].text in "{")
        for k, t in enumerate(term)
    )
    return powers or any(t.text in _WORKED or t.is_sign("/") for t in term)
