"""Measured values of propositions as sentences: ``len(meanings['x']) = 2`` as what it says about the document.

A measurement is put in words only if every part of it has words of its own. Terms that contain a bound variable whose
member is not known, or a function without a phrase, have no sentence.
"""

from __future__ import annotations

import ast
import re

from satsym.instance import files
from satsym.report.findings.parts import Unsaid, bound, divided, outside, tree
from satsym.report.texts import Texts

_CONVENTION = re.compile(r"\b(?:NEAR|OFTEN|EPSILONS|DELTAS)\b")
_PROGRAM = re.compile(r"\bmatlab\(")
_NAMED = re.compile(r"\b(\w+)=(-?\d[\d.e-]*)")
_HOLE = re.compile(r"<(\d)>")
_NUMBER = re.compile(r"[+-]?\d[\d.]*(?:e[+-]?\d+)?(?: [A-Za-z][A-Za-z0-9*/^-]*)?")
_NOTHING = re.compile(r"none of (\d+) .+? satisfies the condition .*|(true|false) for all of (\d+) .*")
_SIGNS = {ast.Add: " + ", ast.Sub: " - ", ast.Mult: " × ", ast.Div: "/", ast.Pow: "^"}
_BINDING = {ast.Add: 1, ast.Sub: 1, ast.Mult: 2, ast.Div: 2, ast.Pow: 3}
_LONGEST_VALUE = 160
"""Largest number of characters of a computed formula in a sentence."""
_PHRASES = (
    *("gravity", "order", "constant", "least_energy", "characteristic"),
    *("seen_latitude", "rates_at", "end", "reference", "start"),
)
"""Functions with a phrase of their own name in ``[terms]``, whose arguments are filled in."""
_ARGUMENTS = {"order": 0, "rates_at": 2, "least_energy": 3}
"""Number of arguments that a phrase names; by default one."""
_LETTERS = {"axis": "a", "period": "T", "constant": "mu", "least_energy": "E"}
"""Letters of terms in words, in calculations."""
_FLAGS = ("stable", "asymptotically_stable", "defined")


def sentences(measured: str, texts: Texts, tested: str = "") -> str:
    """Return measured values as sentences in the language of the texts; empty where a part of them has none.

    Parameters
    ----------
    measured
        Terms with their values, ``TERM = VALUE``, divided by semicolons; the member of a family for which a value was
        measured may follow in brackets.
    tested
        The proposition, whose members are named where it lists them.
    """
    nothing = _NOTHING.fullmatch(measured)
    if nothing:
        none, truth, every = nothing.groups()
        return _filled("of_none" if none else f"{truth}_for_all", [none or every], texts)
    try:
        parts = bound(measured, tested)
        if all(isinstance(node, ast.Call) and _name(node) == "quantity" for node, _ in parts):
            return ""
        said = [_sentence(part, texts) for part in parts]
    except (Unsaid, SyntaxError, ValueError, RecursionError, MemoryError):
        return ""
    return " ".join(sorted(dict.fromkeys(said), key=lambda each: each in _limits(measured, texts)))


def _limits(measured: str, texts: Texts) -> list[str]:
    """Return the sentences on conventions, which come after what was measured."""
    parts = [part.partition(" (")[0].partition(" = ") for part in divided(measured, "; ")]
    return [_capital(_filled(f"{name}_is", [value], texts)) for name, _, value in parts if name in ("NEAR", "OFTEN")]


def chosen(code: str, texts: Texts) -> list[str]:
    """Return the numbers in a proposition that the document does not print, but the auditor chose.

    Printed numbers are in quotes in a proposition; the others are conventions, such as limits of nearness, and numbers
    that are given by name, such as the initial guess of a printed program.
    """
    found = {texts.get("terms", name): texts.get("conventions", name) for name in _CONVENTION.findall(code)}
    for match in _PROGRAM.finditer(code):
        inside = code[match.end() :]
        end = next((k for k in outside(f"({inside}") if k and inside[k - 1] == ")"), len(inside))
        found |= dict(_NAMED.findall(inside[:end]))
    return [f"{name}: {value}" for name, value in found.items()]


