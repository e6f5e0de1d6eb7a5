"""Reading of functions, roots, powers, sums, integrals, brackets and environments of printed formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import MIXED_BRACKETS, are_units, listed
from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.quotients import QuotientCursor
from satsym.auditing.latex.rows import relation_in, split
from satsym.auditing.latex.tokens import END, Token, Unread, environment, group_end
from satsym.auditing.latex.words import FUNCTIONS, MATRICES, OPTIMA
from satsym.formula.reading import MAX_EXPONENT
from satsym.formula.tree import ZERO, Add, Call, Div, Grid, Mul, Neg, Node, Num, Pow, Sym, calls_in, constant
from satsym.wording import printable


class OperatorCursor(QuotientCursor):
    """Parser of operators that apply to the terms after them."""

    _bare_end = -1
    """Position of the end of the last function argument without brackets; -1 if there was none."""

    def _peek_number(self) -> Node | None:
        """Read a number that is printed bold, such as a zero vector.

        Return ``None``, with nothing read, if there is no such number.
        """
        begin, found = self._i, self._found
        inside = self._group() if self._peek() is not END else []
        if len(inside) == 1 and inside[0].kind == "number":
            if inside[0].text != "0":
                raise Unread("a bold number other than zero could be a vector or a matrix", inside[0].at)
            if inside[0].text == "0" and self._accept("_"):
                self._script()
            return Num(Fraction(inside[0].text))
        self._i, self._found = begin, found
        return None

    def _gradient(self, token: Token) -> Node:
        """Read the argument of a gradient, and the letter with respect to which it is taken if that is printed."""
        scripts = self._limits()
        by = [self._inner(scripts["_"], token.at)] if "_" in scripts else []
        if "^" in scripts:
            if [t.text for t in scripts["^"]] != ["2"]:
                raise Unread("a derivative of this order is not supported", token.at)
            return Call("hessian" if by else "laplacian", (self._factor(), *by))
        for sign, name in (("cdot", "divergence"), ("times", "curl")):
            if self._is(sign, kind="macro"):
                self._i += 1
                of = self._factor()
                if not self._is_vector(of) and self._begins_factor(self._peek()):
                    raise Unread("without brackets, it is not clear what is differentiated", self._here)
                return Call(name, (of, *by))
        if self._peek() is END:
            return Sym("nabla")
        of = self._factor()
        if isinstance(of, Call) and of.function == "transpose" and not self._is_vector(of.arguments[0]):
            return Call("transpose", (Call("gradient", (*of.arguments, *by)),))  # of a scalar function
        return Call("gradient", (of, *by))

    def _optimum(self, token: Token) -> Node:
        """Read a limit, minimum or maximum of the following expression over the subscript."""
        begun = any(t.kind != "open" for t in self._found[: self._i - 1])
        below = self._limits().get("_", [])
        while below and below[0].kind == "open" and group_end(below, 0) == len(below):
            below = below[1:-1]
        if token.text == "lim":
            sides = relation_in(below).sides
            if len(sides) != 2:
                raise Unread("a limit needs an arrow below it", token.at)
            ends = [self._limit(side, token.at) for side in sides]
            operand = self._product()
            if self._peek().text in ("+", "-"):
                raise Unread(words.OPERAND_ENDS, self._here)
            return Call("limit", (operand, *ends))
        over = listed(self._condition(below, token.at)) if below else ()
        sign = self._here
        operand = self._sum()
        optima = [call for call in calls_in(operand) if call.function in OPTIMA.values()]
        if isinstance(operand, Add) and (begun or optima):
            raise Unread(words.OPERAND_ENDS, sign)
        return Call(OPTIMA[token.text], (operand, *over))

    def _limits(self) -> dict[str, list[Token]]:
        limits: dict[str, list[Token]] = {}
        while self._is("_") or self._is("^"):
            sign = self._take().text
            limits[sign] = self._script()
        return limits

    def _limit(self, part: Sequence[Token], at: int) -> Node:
        line = relation_in(part)
        part = line.sides[-1] if line.signs == ["="] else part
        endless = len(part) == 1 and part[0].text == "infty"
        return Sym("infinity") if endless else self._inner(part, at)

    def _root(self) -> Node:
        degree: Node | None = None
        if self._is("["):
            at = self._take().at
            inside = []
            while not self._is("]"):
                inside.append(self._take())
            self._i += 1
            degree = self._inner(inside, at)
        radicand = self._inner(self._group(), self._found[self._i - 1].at)
        value = constant(degree) if degree is not None else None
        if degree is None or value == 2:
            return Call("sqrt", (radicand,))
        if value is None or value.denominator != 1 or not 1 < value <= 12:
            raise Unread("a root of this degree is not supported", self._found[self._i - 1].at)
        return Pow(radicand, Div(Num(Fraction(1)), Num(value)))

    def _function(self, name: str, token: Token) -> Node:
        power: Node | None = None
        if self._is("^"):
            at = self._take().at
            power = self._inner(self._script(), at)
            if constant(power) == -1 and name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "log", "exp"):
                if name not in ("sin", "cos", "tan"):
                    raise Unread("the inverse of this function is not supported", at)
                name, power = f"a{name}", None
        if name == "atan" and self._is("2", kind="number") and self._is("(", 1):
            self._i, name = self._i + 1, "atan2"
        if self._is("_") and name == "log":
            at = self._take().at
            base = self._inner(self._script(), at)
            return Div(self._function(name, token), Call("log", (base,)))
        if self._is("_") and name in ("min", "max"):
            raise Unread(f"indices of {name} are not supported", self._take().at)
        if self._is("(") or self._is("["):
            arguments = self._arguments()
        elif name in OPTIMA and power is None and not self._is("{", kind="macro"):
            return self._optimum(replace(token, text=name))
        elif self._is("{", kind="open") or self._peek() is END:
            group = self._group()
            if len(split(group, lambda t: t.is_sign("+-"))) > 1 and not group[0].is_sign("+-"):
                raise Unread("braces around the argument of a function are not printed; write brackets", group[0].at)
            arguments = [self._inner(group, token.at)]
        elif self._is("{", kind="macro"):
            arguments = [self._factor()]
        else:
            arguments = [self._product(argument=True)]
            self._bare_end = self._i
        if name == "det" and isinstance(arguments[0], Call) and arguments[0].function in ("abs", "norm", "det"):
            return arguments[0] if arguments[0].function == "det" else Call("det", arguments[0].arguments)
        if name == "d":
            return self._along(arguments[0])
        wanted = {"min": 2, "max": 2, "atan2": 2, "diff": 2}.get(name, 1)
        if name in ("min", "max") and len(arguments) == 1 and power is None:
            return Call(OPTIMA[name], (arguments[0],))
        if len(arguments) != wanted:
            raise Unread(f"{name} with {len(arguments)} arguments is not supported", token.at)
        found = Call(name, tuple(arguments))
        return found if power is None else Pow(found, power)

    def _arguments(self, interval: bool = False) -> list[Node]:
        begin = self._i + 1
        end = self._bracket_end(interval)
        inside = self._found[begin:end]
        parts = split(inside, lambda token: token.text in (",", ";", "quad"))
        if any(token.text == "quad" for token in inside):
            parts = [part for part in parts if part]
        return [self._inner(part, self._found[begin - 1].at) for part in parts]

    def _bracket(self) -> Node:
        at, square = self._found[self._i].at, self._is("[")
        begin = self._i
        arguments = self._arguments(interval=True)
        if self._found[self._i - 1].text != "])"[not square]:
            if len(arguments) != 2 or self._peek() is not END:
                raise Unread(MIXED_BRACKETS, at)
            return Call("closed_open" if square else "open_closed", tuple(arguments))
        inner = arguments[0] if len(arguments) == 1 else None
        scripted = len(arguments) == 1 and (self._is("_") or self._is("^"))
        if scripted and [t.text for t in self._peek_group()] == ["times"]:
            self._i += 1
            self._script()
            return Call("skew", (arguments[0],))
        vectors = inner.factors[-1] if isinstance(inner, Mul) else inner
        letter = self._letter_of(vectors) if vectors else None
        if square and letter and letter.bold and not letter.marks and (not self._is("^") or self._is("2", 1, "number")):
            raise Unread("vectors in square brackets are not supported, as they could mean matrices", at)
        small = isinstance(inner, Sym) and letter is not None and letter.base.islower() and not letter.bold
        if square and small and not self._is("_") and not (self._is("^") and self._peek(-2).text == ")"):
            raise Unread("letters in square brackets are not supported, as they could mean dimensions", at)
        if square and (self._stands_behind_a_letter(begin) or self._may_be_a_name(inner)):
            raise Unread("letters in square brackets are not supported, as they could be one name", at)
        parted = any(token.text == "quad" for token in self._found[begin : self._i])
        before = self._at(begin - 1)
        if len(arguments) > 1 and square and not parted and self._may_be_of_fields(begin, arguments):
            if len(arguments) > 2 or before.kind == "letter" or before.text in GREEK:
                raise Unread("brackets with a comma are not supported, as they could be Lie brackets", at)
            fields = Call("bracket", tuple(Call("bracket", a.entries) if isinstance(a, Grid) else a for a in arguments))
            if not (self._is("(") and self._is_place_next()):
                return fields
            inside = self._found[self._i + 1 : self._bracket_end()]
            return Call("value", (fields, self._inner(inside, at)))
        if len(arguments) > 1 and begin:
            signed = before.kind in ("sign", "open") and before.text not in ")]'"
            if not signed and before.kind != "number" and before.text not in words.SIGNS:
                raise Unread("arguments in brackets after this expression are not supported", at)
        if square and begin and self._peek() is END and self._are_units(begin):
            raise Unread("this could be a unit in square brackets; leave it out, or set it upright", at)
        timed = (
            isinstance(inner, Add) and self._is("(") and self._peek(1).text in ("t", "k", "tau") and self._is(")", 2)
        )
        if len(arguments) == 1 and (timed or (square and self._is("(") and self._is_place_next())):
            raise Unread("arguments in brackets after this expression are not supported", at)
        if len(arguments) > 1 and not square and self._is("("):
            listed = Grid(tuple(arguments))
            return Call("value", (listed, *self._arguments()))
        rows = split(self._found[begin + 1 : self._i - 1], lambda token: token.is_sign(";"))
        if square and 1 < len(rows) < len(arguments):
            parts = [split(row, lambda token: token.is_sign(",")) for row in rows]
            return Grid(tuple(Grid(tuple(self._inner(cell, at) for cell in row)) for row in parts))
        if len(arguments) > 1:
            return Grid((Grid(tuple(arguments)),)) if parted else Grid(tuple(arguments))
        if not arguments:
            raise Unread("the brackets are empty", at)
        return arguments[0]

    def _may_be_of_fields(self, begin: int, arguments: Sequence[Node]) -> bool:
        """Return whether a bracket that was read could be a Lie bracket of fields instead of a vector."""
        if any(constant(argument) is not None for argument in arguments):
            return False
        nested = [isinstance(argument, Grid) for argument in arguments]
        alone = begin == 0 and (self._peek() is END or self._peek().text in ("|", "vert", "rvert"))
        return (any(nested) and not all(nested)) or not (alone or self._is("^"))

    def _are_units(self, begin: int) -> bool:
        """Return whether the bracket that was read contains only units, such as m/s or kg."""
        before = self._at(begin - 1)
        apart = before.kind == "number" or self._found[begin].at > before.at + len(before.text) + 1
        return apart and before.text != "]" and are_units(self._found[begin + 1 : self._i - 1])

    def _stands_behind_a_letter(self, begin: int) -> bool:
        """Return whether a bracket with one letter or function follows a letter, as in an expectation."""
        inside = self._found[begin + 1 : self._i - 1]
        before = self._at(begin - 1)
        behind = before.kind in ("letter", "close") or before.text in GREEK
        if self._is_taken(inside):
            return behind
        letter = self._letter_in(inside)
        alone = letter is not None and letter == letter.plain and not letter.dots
        called = len(inside) > 1 and inside[0].is_macro(FUNCTIONS)
        called = called and len(split(inside, lambda token: token.is_sign("+-"))) == 1
        return (alone or called) and behind

    def _may_be_a_name(self, inner: Node | None) -> bool:
        if not isinstance(inner, Mul):
            return False
        letters = all(isinstance(factor, Sym | Call) for factor in inner.factors)
        return letters and isinstance(inner.factors[0], Sym) and not self._is_vector(inner)

    def _environment(self, token: Token) -> Node:
        if token.text not in MATRICES and not token.text.endswith("cases"):
            raise Unread(f"the environment {printable(token.text)} is not supported here", token.at)
        if token.text == "array" and self._is("{", kind="open"):
            self._group()
        option = self._peek(1)
        if self._is("[") and self._is("]", 2) and (option.kind == "number" or option.text in "clr"):
            self._i += 3  # how far lines stand apart
        body = self._up_to_end(environment)
        rows = [r for r in split(body, lambda t: t.is_macro(("\\", "cr"))) if r]
        if token.text.endswith("cases"):
            return self._cases(rows, token.at)
        entries: list[Grid] = []
        parted = [split(row, lambda t: t.is_sign("&")) for row in rows]
        width = min(map(len, parted), default=1)
        for row, cells in zip(rows, parted, strict=True):
            if len(cells) == width + 1 and not cells[-1]:
                cells = cells[:-1]
            if len(cells) > 1:  # commas between columns
                cells = [cell[: len(cell) - (cell[-1:] != [] and cell[-1].text == ",")] for cell in cells]
            if len(cells) == 1:  # a row may be printed with commas
                cells = split(row, lambda t: t.is_sign(","))
            across = [parted[k][len(entries) : len(entries) + 1] for k in range(min(len(cells), len(parted)))]
            if any(not cell and other not in ([], [[]]) for cell, other in zip(cells, across, strict=False)):
                raise Unread("an empty entry could be zero, or follow from symmetry", token.at)
            entries.append(Grid(tuple(self._inner(cell, token.at) if cell else ZERO for cell in cells)))
        if not entries or len({len(entry.entries) for entry in entries}) > 1:
            raise Unread("all rows of a matrix must have the same length", token.at)
        if token.text in ("vmatrix", "Vmatrix"):
            return Call("det" if token.text == "vmatrix" else "norm", (Grid(tuple(entries)),))
        return Grid(tuple(entries))

    def _raised(self, base: Node, script: list[Token], at: int) -> Node:
        if not script:
            return base
        if len(script) == 1 and script[0].text == "circ" and isinstance(base, Num):
            if "".join(t.text for t in [self._peek(), *self._peek_group()][-1:]) in ("C", "F", "K"):
                raise Unread("units in formulas are not supported", at)
            return Div(Mul((base, Sym("pi"))), Num(Fraction(180)))
        upright = script[0].text in words.UPRIGHT and "".join(t.text for t in script[1:]) in ("T", "{T}")
        if len(script) == 1 and script[0].text in ("wedge", "times"):
            return Call("skew", (base,))
        if upright or (script[0].text in words.TRANSPOSED and len(script) == 1):
            self._note_matrix(base)
            return Call("transpose", (base,))
        if len(script) == 1 and script[0].text in ("dagger", "dag", *words.STARS):
            return Call("raised", (base, Sym("star" if script[0].text in words.STARS else "dagger")))
        bracketed = script[0].is_sign("[") or script[0].is_macro(words.OPENING)
        if bracketed and base != Sym("e") and (script[-1].is_sign("]") or script[-1].is_macro(words.CLOSING)):
            raise Unread("this index is not supported", at)
        exponent = self._inner(script, at)
        value = constant(exponent)
        if value is None and (constant(base) is not None or base == Sym("pi")):
            return Call("power", (base, exponent))
        if base == Sym("e") and len(script) == 1 and script[0].text in "abcdefghijklmnoBNI":
            raise Unread("this could be a power of a variable e or an exponential; write \\exp for the exponential", at)
        if isinstance(base, Sym) and base.name == "e" and value not in words.OF_ECCENTRICITIES:
            return Call("exp", (exponent,))
        if value is None:  # a power, or an index above
            letters = [t.kind == "letter" or t.text in GREEK for t in script]
            if (len(letters) > 1 and all(letters)) or (isinstance(exponent, Call) and exponent.function != "transpose"):
                raise Unread("exponents of several letters are not supported", at)
            return Call("raised", (base, exponent))
        if value == -1:
            self._note_matrix(base)
        if value == 0:
            raise Unread("an exponent of zero could be an index", at)
        if base == Num(Fraction(10)):  # an order of magnitude
            return Pow(base, exponent) if abs(value) <= MAX_EXPONENT else Call("power", (base, exponent))
        if abs(value) > MAX_EXPONENT:
            raise Unread(f"exponents above {MAX_EXPONENT} are not supported", at)
        return Pow(base, exponent)

    def _note_matrix(self, base: Node) -> None:
        """Record that a capital letter is inverted or transposed, as matrices are."""
        if isinstance(base, Sym) and base.name[0].isupper():
            self._reading.matrices.add(base.name)

    def _of_vectors(self, product: str, left: Node, sign: Token) -> Node:
        r"""Read the product of two vectors; factors may precede the second vector, ``\bm r \times m\bm a``."""
        if product == "cross" and left == Sym("I_vector"):
            raise Unread("a product of vectors needs a vector on both sides", sign.at)  # inertia, or the identity
        right = [self._signed_factor()]
        while not self._is_vector(right[-1]):
            if not self._begins_factor(self._peek()):
                if product == "cross":
                    raise Unread("a product of vectors needs a vector on both sides", sign.at)
                return product_of([left, *right])
            right.append(self._factor())
        while self._is_matrix(right[-1]) and self._begins_factor(self._peek()):
            begin = self._i
            factor = self._factor()
            if not self._is_vector(factor):
                self._i = begin
                break
            if product == "dot":
                raise Unread("several products of vectors in a row need brackets", sign.at)
            right.append(factor)  # r x (A b), since a matrix stands before the vector that it turns
        if product == "dot" and self._is_matrix(right[-1]) and self._peek().is_macro("cdot"):
            raise Unread("several products of vectors in a row need brackets", self._peek().at)
        return Call(product, (left, product_of(right)))


def shows_transposition(terms: Sequence[Node]) -> bool:
    """Return whether primes in a sum can only mean the transpose.

    So it is in ``x'Qx``, where the letter follows without its prime, in ``A'P + PA``, and in ``R^{-1}B'``.
    """
    begins: set[str] = set()
    ends: set[str] = set()
    for term in terms:
        term = term.operand if isinstance(term, Neg) else term
        factors = term.factors if isinstance(term, Mul) else ()
        names = [part.name if isinstance(part, Sym) else "" for part in factors]
        if len(names) > 2 and names[0][:1].isupper() and names[-1] == f"{names[0]}_prime":
            return True  # as A P A'
        for k, name in enumerate(names[:-1]):
            if name.endswith("_prime") and names[k + 1][:1].isupper() and name.removesuffix("_prime") in names[k + 2 :]:
                return True
            power = factors[k]
            base = power.base if isinstance(power, Pow) and constant(power.exponent) == -1 else None
            if base is not None and names[k + 1].endswith("_prime") and base not in factors[k + 1 :]:
                return True
        begins |= {names[0].removesuffix("_prime")} if names and names[0].endswith("_prime") else set()
        ends |= {names[-1]} if names else set()
    return any(name[:1].isupper() for name in begins & ends)


def product_of(factors: Sequence[Node]) -> Node:
    """Return the product of factors as printed; a sign of the first factor becomes the sign of the product."""
    if len(factors) == 1:
        return factors[0]
    if isinstance(factors[0], Neg):
        return Neg(product_of([factors[0].operand, *factors[1:]]))
    return Mul(tuple(factors))
