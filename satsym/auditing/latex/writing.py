"""Writing of formulas in the notation in which they were printed: LaTeX or plain text."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise

from satsym.auditing.latex.arguments import may_be_argument
from satsym.auditing.latex.letters import GREEK, of_word
from satsym.auditing.latex.tokens import tokens
from satsym.auditing.latex.words import BETWEEN, COUNTERS, DOUBLE_SIGNS, OF_SETS, OPTIMA, RELATIONS
from satsym.formula.tree import (
    Add,
    Call,
    Div,
    Equality,
    Grid,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    Text,
    calls_in,
    cells,
    constant,
    each,
    lines,
    substituted,
    symbols,
)
from satsym.formula.writing import written

Writer = Callable[["Node | Equality"], str]
_SUM, _PRODUCT, _ATOM = range(3)
_NAMES = {"log": r"\ln", "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan"}
_WORDS = {"pi": r"\pi", "constant": r"\text{const}", "infinity": r"\infty", "ellipsis": r"\ldots"}
_WORDS |= {"otherwise": r"\text{otherwise}", "nabla": r"\nabla", "star": "*", "dagger": r"\dagger"}


def _macros(names: Mapping[str, str]) -> dict[str, str]:
    """Return function -> macro for a table of macros, of which the first one for each function is written."""
    return {name: rf"\{macro}" if macro.isalpha() else macro for macro, name in reversed(list(names.items()))}


_SIGNS = {**_macros(RELATIONS), "equal": "="}
_OPTIMA = {**_macros(OPTIMA), "argmin": r"\arg\min", "argmax": r"\arg\max"}
_DOUBLE_SIGNS = _macros(DOUBLE_SIGNS)
_BETWEEN = {**_macros(BETWEEN), **_macros(OF_SETS), "cross": r"\times", "times": r"\times", "dot": r"\cdot"}
_ATOMS = {
    "sqrt": r"\sqrt{<all>}",
    "exp": "e^{<all>}",
    "abs": "|<all>|",
    "norm": r"\|<all>\|",
    "list": "<all>",
    "d": r"\frac{d}{dt}\left(<all>\right)",
    "skew": r"\left[<all>\right]_{\times}",
    "closed_open": r"\left[<all>\right)",
    "open_closed": r"\left(<all>\right]",
    "open_interval": r"\left(<all>\right)",
    "bracket": r"\left[<all>\right]",
    "boundary": r"\partial <all>",
    "braces": r"\left\{<all>\right\}",
    "angled": r"\langle <all> \rangle",
    "differential": "d<1>",
    "transpose": r"<1:atom>^{\mathsf T}",
    "diff": r"\frac{\partial <1:product>}{\partial <2>}",
    "variational": r"\frac{\delta <1>}{\delta <2>}",
    "between": r"<1:atom>\Big|_{<2>}^{<3>}",
    "volume": "^{<2>} <1>",
    "order": r"\mathcal{O}\left(<1>\right)",
    "indexed": r"\left(<1>\right)_{<2>}",
    "transform": r"<1>\left\{<2>\right\}",
    "binomial": r"\binom{<1>}{<2>}",
    "over": r"\<2>{<1>}",
    "indexed_norm": r"\|<1>\|_{<2>}",
    "factorial": "<1:atom>!",
}
_PRODUCTS = {
    "divergence": r"\nabla \cdot <1:atom>",
    "curl": r"\nabla \times <1:atom>",
    "laplacian": r"\nabla^2 <1:atom>",
}
_SUMS = {
    **{name: f"<1> {sign} <others>" for name, sign in _SIGNS.items()},
    **{name: f"{sign} <1:product>" for name, sign in _DOUBLE_SIGNS.items()},
    "limit": r"\lim_{<2> \to <3>} <1:product>",
    "given": r"<1> \mid <others>",
    "maps": r"<1> : <2> \to <3>",
}
_FORMS = {
    name: (form, binding) for binding, forms in enumerate((_SUMS, _PRODUCTS, _ATOMS)) for name, form in forms.items()
}
"""Function -> how it is written, and its precedence; an argument may be put in brackets as an atom or a product."""
_OPENING, _CLOSING = r"\left(", r"\right)"
_GAP = re.compile("<(?:(all|others)|([123])(?::(atom|product))?)>")
_KNOWN = frozenset("sin cos tan sinh cosh tanh min max det".split())
_GREEK = "|".join(sorted(GREEK))
_RUNS_ON = re.compile(
    r"\\(?:sinh?|cosh?|tanh?|ln|arc[a-z]+) "
    rf"(?:[A-Za-z][^ |]*\|(?:[A-Za-z]|\\(?:{_GREEK})\b)|\\[^ |]+\|\\(?:{_GREEK})\b)"
)
"""Pattern of a function of a letter without brackets before another letter."""


def _may_take(before: Node, bracket: str) -> bool:
    """Return whether a bracket behind a factor would be read as its argument, or refused, without a sign between."""
    base = before.base if isinstance(before, Pow) else before
    if not isinstance(base, Sym) or "_vector" in base.name:
        return isinstance(base, Call) and base.function in ("diff", "value") and bracket.endswith(_CLOSING)
    if not bracket.endswith(_CLOSING):  # since a power follows
        return False
    return may_be_argument(of_word(base.name), tokens(bracket[len(_OPENING) : -len(_CLOSING)]), False)


def in_latex(letters: Mapping[str, str]) -> Writer:
    """Return a writer of formulas in LaTeX that prints names by the given letters."""
    tex = _Tex(letters)
    return lambda tree: " = ".join(tex.of(side)[0] for side in cells(tree))


def in_plain(letters: Mapping[str, str]) -> Writer:
    """Return a writer of formulas in plain notation, with ``^`` for powers."""
    names: dict[str, Node] = {name: Sym(text) for name, text in letters.items()}
    return lambda tree: written(each(tree, lambda side: substituted(side, names))).replace("**", "^")


class _Tex:
    """Writer of trees in LaTeX; each method returns the text and its precedence."""

    def __init__(self, letters: Mapping[str, str]) -> None:
        self._letters = letters

    def of(self, node: Node) -> tuple[str, int]:
        if isinstance(node, Num):
            text = written(node)
            value = node.value
            return (rf"\frac{{{value.numerator}}}{{{value.denominator}}}" if "/" in text else text), _ATOM
        if isinstance(node, Sym):
            return self._letters.get(node.name) or _WORDS.get(node.name, node.name), _ATOM
        if isinstance(node, Neg):
            return f"-{self._bound(node.operand, _PRODUCT)}", _SUM
        if isinstance(node, Add):
            return self._sum(node), _SUM
        if isinstance(node, Mul):
            return self._product(node), _PRODUCT
        if isinstance(node, Div):
            return rf"\frac{{{self._whole(node.numerator)}}}{{{self._whole(node.denominator)}}}", _ATOM
        if isinstance(node, Pow):
            return self._power(node), _PRODUCT
        if isinstance(node, Grid):
            return self._grid(node), _ATOM
        return self._call(node) if isinstance(node, Call) else (written(node), _ATOM)

    def _whole(self, node: Node) -> str:
        return self.of(node)[0]

    def _bound(self, node: Node, least: int) -> str:
        text, binding = self.of(node)
        return text if binding >= least else rf"\left({text}\right)"

    def _listed(self, nodes: Iterable[Node]) -> str:
        return ", ".join(map(self._whole, nodes))

    def _sum(self, node: Add) -> str:
        said = self._bound(node.terms[0], _SUM)
        for term in node.terms[1:]:
            inner = term.operand if isinstance(term, Neg) else term
            double = isinstance(term, Call) and term.function in _DOUBLE_SIGNS
            said += " " if double else f" {'-' if isinstance(term, Neg) else '+'} "
            said += self._whole(inner) if double else self._bound(inner, _PRODUCT)
        return said

    def _product(self, node: Mul) -> str:
        pieces = [self._bound(factor, _PRODUCT) for factor in node.factors]
        for k, (before, piece) in enumerate(pairwise(pieces)):
            if _RUNS_ON.search(f"{before}|{piece} "):  # sin x y would be read as sin(xy)
                pieces[k] = rf"\left({before}\right)"
        said = pieces[0]
        for factor, piece in zip(node.factors, pieces[1:], strict=False):
            signed = piece[:1].isdigit() or (piece.startswith(_OPENING) and _may_take(factor, piece))
            said += rf" \cdot {piece}" if signed else f" {piece}"
        return said

    def _power(self, node: Pow) -> str:
        (text, binding), exponent = self.of(node.base), self._whole(node.exponent)
        if constant(node.exponent) is not None and len(exponent) > 1:
            exponent = f"{{{exponent}}}"
        if binding < _ATOM or isinstance(node.base, Div) or "^" in text:
            text = rf"\left({text}\right)"
        return f"{text}^{exponent}"

    def _grid(self, node: Grid) -> str:
        if not any(isinstance(entry, Grid) for entry in node.entries):
            return rf"\left[{self._listed(node.entries)}\right]"
        body = r" \\ ".join(" & ".join(map(self._whole, row)) for row in lines(node))
        return rf"\begin{{pmatrix}} {body} \end{{pmatrix}}"

    def _call(self, node: Call) -> tuple[str, int]:
        name, arguments = node.function, node.arguments
        if name in _FORMS:
            form, binding = _FORMS[name]
            return _GAP.sub(lambda gap: self._argument(gap, arguments), form), binding
        if name in _OPTIMA:
            below = f"_{{{self._listed(arguments[1:])}}}" if arguments[1:] else ""
            return rf"{_OPTIMA[name]}{below} \left({self._whole(arguments[0])}\right)", _SUM
        if name in _BETWEEN:
            said = f" {_BETWEEN[name]} ".join(self._bound(argument, _ATOM) for argument in arguments)
            return (rf"\left({said}\right)", _ATOM) if arguments[-1] == Sym("nabla") else (said, _PRODUCT)
        if name in _WRITERS:
            return _WRITERS[name](self, arguments)
        known = _NAMES.get(name) or (rf"\{name}" if name in _KNOWN else rf"\operatorname{{{name}}}")
        if len(arguments) == 1 and isinstance(arguments[0], Sym) and not known.startswith(r"\operatorname"):
            return f"{known} {self._whole(arguments[0])}", _PRODUCT
        return rf"{known}\left({self._listed(arguments)}\right)", _ATOM

    def _argument(self, gap: re.Match[str], arguments: Sequence[Node]) -> str:
        """Return what is written in a gap of a form."""
        if gap[1]:
            return self._listed(arguments if gap[1] == "all" else arguments[1:])
        argument = arguments[int(gap[2]) - 1]
        return self._bound(argument, {"atom": _ATOM, "product": _PRODUCT}.get(gap[3], _SUM))

    def _sum_over(self, arguments: Sequence[Node], sign: str = r"\sum") -> tuple[str, int]:
        first, *limits = arguments
        related = [limit for limit in limits if isinstance(limit, Call) and limit.function in _SIGNS]
        limits = [limit for limit in limits if limit not in related]
        said = [*filter(None, ["=".join(map(self._whole, limits[:2]))]), *map(self._whole, related)]
        below = f"_{{{', '.join(said)}}}" if said else ""
        above = f"^{{{self._whole(limits[2])}}}" if len(limits) > 2 else ""
        return rf"{sign}{below}{above} {self._bound(first, _PRODUCT)}", _SUM

    def _integral(self, arguments: Sequence[Node], joint: str = r" \,", sign: str = r"\int") -> tuple[str, int]:
        inside, by, *limits = arguments
        over = by.arguments if isinstance(by, Call) and by.function == "list" else (by,)
        ends = "".join(f"{mark}{{{self._whole(end)}}}" for mark, end in zip("_^", limits, strict=False))
        steps = r" \, ".join(f"d{self._whole(letter)}" for letter in over)
        sign = {2: r"\iint", 3: r"\iiint"}.get(len(over), sign)
        return f"{sign}{ends} {self._whole(inside)}{joint} {steps}", _SUM

    def _gradient(self, arguments: Sequence[Node], order: str = "") -> tuple[str, int]:
        by = f"_{{{self._listed(arguments[1:])}}}" if arguments[1:] else ""
        return rf"\nabla{order}{by} {self._bound(arguments[0], _ATOM)}", _PRODUCT

    def _value(self, arguments: Sequence[Node]) -> tuple[str, int]:
        first, *places = arguments
        others = self._listed(places)
        if not isinstance(first, Sym) and not (isinstance(first, Call) and first.function == "bracket"):
            return rf"{self._bound(first, _ATOM)}\Big|_{{{others}}}", _ATOM
        inside = symbols(places[0]) if len(places) == 1 else set()
        counts = inside & COUNTERS and not any(calls_in(places[0]))  # the number of a member of a sequence
        return self._whole(first) + (rf"\left[{others}\right]" if counts else rf"\left({others}\right)"), _ATOM

    def _any_power(self, arguments: Sequence[Node]) -> tuple[str, int]:
        base, exponent = arguments
        text = self._whole(base)
        if not isinstance(base, Num | Sym) or "^" in text:
            text = rf"\left({text}\right)"
        return rf"{text}^{{{self._whole(exponent)}}}", _PRODUCT

    def _in_unit(self, arguments: Sequence[Node]) -> tuple[str, int]:
        value, unit = arguments
        said = unit.value if isinstance(unit, Text) else ""
        return rf"{self._whole(value)} \,\mathrm{{{said}}}", _PRODUCT

    def _both(self, arguments: Sequence[Node]) -> tuple[str, int]:
        steps = [part for part in arguments if isinstance(part, Call)]
        said = "".join(f" {_SIGNS[part.function]} {self._whole(part.arguments[1])}" for part in steps)
        return f"{self._whole(steps[0].arguments[0])}{said}", _SUM

    def _cases(self, arguments: Sequence[Node]) -> tuple[str, int]:
        pairs = zip(arguments[::2], arguments[1::2], strict=True)
        body = r" \\ ".join(f"{self._whole(value)} & {self._whole(when)}" for value, when in pairs)
        return rf"\begin{{cases}} {body} \end{{cases}}", _ATOM


_WRITERS: Mapping[str, Callable[[_Tex, Sequence[Node]], tuple[str, int]]] = {
    "sum": _Tex._sum_over,
    "product": lambda tex, arguments: tex._sum_over(arguments, r"\prod"),
    "integral": _Tex._integral,
    "line_integral": lambda tex, arguments: tex._integral(arguments, r" \cdot"),
    "circulation": lambda tex, arguments: tex._integral(arguments, r" \cdot", r"\oint"),
    "gradient": _Tex._gradient,
    "hessian": lambda tex, arguments: tex._gradient(arguments, "^2"),
    "value": _Tex._value,
    "applied": lambda tex, arguments: (" ".join(tex._bound(part, _PRODUCT) for part in arguments), _PRODUCT),
    "power": _Tex._any_power,
    "raised": _Tex._any_power,
    "in_unit": _Tex._in_unit,
    "both": _Tex._both,
    "cases": _Tex._cases,
}
"""Functions that need more than a form -> the method that writes them."""