def _sentence(part: tuple[ast.expr, str], texts: Texts) -> str:
    node, value = part
    if value in ("true", "false"):
        return _capital(_flag(node, value, texts))
    said = _of_document(node, value, texts) or _of_program(node, value, texts)
    if said:
        return _capital(said)
    if isinstance(node, ast.Name) and _CONVENTION.fullmatch(node.id):
        return _capital(_filled(f"{node.id}_is", [value], texts))
    if isinstance(node, ast.Call) and _name(node) == "distance":
        return _capital(_distance(node, value, texts))
    if isinstance(node, ast.List) and len(node.elts) == len(_entries(value)):
        pairs = zip(node.elts, _entries(value), strict=True)
        return " ".join(_sentence((entry, each), texts) for entry, each in pairs)
    if isinstance(node, ast.Call) and texts.find("terms", f"{_name(node)}_is"):
        return _capital(_filled(f"{_name(node)}_is", [_value(value, texts), *_arguments(node, texts)], texts))
    where: dict[str, str] = {}
    if isinstance(node, ast.BinOp):
        said = _filled("value_is", [_formula(node, texts, where), _value(value, texts)], texts)
    else:
        said = _filled("is", [_said(node, texts, where), _value(value, texts)], texts)
    return _capital(_filled("where", [said, texts.listed(list(where.values()))], texts) if where else f"{said}.")


def _formula(node: ast.BinOp, texts: Texts, where: dict[str, str]) -> str:
    """Return a calculation as a formula, and with its units where it has any."""
    whole = _worked_out(node, texts, where)
    if any(_name(part) == "quantity" for part in ast.walk(node) if isinstance(part, ast.Call)):
        return whole
    return f"`{whole.replace('`', '').replace(' × ', '*').replace('^', '**').replace('π', 'pi')}`"


def _of_document(node: ast.expr, value: str, texts: Texts) -> str:
    """Return what is measured of the printed text itself; empty for another measurement."""
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "row":
        return _filled("row_is", [_said(node, texts, {}), _value(value, texts)], texts)
    if not isinstance(node, ast.Call):
        return ""
    name, first = _name(node), node.args[0] if node.args else None
    if name == "len" and isinstance(first, ast.Subscript) and ast.unparse(first.value) == "meanings":
        return _filled("meanings", [value, _symbol(_text(first.slice))], texts)
    if name == "len" and isinstance(first, ast.Call) and _name(first) == "used_early" and value.isdigit():
        return texts.counted("terms", "used_early", int(value))
    if name == "count" and _is_printed(first):
        return texts.counted("terms", "count", int(value), sign=f"`{_text(node.args[1])}`")
    if name == "left" and first is not None:
        names = _entries(value)
        key = "left" if names else "left_none"
        return _filled(key, [_said(first, texts, {}), texts.listed([_symbol(each) for each in names])], texts)
    return ""


def _of_program(node: ast.expr, value: str, texts: Texts) -> str:
    """Return what a printed program gives; empty for another measurement."""
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Call) and _name(node.value) == "matlab":
        return _filled("gives", [_given(node.value, texts), _symbol(node.attr), _value(value, texts)], texts)
    if isinstance(node, ast.Call) and _name(node) == "last" and isinstance(node.args[0], ast.Call):
        inside = node.args[0]
        if _name(inside) == "output" and not inside.keywords:
            return _filled("output", [value], texts)
    return ""


def _distance(node: ast.Call, value: str, texts: Texts) -> str:
    one, other, *rest = node.args
    sides = _sides(one, other, texts)
    if not rest:
        return _filled("distance", [*sides, _value(value, texts)], texts)
    if not isinstance(rest[0], ast.List):
        raise Unsaid
    names = texts.listed([_symbol(_text(entry)) for entry in rest[0].elts])
    return _filled("distance_in", [*sides, _value(value, texts), names], texts)


def _sides(one: ast.expr, other: ast.expr, texts: Texts) -> list[str]:
    """Return two states in words; the reference of the instance of the first one is called its own."""
    said = [_said(side, texts, {}) for side in (one, other)]
    names = [{part.value for part in ast.walk(side) if isinstance(part, ast.Constant)} for side in (one, other)]
    own = isinstance(other, ast.Call) and _name(other) == "reference" and {n for n in names[1] if n} <= names[0]
    return [said[0], texts.get("terms", "reference_own")] if own else said


