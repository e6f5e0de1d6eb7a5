"""Evaluation of propositions: their terms are computed and compared, relation by relation.

Truth has three values as in Kleene's logic: a relation between values that cannot be computed is undecided, and so is
whatever depends on it. An answer names what decides it: the relation that fails, the member that refutes, or the number
of members for which the proposition holds.
"""

from __future__ import annotations

import ast
import operator
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np

from satsym.auditing.program.library import BINARY
from satsym.auditing.propositions.reading import (
    CONNECTIVES,
    ITEMS,
    LOOKUPS,
    MEANINGS,
    PRINTED,
    QUANTIFIERS,
    Proposition,
    Words,
    row_key,
)
from satsym.auditing.propositions.relations import Fit, compared
from satsym.auditing.propositions.values import Family, Record, Undecided, alike, in_words, listed
from satsym.status import BadInput

Truth: TypeAlias = bool | None
"""True, false, or ``None`` for undecided."""
_OPERATORS = {**BINARY, ast.MatMult: operator.matmul}
_MAX_POWER = 64
_JUDGED = (*QUANTIFIERS, *CONNECTIVES)
_text = lru_cache(maxsize=4096)(ast.unparse)
_TOLD = 4
"""Number of members of a list up to which the computed values are reported for each member."""
Lookups: TypeAlias = Mapping[str, Callable[[str], Any]]
"""What a proposition may look up in its document: ``row``, ``text``, ``meanings``, ``items`` and ``symbol``."""
_BREAKS = (ArithmeticError, ValueError, TypeError, LookupError, AttributeError, np.linalg.LinAlgError)


@dataclass(frozen=True)
class Answer:
    """Whether a proposition is true, and the relations that decide it."""

    truth: Truth
    """Truth value of the proposition: true, false or undecided."""
    reasons: tuple[str, ...] = ()
    """The relations that decide the answer, with computed values."""
    evidence: Mapping[str, str] = field(default_factory=dict)
    """Term of the proposition -> computed value as text."""
    members: int = 0
    """Number of members of the largest family for which the proposition was evaluated."""
    idle: frozenset[str] = frozenset()
    """Conditions that no member satisfies, so that an implication with this condition states nothing."""
    miss: Fit | None = None
    """Kind of a failure that is only a wrong last digit or a wrong factor of a unit; otherwise ``None``."""

    @property
    def vacuous(self) -> bool:
        """Whether the proposition, or a part of it, holds only because nothing satisfies its condition."""
        return bool(self.idle)


