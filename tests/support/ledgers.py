"""Small ledgers, as the tests of the audit need them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from satsym.auditing import Judged, Ledger, audit, locate, read
from satsym.auditing.ledger import documents


def whole(document: str) -> str:
    """The text of a shipped ledger, its chapters one after the other: a ledger in one file."""
    return "\n".join(path.read_text(encoding="utf-8") for path in documents.files_of(locate(document)))


HEAD = """
format = 1
[document]
key = "small"
title = "A small document"
authors = "A. Writer"
year = 2024
model = "polar_orbit"
numbers = ["1", "2"]

[symbols]
lam = "1/s"
m = { unit = "kg", positive = true }
k = ""

[inputs]
altitude = "35786 km"

[scope.main]
states = ["x1", "x2", "x3", "x4"]
x1 = "r"
x2 = "r_dot"
x3 = "theta"
x4 = "theta_dot"
d_x1 = "d_r"
d_x2 = "d_r_dot"
d_x3 = "d_theta"
d_x4 = "d_theta_dot"
u1 = "u1"
u2 = "u2"
sigma = "sigma"
omega = "omega"
g = "mu"
m = "m"
c1 = "c1"
c2 = "c2"
lambda1 = "lambda_r"
lambda2 = "lambda_r_dot"
lambda3 = "lambda_theta"
lambda4 = "lambda_theta_dot"
d_lambda1 = "d_lambda_r"
d_lambda2 = "d_lambda_r_dot"
d_lambda4 = "d_lambda_theta_dot"
H = "H"
p = "k"
r = "r"

[scope.deviations]
extends = "main"
states = ["x1", "x3", "x2", "x4"]
x1 = "r - sigma"

[scope.eigen]
lambda = "lam"
omega = "omega"
sigma = "sigma"
"""

HAMILTONIAN = (
    "H = (c1*u1**2 + c2*u2**2)/2 + lambda1*x2 + lambda2*(x1*x4**2 - sigma**3*omega**2/x1**2 + u1) "
    "+ lambda3*x4 + lambda4*(-2*x2*x4/x1 + u2/x1)"
)
TANGENTIAL = "polar_orbit:first_order.theta_dot"

Row = Mapping[str, Any]


def row(item: str, printed: Any, holds: str, kind: str = "equation", **more: Any) -> Row:
    """A row of a ledger."""
    return {"item": item, "kind": kind, "printed": printed, "holds": holds, **more}


def text(rows: Sequence[Row], head: str = HEAD) -> str:
    """A ledger as text; JSON of texts, lists and truth values is TOML, too."""
    blocks = ["\n".join(f"{key} = {_toml(value)}" for key, value in entry.items()) for entry in rows]
    return head + "".join(f"\n[[row]]\n{block}\n" for block in blocks)


def write(folder: Path, rows: Sequence[Row], head: str = HEAD) -> Path:
    """A ledger as a file."""
    path = folder / "small.toml"
    path.write_text(text(rows, head), encoding="utf-8")
    return path


def ledger(folder: Path, rows: Sequence[Row], head: str = HEAD) -> Ledger:
    """A ledger, read."""
    return read(write(folder, rows, head))


def judged(folder: Path, rows: Sequence[Row], head: str = HEAD) -> dict[str, Judged]:
    """Rows by their keys, judged."""
    return {found.key: found for found in audit(ledger(folder, rows, head))}


def _toml(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items()) + " }"
    return json.dumps(value)