def _flag(node: ast.expr, value: str, texts: Texts) -> str:
    """Return what is true or false as a statement."""
    if isinstance(node, ast.Attribute) and node.attr == "again" and isinstance(node.value, ast.Call):
        if _name(node.value) != "matlab":
            raise Unsaid
        return _filled(f"again_{value}", [_given(node.value, texts)], texts)
    if not isinstance(node, ast.Call) or _name(node) not in _FLAGS or not node.args:
        raise Unsaid
    given = _keywords(node, texts) if node.keywords else ""
    return _filled(f"{_name(node)}_{value}", [_said(node.args[0], texts, {}), given], texts)


def _said(node: ast.expr, texts: Texts, where: dict[str, str]) -> str:
    """Return a term in words; what its letters stand for is added to the clauses."""
    if isinstance(node, ast.Constant):
        if isinstance(node.value, int | float):
            return f"{node.value:.12g}"
        return _model(_text(node), texts)
    if isinstance(node, ast.Name) and node.id == "GEOSTATIONARY":
        return texts.get("terms", node.id)
    if isinstance(node, ast.Name) and node.id in ("PI", "printed"):
        return "π" if node.id == "PI" else texts.get("terms", node.id)
    if isinstance(node, ast.Attribute):
        return _part(node, texts, where)
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id in ("row", "text"):
        keys = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return _placed(" ".join(map(_text, keys)), texts)
    if isinstance(node, ast.Call):
        return _call(node, texts, where)
    if isinstance(node, ast.List | ast.Tuple):
        return f"({', '.join(_said(entry, texts, where) for entry in node.elts)})"
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return f"-{_said(node.operand, texts, where)}"
    if isinstance(node, ast.BinOp) and type(node.op) in _SIGNS:
        return _worked_out(node, texts, where)
    raise Unsaid


def _worked_out(node: ast.BinOp, texts: Texts, where: dict[str, str]) -> str:
    here = _BINDING[type(node.op)]
    if isinstance(node.op, ast.Pow) and isinstance(node.right, ast.Constant) and node.right.value == 1:
        return _said(node.left, texts, where)
    sides = []
    for side in (node.left, node.right):
        loose = isinstance(side, ast.BinOp) and _BINDING.get(type(side.op), 0) < here
        loose = loose or _name(side) == "quantity"
        said = _letter(side, texts, where) if _is_prose(side) else _said(side, texts, where)
        sides.append(f"({said})" if loose else said)
    return _SIGNS[type(node.op)].join(sides)


def _is_prose(node: ast.expr) -> bool:
    """Tell whether a term is in words, which a formula needs a letter for."""
    call = node.value if isinstance(node, ast.Attribute) else node
    return not (isinstance(call, ast.Call) and _name(call) in ("quantity", "matlab")) and isinstance(
        node, ast.Attribute | ast.Call
    )


def _letter(node: ast.expr, texts: Texts, where: dict[str, str]) -> str:
    """Return the letter of a term in words, and add what it stands for to the clauses."""
    letter = _LETTERS.get(node.attr if isinstance(node, ast.Attribute) else _name(node))
    if letter is None:
        raise Unsaid
    where[letter] = _filled("stands_for", [_symbol(letter), _said(node, texts, where)], texts)
    return _symbol(letter)


def _part(node: ast.Attribute, texts: Texts, where: dict[str, str]) -> str:
    """Return a part of what is named: of an orbit, an optimum, a motion, a state or a printed program."""
    whole = node.value
    if isinstance(whole, ast.Name) and texts.find("terms", f"{whole.id}_{node.attr}"):
        return texts.get("terms", f"{whole.id}_{node.attr}")
    if not isinstance(whole, ast.Call):
        raise Unsaid
    name = _name(whole)
    if name == "matlab":
        where[node.attr] = _filled("by_program", [_symbol(node.attr), _given(whole, texts)], texts)
        return _symbol(node.attr)
    if name == "least_cost" and node.attr == "J":
        said = _filled("least_cost", [_said(whole.args[0], texts, where)], texts)
        return _filled("with", [said, _keywords(whole, texts)], texts) if whole.keywords else said
    if name == "steered" and node.attr == "end":
        return _filled("steered_end", [_said(part, texts, where) for part in whole.args], texts)
    if name == "difference":
        return _filled(name, [_symbol(node.attr), *_sides(whole.args[0], whole.args[1], texts)], texts)
    raise Unsaid


