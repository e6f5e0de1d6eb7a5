"""Interpreter of printed Python programs, which walks the syntax tree and never passes text to Python for execution.

Assignments, functions, calls of a few library functions (:mod:`satsym.auditing.program.library`), arithmetic, slices,
comparisons, formatted texts and one loop inside ``all`` or ``any`` are supported; anything else is refused. Each node
counts as a step; the numbers of steps and entries and the size of integers are limited.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from satsym.auditing.program.library import (
    BINARY,
    COMPARED,
    Module,
    Run,
    broadcast,
    builtins,
    extent,
    formatted,
    indexed,
    made,
    modules,
)
from satsym.auditing.program.text import Program, Stops
from satsym.formula import budget
from satsym.formula.budget import OverBudget
from satsym.status import BadInput
from satsym.wording import shown

MAX_STEPS = 3_000_000
MAX_CALLS = 30
_NUMBERS = (int, float, complex, np.number)
_LARGEST_INTEGER = 2**53
_PARTS = ("real", "imag")


def run(
    program: Program,
    given: Mapping[str, Any] | None = None,
    *,
    until: str = "",
    world: Mapping[str, Any] | None = None,
) -> Run:
    """Interpret a program and return its result.

    Parameters
    ----------
    program
        The parsed program.
    given
        Values of variables that replace those that the program assigns.
    until
        Name of a variable after whose assignment the run ends; by default the program runs to its end.
    world
        Values of names before the program begins.

    Raises
    ------
    Stops
        If the program would stop with an error; the message contains the line.
    OverBudget
        If the program exceeds a limit.
    BadInput
        If the program uses anything that is not supported.
    """

    def walk() -> Run:
        walker = _Walker(program, given or {}, world or {})
        with np.errstate(all="ignore"):
            for statement in program.statements:
                walker.statement(statement)
                if until and until in walker.world:
                    break
        return walker.left

    return budget.within(budget.CLAIM, walk)


class _Returned(Exception):
    """Control flow of a return statement; the argument is the returned value."""


class _Walker:
    def __init__(self, program: Program, given: Mapping[str, Any], world: Mapping[str, Any]) -> None:
        self.world: dict[str, Any] = dict(world)
        self.left = Run(self.world)
        self._program, self._given = program, given
        self._modules, self._builtins = modules(self.left), builtins(self.left)
        self._steps = self._calls = 0

    def statement(self, found: ast.stmt) -> None:
        """Execute a top-level statement of the program."""
        try:
            self._execute(found, self.world)
        except BadInput as error:
            raise type(error)(f"{error}, in {shown(self._program.line(found))}") from None
        except RecursionError:
            raise OverBudget(f"nested too deeply, in {shown(self._program.line(found))}") from None
        except (ArithmeticError, TypeError, ValueError, LookupError, AttributeError) as error:
            raise Stops(f"the program would stop: {error}, in {shown(self._program.line(found))}") from None

    def _execute(self, found: ast.stmt, scope: dict[str, Any]) -> None:
        self._step()
        if isinstance(found, ast.Assign) and len(found.targets) == 1:
            self._assign(found.targets[0], self._value(found.value, scope), scope)
        elif isinstance(found, ast.Expr):
            self._value(found.value, scope)
        elif isinstance(found, ast.Return) and scope is not self.world:
            raise _Returned(self._value(found.value, scope) if found.value else None)
        elif isinstance(found, ast.Import | ast.ImportFrom) and scope is self.world:
            self._import(found)
        elif isinstance(found, ast.FunctionDef) and scope is self.world:
            scope[found.name] = self._function(found)
        else:
            raise self._refused(found)

    def _import(self, found: ast.Import | ast.ImportFrom) -> None:
        for alias in found.names:
            path = alias.name if isinstance(found, ast.Import) else str(found.module)
            module = self._modules.get(path)
            if module is None:
                raise BadInput(f"the module {shown(path)} is not supported")
            entry = module if isinstance(found, ast.Import) else self._attribute(module, alias.name)
            self.world[alias.asname or alias.name] = entry

    def _function(self, found: ast.FunctionDef) -> Callable[..., Any]:
        names = [argument.arg for argument in found.args.args]
        plain = len(names) == sum(1 for node in ast.walk(found.args) if isinstance(node, ast.arg))
        if found.decorator_list or found.args.defaults or not plain:
            raise self._refused(found)

        def call(*arguments: Any) -> Any:
            if len(arguments) != len(names):
                raise Stops(f"{found.name} takes {len(names)} arguments, and is given {len(arguments)}")
            if self._calls >= MAX_CALLS:
                raise OverBudget(f"calls of functions are nested more than {MAX_CALLS} deep")
            inside = dict(zip(names, arguments, strict=True))
            self._calls += 1
            try:
                for statement in found.body:
                    self._execute(statement, inside)
            except _Returned as back:
                return back.args[0]
            finally:
                self._calls -= 1
            return None

        return call

    def _assign(self, target: ast.expr, value: Any, scope: dict[str, Any]) -> None:
        if isinstance(target, ast.Name):
            scope[target.id] = self._given.get(target.id, value) if scope is self.world else value
        elif isinstance(target, ast.Tuple):
            parts = list(value)
            if len(parts) != len(target.elts):
                raise Stops(f"{len(parts)} values for {len(target.elts)} names")
            for name, part in zip(target.elts, parts, strict=True):
                self._assign(name, part, scope)
        elif isinstance(target, ast.Subscript):
            array = self._value(target.value, scope)
            if not isinstance(array, np.ndarray):
                raise self._refused(target)
            array[self._place(target.slice, scope)] = value
        else:
            raise self._refused(target)

    def _value(self, found: ast.expr, scope: Mapping[str, Any]) -> Any:
        self._step()
        reader = _READERS.get(type(found))
        if reader is None:
            raise self._refused(found)
        return reader(self, found, scope)

    def _constant(self, found: ast.Constant, _: Mapping[str, Any]) -> Any:
        if not isinstance(found.value, int | float | str) or (
            isinstance(found.value, int) and abs(found.value) > _LARGEST_INTEGER
        ):
            raise self._refused(found)
        return found.value

    def _name(self, found: ast.Name, scope: Mapping[str, Any]) -> Any:
        for names in (scope, self.world, self._builtins):
            if found.id in names:
                return names[found.id]
        raise Stops(f"the name {shown(found.id)} has no value")

    def _attribute_of(self, found: ast.Attribute, scope: Mapping[str, Any]) -> Any:
        owner = self._value(found.value, scope)
        if isinstance(owner, Module):
            return self._attribute(owner, found.attr)
        if isinstance(owner, (*_NUMBERS, np.ndarray)) and found.attr in _PARTS:
            return owner.real if found.attr == "real" else owner.imag
        raise self._refused(found)

    def _attribute(self, module: Module, name: str) -> Any:
        if name not in module.attributes:
            raise BadInput(f"{shown(name)} of {module.name} is not supported")
        return module.attributes[name]

    def _unary(self, found: ast.UnaryOp, scope: Mapping[str, Any]) -> Any:
        if not isinstance(found.op, ast.USub | ast.UAdd):
            raise self._refused(found)
        value = self._numeric(self._value(found.operand, scope), found)
        return -value if isinstance(found.op, ast.USub) else value

    def _binary(self, found: ast.BinOp, scope: Mapping[str, Any]) -> Any:
        rule = BINARY.get(type(found.op))
        if rule is None:
            raise self._refused(found)
        one, other = (self._numeric(self._value(side, scope), found) for side in (found.left, found.right))
        if isinstance(one, int) and isinstance(other, int) and rule is operator.pow:
            one = float(one)
        broadcast(one, other)
        value = rule(one, other)
        return float(value) if isinstance(value, int) and abs(value) > _LARGEST_INTEGER else value

    def _numeric(self, value: Any, found: ast.expr) -> Any:
        if not isinstance(value, (*_NUMBERS, np.ndarray)):
            raise self._refused(found)
        return value

    def _compare(self, found: ast.Compare, scope: Mapping[str, Any]) -> Any:
        rule = COMPARED.get(type(found.ops[0]))
        if rule is None or len(found.ops) > 1:
            raise self._refused(found)
        one, other = self._value(found.left, scope), self._value(found.comparators[0], scope)
        if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
            broadcast(one, other)
        return rule(one, other)

    def _choice(self, found: ast.IfExp, scope: Mapping[str, Any]) -> Any:
        return self._value(found.body if self._value(found.test, scope) else found.orelse, scope)

    def _call(self, found: ast.Call, scope: Mapping[str, Any]) -> Any:
        function = self._value(found.func, scope)
        if not callable(function) or any(keyword.arg is None for keyword in found.keywords):
            raise self._refused(found)
        arguments = [self._value(argument, scope) for argument in found.args]
        named = {str(keyword.arg): self._value(keyword.value, scope) for keyword in found.keywords}
        return function(*arguments, **named)

    def _list(self, found: ast.List | ast.Tuple, scope: Mapping[str, Any]) -> Any:
        entries = [self._value(entry, scope) for entry in found.elts]
        made(extent(entries))
        return tuple(entries) if isinstance(found, ast.Tuple) else entries

    def _subscript(self, found: ast.Subscript, scope: Mapping[str, Any]) -> Any:
        owner = self._value(found.value, scope)
        if not isinstance(owner, np.ndarray | list | tuple):
            raise self._refused(found)
        place = self._place(found.slice, scope)
        if isinstance(owner, np.ndarray):
            indexed(owner, place)
        return owner[place]

    def _place(self, found: ast.expr, scope: Mapping[str, Any]) -> Any:
        if isinstance(found, ast.Tuple):
            return tuple(self._place(entry, scope) for entry in found.elts)
        if isinstance(found, ast.Slice):
            return slice(*(self._value(e, scope) if e else None for e in (found.lower, found.upper, found.step)))
        return self._value(found, scope)

    def _formatted(self, found: ast.JoinedStr, scope: Mapping[str, Any]) -> str:
        parts = []
        for part in found.values:
            if isinstance(part, ast.FormattedValue):
                if part.format_spec or part.conversion != -1:
                    raise self._refused(part)
                parts.append(str(self._value(part.value, scope)))
            else:
                parts.append(str(self._value(part, scope)))
        return formatted(parts)

    def _loop(self, found: ast.GeneratorExp, scope: Mapping[str, Any]) -> Iterator[Any]:
        if len(found.generators) > 1 or found.generators[0].ifs:
            raise self._refused(found)
        (loop,) = found.generators
        for entry in self._value(loop.iter, scope):
            inside = dict(scope)
            self._assign(loop.target, entry, inside)
            yield self._value(found.elt, inside)

    def _step(self) -> None:
        self._steps += 1
        if self._steps > MAX_STEPS:
            raise OverBudget(f"the program takes more than {MAX_STEPS:,} steps")

    def _refused(self, found: ast.AST) -> BadInput:
        return BadInput(f"{type(found).__name__} is not supported here, or not for these values")


_READERS: Mapping[type[ast.expr], Callable[[_Walker, Any, Mapping[str, Any]], Any]] = {
    ast.Constant: _Walker._constant,
    ast.Name: _Walker._name,
    ast.Attribute: _Walker._attribute_of,
    ast.UnaryOp: _Walker._unary,
    ast.BinOp: _Walker._binary,
    ast.Compare: _Walker._compare,
    ast.IfExp: _Walker._choice,
    ast.Call: _Walker._call,
    ast.List: _Walker._list,
    ast.Tuple: _Walker._list,
    ast.Subscript: _Walker._subscript,
    ast.JoinedStr: _Walker._formatted,
    ast.GeneratorExp: _Walker._loop,
}
