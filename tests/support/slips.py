"""One term of something derived, or of a generated function, changed by a small share of itself.

What changes by that is checked by what makes it: a step by its own checks, a function's text before it is written, and
a module with a new digest where it is loaded.
"""

from __future__ import annotations

import ast
import random
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from satsym import kernels
from satsym.agreement import DIGITS
from satsym.codegen import verify
from satsym.codegen.naming import code_of
from satsym.kernels import loading
from satsym.kernels.digest import sealed
from satsym.kernels.many_digits import exactly, functions_of, watched
from satsym.status import BadInput
from satsym.symbolic import Derivation, DerivationError, pipeline
from satsym.symbolic.checks import drawn_from, numeric, points
from satsym.symbolic.model import variables_of

LEAST, MOST = 1e-6, 1e-1
"""By which share of itself a term is changed, even in its logarithm."""

SHARE = 1e-9
"""Of its sum, that a term must be."""

SIZE = (40, 40)
"""Shape of an array that has room for what any function of a random model fills."""

ROUNDING, JUMP = mp.mpf(10) ** -DIGITS, mp.mpf(10) ** -12
"""Shares of the largest number of a function that are no change: where terms cancel that need no constants, and where
they cancel but for the rounding of constants in the text."""

ATTEMPTS = 40
"""To find a term that large."""


@dataclass(frozen=True)
class Slip:
    """What was changed, and what came of it.

    Attributes
    ----------
    place
        Step, or function.
    term
        As it was.
    change, share
        Of the term by itself; of the sum by the term.
    nested
        Whether the sum stands inside other terms.
    caught
        What refused it; empty where nothing did.
    effect
        Whether anything came of it.
    """

    place: str
    term: str
    change: float
    share: float
    nested: bool
    caught: str
    effect: bool = True

    @property
    def decade(self) -> int:
        """Of the share of the sum that was changed, 1e-2 for example."""
        return int(np.floor(np.log10(abs(self.change) * min(self.share, 1.0))))


def _changed_by(rng: random.Random) -> float:
    return rng.choice((-1, 1)) * float(10.0 ** rng.uniform(np.log10(LEAST), np.log10(MOST)))


# -- in steps


def in_step(derivation: Derivation, rng: random.Random) -> Slip | None:
    """Change one term of one expression that a step makes, and let the step check itself.

    ``None`` where no term is large enough.
    """
    with drawn_from(variables_of(derivation.model)):
        for _ in range(ATTEMPTS):
            if (slip := _tried(derivation, rng)) is not None:
                return slip
    return None


def _tried(derivation: Derivation, rng: random.Random) -> Slip | None:
    index = rng.randrange(len(derivation.steps))
    step, before = derivation.steps[index], replace(derivation, steps=derivation.steps[:index])
    function = _functions(derivation).get(step.name)
    if function is None:
        return None
    made: list[sp.Expr] = []
    with _intercepted(lambda k, e: made.append(e) or e):
        function(before)
    wanted = [k for k, e in enumerate(made) if e.free_symbols and not e.has(sp.Dummy)]  # of this call alone
    if not wanted:
        return None
    k = rng.choice(wanted)
    sums = [(e, path) for e, path in _sums(made[k])] or [(made[k], ())]
    total, path = rng.choice(sums)
    term = rng.choice(sp.Add.make_args(total))
    if term.is_number or (share := _share(term, total)) < SHARE:
        return None
    change = _changed_by(rng)
    wrong = _put(made[k], path, total + term * sp.Rational(str(change)))
    about = (step.name, str(term), change, share, bool(path))
    try:
        with _intercepted(lambda j, e: wrong if j == k else e):
            found = before.extended(function(before)).steps[-1]
    except (DerivationError, ArithmeticError, ValueError, TypeError, NotImplementedError) as error:
        return Slip(*about, caught=f"{type(error).__name__}: {error}"[:120])
    return Slip(*about, caught="", effect=_differs(found.equations, step.equations))


def _functions(derivation: Derivation) -> dict[str, Callable[[Derivation], Any]]:
    """The functions of the steps by their names."""
    lists = (*derivation.model.steps(), *pipeline.OUTPUTS, *pipeline._principle(derivation))
    return {function.__name__: function for function in lists}


@contextmanager
def _intercepted(by: Callable[[int, sp.Expr], sp.Expr]) -> Iterator[None]:
    """Everything that steps tidy or differentiate passes through this function, with its number."""
    calls = 0
    modules = [m for name, m in sys.modules.items() if name.startswith("satsym.symbolic") and m is not None]
    tidying = [m for m in modules if callable(getattr(m, "tidy", None))]
    tidy, diff = tidying[0].tidy, sp.diff

    def through(e: Any) -> Any:
        nonlocal calls
        if not isinstance(e, sp.Expr):
            return e
        calls += 1
        return by(calls - 1, e)

    _forget(modules)
    try:
        for m in tidying:
            if not m.__name__.endswith("algebra"):
                m.tidy = lambda *given, **more: through(tidy(*given, **more))
        sp.diff = lambda *given, **more: through(diff(*given, **more))
        yield
    finally:
        sp.diff = diff
        for m in tidying:
            m.tidy = tidy
        _forget(modules)


