"""Generated modules with one literal or sign of one function changed."""

from __future__ import annotations

import ast
import copy
import math
import random
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from satsym.kernels import Kernels, consistency, load
from satsym.kernels.contract import BATCH
from satsym.kernels.digest import sealed

GENERATED = Path(__file__).resolve().parents[2] / "generated"


@dataclass(frozen=True)
class Mutant:
    """A function that was changed.

    Attributes
    ----------
    model, function, place, was
        Where, and the expression there before.
    kernels
        Those of the model with the changed function, and with its other form changed alike if both were.
    changed
        Syntax trees of what was changed.
    """

    model: str
    function: str
    place: int
    was: str
    kernels: Kernels
    changed: tuple[ast.FunctionDef, ...]

    @property
    def text(self) -> str:
        """Of the module, with its digest."""
        lines = (GENERATED / f"{self.model}.py").read_text(encoding="utf-8").splitlines()
        for one in sorted(self.changed, key=lambda node: -node.lineno):
            lines[one.lineno - 1 : one.end_lineno] = ast.unparse(one).splitlines()
        return sealed("\n".join([*lines, ""]))


def mutants(model: str, each: int, both: bool = False, seed: int = 1) -> Iterator[Mutant]:
    """Some mutants of every function of a shipped model; of both forms of a function alike, if wanted."""
    rng = random.Random(seed)
    functions = parsed(model)
    for name, function in functions.items():
        pair = functions.get(name + BATCH)
        if both and pair is None:
            continue
        found = sites(function)
        for place in sorted(rng.sample(range(len(found)), min(each, len(found)))):
            changed = [(function, place)]
            if both:
                assert pair is not None
                if (other := _alike(found, place, sites(pair))) is None:
                    continue
                changed.append((pair, other))
            yield _mutant(model, name, place, ast.unparse(found[place]), [_changed(*one) for one in changed])


@cache
def parsed(model: str) -> dict[str, ast.FunctionDef]:
    """The functions of a shipped module."""
    tree = ast.parse((GENERATED / f"{model}.py").read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


def sites(function: ast.FunctionDef) -> list[ast.expr]:
    """Literals, sums, differences and signs, indices left out."""
    found: list[ast.expr] = []
    for node in ast.walk(function):
        literal = isinstance(node, ast.Constant) and isinstance(node.value, float)
        signed = isinstance(node, ast.UnaryOp) or (
            isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)
        )
        if literal or (signed and not any(isinstance(getattr(c, "value", None), int) for c in ast.walk(node))):
            found.append(node)
    return found


def _changed(function: ast.FunctionDef, place: int) -> ast.FunctionDef:
    found = copy.deepcopy(function)
    match sites(found)[place]:
        case ast.Constant(value=value) as node:
            node.value = value + 1.0
        case ast.BinOp(op=ast.Add()) as node:
            node.op = ast.Sub()
        case ast.BinOp() as node:
            node.op = ast.Add()
        case ast.UnaryOp(operand=operand) as node:
            node.operand = ast.UnaryOp(ast.USub(), operand)
    return ast.fix_missing_locations(found)


def _alike(found: list[ast.expr], place: int, others: list[ast.expr]) -> int | None:
    """The same expression in the other form, if it is there as often."""
    wanted = ast.unparse(found[place])
    own = [k for k, node in enumerate(found) if ast.unparse(node) == wanted]
    there = [k for k, node in enumerate(others) if ast.unparse(node).replace("np.", "math.") == wanted]
    return there[own.index(place)] if len(own) == len(there) else None


def _mutant(model: str, name: str, place: int, was: str, changed: list[ast.FunctionDef]) -> Mutant:
    scope: dict[str, Any] = {"math": math, "np": np}
    exec(compile(ast.Module(list(changed), []), "mutant", "exec"), scope)  # noqa: S102
    kernels = load(model)
    replaced = {one.name: scope[one.name] for one in changed}
    changed_kernels = replace(kernels, functions={**kernels.functions, **replaced})
    return Mutant(model, name, place, was, changed_kernels, tuple(changed))


def is_equivalent(mutant: Mutant, places: int = 30) -> bool:
    """Whether the function gives the same numbers as before wherever one looks, thresholds apart."""
    before = load(mutant.model)
    code = before.functions[mutant.function].__code__
    names = [a for a in code.co_varnames[: code.co_argcount] if a != "out"]
    for seed in range(places):
        at = consistency.random_places(before, seed=1000 + seed)
        everywhere = [at] if mutant.function.endswith(BATCH) else [consistency.column(at, k) for k in range(10)]
        for here in everywhere:
            old, new = (
                np.array(one.functions[mutant.function](*(here[a] for a in names)), float)
                for one in (before, mutant.kernels)
            )
            if not np.allclose(old, new, rtol=1e-9, atol=1e-12, equal_nan=True):
                return False
    return True
