"""Propositions that were tested, as mathematics: ``all(re(v) < 0 for v in eigenvalues(S))`` with quantifiers."""

from __future__ import annotations

import ast

from satsym.report.latex import formula_tex

_QUANTIFIERS = {"all": r"\forall", "any": r"\exists"}
_CONNECTIVES = {"implies": r"\Rightarrow", "iff": r"\Leftrightarrow"}
_RELATIONS = {
    ast.Eq: "=", ast.NotEq: r"\ne", ast.Lt: "<", ast.LtE: r"\le", ast.Gt: ">", ast.GtE: r"\ge",
    ast.In: r"\in", ast.NotIn: r"\notin",
}  # fmt: skip
_FUNCTIONS = {"re": "Re", "im": "Im", "sign": "sgn"}
_AROUND = {"abs": (r"\left|", r"\right|"), "norm": (r"\left\|", r"\right\|"), "quantity": ("", "")}
_CONVENTIONS = {"NEAR": r"\varepsilon", "PI": r"\pi", "INFINITY": r"\infty"}
_MOST_PARTS = 60
"""Largest number of parts of a proposition that is shown as mathematics; longer ones are shown as code only."""


class _Unwritten(Exception):
    """A proposition has no usual mathematical form."""


def mathematics(proposition: str) -> str:
    """Return a proposition in LaTeX; empty where it is too long or refers to lines of programs."""
    try:
        tree = ast.parse(proposition, mode="eval").body
        return _tex(tree) if sum(1 for _ in ast.walk(tree)) <= _MOST_PARTS else ""
    except (_Unwritten, SyntaxError, ValueError, RecursionError, MemoryError):
        return ""


def _tex(node: ast.expr) -> str:
    if isinstance(node, ast.BoolOp):
        sign = r" \wedge " if isinstance(node.op, ast.And) else r" \vee "
        return sign.join(_enclosed(part) for part in node.values)
    if isinstance(node, ast.UnaryOp):
        sign = r"\neg " if isinstance(node.op, ast.Not) else "-"
        return f"{sign}{_enclosed(node.operand)}"
    if isinstance(node, ast.Compare):
        signs = [_RELATIONS.get(type(sign), "") for sign in node.ops]
        if not all(signs):
            raise _Unwritten
        rest = (f" {sign} {_tex(part)}" for sign, part in zip(signs, node.comparators, strict=True))
        return _tex(node.left) + "".join(rest)
    if isinstance(node, ast.Constant):
        return _constant(node.value)
    if isinstance(node, ast.Name):
        family = node.id.isupper() and len(node.id) > 2
        return _CONVENTIONS.get(node.id) or (_word(node.id) if family else _name(node.id))
    if isinstance(node, ast.Attribute):
        return rf"{_name(node.attr)}\left({_tex(node.value)}\right)"
    if isinstance(node, ast.Subscript):
        return _entry(node)
    if isinstance(node, ast.List | ast.Tuple):
        return rf"\left[{', '.join(_tex(part) for part in node.elts)}\right]"
    if isinstance(node, ast.BinOp):
        return _worked_out(node)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return _call(node, node.func.id)
    raise _Unwritten


def _enclosed(node: ast.expr) -> str:
    named = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
    loose = isinstance(node, ast.BoolOp | ast.Compare) or named in (*_CONNECTIVES, *_QUANTIFIERS)
    return rf"\left({_tex(node)}\right)" if loose else _tex(node)


def _call(node: ast.Call, name: str) -> str:
    if name in _QUANTIFIERS and isinstance(node.args[0], ast.GeneratorExp):
        bound = []
        for part in node.args[0].generators:
            if part.ifs:
                raise _Unwritten
            bound.append(rf"{_QUANTIFIERS[name]} {_tex(part.target)} \in {_tex(part.iter)}")
        members = r",\ ".join(bound)
        return rf"{members}:\ {_enclosed(node.args[0].elt)}"
    arguments = [_tex(part) for part in node.args]
    if name in _CONNECTIVES:
        return f" {_CONNECTIVES[name]} ".join(_enclosed(part) for part in node.args)
    if name in _AROUND and len(arguments) == 1:
        before, after = _AROUND[name]
        return f"{before}{arguments[0]}{after}"
    arguments += [f"{_name(word.arg or '')} = {_tex(word.value)}" for word in node.keywords]
    return rf"{_function(name)}\left({', '.join(arguments)}\right)"


def _function(name: str) -> str:
    return rf"\mathrm{{{_FUNCTIONS[name]}}}" if name in _FUNCTIONS else _word(name)


def _entry(node: ast.Subscript) -> str:
    keys = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    if isinstance(node.value, ast.Name) and node.value.id in ("row", "meanings"):
        named = " ".join(str(key.value) for key in keys if isinstance(key, ast.Constant))
        return _plain(f"({named})")
    if isinstance(node.value, ast.Name) and node.value.id == "text":
        raise _Unwritten
    return f"{{{_tex(node.value)}}}_{{{', '.join(_tex(key) for key in keys)}}}"  # x_1 has an index of its own


def _worked_out(node: ast.BinOp) -> str:
    sides = [
        rf"\left({_tex(side)}\right)"
        if isinstance(side, ast.BinOp) and isinstance(side.op, ast.Add | ast.Sub) and not isinstance(node.op, ast.Add)
        else _tex(side)
        for side in (node.left, node.right)
    ]
    if isinstance(node.op, ast.Div):
        return rf"\frac{{{_tex(node.left)}}}{{{_tex(node.right)}}}"
    if isinstance(node.op, ast.Pow):
        return f"{{{sides[0]}}}^{{{_tex(node.right)}}}"
    signs = {ast.Add: "+", ast.Sub: "-", ast.Mult: r"\cdot", ast.MatMult: r"\,"}
    if type(node.op) not in signs:
        raise _Unwritten
    return f" {signs[type(node.op)]} ".join(sides)


def _constant(value: object) -> str:
    if isinstance(value, str):
        return formula_tex.symbol(value) if value.isidentifier() and len(value) < 3 else _plain(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _Unwritten
    return str(value)


def _name(name: str) -> str:
    return formula_tex.symbol(name)


def _word(name: str) -> str:
    return _plain(name.lower().replace("_", " ") if name.isupper() else name.replace("_", " "))


def _plain(text: str) -> str:
    """Return upright text; signs that are no plain text have no place in a formula."""
    if any(sign in text for sign in "\\{}$%#&~^`"):
        raise _Unwritten
    return rf"\text{{{text.replace('_', ' ')}}}"