class Evaluation:
    """Evaluator of propositions; `lookups` is the document, if any, and `own` the printed text of the row itself."""

    def __init__(self, words: Words, lookups: Lookups = MappingProxyType({}), own: Any = None) -> None:
        self._words, self._lookups, self._own = words, lookups, own

    def answer(self, proposition: Proposition) -> Answer:
        """Return whether a proposition is true."""
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return self._judge(proposition.tree, {})

    def term(self, proposition: Proposition, last: str = ", ") -> str:
        """Return the value of a term as text; "undecided" with the reason if it cannot be computed.

        The last of several texts, or of numbers collected from several objects, follows after a word such as "and".
        """
        collected = isinstance(proposition.tree, ast.ListComp)
        with np.errstate(all="ignore"):
            try:
                return listed(self._value(proposition.tree, {}), last, numbers=collected)
            except Undecided as reason:
                return f"undecided ({reason})"

    def _judge(self, node: ast.expr, bound: Mapping[str, Any]) -> Answer:
        if isinstance(node, ast.BoolOp):
            return _joined([self._judge(part, bound) for part in node.values], isinstance(node.op, ast.And))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return _denied(self._judge(node.operand, bound))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            name = node.func.id
            if name in QUANTIFIERS:
                try:
                    return self._quantified(node.args[0], bound, name == "all")
                except Undecided as reason:  # of what it is said
                    return Answer(None, (str(reason),))
            if name in CONNECTIVES:
                first = self._judge(node.args[0], bound)
                if name == "implies" and first.truth is False:  # what is implied need not have a value then
                    return replace(first, truth=True, idle=frozenset({_text(node.args[0])}), miss=None)
                second = self._judge(node.args[1], bound)
                return _implied(first, second) if name == "implies" else _equivalent(first, second)
        return self._leaf(node, bound)

    def _leaf(self, node: ast.expr, bound: Mapping[str, Any]) -> Answer:
        try:
            if isinstance(node, ast.Compare):
                return self._compared(node, bound)
            value = self._value(node, bound)
        except Undecided as reason:
            return Answer(None, (str(reason),))
        if value is None:
            return Answer(None, (f"{_text(node)} is undecided",))
        if not isinstance(value, bool | np.bool_):
            raise BadInput(f"{_text(node)} is {in_words(value)}, which is neither true nor false; write a relation")
        return Answer(bool(value), (f"{_text(node)} is {in_words(value)}",), {_text(node): in_words(value)})

    def _compared(self, node: ast.Compare, bound: Mapping[str, Any]) -> Answer:
        terms = [node.left, *node.comparators]
        values = [self._value(term, bound) for term in terms]
        evidence = {
            _text(t): in_words(v) for t, v in zip(terms, values, strict=True) if not isinstance(t, ast.Constant)
        }
        said = "; ".join(f"{term} = {value}" for term, value in evidence.items() if term != value)
        for sign, left, right in zip(node.ops, values, values[1:], strict=False):
            try:
                found = compared(sign, left, right)
            except _BREAKS as error:
                raise BadInput(
                    f"{_text(node)}: {in_words(left)} cannot be compared with {in_words(right)} ({error})"
                ) from None
            if not found.holds:
                miss = found.fit if found.fit in (Fit.NEAR, Fit.UNIT) and isinstance(sign, ast.Eq) else None
                return Answer(False, (said or f"not {_text(node)}",), evidence, miss=miss)
        return Answer(True, (said or _text(node),), evidence)

    def _quantified(self, node: ast.expr, bound: Mapping[str, Any], universal: bool) -> Answer:
        if not isinstance(node, ast.GeneratorExp):
            entries = self._value(node, bound)
            answers = [_plain(node, entry) for entry in entries]
            return _joined(answers, universal) if answers else Answer(universal, ("there is none",))
        answers, total, of = [], 0, "members"
        for member, inner, family in self._members(node.generators, bound):
            total += 1
            of = family.of if isinstance(family, Family) else "cases"
            found = self._judge(node.elt, inner)
            found = replace(found, reasons=tuple(f"{reason} ({member})" for reason in found.reasons))
            if found.truth is (not universal):
                return replace(found, members=max(total, found.members), idle=frozenset())
            answers.append(found)
        if any(answer.truth is None for answer in answers):
            open_ = next(answer for answer in answers if answer.truth is None)
            return Answer(None, open_.reasons, members=total)
        idle = frozenset.intersection(*(answer.idle for answer in answers)) if answers else frozenset({_text(node)})
        idle = idle if universal else frozenset()
        said = f"{'true' if universal else 'false'} for all of {total} {of}" if total else "there is none"
        if idle and total:
            said = f"none of {total} {of} satisfies the condition {' or '.join(sorted(idle))}"
        if not idle and 0 < total <= _TOLD:
            evidence = {k: v for answer in answers for k, v in answer.evidence.items()}
            reasons = dict.fromkeys(reason for answer in answers for reason in answer.reasons)
            return Answer(universal, tuple(reasons), evidence, total)
        return Answer(universal, (said,), {of: str(total)}, total, idle)

    def _members(
        self, parts: list[ast.comprehension], bound: Mapping[str, Any]
    ) -> Iterator[tuple[str, Mapping[str, Any], Any]]:
        """Yield each member of a family by name, with the bound names, and the family of the first quantifier."""
        part, *others = parts
        family = self._value(part.iter, bound)
        for member in _iterated(part, family):
            inner = {**bound, **_unpacked(part.target, member)}
            conditions = [self._judge(condition, inner) for condition in part.ifs]
            if any(condition.truth is False for condition in conditions):
                continue
            open_ = next((condition for condition in conditions if condition.truth is None), None)
            if open_ is not None:
                raise Undecided("; ".join(open_.reasons))
            name = member.name if isinstance(member, Record) else in_words(member)
            if not others:
                yield name, inner, family
                continue
            for further, whole, _ in self._members(others, inner):
                yield f"{name}, {further}", whole, family

    def _value(self, node: ast.expr, bound: Mapping[str, Any]) -> Any:
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            return self._named(node.id, bound)
        if isinstance(node, ast.List | ast.Tuple):
            return [self._value(entry, bound) for entry in node.elts]
        if isinstance(node, ast.ListComp | ast.GeneratorExp):
            return [self._value(node.elt, inner) for _, inner, _ in self._members(node.generators, bound)]
        if isinstance(node, ast.Attribute):
            return self._part(node, bound)
        if isinstance(node, ast.Subscript):
            return self._entry(node, bound)
        if isinstance(node, ast.Call) and _text(node.func) not in _JUDGED:
            return self._called(node, bound)
        if isinstance(node, ast.BinOp):
            return self._worked_out(node, bound)
        if isinstance(node, ast.UnaryOp) and not isinstance(node.op, ast.Not):
            value = self._value(node.operand, bound)
            return -value if isinstance(node.op, ast.USub) else value
        found = self._judge(node, bound)
        if found.truth is None:
            raise Undecided("; ".join(found.reasons))
        return found.truth

    def _named(self, name: str, bound: Mapping[str, Any]) -> Any:
        if name in bound:
            return bound[name]
        if name == PRINTED:
            return self._own
        if name in self._words.values:
            return self._words.values[name]()
        return self._lookups[ITEMS if name == ITEMS else "symbol"](name)

    def _part(self, node: ast.Attribute, bound: Mapping[str, Any]) -> Any:
        whole = self._value(node.value, bound)
        if not isinstance(whole, Record):
            raise BadInput(f"{_text(node.value)} is {in_words(whole)}, which has no attributes")
        return whole.part(node.attr)

    def _entry(self, node: ast.Subscript, bound: Mapping[str, Any]) -> Any:
        if isinstance(node.value, ast.Name) and node.value.id in (*LOOKUPS, MEANINGS):
            return self._lookups[node.value.id](row_key(node))
        whole, index = self._value(node.value, bound), self._value(node.slice, bound)
        try:
            return (
                whole.part(str(index))
                if isinstance(whole, Record)
                else whole[tuple(index) if isinstance(index, list) else index]
            )
        except _BREAKS:
            raise BadInput(f"{_text(node)}: {in_words(whole)} has no such entry") from None

    def _called(self, node: ast.Call, bound: Mapping[str, Any]) -> Any:
        arguments = [self._value(argument, bound) for argument in node.args]
        named = {str(keyword.arg): self._value(keyword.value, bound) for keyword in node.keywords}
        try:
            return self._words.functions[_text(node.func)](*arguments, **named)
        except (BadInput, Undecided):
            raise
        except _BREAKS as error:
            raise BadInput(f"{_text(node)} has no value: {error}") from None

    def _worked_out(self, node: ast.BinOp, bound: Mapping[str, Any]) -> Any:
        left, right = alike(self._value(node.left, bound), self._value(node.right, bound))
        if isinstance(node.op, ast.Pow) and not (isinstance(right, int | float) and abs(right) <= _MAX_POWER):
            raise BadInput(f"{_text(node)}: exponents must be numbers of magnitude at most {_MAX_POWER}")
        try:
            if isinstance(node.op, ast.Pow) and isinstance(left, np.ndarray) and left.ndim > 1:
                return np.linalg.matrix_power(left, right)
            return _OPERATORS[type(node.op)](left, right)
        except _BREAKS as error:
            raise BadInput(f"{_text(node)} has no value: {error}") from None


