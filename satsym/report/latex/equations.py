"""Numbered, aligned equations from signed terms, broken where they are too long for a line.

The printed width of a formula is estimated from its LaTeX, in em of the main font. The estimate errs on the wide side;
a test compares it with TeX's own measurement.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from satsym.report.latex import tex
from satsym.report.latex.tex import label
from satsym.report.texts import Texts
from satsym.symbolic import Derivation, Equation, Step
from satsym.symbolic.latex.products import Piece, Term, joined
from satsym.symbolic.latex.typeset import Typesetter

LINE = 35.0
"""Width in em that an equation may take beside its number: 160 mm of 11-point type."""
INDENT = 1.0
"""Indent of continuation lines in em; it is doubled within parentheses."""

ROW_PLAIN, ROW_SMALL_FRACTIONS, ROW_ONE_FRACTION, ROW_FRACTIONS = (
    r" \\ " + (rf"\noalign{{\vskip {gap}pt}} " if gap else "") for gap in (0, 2, 5, 10)
)
"""Space between two rows of a matrix without fractions, with small fractions, and with fractions in one or both rows.

The denominator in one row must not seem to belong to the next row.
"""
TALL = 4
"""Number of lines up to which an equation is kept on one page."""
TOGETHER = 3
"""Number of lines up to which a group of equations is kept on one page."""
FEWEST = 2
"""Smallest number of lines of a group of equations on a page."""


@dataclass(frozen=True)
class Row:
    """A numbered equation in print."""

    address: str
    """Label of the equation."""
    left: tuple[Term, ...]
    right: tuple[Term, ...]
    """Terms of the left and of the right side."""
    also: str = ""
    """A further expression that equals the left-hand side, printed between both sides."""
    end: str = ""
    """A further relation at the end, such as ``= 0``."""
    again: bool = False
    """Whether the equation was shown before, and is printed with its earlier number."""

    @property
    def left_tex(self) -> str:
        """Return the left side on one line."""
        return joined(self.left) + (f" = {self.also}" if self.also else "")

    @property
    def tag(self) -> str:
        """Return the command that labels the equation."""
        address = label(self.address)
        return rf"\tag{{\ref{{{address}}}}}" if self.again else rf"\label{{{address}}}"


def array(cells: Sequence[Sequence[str]]) -> str:
    """Return a matrix; one row has commas, and a single entry has no parentheses."""
    if len(cells) == 1:
        listed = r",\; ".join(cells[0])
        return listed if len(cells[0]) == 1 else rf"\left({listed}\right)"
    rows = [" & ".join(row) for row in cells]
    body = rows[0] + "".join(_between(above, below) + below for above, below in pairwise(rows))
    body = body.replace(r"\frac", r"\dfrac")
    return rf"\left(\begin{{array}}{{@{{\,}}{'c' * len(cells[0])}@{{\,}}}} {body} \end{{array}}\right)"


def also(back: int, addresses: Sequence[str]) -> str:
    """Return further labels for an equation number, counted back from the last one."""
    return rf"\satsymalso{{{back}}}{{{','.join(map(label, addresses))}}}%" if addresses else ""


def _between(above: str, below: str) -> str:
    """Return what separates two rows of a matrix."""
    for fraction, both, one in (
        (r"\frac", ROW_FRACTIONS, ROW_ONE_FRACTION),
        (r"\tfrac", ROW_ONE_FRACTION, ROW_SMALL_FRACTIONS),
    ):
        if fraction in above and fraction in below:
            return both
        if fraction in above + below:
            return one
    return ROW_PLAIN


def display(rows: Sequence[Row], line: float = LINE) -> str:
    """Write equations, aligned at their equals signs, in as many environments as their widths need.

    Parameters
    ----------
    line
        Width in em that an equation may take beside its number.
    """
    blocks: list[list[Row]] = []
    for row in rows:
        alone = _left_is_long(row, line)
        if not blocks or alone or _left_is_long(blocks[-1][-1], line):
            blocks.append([])
        blocks[-1].append(row)
    return "\n".join(_block(rows, line) for rows in blocks)


def broken(terms: Sequence[Term], limit: float) -> list[str]:
    """Break a sum into as few lines as fit the limit, of similar lengths; later lines begin with their indent."""
    pieces: list[Piece] = []
    for place, term in enumerate(terms):
        whole = term.signed(first=place == 0)
        pieces += [Piece(whole)] if width(whole) <= limit else term.signed_pieces(first=place == 0)
    starts = _best_breaks(pieces, limit)
    lines = []
    for begin, end in pairwise([*starts, len(pieces)]):
        text = " ".join(p.tex for p in pieces[begin:end])
        indent = (r"\qquad " if pieces[begin].depth else r"\quad ") + "{}" if begin else ""
        lines.append(indent + text)
    return lines


def _best_breaks(pieces: Sequence[Piece], limit: float) -> list[int]:
    """Return where lines begin: with the fewest lines, then the most even ones, preferably outside parentheses."""
    widths = [width(p.tex) for p in pieces]
    best: list[tuple[tuple[int, float], list[int]]] = [((0, 0.0), [])]
    for end in range(1, len(pieces) + 1):
        choices = []
        for begin in range(end):
            depth = pieces[begin].depth
            indent = INDENT * (1 + bool(depth)) if begin else 0.0
            length = indent + sum(widths[begin:end])
            if length > limit and end - begin > 1:
                continue
            (lines, cost), starts = best[begin]
            cost += length**2 + (0.4 * limit) ** 2 * depth * bool(begin)
            choices.append(((lines + 1, cost), [*starts, begin]))
        best.append(min(choices))
    return best[-1][1]


def _left_is_long(row: Row, line: float) -> bool:
    left, right = width(row.left_tex), width(joined(row.right))
    return left > 0.4 * line and left + right + 1.3 > line


def _block(rows: list[Row], line: float) -> str:
    star = "*" if rows[0].again else ""
    if len(rows) == 1 and _left_is_long(rows[0], line):
        return _environment(f"equation{star}", [f"{_both_sides_broken(rows[0], line)} {rows[0].tag}"])
    room = line - max(width(row.left_tex) for row in rows) - 1.3
    lines = []
    for row in rows:
        right = broken(row.right, room - width(row.end))
        body = f"{row.left_tex} &= {_on_lines(right)}" + (f" {row.end}" if row.end else "")
        if 1 < len(right) <= TALL:
            body = f"\\begin{{split}}\n  {body}\n  \\end{{split}}"
        elif len(rows) == len(right) == 1:
            body = body.replace(" &= ", " = ", 1)
        lines.append(f"{body} {row.tag}")
    return _environment(("align" if len(rows) > 1 or len(right) > TALL else "equation") + star, lines)


def _on_lines(lines: Sequence[str]) -> str:
    """Write one side of an equation; where it has many lines, page breaks leave a few of them together."""
    if len(lines) <= TALL:
        return " \\\\\n  &".join(lines)
    apart = (FEWEST <= k <= len(lines) - FEWEST for k in range(1, len(lines)))
    ends = [r" \notag \displaybreak[2] \\" if here else r" \notag \\" for here in apart]
    return lines[0] + "".join(f"{end}\n  &{line}" for end, line in zip(ends, lines[1:], strict=True))


def _both_sides_broken(row: Row, line: float) -> str:
    """Write an equation with a long left side above the right one."""
    left = broken(row.left, line)
    right = broken(row.right, line - 2 * INDENT - 1.3)
    lines = [f"&{line}" for line in left] + [rf"&\qquad = {right[0]}"] + [rf"&\qquad\quad {line}" for line in right[1:]]
    return "\\begin{split}\n  " + " \\\\\n  ".join(lines) + "\n  \\end{split}"


def _environment(name: str, lines: Sequence[str]) -> str:
    last, tall = len(lines) - 1, any(r"\begin{array}" in line for line in lines)
    heights = [1 + line.count(r"\\") for line in lines]
    above = list(accumulate(heights))
    apart = [a >= FEWEST and above[-1] - a >= FEWEST for a in above]
    breakable = [tall or (above[-1] > TOGETHER and apart[k]) for k in range(last)]
    ends = [r" \displaybreak[2] \\" if b else r" \\" for b in breakable]
    body = "\n  ".join(line + end for line, end in zip(lines, [*ends, ""], strict=True))
    return f"\\begin{{{name}}}\n  {body}\n\\end{{{name}}}"


SCRIPT = 0.82
"""Size of subscripts and superscripts, relative to the main font."""

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
    """Estimate the width of a formula in display style."""
    return _Reader(tex).sequence()


class _Reader:
    def __init__(self, tex: str) -> None:
        self._tokens = _TOKEN.findall(tex)
        self._next = 0

    def sequence(self, closing: str = "") -> float:
        """Return the width up to the closing token, or to the end."""
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
        """Return the width of sub- and superscript of one nucleus, which are above each other."""
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


@dataclass(frozen=True)
class Context:
    """The derivation, texts and notation that typesetting a step needs besides the step."""

    derivation: Derivation
    texts: Texts
    typeset: Typesetter

    def address(self, step: Step) -> str:
        """Return the address of a step."""
        return f"{self.derivation.name}:{step.name}"

    def costates(self) -> list[str]:
        """Return the names of the costates, in the order of the states."""
        return [self.typeset.costate(v.symbol) for v in self.derivation.model.states]


@dataclass(frozen=True)
class Shown:
    """A step's equations in LaTeX, and the addresses of its first and last numbered equation."""

    body: str
    first: str
    last: str
    appendix: str = ""
    """Equations that are too many for the place of the step; empty if there are none."""


def numbers_of(first: str, last: str) -> str:
    """Refer to the equation number of an address, or to the range of two."""
    ends = dict.fromkeys((tex.label(first), tex.label(last)))
    return r"\mbox{--}".join(rf"\eqref{{{label}}}" for label in ends)


def row_of(context: Context, step: Step, equation: Equation, also: str = "", typeset: Typesetter | None = None) -> Row:
    """Return an equation as a row, in the notation of a typesetter."""
    typeset = typeset or context.typeset
    left, right = typeset.terms(equation.lhs), typeset.terms(equation.rhs)
    return Row(f"{context.address(step)}.{equation.name}", left, right, also)