def _call(node: ast.Call, texts: Texts, where: dict[str, str]) -> str:
    name = _name(node)
    if name == "quantity" and isinstance(node.args[0], ast.Constant):
        return _text(node.args[0])
    if name == "constant":
        return _filled(name, [_symbol(_text(node.args[0]))], texts)
    if name == "diff":
        return _derivative(node, texts, where)
    if name == "parameter":
        return _filled(name, [_said(node.args[0], texts, where), _symbol(_text(node.args[1]))], texts)
    if name not in _PHRASES or node.keywords:
        raise Unsaid
    return _filled(name, _arguments(node, texts)[: _ARGUMENTS.get(name, 1)], texts)


def _derivative(node: ast.Call, texts: Texts, where: dict[str, str]) -> str:
    of, letters = node, []
    while isinstance(of, ast.Call) and _name(of) == "diff" and len(of.args) == 2:
        letter = of.args[1]
        letters.append(_symbol(letter.id if isinstance(letter, ast.Name) else _text(letter)))
        of = of.args[0]  # type: ignore[assignment]
    if len(letters) > 2 or not isinstance(of, ast.Subscript):
        raise Unsaid
    return _filled("diff" if len(letters) == 1 else "diff_twice", [_said(of, texts, where), *reversed(letters)], texts)


def _arguments(node: ast.Call, texts: Texts) -> list[str]:
    if _ARGUMENTS.get(_name(node)) == 0:
        return []
    return [_said(part, texts, {}) for part in node.args]


def _given(node: ast.Call, texts: Texts) -> str:
    """Return the numbers that a printed program starts from."""
    if not node.keywords:
        raise Unsaid
    return _keywords(node, texts)


def _keywords(node: ast.Call, texts: Texts) -> str:
    given = [(word.arg or "", _said(_only(word.value), texts, {})) for word in node.keywords]
    return texts.listed([f"`{k} = {v}`" if _NUMBER.fullmatch(v) else f"{_symbol(k)} = {v}" for k, v in given])


def _only(node: ast.expr) -> ast.expr:
    """Return the only entry of a list, as a program has for a curve of one point; all else unchanged."""
    return node.elts[0] if isinstance(node, ast.List) and len(node.elts) == 1 else node


def _value(value: str, texts: Texts) -> str:
    """Return a value as it is written in sentences."""
    if _NUMBER.fullmatch(value):
        return value
    entries = _entries(value)
    if len(entries) == 1 and _NUMBER.fullmatch(entries[0]):
        return entries[0]
    if entries and not any(entry.startswith("[") for entry in entries):
        numbers = all(_NUMBER.fullmatch(entry) for entry in entries)
        return f"({', '.join(entries)})" if numbers else texts.listed([_value(entry, texts) for entry in entries])
    if len(value) > _LONGEST_VALUE or not value or value == "[]" or "..." in value:
        raise Unsaid
    tree(value)  # refuses what is no formula
    return f"`{value}`"


def _entries(value: str) -> list[str]:
    """Return the entries of a list as texts; none for another value."""
    if not (value.startswith("[") and value.endswith("]")):
        return []
    if "..." in value:
        raise Unsaid
    return [entry.strip() for entry in divided(value[1:-1], ",")]


def _model(name: str, texts: Texts) -> str:
    return _filled("instance" if name in files.shipped() else "model", [name], texts)


def _symbol(name: str) -> str:
    return f"`{name}`"


def _placed(name: str, texts: Texts) -> str:
    """Return the name of a place in the language of the texts; a bare number is called an item."""
    said = re.sub(r"[a-z]{3,}", lambda word: texts.find("places", word[0]) or word[0], name)
    said = f"“{said}”" if "," in said else said
    return said if re.match(r"[a-z]{3,}", name) else _filled("item", [said], texts)


def _name(node: ast.expr) -> str:
    return node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""


def _text(node: ast.expr) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    raise Unsaid


def _is_printed(node: ast.expr | None) -> bool:
    return isinstance(node, ast.Name) and node.id == "printed"


def _capital(said: str) -> str:
    return f"{said[:1].upper()}{said[1:]}" if said[1:2].islower() or said[1:2] == " " else said


def _filled(key: str, parts: list[str], texts: Texts) -> str:
    return _HOLE.sub(lambda hole: parts[int(hole[1])] if int(hole[1]) < len(parts) else "", texts.get("terms", key))