def _forget(modules: list[ModuleType]) -> None:
    """What functions keep of earlier calls."""
    for module in modules:
        for found in list(vars(module).values()):
            if hasattr(found, "cache_clear") and getattr(found, "__module__", "") == module.__name__:
                found.cache_clear()


def _sums(e: sp.Expr, path: tuple[int, ...] = ()) -> Iterator[tuple[sp.Expr, tuple[int, ...]]]:
    if e.is_Add:
        yield e, path
    for k, inner in enumerate(e.args):
        if isinstance(inner, sp.Expr):
            yield from _sums(inner, (*path, k))


def _put(e: sp.Expr, path: tuple[int, ...], new: sp.Expr) -> sp.Expr:
    if not path:
        return new
    args = list(e.args)
    args[path[0]] = _put(args[path[0]], path[1:], new)
    return e.func(*args)


def _share(term: sp.Expr, total: sp.Expr) -> float:
    """The least share of a sum that a term is, at random points."""
    value = numeric([term, total])
    found = []
    with mp.workdps(DIGITS):
        for point in points(total.free_symbols, "share of a term"):
            try:
                one, every = value(point)
                found.append(float(abs(one / every)) if every else 1.0)
            except (ArithmeticError, ValueError, TypeError):
                return 0.0
    return min(found) if all(f == f for f in found) else 0.0


def _differs(found: Any, right: Any) -> bool:
    """Whether equations differ by more than the way they are written."""
    if len(found) != len(right) or [e.name for e in found] != [e.name for e in right]:
        return True
    for a, b in zip(found, right, strict=True):
        if a == b:
            continue
        left, wanted = (list(e.rhs) if isinstance(e.rhs, sp.MatrixBase) else [e.rhs] for e in (a, b))
        value = numeric([*left, *wanted])
        with mp.workdps(DIGITS):
            symbols = set().union(*(e.free_symbols for e in (*left, *wanted)))
            for point in points(symbols, "difference of equations"):
                numbers = value(point)
                pairs = zip(numbers[: len(left)], numbers[len(left) :], strict=True)
                if not all(abs(x - y) <= 1e-24 * (abs(x) + abs(y)) for x, y in pairs):
                    return True
    return False


# -- in text


def in_text(derivation: Derivation, text: str, rng: random.Random) -> tuple[Slip, str] | None:
    """Change one term in the text of one function, and let it be verified; also the changed text.

    ``None`` where no term is large enough.
    """
    functions = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    original = kernels.from_text(text, f"{derivation.name}.py")
    rng_of_places = random.Random(derivation.name)
    with drawn_from(variables_of(derivation.model)):
        known = code_of(derivation).symbols
        places = [verify.drawn(known, original.spec, rng_of_places) for _ in range(5)]
    for _ in range(ATTEMPTS):
        function = rng.choice(functions)
        found = _terms(function)
        if not found:
            continue
        statement, total, term = rng.choice(found)
        share = _share_in(text, function.name, statement.lineno, total, term, places)
        if share is None or share < SHARE:
            continue
        change = _changed_by(rng)
        wrong = _with_factor(text, term, 1.0 + change)
        caught = _verified(derivation, wrong)
        nested = total is not getattr(statement, "value", None)
        effect = not _alone_in_a_condition(statement, total, term)
        if effect and not caught and not _changes(text, wrong, function.name, places):
            settled = _iterated(function, statement) or _guards_only(function, statement)
            effect = not settled and _moves_a_threshold(text, wrong, function.name, places)
        return Slip(function.name, ast.unparse(term)[:200], change, share, nested, caught, effect), wrong
    return None


def _verified(derivation: Derivation, text: str) -> str:
    """What refuses a text; empty where nothing does."""
    try:
        verify.verify(derivation, kernels.from_text(text, f"{derivation.name}.py"))
    except (DerivationError, BadInput, ArithmeticError) as error:
        return f"{type(error).__name__}: {error}"[:160]
    return ""


def in_module(text: str, name: str, folder: Path) -> str:
    """What refuses a changed module with a new digest where it is loaded; empty where nothing does."""
    (folder / f"{name}.py").write_text(sealed(text), encoding="utf-8")
    try:
        loading.load(f"./{name}", folder)
    except BadInput as error:
        return str(error)
    return ""


