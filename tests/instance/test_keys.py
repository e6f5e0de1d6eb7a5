"""What is said of an instance file's keys is what is checked when one is read."""

from __future__ import annotations

import json
import tomllib
from copy import deepcopy
from datetime import datetime
from pathlib import Path
from typing import Any

import msgspec
import pytest

from satsym import instance
from satsym.cli import main
from satsym.cli.app import program
from satsym.instance.files import SHIPPED
from satsym.instance.keys import entries, json_schema
from satsym.instance.schema import InstanceFile, check
from satsym.report.terminal import keys as page
from satsym.status import BadInput

OF_TYPES = {"string": str | datetime, "number": int | float, "integer": int, "object": dict, "array": list}


def faults(value: Any, schema: dict[str, Any], place: str = "") -> list[str]:
    """Where a value is not what a schema says, as far as this one needs."""
    if "anyOf" in schema:
        each = [faults(value, one, place) for one in schema["anyOf"]]
        return [] if [] in each else each[0]
    if not isinstance(value, OF_TYPES[schema["type"]]) or value not in schema.get("enum", [value]):
        return [place]
    if isinstance(value, dict):
        known, other = schema.get("properties", {}), schema.get("additionalProperties", {})
        found = [f"{place}.{name}" for name in schema.get("required", ()) if name not in value]
        for name, entry in value.items():
            one = known.get(name, other)
            found += faults(entry, one, f"{place}.{name}") if one else [f"{place}.{name}"]
        return found
    if isinstance(value, list):
        kinds = schema.get("prefixItems", [schema.get("items")] * len(value))
        return [f for entry, kind in zip(value, kinds, strict=True) for f in faults(entry, kind, place)]
    limits = {"minimum": lambda v, m: v >= m, "maximum": lambda v, m: v <= m, "exclusiveMinimum": lambda v, m: v > m}
    return [place for key, holds in limits.items() if key in schema and not holds(value, schema[key])]


def test_the_page_is_what_the_schema_says() -> None:
    assert page.FILE.read_text(encoding="utf-8") == page.page(), "make derive"


def test_every_key_is_listed_with_its_meaning_and_commands_that_there_are() -> None:
    listed = {(entry.table, entry.name) for entry in entries()}
    assert len(listed) == len(entries()) > 35
    commands = {command.split()[0] for entry in entries() for command in entry.key.commands} - {"all"}
    assert commands <= set(program.commands)
    for entry in entries():
        assert entry.key.meaning
        assert entry.kind
        assert entry.required is False or not entry.default
    text = page.keys_text()
    assert all(entry.name in text for entry in entries())


def test_every_key_can_be_written_with_its_default() -> None:
    law, sky = {"follows": "theta", "command": 1.0}, {"epoch": datetime(2026, 3, 20)}
    required = {"model": "a", "initial": {}, "time": {"tf": 1.0}, "classical": law, "study": {}, "orbit": sky}
    plain = msgspec.to_builtins(check(required))
    for entry in entries():
        if entry.default:
            tree = deepcopy(required)
            table = tree
            for part in filter(None, entry.table.split(".")):
                table = table.setdefault(part, {})
            table[entry.name] = tomllib.loads(f"value = {entry.default}")["value"]
            assert msgspec.to_builtins(check(tree)) == plain


@pytest.mark.parametrize("path", sorted(SHIPPED.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_instances_suit_the_schema_for_editors(path: Path) -> None:
    assert faults(tomllib.loads(path.read_text(encoding="utf-8")), json_schema()) == []


@pytest.mark.parametrize(
    ("tree", "place"),
    [
        ({"time": {"tf": 1.0, "tff": 2.0}}, ".time.tff"),
        ({"title": 3}, ".title"),
        ({"solver": {"method": "swep"}}, ".solver.method"),
        ({"solver": {"steps": 1}}, ".solver.steps"),
        ({"guess": {"state": {"r": [1.0, True, []]}}}, ".guess.state.r"),
    ],
)
def test_what_is_refused_does_not_suit_the_schema_either(tree: dict[str, Any], place: str) -> None:
    whole = {"model": "polar_orbit", "initial": {}, "time": {"tf": 1.0}} | tree
    assert place in faults(whole, json_schema())
    with pytest.raises(BadInput):
        check(whole)


def test_the_command_shows_keys_schema_and_files(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["instances", "--keys"]) == 0
    assert "tf_guess" in capsys.readouterr().out
    assert main(["instances", "--schema"]) == 0
    assert set(json.loads(capsys.readouterr().out)["properties"]) == set(InstanceFile.__struct_fields__)
    assert main(["instances", "soft-return"]) == 0
    assert capsys.readouterr().out == (SHIPPED / "soft-return.toml").read_text(encoding="utf-8")
    assert main(["instances", "soft-return", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["model"] == instance.load("soft-return").model.spec.name
    assert main(["instances", "soft-retrun"]) == 3
    assert 'did you mean "soft-return"?' in capsys.readouterr().err
    assert main(["instances", "--keys", "--schema"]) == 2


def test_the_example_of_the_page_is_an_instance(tmp_path: Path) -> None:
    example = page.HEAD.partition("```toml\n")[2].partition("```")[0]
    (tmp_path / "example.toml").write_text(example, encoding="utf-8")
    assert instance.load(tmp_path / "example.toml").tf == 86400.0
