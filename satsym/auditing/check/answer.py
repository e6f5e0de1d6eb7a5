"""Check of one printed formula: it is read, interpreted, compared with every equation of a model, and explained."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from satsym.auditing.check import remedies
from satsym.auditing.check.answers import Answer, Fit, Verdict
from satsym.auditing.check.comparing import AtOneTime, at_one_time, likeness, matrix_answer
from satsym.auditing.check.derived import Derived, Target, is_plain, says_nothing, solved, vanishes
from satsym.auditing.check.meanings import Guess, Meanings, given_letters
from satsym.auditing.latex.cursor import CONSTANT, Reading
from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.letters import Letter
from satsym.auditing.latex.plain import plain_tokens
from satsym.auditing.latex.tokens import tokens
from satsym.auditing.latex.words import EITHER_PRODUCT, RELATIONS
from satsym.auditing.latex.writing import Writer, in_latex, in_plain
from satsym.formula.calculus import difference
from satsym.formula.tree import (
    ZERO,
    Call,
    Equality,
    Grid,
    Node,
    Sym,
    calls_in,
    cells,
    names_in,
    substituted,
    symbols,
    walk,
)
from satsym.records import shelf
from satsym.status import BadInput

_SIMILAR = 0.75
"""Likeness above which an equation of the model is taken as the intended one even if no edit leads to it."""
_NEAR_LIKENESS = 0.34
"""Likeness below which an equation of the model is never taken as the intended one."""
_SAME_LIKENESS = 1.0
"""Likeness above which an equation that holds only at some times is identified with the printed one.

