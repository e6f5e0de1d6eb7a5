"""What is said to people of the equilibria of an attitude in orbit."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from satsym.report.results.equilibria import axis
from satsym.report.said import each, message, say
from satsym.report.terminal.solution import joined
from satsym.report.terminal.table import figure, table

if TYPE_CHECKING:
    from satsym.symbolic.equilibria.survey import Attitudes


def attitudes_text(found: Attitudes) -> str:
    """Summary of the equilibria."""
    kinds = Counter(one.kind.value for one in found.equilibria)
    listed = ", ".join(f"{count} {message(kind)}" for kind, count in sorted(kinds.items()))
    header = (*each("nadir in the body", "normal of the orbit, reversed"), "")
    attitudes = [
        (_vector(one.cosines[2]), _vector(one.cosines[1]), message(one.kind.value)) for one in found.equilibria
    ]
    parts = [
        [say("equilibria: <number>; <kinds>", number=_number(found), kinds=listed)],
        table([header, *sorted(attitudes)]),
    ]
    if found.followed is not None:
        changes = [
            (
                say("<low> to <high>", low=f"{c.below:.7g}", high=f"{c.above:.7g}"),
                say("<low> to <high>", low=c.counts[0], high=c.counts[1]),
                *map(_kinds, c.kinds),
            )
            for c in found.followed.changes
        ]
        last = figure(float(found.followed.values[-1]))
        bracket = say("change as <name> grows to <value>", name=found.parameter, value=last)
        parts.append(table([(bracket, *each("number", "kinds below", "kinds above")), *changes]))
    return joined(parts)


def _number(found: Attitudes) -> str:
    """How many there are, or what the infinitely many are."""
    whole = found.continuum
    if whole is None:
        return say("<count> attitudes (<number> with complex ones)", count=found.count, number=found.complex)
    if whole.circles is None:
        text = "a continuum of dimension <n> (counting complex ones), which is not resolved"
        return say(text, n=whole.dimension)
    text = "a continuum: <n> circles, by turns about the body's <axis>, one attitude of each below"
    return say(text, n=len(whole.circles), axis=axis(whole))


def _kinds(found: object) -> str:
    assert isinstance(found, dict)
    return ", ".join(f"{count} {message(kind.value)}" for kind, count in found.items())


def _vector(values: object) -> str:
    return "(" + ", ".join(f"{round(value, 4) + 0.0:7.4f}" for value in values) + ")"  # type: ignore[attr-defined]