def _terms(function: ast.FunctionDef) -> list[tuple[ast.stmt, ast.expr, ast.expr]]:
    """Statement, sum, and term of it, of every sum in a function that is no index."""
    found: list[tuple[ast.stmt, ast.expr, ast.expr]] = []
    for statement in ast.walk(function):
        if not isinstance(statement, ast.Assign | ast.Return | ast.AugAssign) or statement.value is None:
            continue
        inner = {id(n) for node in ast.walk(statement) if isinstance(node, ast.Subscript) for n in ast.walk(node.slice)}
        parts = {
            id(side)
            for node in ast.walk(statement)
            if _is_sum(node)
            for side in (node.left, node.right)
            if _is_sum(side)
        }
        for node in ast.walk(statement.value):
            if _is_sum(node) and id(node) not in inner and id(node) not in parts:
                found += [(statement, node, term) for term in _flat(node)]
    return found


def _alone_in_a_condition(statement: ast.stmt, total: ast.expr, term: ast.expr) -> bool:
    """Whether nothing but the sign of the term counts: what it is compared with, or added to where that is, is zero."""
    conditions = [
        node.args[0] if isinstance(node, ast.Call) else node.left
        for node in ast.walk(statement)
        if isinstance(node, ast.Compare) or (isinstance(node, ast.Call) and ast.unparse(node.func) == "np.heaviside")
    ]
    zeros = [isinstance(other, ast.Constant) and not other.value for other in _flat(total) if other is not term]
    return any(total is condition for condition in conditions) and all(zeros)


def _iterated(function: ast.FunctionDef, statement: ast.stmt) -> bool:
    """Whether a statement belongs to an iteration, whose limit may be the same whichever way it is approached."""
    return any(isinstance(node, ast.For) and statement in node.body for node in ast.walk(function))


def _guards_only(function: ast.FunctionDef, statement: ast.stmt) -> bool:
    """Whether what a statement outside loops assigns is used only in zero times a root, where its sign alone counts."""
    products = [node for node in ast.walk(function) if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)]
    guards = [node for node in products if ast.unparse(node.left) == "0.0" and "sqrt(" in ast.unparse(node.right)]
    inside = {id(part) for guard in guards for part in ast.walk(guard)}
    names, waiting = set[str](), [statement]
    while waiting:
        one = waiting.pop()
        if not isinstance(one, ast.Assign) or not all(isinstance(target, ast.Name) for target in one.targets):
            return False
        new = {ast.unparse(target) for target in one.targets} - names
        names |= new
        for other in (node for node in ast.walk(function) if isinstance(node, ast.stmt)):
            if other.lineno <= statement.lineno:  # whatever has these names there
                continue
            used = {n.id for n in ast.walk(other) if isinstance(n, ast.Name) and id(n) not in inside} & new
            if used and other is not one and other not in waiting:
                waiting.append(other)
    return True


def _moves_a_threshold(text: str, wrong: str, name: str, places: list[dict[str, Any]]) -> bool:
    """Whether two texts of a function that agree at random places may differ between the thresholds of conditions."""
    if name not in watched(text, {}):
        return False
    between = list(_where_conditions_differ(text, wrong, name, places))
    return not between or _changes(text, wrong, name, between, JUMP)


def _where_conditions_differ(
    text: str, wrong: str, name: str, places: list[dict[str, Any]]
) -> Iterator[dict[str, Any]]:
    """Places between the thresholds of a condition in two texts of a function, found by scaling single numbers.

    Where a function is the same on both sides of a threshold, as H_u times a step is where H_u vanishes, no place shows
    that the threshold is another one.
    """
    with mp.workdps(DIGITS):
        both = [watched(one, {})[name] for one in (text, wrong)]
        arguments = both[0][0].__code__.co_varnames[: both[0][0].__code__.co_argcount]

        def gaps(place: dict[str, Any]) -> list[dict[int, Any]]:
            for function, seen in both:
                seen.clear()
                given = [exactly(place[a]) for a in arguments if a != "out"]
                function(*given, *([np.empty(SIZE, dtype=object)] if "out" in arguments else []))
            return [dict(seen) for _, seen in both]

        for place in places:
            for argument in (a for a in ("lam", "bounds") if a in arguments):
                for k in range(len(place[argument])):
                    yield from _between_thresholds(gaps, partial(_scaled, place, argument, k))


def _scaled(place: dict[str, Any], argument: str, component: int, factor: Any) -> dict[str, Any]:
    """A place with one number multiplied by a factor."""
    values = place[argument]
    return place | {argument: tuple(factor * v if i == component else v for i, v in enumerate(values))}