def _plain(node: ast.expr, entry: Any) -> Answer:
    if not isinstance(entry, bool | np.bool_):
        raise BadInput(f"{_text(node)} contains {in_words(entry)}, which is neither true nor false")
    return Answer(bool(entry), (f"{_text(node)}: {in_words(entry)}",))


def _iterated(part: ast.comprehension, family: Any) -> Iterable[Any]:
    try:
        if not isinstance(family, str | Record):
            return list(family)
    except TypeError:
        pass
    raise BadInput(f"{_text(part.iter)} is {in_words(family)}, but must be a family or a list")


def _unpacked(target: ast.expr, member: Any) -> dict[str, Any]:
    if isinstance(target, ast.Name):
        return {target.id: member}
    assert isinstance(target, ast.Tuple)
    names = [part.id for part in target.elts if isinstance(part, ast.Name)]
    try:
        return dict(zip(names, member, strict=True))
    except (TypeError, ValueError):
        raise BadInput(
            f"each member of the family must consist of {len(names)} values, but one is {in_words(member)}"
        ) from None


def _joined(answers: list[Answer], conjunction: bool) -> Answer:
    """Return the answer for "and" or "or" of several propositions.

    An "and" is vacuous if one of its parts is; an "or" only if all true parts are.
    """
    deciding = [answer for answer in answers if answer.truth is (not conjunction)]
    if deciding:
        first = min(deciding, key=lambda answer: answer.vacuous)
        return replace(first, miss=first.miss if all(answer.miss is first.miss for answer in deciding) else None)
    undecided = [answer for answer in answers if answer.truth is None]
    if undecided:
        return undecided[0]
    together = {k: v for answer in answers for k, v in answer.evidence.items()}
    reasons = tuple(dict.fromkeys(reason for answer in answers for reason in answer.reasons))
    members = max(answer.members for answer in answers)
    idle = frozenset().union(*(answer.idle for answer in answers)) if conjunction else frozenset()
    return Answer(conjunction, reasons, together, members, idle)


def _denied(answer: Answer) -> Answer:
    return replace(answer, truth=None if answer.truth is None else not answer.truth, idle=frozenset(), miss=None)


def _implied(first: Answer, second: Answer) -> Answer:
    if first.truth is None and second.truth is not True:
        return replace(first, truth=None)
    if second.truth is False:
        both = {**first.evidence, **second.evidence}
        return replace(second, reasons=(*first.reasons, *second.reasons), evidence=both)
    return second


def _equivalent(first: Answer, second: Answer) -> Answer:
    if first.truth is None or second.truth is None:
        return first if first.truth is None else second
    both = {**first.evidence, **second.evidence}
    reasons = tuple(dict.fromkeys((*first.reasons, *second.reasons)))
    return Answer(first.truth is second.truth, reasons, both, max(first.members, second.members))
