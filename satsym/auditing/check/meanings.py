"""Meanings of printed letters in a model: by the model's own notation, by the user's statement, or by a guess.

A guess is reported and can be corrected by the user. A wrong guess therefore gives a verdict on an equation that was
misread, but no false statement about the model.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, product

from satsym.auditing.check.derived import Derived
from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.letters import GREEK, Letter, of_word
from satsym.auditing.latex.tokens import Unread, tokens
from satsym.formula.tree import Node, Sym
from satsym.status import BadInput
from satsym.wording import shown, suggestion

MOST_GUESSES = 60
"""Number of interpretations of the letters of one formula that are tried."""
_NAMES_EACH = 6
_PLACES = ("x", "y", "z")
_COSTATES = frozenset(("lambda", "p", "psi", "Lambda", "mu"))
_RATES = ("n", "omega", "Omega", "w", "nu")
_LENGTHS = ("R", "a", "r", "rho", "sigma", "l", "h", "d", "L")
_VARIANTS = {"varphi": "phi", "varepsilon": "epsilon", "vartheta": "theta", "varrho": "rho", "varsigma": "sigma"}
_OPTIMAL = ("star", "opt", "hat", "ast")


@dataclass(frozen=True)
class Guess:
    """An interpretation of letters: printed letter without dots -> name in the model.

    `oddity` measures how unnatural the interpretation is; zero is the most natural.
    """

    meaning: Mapping[Letter, str]
    oddity: int


@dataclass(frozen=True, eq=False)
class Meanings:
    """Meanings of printed letters in one model."""

    derived: Derived

    @cached_property
    def known(self) -> Mapping[Letter, str]:
        """Letters of the model's own notation -> names in the model."""
        found: dict[Letter, str] = {}
        for name, entry in self.derived.record.names.items():
            if letter := _letter(entry.latex):
                found.setdefault(letter, name)
        for name in self.derived.definitions:
            if name in ("L", "S"):
                found.setdefault(Letter(name), name)
        return found

    @cached_property
    def letters(self) -> Mapping[str, Letter]:
        """Names in the model -> letters of the model's own notation."""
        return {name: letter for letter, name in reversed(list(self.known.items()))}

    def spelled(self, given: Mapping[Letter, str]) -> frozenset[str]:
        """Return the known names of several Latin letters, which are read as one symbol even if printed in italics."""
        words = {letter.base for letter in (*self.known, *given)}
        return frozenset(word for word in words - GREEK if len(word) > 1 and word.isalpha())

    def named(self, letter: Letter) -> str | None:
        """Return the name in the model of a letter with its dots, if notation or spelling decide; else ``None``."""
        for wanted in (letter, _alike(letter), replace(_alike(letter), style="")):
            if (name := self.known.get(wanted)) is not None:
                return name
        names = self.derived.record.names
        for name in (letter.name, f"d_{letter.still.name}" if letter.dots == 1 else ""):
            if name in names and of_word(name) == letter:
                return name
        return None

    def tree(self, letter: Letter, meaning: Mapping[Letter, str]) -> Node | None:
        """Return the formula of a letter, including its dots (time derivatives).

        Return ``None`` if the meaning is not known.
        """
        still = letter.still
        if letter.dots and (name := self.named(letter)) is not None and still not in meaning:
            return self._one(name)
        if letter in meaning:
            return self._one(meaning[letter])
        name = meaning.get(still) or self.named(still) or ""
        if not name:
            return None
        try:
            return self.derived.rate(name, letter.dots) if letter.dots else self._one(name)
        except BadInput:
            return None

    def _one(self, name: str) -> Node:
        return self.derived._one_name.get(name, Sym(name))

    def unknown(self, letters: Sequence[Letter], given: Mapping[Letter, str]) -> list[Letter]:
        """Return the letters, without dots, that are explained neither by the notation nor by the user."""
        found: dict[Letter, None] = {}
        for letter in letters:
            if letter.still not in given and (self.tree(letter, given) is None or self._is_other(letter)):
                found[letter.still] = None
        return list(found)

    def _is_other(self, letter: Letter) -> bool:
        """Return whether a letter is a state of the original model; it may then be meant for a letter of this model."""
        return self.named(letter.still) in self.derived.others

    def guesses(self, letters: Sequence[Letter], given: Mapping[Letter, str]) -> Iterator[Guess]:
        """Yield interpretations of the unknown letters, the most natural first."""
        unknown = self.unknown(letters, given)
        used = {name for letter in letters if (name := given.get(letter.still) or self.named(letter.still))}
        used -= self.derived.others
        each = [self._candidates(letter, letters, used)[:_NAMES_EACH] or self._new(letter) for letter in unknown]
        if not all(each):
            return
        ways = islice(product(*(list(enumerate(names)) for names in each)), 20 * MOST_GUESSES)
        found = []
        for way in ways:
            names = [name for _, name in way]
            if len(set(names)) == len(names):
                meaning = dict(zip(unknown, names, strict=True))
                found.append(Guess({**given, **meaning}, sum(rank for rank, _ in way)))
        yield from sorted(found, key=lambda guess: guess.oddity)[:MOST_GUESSES]

    def _new(self, letter: Letter) -> list[str]:
        """Return the letter itself as a new name, or an empty list if the model uses this name for something else."""
        return [] if letter.name in self.derived.record.names else [letter.name]

    def alternatives(self, letters: Sequence[Letter], given: Mapping[Letter, str]) -> Iterator[Guess]:
        """Yield interpretations of a control with a star or hat: its law without active bounds, or itself."""
        for letter in letters:
            marked = [mark for mark in letter.marks if mark in _OPTIMAL]
            bare = replace(letter.still, marks=tuple(m for m in letter.marks if m not in _OPTIMAL))
            name = given.get(bare) or self.named(bare)
            if letter.still in given or not name or name not in self.derived.controls:
                continue
            for rank, other in enumerate((f"{name}_star", f"{name}_hat", name) if marked else ()):
                if other in self.derived.record.names and other != self.named(letter):
                    yield Guess({**given, letter.still: other}, rank)

    def _candidates(self, letter: Letter, letters: Sequence[Letter], used: set[str]) -> list[str]:
        """Return names in the model that a letter may mean, the most likely first."""
        derived, names = self.derived, self.derived.record.names
        moving = any(one.still == letter and one.dots for one in letters)
        at = _place(letter)
        places = [x for x in derived.states if x in derived.speeds] or list(derived.states)
        likely: list[str] = []
        if letter.marks and (bare := self.named(replace(letter, marks=()))) is not None:
            likely += [bare]
        if letter.style and (bare := self.named(replace(letter, style=""))) is not None:
            likely += [bare]
        if letter.base in _COSTATES and letter.index:
            likely += self._of_costates(letter, at)
        if letter.before and (varied := self.named(replace(letter, before=""))):
            likely.append(varied)
        if letter.base in _PLACES and not letter.index:
            likely += places[_PLACES.index(letter.base) :][:1]
        if at is not None and letter.base in ("x", "q", "z", "y", "s"):
            likely += derived.states[at : at + 1]
        if letter.base in ("u", "a", "f", "T", "F", "U", "w", "gamma") and not moving:
            likely += derived.controls[at : at + 1] if at is not None else derived.controls
        if letter.base == "v" and not moving:
            speeds = [speed for x, speed in derived.speeds.items() if x in derived.states]
            likely += speeds[at : at + 1] if at is not None else speeds
        constants = [n for n, entry in names.items() if entry.kind in ("parameter", "constant") and n not in used]
        if letter.base in _RATES:
            likely += [n for n in constants if (names[n].dimension or {}) == {"[time]": "-1"}]
        if letter.base in _LENGTHS:
            likely += [n for n in constants if (names[n].dimension or {}) == {"[length]": "1"}]
        if (own := self.named(letter)) is not None:
            likely.append(own)
        if moving:
            likely += [x for x in (*places, *derived.states) if x not in used]
        elif letter.base not in _PLACES:
            likely += constants
        found = [n for n in dict.fromkeys(likely) if n in names]
        same = [n for n in found if n[:1].lower() == letter.base[:1].lower()]
        return list(dict.fromkeys([*found[:1], *same, *found[1:]])) if same and not likely[:1] else found

    def _of_costates(self, letter: Letter, at: int | None) -> list[str]:
        derived = self.derived
        if at is not None:
            return list(derived.costates[at : at + 1])
        state = self.named(of_word(letter.index)) or letter.index
        found = [name for name in derived.costates if name == f"lambda_{state}"]
        if not found and letter.index in _PLACES:
            found = list(derived.costates[_PLACES.index(letter.index) :][:1])
        if not found and (speed := re.fullmatch(r"v_?([xyz])|v", letter.index)):
            speeds = [f"lambda_{v}" for v in derived.speeds.values()]
            k = _PLACES.index(speed[1]) if speed[1] else 0
            found = [name for name in speeds[k : k + 1] if name in derived.costates]
        return found


