"""Claims changed by machine: denied, and with one leaf replaced as a slip of the author would."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from satsym import auditing
from satsym.auditing import Ledger, measurements
from satsym.auditing.comparison.bench import Bench
from satsym.auditing.judge.claim import Pages
from satsym.auditing.ledger.contents import Row
from satsym.auditing.propositions.evaluation import Answer
from satsym.auditing.propositions.reading import proposition
from satsym.instance.files import SHIPPED
from satsym.kernels import shipped
from satsym.status import BadInput

_OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt,
    ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
# put in place of others: always the same, whatever is shipped some day
_MODELS = ("clohessy_wiltshire", "double_integrator_energy", "polar_orbit", "roll_yaw_manoeuvre")
_INSTANCES = ("double-integrator-energy", "soft-return")
DOCUMENTS = tuple(path.name for path in auditing.shipped())


@dataclass(frozen=True)
class Changed:
    """A proposition with one leaf changed.

    Attributes
    ----------
    kind
        What was changed.
    text
        What it says now.
    others
        What it says with other replacements of the same leaf. A claim that no model but one makes false depends on the
        model, although most replacements leave it true.
    """

    kind: str
    text: str
    others: tuple[str, ...] = ()


@cache
def bench(document: str) -> Bench:
    """What a shipped ledger is judged with."""
    return Bench(auditing.read(auditing.locate(document)))


def claims(document: str) -> list[Row]:
    """The rows of a document that print propositions."""
    ledger: Ledger = bench(document).ledger
    return [row for row in ledger.rows if row.claims is not None and row.table.kind == "claim"]


def judged(document: str, row: Row, text: str) -> Answer:
    """Whether a proposition is true in the place of a row."""
    ready = bench(document)
    words = measurements.words(ready.scope(row).meanings)
    return Pages(ready, row).answer(proposition(text, words, own=row.table.kind != "claim"))


def changes(text: str) -> Iterator[Changed]:
    """All propositions with one leaf changed; a model is changed wherever the proposition names it, as one slip."""
    tree = ast.parse(" ".join(text.split()), mode="eval")
    nodes = list(ast.walk(tree))
    texts = dict.fromkeys(node.value for node in nodes if isinstance(node, ast.Constant))
    for model in (text for text in texts if text in shipped()):
        first, *rest = (ast.unparse(_renamed(tree, model, other)) for other in _MODELS if other != model)
        yield Changed("model", first, tuple(rest))
    keys = {id(part) for node in nodes if isinstance(node, ast.Subscript) for part in ast.walk(node.slice)}
    for place, node in enumerate(nodes):
        if id(node) in keys:
            continue  # the name of a row
        for kind, replace in _changes_of(node):
            other = copy.deepcopy(tree)
            replace(list(ast.walk(other))[place])
            if ast.dump(other) != ast.dump(tree):
                yield Changed(kind, ast.unparse(other))


def _changes_of(node: ast.AST) -> Iterator[tuple[str, Any]]:
    if isinstance(node, ast.Compare):
        for i, sign in enumerate(node.ops):
            yield "relation", lambda n, i=i, s=sign: n.ops.__setitem__(i, _OPPOSITE[type(s)]())
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        if node.func.id in ("all", "any"):
            other = "any" if node.func.id == "all" else "all"
            yield f"{other} for {node.func.id}", lambda n: setattr(n.func, "id", other)
        if node.func.id == "implies":
            yield "direction", lambda n: n.args.reverse()
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        if node.value in _instances():
            yield "instance", lambda n: setattr(n, "value", _another(n.value, _INSTANCES))
        if node.value[:1].isdigit() or node.value[:2] in ("0.", "-0"):
            yield "digit", lambda n: setattr(n, "value", other_digit(n.value))
    if isinstance(node, ast.Attribute) and len(_states(node.attr)) > 1:
        yield "state", lambda n: setattr(n, "attr", _another(n.attr, _states(n.attr)))


def _renamed(tree: ast.Expression, model: str, other: str) -> ast.Expression:
    renamed = copy.deepcopy(tree)
    for node in ast.walk(renamed):
        if isinstance(node, ast.Constant) and node.value == model:
            node.value = other
    return renamed


def other_digit(text: str) -> str:
    """A printed number whose first digit is another, so that it is off by far more than its last."""
    place = next(i for i, character in enumerate(text) if character in "123456789")
    return f"{text[:place]}{(int(text[place]) + 4) % 9 + 1}{text[place + 1 :]}"


def _another(name: str, names: Sequence[str]) -> str:
    others = [other for other in names if other != name]
    return others[0] if others else name


def _states(name: str) -> tuple[str, ...]:
    for group in (("r", "theta", "r_dot", "theta_dot"), ("x1", "x2", "x3", "x4"), ("u1", "u2")):
        if name in group:
            return group
    return (name,)


@cache
def _instances() -> tuple[str, ...]:
    return tuple(sorted(path.stem for path in Path(SHIPPED).glob("*.toml")))


def turns(document: str, row: Row, changed: Changed, before: Answer) -> bool:
    """Whether a change turns a claim, or makes it say nothing any more."""
    for text in (changed.text, *changed.others):
        try:
            if judged(document, row, text).truth is not before.truth:
                return True
        except (BadInput, LookupError):  # what it names is not there
            return True
    return False
