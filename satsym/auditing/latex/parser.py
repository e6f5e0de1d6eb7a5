"""The parser of one side of an equation: terms, factors with their powers, and what a factor consists of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import factorial

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import CONSTANT
from satsym.auditing.latex.letters import GREEK, Letter
from satsym.auditing.latex.operators import product_of
from satsym.auditing.latex.rows import relation_in, split
from satsym.auditing.latex.sums import SumCursor
from satsym.auditing.latex.tokens import END, Token, Unread
from satsym.auditing.latex.words import ACCENTS, ATOMS, FUNCTIONS, KEPT_GROUPS, MARKS
from satsym.formula.reading import MAX_DEPTH
from satsym.formula.tree import Call, Div, Grid, Mul, Neg, Node, Num, Pow, Sym, constant
from satsym.wording import printable


class Parser(SumCursor):
    """Parser of one side of an equation."""

    def side(self) -> Node:
        """Read the whole side, which may be a list."""
        parts = split(self._found, lambda token: token.is_sign(","))
        return self.whole() if len(parts) < 2 else Call("list", tuple(self._inner(part, self._start) for part in parts))

    def whole(self) -> Node:
        """Read the whole side as one expression."""
        tree = self._sum()
        if self._i < len(self._found):
            self._refuse()
        return tree

    def _product(self, argument: bool = False) -> Node:
        """Read a term, or with `argument` the argument of a function without brackets."""
        chain, crossed = [self._signed_factor()], ""
        while (token := self._peek()) is not END:
            text = token.text
            times = token.is_sign("*") or token.is_macro(words.TIMES)
            over = token.is_sign("/:") or token.is_macro("div")
            if argument and (times or over or not self._continues_argument(token, chain[-1])):
                break
            if times:
                crossed = self._times(token, chain, crossed)
            elif token.is_macro(words.OF_SETS):
                self._i += 1
                return Call(words.OF_SETS[text], (product_of(chain), self._product()))
            elif (unit := self._unit(chain[-1])) is not None:
                return Call("in_unit", (product_of(chain), unit))
            elif over:
                chain = [self._over(token, chain)]
            elif token.is_macro(words.BETWEEN):
                self._i += 1
                chain[-1] = Call(words.BETWEEN[text], (chain[-1], self._signed_factor()))
            elif self._begins_factor(token) and not (self._deriving and self._is_bar_of_place()):
                if self._is_along_field(chain[-1]):
                    chain[-1] = self._applied(chain[-1])
                    continue
                self._refuse_behind(chain[-1], token)
                last = self._found[self._i - 1]
                order = text == "10" and self._is("^", 1)
                if token.kind == last.kind == "number" and isinstance(chain[-1], Num) and not order:
                    raise Unread("two numbers stand side by side", token.at)
                if token.is_sign("(") and constant(chain[-1]) is None and self._encloses_one():
                    raise Unread(words.ARGUMENT_OR_FACTOR, token.at)
                group = self._found[self._i + 1 : self._i + 3] if token.kind == "open" else [token]
                worn = last.kind == "letter" or last.text in GREEK
                beside = token.at <= last.at + len(last.text) + (last.kind == "macro")
                numeral = [t.kind for t in group] in (["number"], ["number", "close"])
                if numeral and worn and beside and (token.kind == "open" or last.kind == "letter"):
                    raise Unread("a number after a letter could be an index or a power", token.at)
                between = last.text == ")" and self._is("(", 1)
                if (text in words.ELLIPSES and not between) or (chain[-1] == Sym("ellipsis") and text != "("):
                    raise Unread("an ellipsis between factors is not supported", token.at)
                chain.append(self._factor())
            else:
                break
        if len(chain) > 1 and any(isinstance(one, Call) and one.function == "braces" for one in chain):
            raise Unread(words.BRACES, self._found[self._i - 1].at)
        return product_of(chain)

    def _encloses_one(self) -> bool:
        """Return whether the next bracket holds one letter, value or function and has no power.

        Nobody writes brackets around a single factor, so that it is the argument of what stands in front of it.
        """
        begin = self._i
        inside = self._found[begin + 1 : self._bracket_end(interval=True)]
        raised, self._i = self._is("^"), begin
        if raised or not inside or any(t.is_sign(",;") or t.kind == "begin" for t in inside):
            return False
        tree = self._inner(inside, self._found[begin].at)
        if isinstance(tree, Sym):
            letter = self._reading.letters.get(tree.name)
            return letter is not None and not letter.dots
        return isinstance(tree, Call) and (tree.function == "value" or tree.function in _CALLED)

    def _times(self, sign: Token, chain: list[Node], crossed: str) -> str:
        """Read the right operand of a multiplication sign into a product, and return the last vector product."""
        self._i += 1
        before, product = chain[-1], words.OF_VECTORS.get(sign.text)
        if isinstance(before, Grid) and isinstance(before.entries[0], Grid) and len(before.entries[0].entries) > 1:
            product = product if product == "cross" else None  # matrices are multiplied
        last = self._peek(-2)
        if product and self._is_vector(before):
            field = isinstance(before, Call) and before.function in ("curl", "divergence")
            if (crossed in ("cross", "dot") and "cross" in (product, crossed)) or field:
                raise Unread("several products of vectors in a row need brackets", sign.at)
            chain[-1] = self._of_vectors(product, before, sign)
            return product
        chain.append(self._signed_factor())
        if chain[-1] == Sym("nabla"):
            raise Unread("a nabla on its own is not a quantity", sign.at)
        numbers = any(constant(side) is not None for side in (before, chain[-1]))
        convolved = last.text == self._found[self._i - 1].text == ")"  # of x(t) and y(t)
        letters = [self._letter_of(factor) for factor in (before, chain[-1])]
        convolved |= any(letter and letter.base == "q" for letter in letters)
        convolved |= all(letter and letter.base in "fgh" for letter in letters)
        if (sign.text in ("ast", "odot", "bullet") or (sign.text == "*" and convolved)) and not numbers:
            raise Unread("this sign could be a convolution or another product; write \\cdot for a product", sign.at)
        scalar = crossed == "number" or any(constant(side) is not None for side in (before, chain[-1]))
        if sign.text == "times" and not scalar and not isinstance(before, Grid):
            right = [chain.pop()]
            while self._begins_factor(self._peek()):
                right.append(self._factor())
            if crossed or self._peek().text in words.TIMES:
                raise Unread(words.EITHER_PRODUCT, sign.at)
            chain[-1] = Call("times", (before, product_of(right)))
            return "times"
        return "number" if sign.text == "times" and scalar else crossed

    def _over(self, slash: Token, chain: Sequence[Node]) -> Node:
        """Read the divisor after a slash, and return the quotient."""
        if self._bare_end == self._i:
            raise Unread("the argument of a function before a slash needs brackets", slash.at)
        self._i += 1
        following = self._peek()
        if slash.text == ":" and not (isinstance(chain[-1], Num) and following.kind == "number"):
            raise Unread("this colon could be a ratio or a tensor product; write a fraction or components", slash.at)
        divisor, unit = self._signed_factor(), self._peek()
        if isinstance(divisor, Num) and unit.text in words.UPRIGHT:
            raise Unread("units after a slash are not supported", unit.at)
        if self._may_be_divided_by(unit, chain, divisor):
            raise Unread("without brackets, it is not clear what the slash divides by", slash.at)
        return Div(product_of(chain), divisor)

    def _is_along_field(self, node: Node) -> bool:
        """Return whether an expression is the sign of a derivative along a field, as in ``L_f h``, or a power of it."""
        letter = self._letter_of(node, power=True)
        if letter is None or letter.base != "L":
            return (
                letter is not None and letter.base == "D" and any(rf"\{style}" in letter.foot for style in words.BOLD)
            )
        scripted = "cal" in letter.style and letter.index[:1].isalpha()
        return scripted or letter.index.rstrip("_0123456789") in words.FIELDS

    def _applied(self, operator: Node) -> Node:
        """Read what an operator is applied to, which may be another operator with its operand."""
        operand = self._factor()
        if self._begins_factor(self._peek()) and self._is_along_field(operand):
            operand = self._applied(operand)
        return Call("applied", (operator, operand))

    def _signed_factor(self) -> Node:
        if self._is("-") or self._is("+"):
            negative = self._take().text == "-"
            inner = self._factor()
            return Neg(inner) if negative else inner
        return self._factor()

    def _begins_factor(self, token: Token) -> bool:
        return token.kind in ("letter", "number", "open", "begin") or token.is_sign("([|") or token.is_macro(_FACTORS)

    def _factor(self) -> Node:
        """Read a factor with its powers.

        Every nested part of a formula is read by this function, which therefore counts the depth.
        """
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise Unread(f"the formula is nested more than {MAX_DEPTH} levels deep", self._here)
        try:
            return self._factor_within()
        finally:
            self._depth -= 1

    def _factor_within(self) -> Node:
        if self._is("^") or self._is("_"):
            return self._powers(self._in_a_frame())
        found = self._derivative(self._peek())
        if isinstance(found, Call) and found.function == "diff" and self._is("("):
            begin, arguments = self._i, self._arguments()
            if len(arguments) > 1:
                return self._powers(Call("value", (found, *arguments)))
            self._i = begin
        return self._powers(found if found is not None else self._atom())

    def _powers(self, base: Node) -> Node:
        while True:
            if self._is_transform(base):
                base = self._transform(base)
            elif self._is("^"):
                self._part_transposition(base == Sym("e"))
                taken = self._peek(-1).text == ")"
                at = self._take().at
                known = isinstance(base, Sym) and base.name in self._reading.letters and not taken
                base = self._raised(base, self._script(), at)
                if known and self._is("(") and isinstance(base, Pow | Call):
                    base = self._timed_behind_power(base)
            elif self._is_bar_of_place() and not self._deriving:
                at = self._take().at
                self._i += 1
                below = self._script()
                if self._accept("^"):
                    ends = below, self._script()
                    return Call("between", (base, *(self._condition(end, at) for end in ends)))
                base = self._taken(base, below, at)
            elif self._is("_") and not isinstance(base, Num):
                bracketed, at = self._found[self._i - 1].text == "]", self._take().at
                script = self._script()
                above = [t.text for t in self._peek_group()] if self._is("^") else []
                related = not relation_in(script).bare
                limits = above[:1] == ["infty"] or (bool(above) and [t.text for t in script] in (["0"], ["a"]))
                limits |= len(above) > 1 and above[:2] == [t.text for t in script][:2]  # as t_0 and t_f are
                if related and (above or not bracketed):
                    raise Unread("this evaluation point is not supported", at)
                if related:
                    base = self._taken(base, script, at)
                elif limits and bracketed:
                    self._i += 1
                    base = Call("between", (base, self._inner(script, at), self._inner(self._script(), at)))
                else:
                    base = Call("indexed", (base, self._indices_of(script, at)))
            elif self._is("'") and not self._is("'", 1) and self._has_matrix(base):
                sure = self._is_vector(base) or self._begins_factor(self._peek(1)) or self._reading.transposing
                if not sure and not self._reading.lenient:
                    raise Unread(words.PRIMED, self._here)
                self._reading.transposing |= sure
                self._i += 1
                base = Call("transpose", (base,))
            elif self._is("'") and not isinstance(base, Num):
                raise Unread("a prime is not allowed here", self._take().at)
            elif self._accept("!"):
                value = base.value if isinstance(base, Num) else -1
                base = Num(Fraction(factorial(int(value)))) if value in range(13) else Call("factorial", (base,))
            else:
                return base

    def _indices_of(self, script: Sequence[Token], at: int) -> Node:
        """Read the index of a bracket: one expression, a word, or several ones, e.g. those of a matrix entry."""
        letters = all(t.kind == "letter" for t in script)
        if letters and len(script) > 2 and not all(t.text in words.COUNTERS for t in script):
            return Sym("".join(t.text for t in script))
        parts = [[t] for t in script] if letters else split(script, lambda t: t.is_sign(","))
        indices = [self._inner(part, at) for part in parts]
        if any(isinstance(index, Mul) for index in indices):
            raise Unread("this index is not supported", at)
        return indices[0] if len(indices) == 1 else Call("list", tuple(indices))

    def _inner(self, part: Sequence[Token], at: int) -> Node:
        if not part:
            raise Unread("an expression is missing here", at)
        return self._of(part).whole()

    def _atom(self) -> Node:
        token = self._take()
        if token.kind == "number":
            if token.text == "0" and self._accept("_"):  # the size of a zero matrix
                self._script()
            return Num(Fraction(token.text))
        if token.kind == "open":
            self._i -= 1
            inner = self._group()
            if not inner:
                return self._in_a_frame() if self._is("^") else self._factor()
            if letter := self._letter_in(inner):
                return self._symbol(self._scripts(letter), token.at)
            return self._inner(inner, token.at)
        if token.is_sign("(["):
            self._i -= 1
            return self._bracket()
        if token.kind == "begin":
            return self._environment(token)
        if token.is_sign("|") or token.is_macro(words.BARS):
            return self._size(token)
        if token.kind == "macro":
            return self._macro(token)
        if token.kind == "letter":
            if any(map(self._spells, words.CONSTANT)):
                self._reading.constants = True
                return Sym(CONSTANT)
            if (called := self._spelled_function(token)) is not None:
                return called
            after, before = self._peek(), self._peek(-2)
            if (before.text, before.at) == (token.text, token.at - 1) and self._peek(-3).is_sign("_"):
                raise Unread("an exponent or an index of several characters needs braces", before.at)
            if (after.text, after.at) == (token.text, token.at + 1) and self._is("_", 1):
                raise Unread("a doubled letter with an index could be one name", token.at)
            differs = after.kind == "letter" or after.text in GREEK or after.text in words.STYLES
            if token.text == "d" and after.at <= token.at + 2 and differs:
                return self._differential(token.at)
            self._i -= 1
            letter = self._letter()
            assert letter is not None
            return self._symbol(letter, token.at)
        self._i -= 1
        self._refuse()
        raise AssertionError

    def _macro(self, token: Token) -> Node:
        name = token.text
        if name in words.ELLIPSES or name == "infty":
            return Sym("infinity" if name == "infty" else "ellipsis")
        if name == "lim" or (name in words.OPTIMA and self._is("_")):
            return self._optimum(token)
        if name in ("frac", "tfrac", "dfrac", "cfrac"):
            above, below = self._group(), self._group()
            if len(above) > 1 and len(below) > 1 and above[0].text == below[0].text == "delta":
                return Call("variational", (self._inner(above[1:], token.at), self._inner(below[1:], token.at)))
            self._refuse_derivative(above, below, token.at)
            self._refuse_units(above, below)
            return Div(self._inner(above, token.at), self._inner(below, token.at))
        if name in words.OPERATOR_NAMES and (called := self._called(name)) is not None:
            return called
        if name in ("d", "dd", "diff") and not self._is("("):
            return self._differential(token.at)
        if name == "partial" and self._is("Omega", kind="macro"):
            letter = self._letter()
            assert letter is not None
            return Call("boundary", (self._symbol(letter, token.at),))
        if name == "binom":
            return Call("binomial", (self._inner(self._group(), token.at), self._inner(self._group(), token.at)))
        if name in KEPT_GROUPS:
            inner = self._inner(self._group(), token.at)
            if self._accept("_") or self._accept("^"):  # what is written beside the brace
                self._script()
            return inner
        if name in words.STYLES and (zero := self._peek_number()) is not None:
            return zero
        if name in words.CLOSING:
            raise Unread(f'"\\{name}" is not supported here', token.at)
        if name in _READERS:
            return _READERS[name](self, token)
        if name in FUNCTIONS:
            return self._function(FUNCTIONS[name], token)
        if name in words.RECIPROCALS:
            return Div(Num(Fraction(1)), self._function(words.RECIPROCALS[name], token))
        self._i -= 1
        if name in words.UPRIGHT and (found := self._upright(token)) is not None:
            return found
        letter = self._letter()
        if letter is None and (name in MARKS or name in ACCENTS):
            self._i += 1
            group = self._group()
            if len(group) > 1 and all(t.kind == "letter" and t.text.isupper() for t in group):
                name = "".join(t.text for t in group)
                raise Unread(f"{name} could be one name, \\mathrm{{{name}}}, or a product", group[0].at)
            if name in ACCENTS and len(group) > 1 and all(t.kind == "letter" for t in group):
                name = "".join(t.text for t in group)
                raise Unread(f"{name} could be one name, \\mathrm{{{name}}}, or a product", group[0].at)
            inner = self._inner(group, token.at)
            if isinstance(inner, Num) and self._peek(-len(group) - 4).kind == "number":
                raise Unread("a repeating decimal is not supported; write a fraction", token.at)
            return Call("over", (inner, Sym(MARKS[name]))) if name in MARKS else self._dotted(inner, ACCENTS[name])
        if letter is None:
            self._refuse()
        assert letter is not None
        after = self._peek()
        short = name in words.UPRIGHT and letter in (Letter("s"), Letter("c"))
        if short and after.is_macro(GREEK):
            raise Unread("s and c could be abbreviations of sine and cosine", token.at)
        plain = name.startswith(("text", "mbox")) and len(letter.base) > 3 and letter == Letter(letter.base)
        if plain and self._begins_factor(after) and after.text != "(":
            raise Unread("words inside a formula are not supported", token.at)
        if name in words.UPRIGHT and len(letter.base) > 1 and letter.base in words.UNITS:
            raise Unread("units in formulas are not supported", token.at)
        timed = self._is("t", 1, "letter") and self._is(")", 2)
        applied = (self._is("(") and not timed) or self._is("[") or after.is_macro(("{", "lbrace"))
        if name in words.UPRIGHT and len(letter.base) > 1 and applied:
            raise Unread(f"unknown function {printable(letter.base)}", token.at)
        return self._symbol(letter, token.at)


_CALLED = frozenset(FUNCTIONS.values()) - {"sqrt", "abs", "det", "d", "diff"}
"""Functions of which one alone in brackets is an argument."""
_FACTORS = frozenset(GREEK).union(
    *(FUNCTIONS, words.RECIPROCALS, ACCENTS, MARKS, words.STYLES, words.UPRIGHT, KEPT_GROUPS, ATOMS, words.BARS)
)
"""Macros with which a factor can begin."""
_READERS: Mapping[str, Callable[[Parser, Token], Node]] = {
    "sqrt": lambda parser, _: parser._root(),
    "nabla": Parser._gradient,
    **dict.fromkeys(("sum", "prod"), Parser._sum_over),
    **dict.fromkeys(words.INTEGRALS, Parser._integral),
    **dict.fromkeys(words.OPENING, Parser._braces),
}
"""Macros that begin a construct -> the function that reads it."""