def given_letters(texts: Sequence[str], derived: Derived) -> dict[Letter, str]:
    """Return the meanings of letters that the user states as ``n=omega``, with a name of the model on the right.

    Raises
    ------
    BadInput
        If a text has another form, or the model does not have the name.
    """
    found: dict[Letter, str] = {}
    for text in (part for listed in texts for part in listed.split(",")):
        printed, equals, name = (part.strip() for part in text.partition("="))
        if not equals or not printed or not name:
            raise BadInput(
                f"--let {shown(text)}: write a printed symbol, an equals sign and a name of the model, such as n=omega"
            )
        names = {*derived.record.names, *derived.definitions}
        if name not in names:
            message = f"{shown(name)} is not a name of {derived.record.name}; {suggestion(name, names)}"
            raise BadInput(f"--let {shown(text)}: {message}")
        found[_letter(printed) or of_word(printed)] = name
    return found


def _letter(latex: str) -> Letter | None:
    """Return the letter that some LaTeX consists of; ``None`` if it is not a single letter."""
    try:
        reading = read(tokens(latex), latex)
    except Unread:
        return None
    tree = reading.statements[0]
    return reading.letters.get(tree.name) if isinstance(tree, Sym) and len(reading.statements) == 1 else None


def _alike(letter: Letter) -> Letter:
    return replace(letter, base=_VARIANTS.get(letter.base, letter.base))


def _place(letter: Letter) -> int | None:
    """Return the position, from zero, that the index of a letter (a number, x, y or z) refers to, else ``None``."""
    if letter.index.isdigit() and 0 < int(letter.index) < 30:
        return int(letter.index) - 1
    return _PLACES.index(letter.index) if letter.index in _PLACES else None