Below, the printed equation might merely follow from it.
"""
_SOMEWHERE = 0.25
"""Deduction from the likeness of equations that hold only at some times, such as boundary conditions."""
_TRIED = 5
"""Number of the most similar equations for which an edit is searched."""
_LOOKED_AT = 12
"""Number of interpretations of the letters for which similar equations are searched."""
_ODD = 0.03
"""Deduction from the likeness for each step of oddity (unnaturalness) of an interpretation of the letters."""


def check(text: str, model: str, let: Sequence[str] = (), free: bool = False) -> list[Answer]:
    """Check the equations in a formula and return one answer for each; see :func:`satsym.check`."""
    derived = Derived(shelf.find(model))
    meanings = Meanings(derived)
    given = given_letters(let, derived)
    latex = "\\" in text or "{" in text or "$" in text
    reading = _read(text, latex, meanings, given)
    subject = Subject(derived, meanings, reading, given, free, latex)
    return [subject.answer(statement) for statement in reading.statements]


def check_in(text: str, model: str, folder: Path, let: Sequence[str] = (), free: bool = False) -> list[Answer]:
    """Check a formula against a model that is shipped, or that lies in a folder relative to `folder`."""
    place, name = shelf.place_of(model, folder)
    with shelf.opened(place):
        return check(text, name, let, free)


def _read(text: str, latex: bool, meanings: Meanings, given: Mapping[Letter, str]) -> Reading:
    if latex:
        inner = text.strip().strip("$")
        return read(tokens(inner), inner, names=meanings.spelled(given))
    found = plain_tokens(text, lambda letter: meanings.tree(letter, given) is not None)
    return read(found, text)


@dataclass(frozen=True, eq=False)
class Subject:
    """Equations of one formula, with the model and the meanings of letters that are needed to judge them."""

    derived: Derived
    meanings: Meanings
    reading: Reading
    given: Mapping[Letter, str]
    free: bool
    latex: bool

    @cached_property
    def letters(self) -> dict[str, Letter]:
        """Printed letters by their names in the trees, including the letters of the model's own notation."""
        own = {letter.name: letter for letter in self.meanings.known}
        return {**own, **self.reading.letters}

    def writer(self, latex: bool, besides: Mapping[str, str] | None = None) -> Writer:
        """Return a writer of trees in the notation of the formula, in LaTeX or in plain text."""
        if latex:
            return in_latex({**{name: letter.latex for name, letter in self.letters.items()}, **(besides or {})})
        return in_plain(besides or {})

    def answer(self, statement: Node | Equality) -> Answer:
        """Judge one statement of the formula; a statement that cannot be compared is undecided."""
        try:
            if isinstance(statement, Call) and statement.function in RELATIONS.values():
                return self.answered(
                    statement, "undecided", "it is not an equation, so there is nothing to compare it with"
                )
            if (there := at_one_time(statement)) is not None:
                return self._at_one_time(statement, there)
            if any(isinstance(part, Grid) for side in cells(statement) for _, part in walk(side)):
                return self._of_matrix(statement)
            return self._of_equation(statement)
        except (BadInput, RecursionError) as error:
            why = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
            return self.answered(statement, "undecided", why)

    def answered(
        self,
        statement: Node | Equality,
        verdict: Verdict,
        diagnosis: str = "",
        *,
        fit: Fit | None = None,
        address: str = "",
        correct: Node | Equality | None = None,
        besides: tuple[Mapping[str, str], Mapping[str, str]] = ({}, {}),
    ) -> Answer:
        """Return the answer with the given verdict, written in the notation of the formula."""
        latex, plain = besides
        write, write_tex = self.writer(self.latex, latex if self.latex else plain), self.writer(True, latex)
        shown = correct if correct is not None else statement
        meaning = fit.guess.meaning if fit else self.given
        named = {}
        for letter in self.reading.letters.values():
            ours = meaning.get(letter.still)
            if ours and ours != self.meanings.named(letter.still):
                named[letter.still.latex if self.latex else letter.still.name] = ours
        for capitals in self.reading.products:
            if any(self.meanings.tree(Letter(one), self.given) is None for one in capitals):
                named[capitals] = "*".join(capitals)
        return Answer(
            write(statement),
            self.derived.record.name,
            named,
            bool(fit and fit.free),
            verdict,
            address or (fit.target.address if fit and fit.target else ""),
            diagnosis,
            write(correct) if correct is not None else "",
            write_tex(shown),
            self.writer(False, plain)(shown),
            fit,
        )

    def _at_one_time(self, statement: Node | Equality, there: AtOneTime) -> Answer:
        """Judge an equation that is taken at the initial or the final time only, e.g. a boundary condition.

        The equation is compared with the conditions of the model at this time and with equations that hold at all
        times.
        """
        found = self.answer(there.equation)
        target = found.fit.target if found.fit else None
        meant = found.verdict == "right" or (target is not None and there.is_condition(target))
        if found.verdict != "undecided" and meant and there.holds_at_this_end(target, self.derived.states):
            return replace(found, formula=self.writer(self.latex)(statement))
        return self.answered(statement, "undecided", "the model has no condition at this time", fit=found.fit)

    def _of_matrix(self, statement: Node | Equality) -> Answer:
        inside = self._inside(statement)
        guess = next(self._guesses(inside), None)
        if guess is None:
            return self._unknown(statement, inside)
        meanings = {name: tree for name in inside if (tree := self._meaning(name, guess)) is not None}
        verdict, address, diagnosis, correct = matrix_answer(statement, meanings, self.derived, self)
        fit = Fit(guess, None, False, 0.0)
        return self.answered(statement, verdict, diagnosis, fit=fit, address=address, correct=correct)

    def _of_equation(self, statement: Node | Equality) -> Answer:
        inside = self._inside(statement)
        guesses = list(self._guesses(inside))
        if not guesses:
            return self._unknown(statement, inside)
        named, derivatives = remedies.with_names(statement, self)
        fits: list[Fit] = []
        for place, guess in enumerate(guesses):
            fit = self._right(named, derivatives, guess)
            if fit is not None and not (guess.oddity and fits and fits[0].likeness > fit.likeness + 0.3):
                return self.answered(statement, "right", fit=fit)
            if place < _LOOKED_AT:
                best = max((fit.likeness - _ODD * fit.guess.oddity for fit in fits), default=0.0)
                fits += self._near(named, derivatives, guess, min(_NEAR_LIKENESS, best + _ODD * guess.oddity))
        fits.sort(key=lambda fit: fit.likeness - _ODD * fit.guess.oddity, reverse=True)
        return self._wrong_answer(statement, named, derivatives, fits)

    def _wrong_answer(
        self, statement: Node | Equality, named: Node | Equality, derivatives: Mapping[str, Node], fits: list[Fit]
    ) -> Answer:
        near: list[Fit] = []
        seen: set[tuple[Equality | None, bool]] = set()
        for fit in fits:
            key = fit.target.equation if fit.target else None
            if fit.target and fit.likeness >= _NEAR_LIKENESS and (key, fit.free) not in seen and len(near) < _TRIED:
                seen.add((key, fit.free))
                near.append(fit)
        if not near:
            why = f"no equation of {self.derived.record.name} resembles it"
            return self.answered(statement, "undecided", why, fit=fits[0] if fits else None)
        best: tuple[float, Fit, remedies.Found] | None = None
        for fit in near:
            if best is not None and best[2].cost < 20 and fit.likeness < best[1].likeness - 0.15:
                break
            found = remedies.sought(named, derivatives, fit, self)
            if found.right:
                return self.answered(statement, "right", fit=fit)
            if found.cost >= remedies.NO_EDIT and fit.likeness < _SIMILAR:
                continue
            cost = found.cost - 30.0 * (fit.likeness - _ODD * fit.guess.oddity)
            if best is None or cost < best[0]:
                best = cost, fit, found
        if best is None:
            why = f"no equation of {self.derived.record.name} resembles it"
            return self.answered(statement, "undecided", why, fit=near[0])
        _, fit, found = best
        besides = self.derivatives(True, derivatives), self.derivatives(False, derivatives)
        return self.answered(statement, "wrong", found.diagnosis, fit=fit, correct=found.correct, besides=besides)

    def derivatives(self, latex: bool, derivatives: Mapping[str, Node]) -> dict[str, str]:
        """Return how derivatives that are replaced by one letter in the tree are written."""
        write = self.writer(latex)
        return {name: write(tree) for name, tree in derivatives.items()}

    def _unknown(self, statement: Node | Equality, inside: Sequence[str]) -> Answer:
        letters = [self.reading.letters[name] for name in inside if name in self.reading.letters]
        odd = self.meanings.unknown(letters, self.given)
        written = ", ".join(letter.latex if self.latex else letter.name for letter in odd)
        why = f"{written} might have no meaning in {self.derived.record.name}; give its meaning with --let LETTER=NAME"
        return self.answered(statement, "undecided", why)

    def _inside(self, statement: Node | Equality) -> list[str]:
        names = names_in(statement)
        return [name for name in self.reading.letters if name in names]

    def _guesses(self, inside: Sequence[str]) -> Iterator[Guess]:
        letters = [self.reading.letters[name] for name in inside]
        labels = {"A", "B", "C", "D", "V", "E", "T", "U", "K", "P", "W"}
        if any(letter.base in labels and not letter.dots for letter in letters):
            letters = [
                one for one in letters if one.base not in labels or self.meanings.named(one) or not self._is_label(one)
            ]
        if self.meanings.unknown(letters, self.given):
            yield from self.meanings.guesses(letters, self.given)
        else:
            yield Guess(self.given, 0)
            yield from self.meanings.alternatives(letters, self.given)

    def _is_label(self, letter: Letter) -> bool:
        """Return whether a letter is only the name of the right-hand side, and does not occur in it."""
        for statement in self.reading.statements:
            if isinstance(statement, Equality) and statement.lhs == Sym(letter.name):
                return letter.name not in symbols(statement.rhs)
        return False

    def _meaning(self, name: str, guess: Guess) -> Node | None:
        letter = self.reading.letters.get(name)
        return self.meanings.tree(letter, guess.meaning) if letter else None

    def meant(self, named: Node | Equality, derivatives: Mapping[str, Node], guess: Guess) -> dict[str, Node]:
        """Return what each name in the tree means, as a formula in the names of the model."""
        found: dict[str, Node] = {}
        for name in sorted(names_in(named)):
            if name in derivatives:
                inner = derivatives[name]
                terms = {n: t for n in symbols(inner) if (t := self._meaning(n, guess)) is not None}
                found[name] = self.derived.differentiated(substituted(inner, terms))
            elif (tree := self._meaning(name, guess)) is not None:
                found[name] = tree
        return found

    def residuals(self, named: Node | Equality, derivatives: Mapping[str, Node], guess: Guess) -> Iterator[Node]:
        """Yield the difference of the two sides in the names of the model, or a sole expression itself.

        An equation "... = const" yields the time derivative of its left-hand side along the motion.
        """
        meant = self.meant(named, derivatives, guess)
        if isinstance(named, Equality):
            if named.rhs == Sym(CONSTANT):
                yield self.derived.along(self.derived.opened(substituted(named.lhs, meant)))
                return
            yield difference(substituted(named.lhs, meant), substituted(named.rhs, meant))
        else:
            yield substituted(named, meant)

    def _right(self, named: Node | Equality, derivatives: Mapping[str, Node], guess: Guess) -> Fit | None:
        """Return how an equation holds in the model, for one interpretation of the letters.

        Return ``None`` if it does not hold.
        """
        residual = next(self.residuals(named, derivatives, guess))
        if any(call.function == "times" for call in calls_in(residual)):
            raise BadInput(EITHER_PRODUCT)
        if not is_plain(residual):
            raise BadInput(
                "vectors, sums and integrals are not compared; check the components, or the expressions in them"
            )
        if not isinstance(named, Equality):
            return self._right_expression(residual, guess)
        if says_nothing(residual, self.derived):
            return self._identity(named, guess)
        for free in (False, True) if not self.free else (True,):
            besides: dict[str, Node] = dict.fromkeys(self.derived.controls, ZERO) if free else {}
            if free and symbols(residual) & {*self.derived.controls, *self.derived.costates}:
                continue
            if vanishes(residual, self.derived, besides):
                left = substituted(named.lhs, self.meant(named.lhs, derivatives, guess))
                same = (t for t in self.derived.targets if t.always and t.equation.lhs == left and not besides)
                return Fit(guess, self._likest(residual, besides) or next(same, None), free, 1.0)
        for target in self.derived.targets:
            if not target.always and likeness(residual, target.residual, _SAME_LIKENESS) >= _SAME_LIKENESS:
                for extra in solved(target, self.derived):
                    if vanishes(residual, self.derived, extra):
                        return Fit(guess, target, False, 1.0)
        return None

    def _right_expression(self, tree: Node, guess: Guess) -> Fit | None:
        found = [t for t in self.derived.targets if vanishes(difference(tree, t.equation.rhs), self.derived)]
        found.sort(key=lambda target: likeness(tree, target.equation.rhs), reverse=True)
        return Fit(guess, found[0], False, 1.0) if found else None

    def _identity(self, named: Equality, guess: Guess) -> Fit | None:
        """Return the fit of an equation that only states which state is the rate of change of another state."""
        dotted = [self.reading.letters[n] for n in symbols(named.lhs) | symbols(named.rhs) if n in self.reading.letters]
        for letter in dotted:
            name = guess.meaning.get(letter.still) or self.meanings.named(letter.still)
            if letter.dots == 1 and name and name in self.derived.speeds:
                return Fit(guess, self._kinematic(name), False, 1.0)
        return Fit(guess, None, False, 1.0)

    def _kinematic(self, state: str) -> Target | None:
        address = next((a for a, x in self.derived.kinematic.items() if x == state), "")
        return next((target for target in self.derived.targets if target.address == address), None)

    def _likest(self, residual: Node, besides: Mapping[str, Node]) -> Target | None:
        """Return the equation of the model most similar to an equation that holds; ``None`` if none is similar."""
        best: tuple[float, Target | None] = 0.7, None
        inside = symbols(residual)
        for target in self.derived.targets:
            if not symbols(target.equation.lhs) <= inside | {*besides}:
                continue
            there = substituted(target.residual, besides) if besides else target.residual
            alike = likeness(residual, there, best[0]) if target.always else 0.0
            if alike > best[0] + 1e-9:
                best = alike, target
        return best[1]

    def _near(self, named: Node | Equality, derivatives: Mapping[str, Node], guess: Guess, least: float) -> list[Fit]:
        """Return the equations of the model that are similar to the printed one, for one interpretation of the letters.

        Equations with a likeness below `least` are left out.
        """
        residual = next(self.residuals(named, derivatives, guess))
        found = []
        inside = symbols(residual)
        without = not inside & {*self.derived.controls, *self.derived.costates}
        for target in self.derived.targets:
            there = target.residual if isinstance(named, Equality) else target.equation.rhs
            cost = {"L", "S"} & symbols(target.equation.lhs)
            if not symbols(there) & inside or not cost <= inside:  # what is printed must name the cost
                continue
            controlled = bool(symbols(there) & set(self.derived.controls))
            for free in (False, True) if without and controlled and not self.free else (self.free,):
                besides = dict.fromkeys(self.derived.controls, ZERO) if free else {}
                alike = likeness(residual, substituted(there, besides) if besides else there, least)
                alike -= 0.0 if target.always or "stationarity" in target.address else _SOMEWHERE
                if alike > 0.0:
                    found.append(Fit(guess, target, free, alike))
        return found
