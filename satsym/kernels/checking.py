"""Check whether a text is a module that the generator writes, without running any of it.

The generator writes a docstring, two imports, one literal and functions of known names, arguments and results. This
language is accepted and nothing more.
"""

from __future__ import annotations

import ast
import re
import warnings
from itertools import islice
from math import isfinite

import msgspec

from satsym.kernels.bodies import Body, Unexpected, refuse, text_of
from satsym.kernels.contract import BATCH, LINEAR, Signature, loops, missing, pointwise, sizes
from satsym.spec import PRODUCT, ProblemSpec

_IMPORTS = ("import math", "import numpy as np")
_LARGEST_INTEGER = 10**6
_LONGEST_NAME = 1000
_MOST_WORDS = 200_000
"""Largest number of tokens, including line ends, of a module; larger modules are refused.

Shipped modules have a tenth of that. Parsing a text takes a thousand times its memory.
"""
_WORD = re.compile(r"\w+|[^\w ]")
_NAME = re.compile(r"[a-z][a-z0-9_]*\Z")


def check(text: str) -> tuple[ProblemSpec, list[ast.FunctionDef]]:
    """Read a module without running it.

    Returns
    -------
    The model's description, and the functions, which can be compiled.

    Raises
    ------
    Unexpected
        At the first line that the generator does not write.
    """
    if sum(1 for _ in islice(_WORD.finditer(text), _MOST_WORDS + 1)) > _MOST_WORDS:
        raise Unexpected(1, "begins a statement that no generated module contains")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they would print lines of the file
            body = ast.parse(text).body
    except SyntaxError as error:
        raise Unexpected(error.lineno or 1, f"is not Python ({error.msg})") from None
    except ValueError:  # NUL characters, up to Python 3.11
        raise Unexpected(1, "is followed by a character that is not text") from None
    opening = len(_IMPORTS) + 2
    docstring, *imports = body[: opening - 1] or [ast.Pass()]
    _docstring(docstring)
    if tuple(text_of(node) for node in imports if isinstance(node, ast.Import)) != _IMPORTS:
        refuse(docstring, f"is not followed by `{'` and `'.join(_IMPORTS)}`")
    if len(body) < opening:
        refuse(docstring, "is not followed by MODEL")
    spec = _model(body[opening - 1])
    return spec, _functions(body[opening:], spec)


def _docstring(node: ast.stmt) -> None:
    match node:
        case ast.Expr(value=ast.Constant(value=str())):
            pass
        case _:
            refuse(node, "has no docstring where one belongs")


def _model(node: ast.stmt) -> ProblemSpec:
    match node:
        case ast.Assign(targets=[ast.Name(id="MODEL")], value=ast.Dict() as value):
            _literal(value)
        case _:
            refuse(node, "is not MODEL = {...}")
    literal = ast.literal_eval(value)
    try:
        ProblemSpec.from_literal(literal)
        spec = msgspec.convert(literal, ProblemSpec)
    except ValueError as error:  # the second one's too: fields of another type
        refuse(node, f"begins a MODEL that cannot be read: {error}")
    if fault := _fault(spec):
        refuse(node, f"begins a MODEL with {fault}")
    return spec


def _literal(node: ast.AST) -> None:
    match node:
        case ast.Dict(keys=keys, values=values):
            for key in keys:
                if not (isinstance(key, ast.Constant) and isinstance(key.value, str)):
                    refuse(node, "has a table with a key that is not text")
            for value in values:
                _literal(value)
        case ast.Tuple(elts=values):
            for value in values:
                _literal(value)
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=float() | int())):
            pass
        case ast.Constant(value=str() as text) if len(text) <= _LONGEST_NAME and text.isprintable():
            pass
        case ast.Constant(value=int() as number) if abs(number) <= _LARGEST_INTEGER:
            pass
        case ast.Constant(value=float() as number) if isfinite(number):
            pass
        case ast.Constant(value=None):
            pass
        case _:
            refuse(node, "has something in MODEL that is not a plain value")


def _fault(spec: ProblemSpec) -> str:
    """Describe what no model has, though its fields are of the right types; empty for a possible model."""
    if not _NAME.match(spec.name):
        return "a name that is not valid"
    if spec.has_cost == (spec.control_set is None):
        return "a cost without a control set, or a control set without a cost"
    if not spec.states:
        return "no states"
    if spec.switching and spec.control_set != "box":
        return "controls that switch but are not in a box"
    if (spec.control_set == PRODUCT) != bool(spec.control_parts):
        return "a product of control sets without a list of these sets, or such a list without a product"
    in_sets = sorted(c for part in spec.control_parts for c in part.controls)
    if spec.control_parts and sorted(spec.control_names) != in_sets:
        return "control sets that contain other controls than its own"
    halves = (*spec.coordinates, *spec.velocities)
    if halves and (len(spec.coordinates) != len(spec.velocities) or sorted(halves) != sorted(spec.state_names)):
        return "coordinates and velocities that are not its states"
    if set(spec.linear) - set(LINEAR):
        return "functions of linear models that no linear model has"
    if len(spec.terminal_inequalities) > len(spec.multipliers):
        return "terminal inequalities without multipliers"
    groups = (
        spec.states,
        spec.controls,
        spec.parameters,
        spec.invariants,
        spec.position,
        spec.multipliers,
        spec.outputs,
    )
    for group in groups:
        if len({v.symbol for v in group}) < len(group):
            return "two variables with the same name"
    return ""


def _functions(nodes: list[ast.stmt], spec: ProblemSpec) -> list[ast.FunctionDef]:
    found: dict[str, ast.FunctionDef] = {}
    simple, looping, counts = pointwise(spec), loops(spec), sizes(spec)
    for node in nodes:
        if not isinstance(node, ast.FunctionDef):
            refuse(node, "is not a function")
        name = node.name.removesuffix(BATCH)
        batch = name != node.name
        if node.name in found or (name not in simple and (batch or name not in looping)):
            refuse(node, "defines a function that does not belong there")
        signature = simple.get(name) or looping[name]
        _header(node, signature, batch)
        form = "np" if batch else "math" if name in simple else "loop"
        Body(signature, counts, form, form != "loop" or (name == "forward" and spec.has_cost)).check(node.body[1:])
        found[node.name] = node
    if absent := missing(spec, found):
        raise Unexpected(1, f"does not contain {', '.join(absent)}")
    return list(found.values())


def _header(node: ast.FunctionDef, signature: Signature, batch: bool) -> None:
    """Check everything about a function but its body: no decorators, annotations, or defaults that could run."""
    arguments = ", ".join((*signature.arguments, "out=None") if batch else signature.arguments)
    plain = not (node.decorator_list or node.returns or getattr(node, "type_params", None))
    if not plain or text_of(node.args) != arguments:
        refuse(node, f"defines {node.name} with other arguments than ({arguments})")
    _docstring(node.body[0])
