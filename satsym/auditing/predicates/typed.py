"""What can be said of a typed listing, and of references inside a document, without running anything."""

from __future__ import annotations

import re

import numpy as np

from satsym.auditing.ledger import documents
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.instance import files

_NAME = re.compile(r"[A-Za-z_]\w*")
_PAIRS = {")": "(", "]": "["}
_EIGEN = ("eigenvals", "eigenvalues", "eigenvectors", "eigenvects")
"""Functions of Maple's package linalg whose names begin with eig (Maple 15, overview of the linalg package)."""


@predicate
def brackets_close(row: Question) -> Finding:
    """Whether each bracket of a typed line is closed by its own kind."""
    open_: list[tuple[str, int]] = []
    for i, character in enumerate(str(row.printed)):
        if character in _PAIRS.values():
            open_.append((character, i))
        elif character in _PAIRS:
            if not open_ or open_[-1][0] != _PAIRS[character]:
                expected = f"{open_[-1][0]} of column {open_[-1][1] + 1} is still open" if open_ else "nothing is open"
                return Finding(False, f"in column {i + 1} {character} closes, but {expected}", {"column": i + 1})
            open_.pop()
    return Finding(not open_, "all brackets close" if not open_ else f"{len(open_)} are never closed", {})


@predicate
def names_have_values(row: Question, known: tuple[str, ...]) -> Finding:
    """Whether every name on the right of a line has a value from a line before it, or is known."""
    given, missing = set(known), []
    for line in row.printed:
        target, _, right = str(line).partition("=")
        missing += [name for name in _NAME.findall(right) if name not in given]
        given.add(target.strip())
    return Finding(
        not missing,
        f"{', '.join(missing)} never gets a value" if missing else "every name has a value",
        {"without a value": ", ".join(missing) or "none"},
    )


@predicate
def in_linalg(name: str) -> Finding:
    """Whether Maple's package linalg has a function for eigenvalues of that name."""
    return Finding(
        name in _EIGEN,
        f"linalg has {', '.join(_EIGEN)}; {name} is given back as it stands",
        {"names": ", ".join(_EIGEN)},
    )


@predicate
def listed_field(model: str) -> Finding:
    """Whether A times (x1, x2)' are the rates of a model: at random states."""
    from satsym.symbolic.lookup.library import derivation

    found, equations = analysis(model).system, derivation(model).step("first_order").equations
    rng, worst = np.random.default_rng(1), 0.0
    for _ in range(10):
        values = dict(zip(found.states, rng.uniform(-1.0, 1.0, len(found.states)), strict=True))
        rates = [float(e.rhs.xreplace({s: values[s.name] for s in e.rhs.free_symbols})) for e in equations]
        worst = max(worst, float(np.abs(numeric(found.a, {}) @ np.array(list(values.values())) - rates).max()))
    return Finding(worst < 1e-12, f"they differ by {worst:.0e} at most", {"largest difference": worst})


@predicate
def names_an_item(document: str, item: str) -> Finding:
    """Whether a document numbers anything so, by the list of its numbers in the ledger."""
    numbers = files.read(documents.files_of(documents.locate(document))[0])["document"]["numbers"]
    word = item.partition(" ")[0]
    there = [number for number in numbers if number.partition(" ")[0] == word]
    return Finding(
        item in numbers,
        f"there is no {item}; the document has {', '.join(there[:3])}{' ...' if len(there) > 3 else ''}",
        {f"numbers of this kind ({word})": len(there)},
    )
