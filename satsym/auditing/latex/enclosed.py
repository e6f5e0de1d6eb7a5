"""Reading of what is enclosed by signs: braces, bars, cases, points of evaluation, and indices before a letter."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate, pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import CONSTANT, bar_in, listed, refuse_unit
from satsym.auditing.latex.letters import GREEK, Letter, cleaned
from satsym.auditing.latex.refusals import RefusalCursor
from satsym.auditing.latex.remarks import REMARK
from satsym.auditing.latex.rows import relation_in, split
from satsym.auditing.latex.tokens import END, Token, Unread
from satsym.auditing.latex.words import ACCENTS, FUNCTIONS
from satsym.formula.tree import Add, Call, Grid, Mul, Node, Pow, Sym, Text, constant, symbols

_BARS = "bars around a matrix could mean its determinant or its norm; write \\det for the determinant"
_OF_MATRICES = frozenset("A C D K P Q S W Lambda Phi".split())
"""Letters of matrices if they are set in bold."""
_OF_SETS = frozenset(("given", "both", "equal", *words.RELATIONS.values()))
"""Functions of which braces around them make a set."""


class EnclosedCursor(RefusalCursor):
    """Parser of the expressions that signs enclose."""

    def _taken(self, base: Node, script: list[Token], at: int) -> Node:
        """Return an expression evaluated at the point that is written below a bar."""
        places = self._condition(script, at)
        letter = self._letter_of(places)
        if letter is not None and letter.base.isupper() and not (letter.index or letter.marks):
            raise Unread("this letter could denote a frame, a set or the point where the expression is taken", at)
        if isinstance(places, Mul) and all(isinstance(one, Sym) and one.name[-1:].isdigit() for one in places.factors):
            raise Unread("this space could separate two entries or two factors", at)
        return Call("value", (base, *listed(places)))

    def _condition(self, part: Sequence[Token], at: int) -> Node:
        bar = bar_in(part)
        if bar >= 0:
            return Call("given", (self._condition(part[:bar], at), *listed(self._condition(part[bar + 1 :], at))))
        found: list[Node] = []
        for piece in split(part, lambda t: t.is_sign(",;")):
            line = relation_in(piece)
            for side in () if line.bare else line.sides:
                refuse_unit(side)
            sides = [self._inner(side, at) for side in line.sides]
            steps: list[Node] = [
                Call("equal" if sign == "=" else sign, pair)
                for sign, pair in zip(line.signs, pairwise(sides), strict=True)
            ]
            found.append(sides[0] if line.bare else steps[0] if len(steps) == 1 else Call("both", tuple(steps)))
            if line.signs == ["element"]:
                begin = max((k + 1 for k, one in enumerate(found[:-1]) if not isinstance(one, Sym)), default=0)
                if members := found[begin:-1]:  # x, u in a set
                    found[begin:] = [Call("element", (Call("list", (*members, sides[0])), sides[1]))]
        return found[0] if len(found) == 1 else Call("list", tuple(found))

    def _is_transform(self, base: Node) -> bool:
        r"""Return whether braces or square brackets follow a letter typeset as an operator, ``\mathcal{L}^{-1}``."""
        letter = self._letter_of(base.base if isinstance(base, Pow) else base)
        operator = letter is not None and letter.style == "cal" and letter.base in words.TRANSFORMS
        token = self._peek()
        if letter == Letter("E") and (token.is_sign("[") or token.is_macro("{")):
            begin = self._i
            inside = [] if token.kind == "macro" else self._found[begin + 1 : self._bracket_end()]
            self._i = begin
            summed = len(split(inside, lambda t: t.is_sign("+-"))) > 1
            operator = token.kind == "macro" or bar_in(inside) >= 0 or not summed
        return operator and (token.text == "[" or token.is_macro(("{", "lbrace")))

    def _transform(self, base: Node) -> Node:
        """Read the argument of a transform or mean."""
        opening = self._take()
        begin = self._i
        if opening.text == "[":
            self._i -= 1
            return Call("transform", (base, self._condition(self._found[begin : self._bracket_end()], opening.at)))
        return Call("transform", (base, self._condition(self._braced(), opening.at)))

    def _braced(self) -> Sequence[Token]:
        """Return the tokens within braces or angle brackets, after the opening one was read."""
        return self._up_to_end(lambda token: token.is_macro(words.OPENING) - token.is_macro(words.CLOSING))

    def _in_a_frame(self) -> Node:
        """Read a letter with its reference frame printed before it, ``{}^A r``: components in this frame."""
        at, said = self._found[self._i].at, []
        while self._accept("^") or self._accept("_"):
            said.append(cleaned(self._said(self._script())))
        if self._is("{", kind="open") and not self._peek_group():
            self._group()
        letter = self._letter()
        if letter is None or not all(said):
            raise Unread("it is not clear to which letter this leading index belongs", at)
        return self._symbol(replace(letter, marks=(*letter.marks, f"in_{'_'.join(said)}")), at)

    def _named(self, macro: str, word: str, length: int) -> Node | None:
        """Read a function of unknown meaning whose name is printed upright, followed by brackets.

        Otherwise ``None``.
        """
        begin, behind = self._i, self._i + 1 + length + 2 * self._is("{", 1, "open")
        known = word in words.UNKNOWN or (macro == "operatorname" and word not in words.OPTIMA)
        spelled = len(word) > 2 and not word.isupper() and word not in words.UNITS | words.SAID | words.OPTIMA.keys()
        if not (known or spelled) or word in FUNCTIONS or not word.isalpha() or behind >= len(self._found):
            return None
        self._i = behind
        grouped = self._is("{", kind="open") and self._is("(", 1)
        self._i += grouped
        if known and self._accept("^"):
            power = self._inner(self._script(), self._found[begin].at)
            if self._is("("):
                return Pow(Call(word, self._places()), power)
            self._i = behind
        token = self._peek()
        timed = not known and self._is("t", 1, "letter") and self._is(")", 2)
        if not timed and (self._is("(") or (known and self._is("["))):
            arguments = self._places()
            self._i += grouped
            return Call(word, arguments)
        letter = self._letter() if known else None
        if letter is not None and not self._begins_factor(self._peek()):
            return Call(word, (self._symbol(letter, self._found[begin].at),))
        self._i = behind
        if known and (token.kind == "begin" or token.is_macro("{")):
            return Call(word, (self._factor(),))
        self._i = begin
        return None

    def _places(self) -> tuple[Node, ...]:
        """Read the arguments in the next bracket, which may be relations, and given conditions."""
        begin = self._i
        inside = self._found[begin + 1 : self._bracket_end()]
        if not inside:
            raise Unread("the brackets are empty", self._found[begin].at)
        if any(t.text == "quad" for t in inside):  # the entries of a row
            self._i = begin
            return (self._bracket(),)
        return listed(self._condition(inside, self._found[begin].at))

    def _upright(self, token: Token) -> Node | None:
        """Read a function or word that is printed upright; ``None``, with nothing read, for a letter."""
        group = self._peek_group()
        word = "".join(t.text for t in group)
        behind = self._i + 1 + len(group) + 2 * self._is("{", 1, "open")
        following = self._at(behind)
        worn = following.text in (*GREEK, *ACCENTS, *words.STYLES)
        if word == "d" and (worn or following.kind in ("letter", "open")):
            self._i = behind
            return self._differential(token.at)
        if (found := self._named(token.text, word, len(group))) is not None:
            return found
        if word != "constantvector":
            self._refuse_word(token.text, word.strip(), token.at)
        if word in words.OPTIMA and following.text == "_":
            self._i = behind
            return self._optimum(replace(token, text=word))
        if word in FUNCTIONS and len(word) > 1 and word != "diff":
            self._i = behind
            return self._function(FUNCTIONS[word], token)
        if word.strip(". ") in ("const", "constant", "constantvector", "konstan", "konst", "tetap"):
            self._i = behind + (following.text == ".")
            self._reading.constants = True
            return Sym(CONSTANT)
        return None

    def _called(self, name: str) -> Node | None:
        """Read a function of unknown meaning with its argument, in brackets or a single letter."""
        if self._is("("):
            return Call(name, self._places())
        letter = self._letter()
        return Call(name, (self._symbol(letter, self._found[self._i - 1].at),)) if letter else None

    def _unit(self, last: Node) -> Node | None:
        """Read the upright unit after a number; ``None``, with nothing read, if there is no unit."""
        begin, said = self._i, ""
        numeric = constant(last) is not None or (isinstance(last, Call) and last.function == "power")
        while numeric and (token := self._peek()) is not END:
            if token.is_macro(words.UPRIGHT):
                self._i += 1
                group = self._group()
                ends = [0, *(t.at + len(t.text) for t in group)]
                said += "".join(" " * (0 < end < t.at) + t.text for end, t in zip(ends, group, strict=False))
            elif said and (token.is_sign("^/") or token.is_macro("cdot")):
                said += {"cdot": " "}.get(token.text, token.text)
                self._i += 1
                said += "".join(t.text for t in self._script()) if token.text == "^" else ""
            else:
                break
        parts = re.findall(r"[A-Za-z]+", said)
        if said and all(part in words.UNITS for part in parts) and not self._begins_factor(self._peek()):
            return Text(said)
        self._i = begin
        return None

    def _braces(self, token: Token) -> Node:
        """Read the contents of braces, or of angle brackets, which denote a mean or an inner product."""
        begin = self._i - 1
        inside = self._braced()
        if (bar := bar_in(inside, colon=True)) >= 0:
            bar_sign = replace(inside[bar], kind="macro", text="mid")
            inside = [*inside[:bar], bar_sign, *inside[bar + 1 :]]
        found = self._condition(inside, token.at)
        several = listed(found) != (found,) or (isinstance(found, Call) and found.function in _OF_SETS)
        if token.text == "langle":
            return Call("angled", listed(found))
        alone = begin == 0 and self._peek() is END and isinstance(found, Sym)
        return Call("braces", listed(found)) if several or alone else found

    def _cases(self, rows: Sequence[Sequence[Token]], at: int) -> Node:
        """Read values, each with the condition under which it applies."""
        found: list[Node] = []
        for row in rows:
            cells = split(row, lambda t: t.is_sign("&,"))
            value, *rest = [cell for cell in cells if any(t.text != REMARK for t in cell)]
            said = [token for cell in rest for token in (*cell, Token("sign", ",", cell[-1].at))][:-1]
            spoken = "".join(t.text for t in said if t.text != REMARK)
            if "otherwise" in spoken or spoken.strip("{}.") in words.OTHERWISE:
                found += [self._inner(value, at), Sym("otherwise")]
                continue
            conditions = listed(self._condition(said, at)) if said else ()
            if not conditions or not all(isinstance(c, Call) and c.function in _OF_SETS for c in conditions):
                raise Unread("the condition of this case is not supported", said[0].at if said else at)
            found += [self._inner(value, at), conditions[0] if len(conditions) == 1 else Call("list", conditions)]
        return Call("cases", tuple(found))

    def _may_be_matrix(self, node: Node, arrow: bool) -> bool:
        """Return whether a letter could be a matrix or a set, so that bars around it are not its absolute value."""
        letter = self._letter_of(node)
        if letter is None or letter.dots:
            return False
        known = letter.style == "cal" or letter.name in self._reading.matrices
        return known or letter.base in ("J", "Sigma") or (letter.bold and letter.base in _OF_MATRICES and not arrow)

    def _size(self, token: Token) -> Node:
        """Read an expression between bars: absolute value, norm or determinant."""
        closing = {"lvert": "rvert", "lVert": "rVert"}.get(token.text, token.text)
        rest = self._found[self._i :]
        depths = accumulate(inside.group for inside in rest)
        ends = (
            k for k, depth in enumerate(depths) if depth == 0 and rest[k] == replace(token, text=closing, at=rest[k].at)
        )
        end = next(ends, -1)
        if end < 0:
            why = "vertical bars without a closing bar, as in evaluations at a point, are not supported"
            raise Unread(why, token.at)
        self._i += end + 1
        inner = self._inner(rest[:end], token.at)
        single = token.text in ("lvert", "vert") or (token.text == "|" and token.kind != "macro")
        of = inner.arguments[0] if isinstance(inner, Call) and inner.function == "value" else inner
        arrow = any(t.is_macro(("vec", "overrightarrow")) for t in rest[:end])
        if single and (self._may_be_matrix(of, arrow) or (isinstance(of, Call) and of.function == "braces")):
            raise Unread(_BARS, token.at)
        if (letter := self._letter_of(inner)) and letter.bold and not self._is("_"):
            return self._symbol(replace(letter, style="", marks=(*letter.marks, "norm")), token.at)
        if single and isinstance(inner, Add) and {"I", "lambda"} <= symbols(inner):
            return Call("det", (inner,))
        if single and isinstance(inner, Add) and "I" in symbols(inner):
            raise Unread(_BARS, token.at)
        if single and isinstance(inner, Grid):
            return Call("det", (inner,))
        if not single and self._is("^"):
            self._index_first()
        if not single and self._accept("_"):
            script = self._script()
            if len(script) > 1 and all(t.kind == "letter" for t in script):
                return Call("indexed_norm", (inner, Sym("".join(t.text for t in script))))
            if [t.text for t in script] != ["2"]:
                return Call("indexed_norm", (inner, self._inner(script, token.at)))
        return Call("abs" if single and not self._is_vector(inner) else "norm", (inner,))
