"""Instance files that went wrong, drawn at random from shipped ones: values, keys, text, and what is no text."""

from __future__ import annotations

import json
import os
import random
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from satsym.instance.files import SHIPPED

SECONDS = 0.2
"""What a solver may take, unless that is what went wrong."""

WRONG: tuple[str, ...] = (
    *("nan", "inf", "-inf", "1e308", "-1e308", "5e-324", "0", "-0.0", "9" * 400, "9" * 5000, "true", "1979-05-27"),
    *('""', '"free"', '"reference"', '"5 km"', '"1 deg"', '"1 parsec/fortnight"', '"1e400 km"', '"5 km**9**9"', "'km'"),
    *('"\u202e\u0000x"'.replace("\u0000", ""), '"θ ± 5"', '"' + "x" * 3000 + '"', "[]", "[[]]", "[1, [2, [3]]]"),
    *("[1e308, -1e308]", "[0, 0]", "[" * 500 + "]" * 500, "{}", "{a = 1}", "-1", "1", "2", "1e-9", "1e6", "0x7fffffff"),
)
NAMES = ("x", "r", "theta", "u1", "steps", '""', '"\u202e"', "__proto__", '"a.b"', "tf", "Q", "model")


def mutated(rng: random.Random, folder: Path) -> tuple[Path, str]:
    """A file of this kind, and what kind."""
    source = rng.choice(sorted(SHIPPED.glob("*.toml")))
    tree = tomllib.loads(source.read_text(encoding="utf-8"))
    tree.setdefault("solver", {}).update({"max_seconds": SECONDS, "steps": rng.choice([2, 10, 200])})
    path = folder / f"{source.stem}.toml"
    mutate = rng.choice(MUTATIONS)
    mutate(rng, tree, path)
    return path, mutate.__name__


def value_changed(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    for _ in range(rng.choice([1, 1, 2, 4])):
        table, key = _leaf(rng, tree)
        table[key] = _Raw(rng.choice(WRONG))
    path.write_text(_text(tree), encoding="utf-8")


def number_scaled(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    for _ in range(rng.choice([1, 1, 3])):
        table, key = rng.choice(_numbers(tree))
        factors = [-1, 0, 1e-12, 1e-3, 0.5, 0.9, 1.1, 2, 10, 1e3, 1e12, 1e200]
        table[key] = type(table[key])(min(table[key] * rng.choice(factors), 1e300))
    path.write_text(_text(tree), encoding="utf-8")


def key_changed(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    table, key = _leaf(rng, tree)
    value = table[key]
    if rng.random() < 0.6:
        del table[key]
    if rng.random() < 0.6:
        table[rng.choice(NAMES)] = value
    path.write_text(_text(tree), encoding="utf-8")


def table_changed(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    key = rng.choice(list(tree))
    value = tree.pop(key)
    if rng.random() < 0.7:
        tree[rng.choice(["lqr", "guess", "control", "final", "classical", "limits", "switching", "solver", "odd"])] = (
            value
        )
    path.write_text(_text(tree), encoding="utf-8")


def text_changed(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    content = bytearray(_text(tree).encode())
    for _ in range(rng.choice([1, 3, 20])):
        place = rng.randrange(len(content))
        choice = rng.random()
        if choice < 0.4:
            content[place] = rng.randrange(256)
        elif choice < 0.7:
            del content[place : place + rng.randrange(1, 9)]
        else:
            content[place:place] = rng.choice(
                [b'"', b"[", b"]", b"=", b"\n", b"\x00", b"\xff", "é".encode(), b"9" * 30]
            )
        content = content or bytearray(b"\n")
    path.write_bytes(content)


def no_instance(rng: random.Random, tree: dict[str, Any], path: Path) -> None:
    kind = rng.choice(
        ["pipe", "folder", "zero", "loop", "missing", "huge", "sparse", "deep", "dotted", "binary", "empty"]
    )
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind in ("zero", "loop"):
        path.symlink_to("/dev/zero" if kind == "zero" else path)
    elif kind == "sparse":
        path.touch()
        os.truncate(path, 2**40)
    elif kind != "missing":
        contents = {
            "huge": _text(tree) + "# x" * 600_000,
            "deep": "a = " + "[" * 100_000,
            "dotted": ".".join("a" * 5000) + " = 1",
            "binary": "\x7fELF\x00",
            "empty": "",
        }
        path.write_text(contents[kind], encoding="utf-8")


MUTATIONS: tuple[Callable[[random.Random, dict[str, Any], Path], None], ...] = (
    *(value_changed, value_changed, value_changed, number_scaled, number_scaled, number_scaled),
    *(key_changed, table_changed, text_changed, no_instance),
)


class _Raw(str):
    """A value as it is to be written."""


def _leaf(rng: random.Random, tree: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """A table and a key in it, at any depth, whose value is no table with anything in it."""
    table = tree
    while True:
        key = rng.choice(list(table))
        if not (isinstance(table[key], dict) and table[key]):
            return table, key
        table = table[key]


def _numbers(tree: dict[str, Any]) -> list[tuple[dict[str, Any], str]]:
    """Tables and keys of all numbers, but for what limits the time."""
    found = [(tree, key) for key, value in tree.items() if type(value) in (int, float) and key != "max_seconds"]
    return found + [each for value in tree.values() if isinstance(value, dict) for each in _numbers(value)]


def _text(tree: dict[str, Any], name: str = "") -> str:
    """The tree as TOML."""
    plain = {key: value for key, value in tree.items() if not isinstance(value, dict)}
    lines = [f"[{name}]"] if name else []
    lines += [f"{key} = {_value(value)}" for key, value in plain.items()]
    tables = [_text(value, f"{name}.{key}" if name else key) for key, value in tree.items() if isinstance(value, dict)]
    return "\n".join([*lines, "", *tables])


def _value(value: Any) -> str:
    if isinstance(value, _Raw):
        return str(value)
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool | str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)
