"""LaTeX of control laws: minimisers of H in the terms of textbooks, with delimiters of suitable size."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from functools import partial, reduce

import sympy as sp
from sympy.printing.latex import LatexPrinter

from satsym.symbolic.functions.minimisers import Clip
from satsym.symbolic.functions.pieces import pieces_of
from satsym.symbolic.functions.roots import Root
from satsym.symbolic.latex.products import sides

LE, GE = r"\le", r"\ge"


class LawPrinter(LatexPrinter):
    """A LaTeX printer of sympy with the functions of control laws.

    Parameters
    ----------
    taken
        LaTeX of what has a letter of its own.
    comma
        Whether decimal numbers have a comma.
    """

    def __init__(self, taken: Collection[str], comma: bool) -> None:
        separator = "comma" if comma else "period"
        super().__init__({"fold_frac_powers": True, "ln_notation": True, "decimal_separator": separator})
        self._taken = taken
        self._small = 0  # how many fractions, roots and exponents we are within

    def _print_Max(self, expr: sp.Expr, exp: str | None = None) -> str:
        parts = map(self._print, sorted(expr.args, key=sp.default_sort_key))
        tex = reduce(partial(extreme, rf"\{expr.func.__name__.lower()}"), parts)
        return f"{self._enclosed(tex)}^{{{exp}}}" if exp else tex

    _print_Min = _print_Max

    def _print_Clip(self, expr: sp.Expr, exp: str | None = None) -> str:
        value, lower, upper = map(self._print, expr.args)
        return extreme(r"\max", lower, extreme(r"\min", upper, value))

    def _print_Switch(self, expr: sp.Expr, exp: str | None = None) -> str:
        reverse = expr.args[0].could_extract_minus_sign()
        slope, weight, low, high = expr.args
        value, *others = map(self._print, (-slope if reverse else slope, weight, low, high))
        return levels(value, others[0], others[1], others[2], reverse)

    def _print_SignedClip(self, expr: sp.Expr, exp: str | None = None) -> str:
        slope, weight, *smoothing, low, high = map(self._print, expr.args)
        v = letter(self._taken)
        bent = "".join(rf"\tfrac{{1}}{{2}} {e} {v}^{{2}} + " for e in smoothing)
        among = rf"{low} \le {v} \le {high}" if smoothing else rf"{v} \in \{{{low},\, {nearest(low, high)},\, {high}\}}"
        return self._argmin(rf"{bent}{slope} {v} + {weight} |{v}|", among, exp)

    _print_SignedSwitch = _print_SignedClip

    def _argmin(self, value: str, among: str, exp: str | None) -> str:
        least = rf"\operatorname*{{arg\,min}}_{{{among}}} {self._enclosed(value)}"
        return rf"{self._enclosed(least)}^{{{exp}}}" if exp else least

    def _print_sign(self, expr: sp.Expr, exp: str | None = None) -> str:
        raised = rf"^{{{exp}}}" if exp else ""
        return rf"\operatorname{{sgn}}{raised}{self._enclosed(self._print(expr.args[0]))}"

    def _print_Shrink(self, expr: sp.Expr, exp: str | None = None) -> str:
        value, width = map(self._print, expr.args)
        return rf"\mathcal{{S}}_{{{width}}}({value})"

    def _print_Shorten(self, expr: sp.Expr, exp: str | None = None) -> str:
        norm_squared, limit = expr.args
        with self._inside():
            ratio = rf"\frac{{{self._print(limit)}}}{{\sqrt{{{self._print(norm_squared)}}}}}"
        return extreme(r"\min", "1", ratio)

    def _print_Stretch(self, expr: sp.Expr, exp: str | None = None) -> str:
        norm_squared, smoothing, length = expr.args
        with self._inside():
            ratio = rf"\frac{{{self._print(length)}}}{{\sqrt{{{self._print(norm_squared)}}}}}"
            return extreme(r"\min", rf"\frac{{1}}{{{self._print(smoothing)}}}", ratio)

    def _print_Within(self, expr: sp.Expr, exp: str | None = None) -> str:
        norm_squared, *limits = expr.args
        with self._inside():
            root = rf"\sqrt{{{self._print(norm_squared)}}}"
            least, largest = (rf"\frac{{{self._print(limit)}}}{{{root}}}" for limit in limits)
        return extreme(r"\min", largest, extreme(r"\max", "1", least))

    def _print_Convex(self, expr: sp.Expr, exp: str | None = None) -> str:
        value = self._print(expr.args[0])
        return rf"{self._enclosed(value)}^{{{exp}}}" if exp else value

    def _print_Choice(self, expr: sp.Expr, exp: str | None = None) -> str:
        one, other = (self._print(value).replace(r"\frac", r"\dfrac") for value in expr.args[1:])
        left, right = map(self._print, sides(expr.args[0]))
        return rf"\begin{{cases}} {one}, & {left} \le {right} \\ {other}, & {left} > {right} \end{{cases}}"

    def _print_Until(self, expr: sp.Expr, exp: str | None = None) -> str:
        """Print the pieces as cases in the order of time, if numbers order them."""
        if (found := pieces_of(expr)) is None:
            text = self._print_Choice(expr)
        else:
            what, values, ends = found
            shown = [self._print(value).replace(r"\frac", r"\dfrac") for value in values]
            limits = [self._print(end) for end, _ in ends]
            by = self._print(what)
            begins = [
                "",
                *(rf"{limit} {'<' if before else LE} " for limit, (_, before) in zip(limits, ends, strict=True)),
            ]
            wheres = [
                rf"{begin}{by} {LE if before else '<'} {limit}"
                for begin, limit, (_, before) in zip(begins, limits, ends, strict=False)
            ]
            wheres.append(rf"{by} {'>' if ends[-1][1] else GE} {limits[-1]}")
            rows = r" \\ ".join(rf"{value}, & {where}" for value, where in zip(shown, wheres, strict=True))
            text = rf"\begin{{cases}} {rows} \end{{cases}}"
        return rf"{self._enclosed(text)}^{{{exp}}}" if exp else text

    def _print_Vertex(self, expr: sp.Expr, exp: str | None = None) -> str:
        curvature, slope, lower, upper = expr.args
        bent, low, high, rise = map(self._print, (curvature, lower, upper, slope + curvature * (lower + upper) / 2))
        inside = self._print(Clip(-slope / curvature, lower, upper))
        flat = rf"& {bent} \le 0,\ {rise}"
        rows = rf"{inside}, & {bent} > 0 \\ {high}, {flat} < 0 \\ {low}, {flat} \ge 0"
        return rf"\begin{{cases}} {rows} \end{{cases}}"

    def _print_Argmin(self, expr: sp.Expr, exp: str | None = None) -> str:
        lower, upper, *coefficients = expr.args
        limits = [] if lower.is_infinite else [self._print(lower), r"\le"]
        v = sp.Symbol(letter(self._taken), real=True)
        limits += [v.name, *([] if upper.is_infinite else [r"\le", self._print(upper)])]
        polynomial = self._print(sp.Add(*(c * v**k for k, c in enumerate(coefficients, 1))))
        return self._argmin(polynomial, " ".join(limits), exp)

    def _print_Middle(self, expr: sp.Expr, exp: str | None = None) -> str:
        lower, upper = map(self._print, expr.args)
        return rf"\tfrac{{1}}{{2}} ({lower} + {upper})"

    def _print_Root(self, expr: Root, exp: str | None = None) -> str:
        slope, unknown = self._print(expr.at()), self._print(expr.unknown)
        return rf"\operatorname{{root}}_{{{unknown}}} {self._enclosed(slope)}"

    # sizes

    def _parentheses(self, content: str) -> tuple[str, str]:
        bigger = "" if self._small else size(content)
        return (f"{bigger}l(", f"{bigger}r)") if bigger else ("(", ")")

    def _enclosed(self, content: str) -> str:
        opening, closing = self._parentheses(content)
        return f"{opening}{content}{closing}"

    @contextmanager
    def _inside(self) -> Iterator[None]:
        """Print within a fraction, root or exponent, where fractions are slashed because the type is small."""
        self._small += 1
        yield
        self._small -= 1


def levels(value: str, threshold: str, low: str, high: str, reverse: bool) -> str:
    """Print the levels between which a control switches, each with its condition.

    Parameters
    ----------
    threshold
        Weight of the control's magnitude; ``"0"`` where it has none.
    reverse
        Whether the upper bound goes with great values, as where H is maximised.
    """
    above, below = (high, low) if reverse else (low, high)
    if threshold != "0":
        middle = rf"{nearest(low, high)}, & |{value}| \le {threshold}"
        rows = (rf"{above}, & {value} > {threshold}", middle, rf"{below}, & {value} < -{threshold}")
    else:
        middle = rf"\tfrac{{1}}{{2}} ({low} + {high}), & {value} = 0"
        rows = (rf"{above}, & {value} > 0", middle, rf"{below}, & {value} < 0")
    return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}"


def nearest(low: str, high: str) -> str:
    """Print the value of least magnitude between two bounds."""
    return rf"\max\{{{low},\, \min\{{{high},\, 0\}}\}}"


def letter(taken: Collection[str]) -> str:
    """Return a letter that has no other meaning in the notation."""
    return next(one for one in "vzsyxabcd" if one not in taken)


def extreme(operator: str, first: str, second: str) -> str:
    r"""Print the lesser or the greater of two values; the operator is ``\min`` or ``\max``."""
    bigger = size(first + second)
    left, right = (rf"{bigger}l\{{", rf"{bigger}r\}}") if bigger else (r"\{", r"\}")
    return operator + left + first + r",\, " + second + right


def size(content: str) -> str:
    """Return the command for delimiters around some content: empty for ordinary ones."""
    for inner, outer in ((r"\bigg", r"\Bigg"), (r"\Bigg", r"\Bigg"), (r"\Big", r"\bigg"), (r"\frac", r"\Big")):
        if inner in content:
            return outer
    return r"\big" if "(" in content else ""
