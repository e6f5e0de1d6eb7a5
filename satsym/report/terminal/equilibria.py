"""What is said to people of the equilibria of an attitude in orbit."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from satsym.report.results.equilibria import axis
from satsym.report.terminal.solution import joined
from satsym.report.terminal.table import figure, table

if TYPE_CHECKING:
    from satsym.symbolic.equilibria.survey import Attitudes


def attitudes_text(found: Attitudes) -> str:
    """Summary of the equilibria."""
    kinds = Counter(each.kind.value for each in found.equilibria)
    listed = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    header = ("nadir in the body", "normal of the orbit, reversed", "")
    attitudes = [(_vector(each.cosines[2]), _vector(each.cosines[1]), each.kind.value) for each in found.equilibria]
    parts = [[f"equilibria: {_number(found)}; {listed}"], table([header, *sorted(attitudes)])]
    if found.followed is not None:
        changes = [
            (f"{c.below:.7g} to {c.above:.7g}", f"{c.counts[0]} to {c.counts[1]}", *map(_kinds, c.kinds))
            for c in found.followed.changes
        ]
        bracket = f"change as {found.parameter} grows to {figure(float(found.followed.values[-1]))}"
        parts.append(table([(bracket, "number", "kinds below", "kinds above"), *changes]))
    return joined(parts)


def _number(found: Attitudes) -> str:
    """How many there are, or what the infinitely many are."""
    whole = found.continuum
    if whole is None:
        return f"{found.count} attitudes ({found.complex} with complex ones)"
    if whole.circles is None:
        return f"a continuum of dimension {whole.dimension} (counting complex ones), which is not resolved"
    circles = f"{len(whole.circles)} circles, by turns about the body's {axis(whole)}"
    return f"a continuum: {circles}, one attitude of each below"


def _kinds(found: object) -> str:
    assert isinstance(found, dict)
    return ", ".join(f"{count} {kind.value}" for kind, count in found.items())


def _vector(values: object) -> str:
    return "(" + ", ".join(f"{round(value, 4) + 0.0:7.4f}" for value in values) + ")"  # type: ignore[attr-defined]
