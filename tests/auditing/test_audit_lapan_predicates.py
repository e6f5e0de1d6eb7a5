"""The predicates behind the ledger of lapan_pitch can say yes and no: of things put right, and of others put wrong."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import pytest

from satsym.auditing.predicates import Finding, Question, registry
from tests.support.ledgers import whole

LEDGER = tomllib.loads(whole("lapan_pitch"))
INPUTS = LEDGER["inputs"]
PRINTED = {f"{row['item']} {row.get('part', '')}".strip(): row.get("printed", "") for row in LEDGER["row"]}
ROW = Question("row", "claim", "", (), INPUTS, "main", {}, PRINTED)


def ask(predicate: str, text: str = "", inputs: dict | None = None, rows: dict | None = None, **words) -> Finding:
    """What a predicate finds, given a row if it wants one; some numbers and rows of the document replaced."""
    found = registry()[predicate]
    if "row" in found.__code__.co_varnames[: found.__code__.co_argcount]:
        words["row"] = replace(ROW, printed=text, inputs=INPUTS | (inputs or {}), document=PRINTED | (rows or {}))
    return found(**words)


@pytest.mark.parametrize("axis", ["roll", "yaw"])
def test_the_acceleration_of_the_wheel_turns_roll_and_yaw(axis):
    assert ask("wheel_couples", axes=(axis,)).holds


def test_it_does_not_turn_the_gimbals():
    assert not ask("wheel_couples", axes=("roll gimbal",)).holds
