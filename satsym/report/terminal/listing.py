"""Lists of models and instances, and one model in full, as plain text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from satsym.report.results.objects import bounded
from satsym.report.terminal.table import figure, fitting, table, wrapped
from satsym.spec import ProblemSpec, Variable

if TYPE_CHECKING:
    from satsym.instance import Instance


MOST = 4
"""Names of a model that fit in its line; `satsym models MODEL` has all."""


def models_text(specs: Iterable[ProblemSpec]) -> str:
    """A line for each model."""
    header = ("model", "states", "controls", "title")
    rows = [(s.name, _few(s.state_names), _few(s.control_names), s.title) for s in specs]
    return "\n".join(table([header, *rows], indent=""))


def _few(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= MOST else f"{', '.join(names[: MOST - 1])} ... {len(names)} in all"


def instances_text(instances: Iterable[Instance]) -> str:
    """A line for each instance."""
    header = ("instance", "model", "type", "final time", "bounded", "title")
    rows = [
        (
            each.name,
            each.model.spec.name,
            str(each.boundary_type),
            "free" if each.tf is None else figure(each.tf),
            "yes" if bounded(each) else "no",
            each.title,
        )
        for each in instances
    ]
    return "\n".join(table([header, *rows], right=(2, 3), indent=""))


def model_text(spec: ProblemSpec) -> str:
    """Everything that an instance of the model can name."""
    blocks = [
        [spec.title, f"{spec.name}, from {spec.source}: {_control_set(spec)}"],
        _variables("state", spec.states),
        _variables("control", spec.controls),
        _variables("parameter", spec.parameters),
    ]
    if spec.has_reference:
        blocks.append(wrapped('It has a reference: [final] may say "reference" for any state.'))
    return "\n\n".join("\n".join(part for line in block for part in fitting(line)) for block in blocks if block)


def _control_set(spec: ProblemSpec) -> str:
    """What limits the controls, in words."""
    kinds = {"free": "any control", "box": "each control between its bounds", "ball": "bounded norm"}
    kinds |= {"annulus": "norm between its bounds", "angle": "any angle"}
    if spec.control_parts:
        return "; ".join(f"{part.name} ({', '.join(part.controls)}): {kinds[part.kind]}" for part in spec.control_parts)
    return kinds[spec.control_set] if spec.control_set else "no cost"


def _variables(word: str, variables: Iterable[Variable]) -> list[str]:
    rows = [
        (v.symbol, "" if v.default is None else figure(v.default), "" if v.unit == "1" else v.unit, v.meaning)
        for v in variables
    ]
    return table([(word, "default", "unit", "meaning"), *rows], right=(1,)) if rows else []