def _between_thresholds(
    gaps: Callable[[dict[str, Any]], list[dict[int, Any]]], at: Callable[[Any], dict[str, Any]]
) -> Iterator[dict[str, Any]]:
    """Places at which a condition holds in one text and not in the other, along a grid of factors."""
    factors = [mp.mpf(10) ** (k / 2) for k in range(-12, 5)]
    found = [gaps(at(factor)) for factor in factors]
    for (low, left), (high, right) in pairwise(zip(factors, found, strict=True)):
        for condition in left[0].keys() & right[0].keys():
            if all(a[condition] * b[condition] < 0 for a, b in zip(left, right, strict=True)):
                roots = [_bisected(lambda f, j=j, c=condition: gaps(at(f))[j][c], low, high) for j in (0, 1)]  # type: ignore[misc]
                middle = at(sum(roots) / 2)
                if len({gap[condition] > 0 for gap in gaps(middle)}) == 2:
                    yield middle


def _bisected(value: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Where a function changes its sign, to seven digits of a slip of 1e-6."""
    sign = value(low) > 0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if (value(middle) > 0) == sign else (low, middle)
    return (low + high) / 2


def _changes(text: str, wrong: str, name: str, places: list[dict[str, Any]], jump: Any = ROUNDING) -> bool:
    """Whether two texts of a function have other numbers at some places, however many digits these have.

    Differences up to a share ``jump`` of the largest number do not count.
    """
    for place in places:
        found = []
        for one in (text, wrong):
            with mp.workdps(2 * DIGITS):
                function = functions_of(one, {})[name]
                names = function.__code__.co_varnames[: function.__code__.co_argcount]
                if "times" in names:
                    return True
                given = [exactly(place[a]) for a in names if a != "out"]
                if "out" in names:
                    given.append(np.empty(SIZE, dtype=object))
                value = function(*given)
                found.append(np.ravel(np.asarray(value, dtype=object)).tolist())
        numbers = [(a, b) for a, b in zip(*found, strict=True) if a is not None]
        faint = jump * max(abs(b) for _, b in numbers)
        if any(abs(a - b) > faint for a, b in numbers):
            return True
    return False


def _is_sum(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def _flat(node: ast.expr) -> list[ast.expr]:
    return [*_flat(node.left), *_flat(node.right)] if _is_sum(node) else [node]


def _with_factor(text: str, term: ast.expr, factor: float) -> str:
    """The text with a factor before a term."""
    lines = text.split("\n")
    if term.lineno != term.end_lineno:
        raise ValueError("a term over several lines")
    line = lines[term.lineno - 1]
    start, end = term.col_offset, term.end_col_offset
    lines[term.lineno - 1] = f"{line[:start]}({factor!r}*({line[start:end]})){line[end:]}"
    return "\n".join(lines)


class _Probe(ast.NodeTransformer):
    """Puts the return of a term and its sum in place of the statement that has them."""

    def __init__(self, line: int, total: ast.expr, term: ast.expr) -> None:
        self.line, self.shown = line, ast.parse(f"return {ast.unparse(term)}, {ast.unparse(total)}").body[0]

    def visit(self, node: ast.AST) -> ast.AST:
        """As always, but for that statement."""
        if isinstance(node, ast.Assign | ast.Return | ast.AugAssign) and node.lineno == self.line:
            return ast.copy_location(self.shown, node)
        return super().visit(node)


def _share_in(
    text: str, function: str, line: int, total: ast.expr, term: ast.expr, places: list[dict[str, Any]]
) -> float | None:
    """The least share of a sum that a term is, at some places; ``None`` where there are no numbers."""
    tree = _Probe(line, total, term).visit(ast.parse(text))
    scope: dict[str, Any] = {}
    try:
        with np.errstate(all="ignore"):
            exec(compile(ast.fix_missing_locations(tree), "probe", "exec"), scope)  # noqa: S102
            found = [
                abs(np.asarray(one, float) / every) for one, every in (_called(scope[function], p) for p in places)
            ]
    except (ArithmeticError, ValueError, TypeError, IndexError):
        return None
    shares = np.concatenate([np.ravel(f) for f in found])
    return float(shares.min()) if shares.size and np.isfinite(shares).all() else None


def _called(function: Any, place: dict[str, Any]) -> Any:
    """A probe at a place; loops over two steps from there."""
    names = function.__code__.co_varnames[: function.__code__.co_argcount]
    given: dict[str, Any] = dict(place)
    if function.__name__.endswith("_batch"):
        given = {a: np.array(v)[..., None] if a in ("x", "u", "lam") else v for a, v in place.items()} | {"out": None}
        given["t"] = np.array([place["t"]])
    given |= {"times": [place["t"] + k * 0.001 for k in range(3)], "x0": place["x"], "lam_f": place["lam"]}
    if "times" in names:
        for group in ("x", "u", "lam"):
            rows = [np.array([v, v * 1.01, v * 0.99]) for v in place[group]]
            given[group] = tuple(rows)
            given[f"{group}_mid"] = tuple(r[:2] * 1.0 for r in rows)
    return function(*(given[a] for a in names))
