"""Draft of a ledger from a document, to be confirmed by a person: one row for each equation.

A row states what is printed and the derived quantity that it is compared with. A drafted row contains ``draft = true``,
a line that is removed to confirm the row. When the document is read again, only drafted rows are replaced.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from satsym.auditing.check import remedies
from satsym.auditing.check.answer import Subject
from satsym.auditing.check.answers import Answer
from satsym.auditing.check.derived import Derived, vanishes
from satsym.auditing.check.meanings import Guess, Meanings, given_letters
from satsym.auditing.document import displays
from satsym.auditing.document.displays import Display, Source
from satsym.auditing.latex.cursor import CONSTANT, Reading
from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.letters import Letter, of_word
from satsym.auditing.latex.tokens import Token, Unread, tokens
from satsym.formula import reading as safe
from satsym.formula.calculus import derivative, difference
from satsym.formula.tree import Call, Equality, Grid, Neg, Node, Sym, Text, each, substituted, symbols
from satsym.formula.writing import written
from satsym.records import record, shelf
from satsym.status import BadInput

SUFFIX = ".ledger.toml"
_UNSEEN = re.compile(r"\\(?:label|tag)\*?\s*\{[^{}]*\}|(?<!\\)&|\\(?:nonumber|notag)\b")
"""Pattern of the parts of a display that are not visible on the page."""
_BLOCK = re.compile(r"^\[\[row\]\]\s*$", re.MULTILINE)


@dataclass
class Draft:
    """Result of reading a document: the text of the ledger, its rows, and the parts that could not be read."""

    text: str
    rows: list[dict[str, Any]]
    kept: int
    unread: list[tuple[str, str]]
    undecided: list[tuple[str, str]]


@dataclass
class _Entry:
    """An equation of a display, with its interpretation."""

    display: Display
    statement: Node | Equality
    subject: Subject
    part: str
    answer: Answer
    table: dict[str, Any] = field(default_factory=dict)
    letters: dict[str, str] = field(default_factory=dict)

    @property
    def meanings(self) -> dict[str, Node]:
        """Meanings of the letters in the names of the model."""
        return {name: safe.expression(text, judging=True) for name, text in self.letters.items()}


def draft(path: Path, model: str, before: str = "", let: Sequence[str] = ()) -> Draft:
    """Draft a ledger from a document.

    Parameters
    ----------
    path
        The document.
    model
        ``"NAME"``, or ``"DIR/NAME"`` relative to the document; if empty, the model of the existing ledger is used.
    before
        The text of the existing ledger, whose confirmed rows and notation are kept.
    let
        Meanings of letters, such as ``"n=omega"``.

    Raises
    ------
    BadInput
        If the document cannot be read, or the model does not exist.
    """
    old = _parsed(before)
    model = model or str(old.get("document", {}).get("model", ""))
    if not model:
        raise BadInput(
            f"{path}: the model to which the document refers is unknown; give --model NAME or --model DIR/NAME"
        )
    source = displays.read(path)
    place, name = shelf.place_of(model, path.parent)
    with shelf.opened(place):
        derived = Derived(shelf.find(name))
        meanings = Meanings(derived)
        given = {**_scope_letters(old, derived), **given_letters(let, derived)}
        readings = list(_readings(source, meanings.spelled(given)))
        given = {**_voted(readings, derived, meanings, given), **given}
        entries = list(_entries(readings, derived, meanings, given, source))
        _propose_origins(entries, derived)
    return _written(path, model, before, old, entries, source)


def as_object(ledger: Path, found: Draft) -> dict[str, Any]:
    """Return the JSON object of a draft."""
    lists = {"unread": found.unread, "undecided": found.undecided}
    told = {name: [{"place": place, "reason": why} for place, why in entries] for name, entries in lists.items()}
    return {"ledger": str(ledger), "rows": found.rows, "kept": found.kept, **told}


def _readings(source: Source, names: Collection[str]) -> Iterator[tuple[Display, Reading]]:
    for display in displays.displays(source):
        try:
            found = tokens(display.text, source.macros, display.start)
            if display.columns:
                begin, end = (Token(kind, display.columns, display.start) for kind in ("begin", "end"))
                found = [begin, *found, end]
            yield display, read(found, display.text, display.start, names=names)
        except Unread as error:
            source.unread.append((source.place(min(error.at, len(source.text) - 1)), error.message))


def _voted(
    readings: Sequence[tuple[Display, Reading]], derived: Derived, meanings: Meanings, given: Mapping[Letter, str]
) -> dict[Letter, str]:
    """Return the meanings of letters unknown to the model, by a vote of the equations, weighted by verdict."""
    votes: dict[Letter, Counter[str]] = {}
    for _, reading in readings:
        if not meanings.unknown(list(reading.letters.values()), given):
            continue
        subject = Subject(derived, meanings, reading, given, False, True)
        for statement in reading.statements:
            answer = subject.answer(statement)
            fit = answer.fit
            weight = {"right": 5, "wrong": 1, "undecided": 0}[answer.verdict]
            for letter, name in fit.guess.meaning.items() if fit else ():
                votes.setdefault(letter, Counter())[name] += weight
    return {letter: counted.most_common(1)[0][0] for letter, counted in votes.items() if counted.total()}


def _entries(
    readings: Sequence[tuple[Display, Reading]],
    derived: Derived,
    meanings: Meanings,
    given: Mapping[Letter, str],
    source: Source,
) -> Iterator[_Entry]:
    for display, reading in readings:
        subject = Subject(derived, meanings, reading, given, False, True)
        for k, statement in enumerate(reading.statements):
            part = chr(ord("a") + k) if len(reading.statements) > 1 and k < 26 else ""
            entry = _Entry(display, statement, subject, part, subject.answer(statement))
            try:
                _fill(entry)
            except BadInput as error:
                entry.answer, entry.table = subject.answered(statement, "undecided", str(error)), {}
            yield entry


def _fill(entry: _Entry) -> None:
    """Fill in the keys of the row, and the meanings of letters that its notation needs."""
    display, subject, fit = entry.display, entry.subject, entry.answer.fit
    entry.table = {"item": display.item, **({"part": entry.part} if entry.part else {})}
    entry.table |= {"kind": "equation", "where": ", ".join(filter(None, (display.section, display.place)))}
    if isinstance(entry.statement, Grid) or entry.answer.diagnosis.startswith("entry"):
        _fill_matrix(entry)
        return
    named, derivatives = remedies.with_names(entry.statement, subject)
    follows = fit is not None and entry.answer.verdict == "right" and isinstance(named, Equality)
    if fit is None or not (entry.answer.address or follows) or entry.answer.verdict == "undecided":
        entry.table |= {"original": display.text.strip(), "printed": written(named)}
        return
    names = {name: _called(tree, k) for k, (name, tree) in enumerate(derivatives.items(), start=1)}
    meant = subject.meant(named, derivatives, fit.guess)
    if isinstance(named, Equality) and named.rhs == Sym(CONSTANT):
        raise BadInput("the statement that a quantity is constant is a claim; write it as a claim")
    rate_of = subject.derived.kinematic.get(entry.answer.address)
    for name, tree in meant.items():
        letter = subject.reading.letters.get(name)
        if name in derivatives:
            text = _derivative(derivatives[name], subject) or written(tree)
        elif rate_of and letter and letter.dots == 1 and isinstance(tree, Sym):
            text = f"d_{rate_of}"  # else the row would say nothing
        else:
            text = _of_output(letter, fit.guess, subject) or written(tree)
        entry.letters[names.get(name, name)] = text
    renamed: dict[str, Node] = {name: Sym(new) for name, new in names.items()}
    shown = each(named, lambda side: substituted(side, renamed))
    entry.table["printed"] = written(shown)
    safe.statement(entry.table["printed"])  # what the ledger could not read is told now
    controls = ", ".join(f"{name}=0" for name in subject.derived.controls)
    address = entry.answer.address
    if follows and not address and isinstance(shown, Equality):
        # it holds without being one of the equations: the right-hand side is held against what the left-hand side is
        entry.table["printed"] = written(shown.rhs)
        address = written(substituted(shown.lhs, entry.meanings))
    entry.table["holds"] = f"subs('{address}', {controls})" if fit.free else address


def _fill_matrix(entry: _Entry) -> None:
    side = entry.statement.rhs if isinstance(entry.statement, Equality) else entry.statement
    rows = side.entries if isinstance(side, Grid) else ()
    if not rows or not entry.answer.address or entry.answer.fit is None:
        raise BadInput(entry.answer.diagnosis or "no matrix of the model resembles it")
    lines = [[written(cell) for cell in row.entries] if isinstance(row, Grid) else [written(row)] for row in rows]
    entry.table |= {"kind": "matrix", "printed": lines, "holds": entry.answer.address}
    for name, tree in entry.subject.meant(side, {}, entry.answer.fit.guess).items():
        entry.letters[name] = written(tree)


def _derivative(tree: Node, subject: Subject) -> str:
    """Return a partial derivative of a quantity that has an address, in the form used in ledgers; otherwise empty."""
    if not isinstance(tree, Call) or tree.function != "diff" or not all(isinstance(a, Sym) for a in tree.arguments):
        return ""
    readings, meaning = subject.reading.letters, subject.given
    letters = [readings[part.name] for part in tree.arguments if isinstance(part, Sym) and part.name in readings]
    of, by = [subject.meanings.tree(letter, meaning) for letter in letters] if len(letters) == 2 else (None, None)
    target = next((t for t in subject.derived.targets if t.equation.lhs == of), None)
    return f"diff(at('{target.address}'), {by.name})" if target and isinstance(by, Sym) else ""


def _of_output(letter: Letter | None, guess: Guess, subject: Subject) -> str:
    """Return an output, or the unnamed rate of a state, in the form used in ledgers; otherwise empty."""
    derived = subject.derived
    name = (guess.meaning.get(letter.still) or subject.meanings.named(letter.still) or "") if letter else ""
    address, times = f"{derived.record.name}:{record.DECLARED}.{name}", letter.dots if letter else 0
    if name in derived.states and times > 1 and name not in derived.speeds:
        address, times = f"{derived.record.name}:first_order.{name}", times - 1
    elif name not in record.variables(derived.record, "output"):
        return ""
    if times > 1:
        raise BadInput(
            "the second derivative of an output is not supported; write by hand what to compare the formula with"
        )
    return f"{'d(' * times}at('{address}'){')' * times}"


def _called(tree: Node, k: int) -> str:
    """Return the name of a derivative that is one letter in the row, such as dH_dr."""
    parts = [tree]
    while isinstance(parts[-1], Call):
        parts.append(parts[-1].arguments[0])
    of = parts[-1].name if isinstance(parts[-1], Sym) else ""
    by = tree.arguments[1] if isinstance(tree, Call) and tree.function == "diff" else None
    name = f"d{of}_d{by.name}" if of and isinstance(by, Sym) else f"derivative{k}"
    return name if safe.NAME.match(name) else f"derivative{k}"


def _propose_origins(entries: Sequence[_Entry], derived: Derived) -> None:
    """Propose how each row follows from an equation that the text just before it refers to.

    A proposal is made only if the row equals the other equation or is a derivative of it.
    """
    by_label = {entry.display.label: entry for entry in entries if entry.display.label and entry.table.get("holds")}
    for entry in entries:
        if not entry.table.get("holds") or entry.table["kind"] != "equation":
            continue
        for label in entry.display.refers:
            other = by_label.get(label)
            if other is None or other is entry:
                continue
            found = _origin(entry, other, derived)
            if found:
                entry.table["from"] = found
                break


def _origin(entry: _Entry, other: _Entry, derived: Derived) -> str:
    mine, theirs = _ours(entry), _ours(other)
    if not isinstance(mine, Equality) or not isinstance(theirs, Equality):
        return ""
    row: Node = Call("row", tuple(map(Text, filter(None, (other.display.item, other.part)))))
    letters = {name: tree.name for name, tree in entry.meanings.items() if isinstance(tree, Sym)}
    tries: list[tuple[Node, Node]] = [(row, theirs.rhs)]
    for name, ours in letters.items():
        if ours in symbols(theirs.rhs):
            try:
                slope = derivative(theirs.rhs, ours)
            except BadInput:
                continue
            tries += [(Call("diff", (row, Sym(name))), slope), (Neg(Call("diff", (row, Sym(name)))), Neg(slope))]
    for tree, value in tries:
        if vanishes(difference(mine.rhs, value), derived):
            return written(tree)
    return ""


def _ours(entry: _Entry) -> Node | Equality | None:
    try:
        tree = safe.statement(str(entry.table["printed"]))
        values = entry.meanings
    except BadInput:
        return None
    return each(tree, lambda side: substituted(side, values))


def _parsed(before: str) -> dict[str, Any]:
    try:
        return tomllib.loads(before)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise BadInput(f"the existing ledger cannot be read ({error}); correct it, or give another --out") from None


def _scope_letters(old: Mapping[str, Any], derived: Derived) -> dict[Letter, str]:
    """Return the meanings of letters that the notation of the existing ledger states."""
    scope = old.get("scope", {}).get("main", {})
    found = {}
    for name, meaning in scope.items() if isinstance(scope, dict) else ():
        if isinstance(meaning, str) and meaning in derived.record.names and not (letter := of_word(name)).dots:
            found[letter] = meaning
    return found


def _written(
    path: Path, model: str, before: str, old: Mapping[str, Any], entries: Sequence[_Entry], source: Source
) -> Draft:
    confirmed = {
        (str(row.get("item")), str(row.get("part", ""))): block
        for row, block in _blocks(before)
        if not row.get("draft")
    }
    letters: dict[str, str] = {}
    rates: dict[str, str] = {}
    blocks, rows, undecided, used = [], [], [], set()
    for entry in entries:
        key = entry.display.item, entry.part
        if key in confirmed:
            blocks.append(confirmed[key])
            used.add(key)
            continue
        for name, meaning in entry.letters.items():
            if letters.setdefault(name, meaning) != meaning:
                rates[name] = meaning
                entry.table["scope"] = "rates"
        blocks.append(_block(entry))
        rows.append({**entry.table, "verdict": entry.answer.verdict})
        if not entry.table.get("holds"):
            undecided.append((entry.display.place, entry.answer.diagnosis or "it says nothing about the model"))
    blocks += [block for key, block in confirmed.items() if key not in used]
    head = _head(path, model, before, old, letters) + _other_scope(rates, old)
    return Draft("\n".join([head, *blocks]), rows, len(confirmed), source.unread, undecided)


def _blocks(before: str) -> Iterator[tuple[dict[str, Any], str]]:
    starts = [match.start() for match in _BLOCK.finditer(before)]
    for start, end in pairwise([*starts, len(before)]):
        block = before[start:end].rstrip() + "\n"
        kept = "\n".join(line for line in block.splitlines() if not line.startswith("#")).rstrip() + "\n"
        yield tomllib.loads(block)["row"][0], kept


def _head(path: Path, model: str, before: str, old: Mapping[str, Any], letters: Mapping[str, str]) -> str:
    if before and (start := _BLOCK.search(before)):
        head = before[: start.start()].rstrip("\n") + "\n"
        known = old.get("scope", {}).get("main", {})
        new = "".join(f"{name} = {_toml(meaning)}\n" for name, meaning in letters.items() if name not in known)
        return re.sub(r"^\[scope\.main\].*\n", lambda m: f"{m[0]}{new}", head, count=1, flags=re.MULTILINE)
    key = re.sub(r"[^A-Za-z0-9]+", "_", path.stem).strip("_") or "document"
    key = key if key[0].isalpha() else f"document_{key}"
    lines = [
        f"# What {path.name} prints, drafted by satsym read; this file contains no verdicts.",
        "# To confirm a row, delete its line `draft = true`; confirmed rows are kept if the document is read again.",
        "format = 1\n\n[document]",
        f"key = {_toml(key[:40])}",
        f"title = {_toml(path.stem)}",
        f"model = {_toml(model)}\n\n[scope.main]",
    ]
    lines += [f"{name} = {_toml(meaning)}" for name, meaning in letters.items()]
    return "\n".join(lines) + "\n"


def _other_scope(letters: Mapping[str, str], old: Mapping[str, Any]) -> str:
    """Return the notation of the rows in which a letter has another meaning than in most rows."""
    known = old.get("scope", {}).get("rates", {})
    lines = [f"{name} = {_toml(meaning)}" for name, meaning in letters.items() if name not in known]
    return "\n".join(["\n[scope.rates]", 'extends = "main"', *lines]) + "\n" if lines and not known else ""


def _block(entry: _Entry) -> str:
    """Return the text of a row; a row that is not understood becomes a comment, to be completed by hand."""
    shown = " ".join(_UNSEEN.sub(" ", entry.display.text).split())[:300]
    lines = [f"{key} = {_toml(value)}" for key, value in entry.table.items() if key != "original"]
    capitals = [one for one in entry.subject.reading.products if one in entry.answer.letters]
    doubts = [f"# {one} was read as a product; --let {one}=NAME makes it a single name" for one in capitals]
    if entry.table.get("holds"):
        return "\n".join(["[[row]]", "draft = true", *doubts, *lines, f"original = {_toml(shown)}"]) + "\n"
    why = entry.answer.diagnosis or "it says nothing about the model"
    told = [f"# {shown}", f"# not understood: {why}; complete it", *doubts, *(f"# {line}" for line in lines)]
    return "\n".join(told) + "\n"


def _toml(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)
