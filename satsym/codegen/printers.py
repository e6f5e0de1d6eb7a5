"""Printers of expressions as source text: floats and ``math`` in scalar form, arrays and ``np`` in batch form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mpmath as mp
import sympy as sp
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.pycode import PythonCodePrinter

from satsym.symbolic.decimals import DIGITS
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.unsupported import FUNCTIONS

LARGEST_PRODUCT = 4
"""Integer powers up to this one are printed as products, which are several times faster."""

WRITTEN: dict[float, Any] = {}
"""Magnitudes of printed floats with the mpmath numbers that they approximate."""


class _Printer(PythonCodePrinter):
    """The printing that both forms share; numbers are floats, because an int literal makes float code slower."""

    module: str
    functions: Mapping[str, str]

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False, "contract": False})

    def _as_ordered_terms(self, expr: Any, order: Any = None) -> list[Any]:
        """Order terms with a plus sign first where there is one: a leading minus costs an operation."""
        return sorted(super()._as_ordered_terms(expr, order), key=lambda term: term.could_extract_minus_sign())

    def parenthesize(self, item: Any, level: int, strict: bool = False) -> str:
        """Add brackets where needed, but none around a fraction that prints as one literal."""
        return self._print(item) if _literal(item) else super().parenthesize(item, level, strict)

    def _print_Integer(self, expr: Any) -> str:
        return _noted(expr)

    def _print_Rational(self, expr: Any) -> str:
        return _noted(expr) if _exact(expr) else f"{_noted(sp.Integer(expr.p))}/{_noted(sp.Integer(expr.q))}"

    _print_Half = _print_NegativeOne = _print_One = _print_Zero = _print_Rational

    def _print_Float(self, expr: Any) -> str:
        return _noted(expr)

    def _print_Pi(self, expr: Any) -> str:
        return f"{self.module}.pi"

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        base, exponent = expr.as_base_exp()
        if exponent == sp.S.Half:
            return f"{self.module}.sqrt({self._print(base)})"
        text = self._factor(base)
        if exponent == -1:
            return f"1.0/{text}"
        if exponent.is_Integer and 1 < exponent <= LARGEST_PRODUCT and base.is_Symbol:
            return "*".join([text] * int(exponent))
        return f"{text}**{self._factor(exponent)}"

    def _print_Function(self, expr: Any) -> str:
        name = expr.func.__name__
        if name not in self.functions:
            raise DerivationError(
                f"generated code has no function {name}; available are {', '.join(sorted(self.functions))}"
            )
        return f"{self.module}.{self.functions[name]}({', '.join(self._print(a) for a in expr.args)})"

    _print_sin = _print_cos = _print_tan = _print_asin = _print_acos = _print_atan = _print_atan2 = _print_Function
    _print_sign = _print_sinh = _print_cosh = _print_tanh = _print_exp = _print_log = _print_Abs = _print_Function

    def _factor(self, expr: Any) -> str:
        return self.parenthesize(expr, PRECEDENCE["Atom"], strict=True)


class ScalarPrinter(_Printer):
    """Printer for floats and the ``math`` module, whose code numba can compile."""

    module = "math"
    functions = {name: name for name in FUNCTIONS} | {"Abs": "fabs"}

    def _print_Clip(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"{lower} if {value} < {lower} else {upper} if {value} > {upper} else {value}"

    def _print_Inside(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"0.0 if {value} < {lower} else 0.0 if {value} > {upper} else 1.0"

    def _print_Shorten(self, expr: Any) -> str:
        norm_squared, limit = (self._print(a) for a in expr.args)
        return f"1.0 if {norm_squared} <= {limit}*{limit} else {limit}/math.sqrt({norm_squared})"

    def _print_ShortenSlope(self, expr: Any) -> str:
        s, limit = (self._print(a) for a in expr.args)
        return f"0.0 if {s} <= {limit}*{limit} else -0.5*{limit}/({s}*math.sqrt({s}))"

    def _print_Stretch(self, expr: Any) -> str:
        s, smoothing, length = (self._print(a) for a in expr.args)
        return f"{length}/math.sqrt({s}) if {s} > {smoothing}*{length}*({smoothing}*{length}) else 1.0/{smoothing}"

    def _print_StretchSlope(self, expr: Any) -> str:
        s, smoothing, length = (self._print(a) for a in expr.args)
        return f"-0.5*{length}/({s}*math.sqrt({s})) if {s} > {smoothing}*{length}*({smoothing}*{length}) else 0.0"

    def _print_Within(self, expr: Any) -> str:
        s, least, largest = (self._print(a) for a in expr.args)
        root = f"math.sqrt({s})"
        inside = f"1.0 if {s} >= {least}*{least} else {least}/{root} if {s} > 0.0 else 0.0"
        return f"{largest}/{root} if {s} > {largest}*{largest} else {inside}"

    def _print_WithinSlope(self, expr: Any) -> str:
        s, least, largest = (self._print(a) for a in expr.args)
        cube = f"({s}*math.sqrt({s}))"
        inside = f"0.0 if {s} >= {least}*{least} else -0.5*{least}/{cube} if {s} > 0.0 else 0.0"
        return f"-0.5*{largest}/{cube} if {s} > {largest}*{largest} else {inside}"

    def _print_Switch(self, expr: Any) -> str:
        slope, weight, lower, upper = (self._print(a) for a in expr.args)
        middle = f"0.5*({lower} + {upper})"
        if expr.args[1].is_zero:
            return f"{lower} if {slope} > 0.0 else {upper} if {slope} < 0.0 else {middle}"
        rest = f"{lower} if {lower} > 0.0 else {upper} if {upper} < 0.0 else 0.0"
        rest = rest if expr.args[1].is_Number else f"{middle} if {weight} <= 0.0 else {rest}"
        return f"{lower} if {slope} > {weight} else {upper} if {slope} < -{weight} else {rest}"

    def _print_Shrink(self, expr: Any) -> str:
        value, width = (self._print(a) for a in expr.args)
        return f"{value} - {width} if {value} > {width} else {value} + {width} if {value} < -{width} else 0.0"

    def _print_Side(self, expr: Any) -> str:
        value, width = (self._print(a) for a in expr.args)
        below = "0.0" if expr.args[1].is_zero else f"-{width}"
        return f"1.0 if {value} > {width} else -1.0 if {value} < {below} else 0.0"

    def _print_Interior(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"0.0 if {value} <= {lower} else 0.0 if {value} >= {upper} else 1.0"

    def _print_Convex(self, expr: Any) -> str:
        value, curvature = (self._print(a) for a in expr.args)
        return f"{value} + 0.0*math.sqrt({curvature})"  # no number of what is negative

    def _print_Choice(self, expr: Any) -> str:
        excess, one, other = (self._print(a) for a in expr.args)
        return f"({one} if {excess} <= 0.0 else {other}) + 0.0*{excess}"

    def _print_Until(self, expr: Any) -> str:
        excess, one, other = (self._print(a) for a in expr.args)
        return f"{one} if {excess} <= 0.0 else {other}"

    def _print_Vertex(self, expr: Any) -> str:
        curvature, slope, lower, upper = (self._factor(a) for a in expr.args)
        rise = f"({upper} - {lower})*(0.5*{curvature}*({lower} + {upper}) + {slope})"
        clipped = f"{lower} if -{slope} <= {lower}*{curvature} else {upper} if -{slope} >= {upper}*{curvature}"
        end = f"{upper} if {rise} < 0.0 else {lower}"
        return f"({clipped} else -{slope}/{curvature}) if {curvature} > 0.0 else ({end}) + 0.0*{rise}"

    def _print_Bend(self, expr: Any) -> str:
        curvature, slope, lower, upper = (self._factor(a) for a in expr.args)
        inside = f"0.0 if -{slope} <= {lower}*{curvature} else 0.0 if -{slope} >= {upper}*{curvature}"
        return f"({inside} else -1.0/{curvature}) if {curvature} > 0.0 else 0.0"

    def _print_Bearing(self, expr: Any) -> str:
        across, along = (self._print(a) for a in expr.args)
        # no number where there is no direction, as on arrays
        return f"math.atan2({across}, {along}) + 0.0/({across}*{across} + {along}*{along})"

    def _print_Middle(self, expr: Any) -> str:
        lower, upper = (self._print(a) for a in expr.args)
        least = f"({upper} if {upper} < math.pi else math.pi) - 2.0*math.pi"
        largest = f"({lower} if {lower} > -math.pi else -math.pi) + 2.0*math.pi"
        ends = f"({lower} if {lower} > {least} else {least})", f"({upper} if {upper} < {largest} else {largest})"
        return f"0.5*({ends[0]} + {ends[1]})"


class BatchPrinter(_Printer):
    """Printer for arrays and ``np``, real or complex."""

    module = "np"
    functions = {name: name for name in FUNCTIONS} | {
        "Abs": "abs",
        "asin": "arcsin",
        "acos": "arccos",
        "atan": "arctan",
        "atan2": "arctan2",
    }

    def _print_Clip(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"np.minimum(np.maximum({value}, {lower}), {upper})"

    def _print_Shorten(self, expr: Any) -> str:
        norm_squared, limit = (self._print(a) for a in expr.args)
        return f"np.minimum(1.0, {limit}/np.sqrt(np.maximum({norm_squared}, 1e-300)))"

    def _print_Stretch(self, expr: Any) -> str:
        s, smoothing, length = (self._print(a) for a in expr.args)
        return f"np.minimum(1.0/{smoothing}, {length}/np.sqrt(np.maximum({s}, 1e-300)))"

    def _print_StretchSlope(self, expr: Any) -> str:
        s, smoothing, length = (self._print(a) for a in expr.args)
        slope = f"np.minimum({length}, 1e100)/np.maximum({s}*np.sqrt({s}), 1e-200)"
        return f"-0.5*np.heaviside(np.sqrt({s}) - {smoothing}*{length}, 0.0)*{slope}"

    def _print_Within(self, expr: Any) -> str:
        s, least, largest = (self._print(a) for a in expr.args)
        norm = f"np.sqrt(np.maximum({s}, 1e-300))"
        # a vector without length has no direction to be lengthened in
        some = f"(({s} + 1e-300)/(np.maximum({s}, {least}*{least}*1e-200) + 1e-300))**2.0"
        return f"{some}*np.minimum(np.maximum(1.0, {least}/{norm}), {largest}/{norm})"

    def _print_WithinSlope(self, expr: Any) -> str:
        s, least, largest = (self._print(a) for a in expr.args)
        far, near = f"np.heaviside({s} - {largest}*{largest}, 0.0)", f"np.heaviside({least}*{least} - {s}, 0.0)"
        met = f"({far}*np.minimum({largest}, 1e100) + (1.0 - {far})*{near}*{least})"
        return f"-0.5*np.heaviside({s}, 0.0)*{met}/np.maximum({s}*np.sqrt({s}), 1e-200)"

    def _print_Inside(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"np.heaviside({value} - {lower}, 1.0)*np.heaviside({upper} - {value}, 1.0)"

    def _print_Abs(self, expr: Any) -> str:
        value = self._print(expr.args[0])
        return f"np.maximum({value}, -{value})"  # np.abs of a complex step would be its modulus

    def _print_Switch(self, expr: Any) -> str:
        slope, weight, lower, upper = (self._print(a) for a in expr.args)
        rest = f"0.5*({lower} + {upper})"
        if not expr.args[1].is_zero:
            least = f"np.minimum(np.maximum({lower}, 0.0), {upper})"
            weighs = f"np.heaviside({weight}, 0.0)"
            rest = least if expr.args[1].is_Number else f"({weighs}*{least} + (1.0 - {weighs})*{rest})"
        above, below = f"np.heaviside({slope} - {weight}, 0.0)", f"np.heaviside(-{slope} - {weight}, 0.0)"
        return f"{above}*{lower} + {below}*{upper} + (1.0 - {above} - {below})*{rest}"

    def _print_Shrink(self, expr: Any) -> str:
        value, width = (self._print(a) for a in expr.args)
        return f"np.maximum({value} - {width}, 0.0) + np.minimum({value} + {width}, 0.0)"

    def _print_Side(self, expr: Any) -> str:
        value, width = (self._print(a) for a in expr.args)
        beyond = "" if expr.args[1].is_zero else f" - {width}"
        return f"np.heaviside({value}{beyond}, 0.0) - np.heaviside(-{value}{beyond}, 0.0)"

    def _print_Interior(self, expr: Any) -> str:
        value, lower, upper = (self._print(a) for a in expr.args)
        return f"np.heaviside({value} - {lower}, 0.0)*np.heaviside({upper} - {value}, 0.0)"

    def _print_Convex(self, expr: Any) -> str:
        value, curvature = (self._print(a) for a in expr.args)
        return f"{value} + 0.0*np.sqrt({curvature})"

    def _print_Choice(self, expr: Any) -> str:
        excess, one, other = (self._print(a) for a in expr.args)
        return f"np.where({excess} <= 0.0, {one}, {other}) + 0.0*{excess}"

    def _print_Until(self, expr: Any) -> str:
        excess, one, other = (self._print(a) for a in expr.args)
        return f"np.where({excess} <= 0.0, {one}, {other})"

    def _print_Vertex(self, expr: Any) -> str:
        curvature, slope, lower, upper = (self._factor(a) for a in expr.args)
        rise = f"({upper} - {lower})*(0.5*{curvature}*({lower} + {upper}) + {slope})"
        clipped = f"np.minimum(np.maximum(-{slope}/{self._curved(curvature)}, {lower}), {upper})"
        return f"np.where({curvature} <= 0.0, np.where({rise} < 0.0, {upper}, {lower}), {clipped}) + 0.0*{rise}"

    def _print_Bend(self, expr: Any) -> str:
        curvature, slope, lower, upper = (self._factor(a) for a in expr.args)
        curved = self._curved(curvature)
        inside = f"np.heaviside(-{slope} - {lower}*{curved}, 0.0)*np.heaviside({upper}*{curved} + {slope}, 0.0)"
        return f"-np.heaviside({curvature}, 0.0)*{inside}/{curved}"

    def _curved(self, curvature: str) -> str:
        """Print a curvature to divide by, replaced by one where it is zero."""
        return f"np.where({curvature} <= 0.0, 1.0, {curvature})"

    def _print_Bearing(self, expr: Any) -> str:
        across, along = (self._print(a) for a in expr.args)
        angle = f"np.arctan2(np.real({across}), np.real({along}))"  # and what a complex step turns it by
        turned = (
            f"{across}*np.cos({angle}) - {along}*np.sin({angle})",
            f"{along}*np.cos({angle}) + {across}*np.sin({angle})",
        )
        return f"{angle} + np.arctan(({turned[0]})/({turned[1]}))"

    def _print_Middle(self, expr: Any) -> str:
        lower, upper = (self._print(a) for a in expr.args)
        least = f"np.minimum({upper}, np.pi) - 2.0*np.pi"
        largest = f"np.maximum({lower}, -np.pi) + 2.0*np.pi"
        return f"0.5*(np.maximum({lower}, {least}) + np.minimum({upper}, {largest}))"

    def _print_ShortenSlope(self, expr: Any) -> str:
        s, limit = (self._print(a) for a in expr.args)
        # Finite whatever the limit and the norm, because the other factor must be able to make it zero.
        slope = f"np.minimum({limit}, 1e100)/np.maximum({s}*np.sqrt({s}), 1e-100)"
        return f"-0.5*np.heaviside({s} - {limit}*{limit}, 0.0)*{slope}"


def _noted(number: Any) -> str:
    """Return a number as a literal, and record its rounding error in :data:`WRITTEN`."""
    nearest = float(number)
    with mp.workdps(DIGITS):
        WRITTEN[abs(nearest)] = abs(sp.N(number, DIGITS)._to_mpmath(mp.mp.prec))
    return repr(nearest)


def _exact(number: Any) -> bool:
    """Tell whether a rational is a binary fraction, so that one literal represents it."""
    return number.q & (number.q - 1) == 0


def _literal(item: Any) -> bool:
    return bool(item.is_Rational and item >= 0 and _exact(item))
