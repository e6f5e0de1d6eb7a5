"""The ``[control]`` table of an instance: bounds by control, and norms by set."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from satsym.control_part import SWITCHED, ControlPart
from satsym.instance.resolve import Row, quantity
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

MAX_NORM, MIN_NORM = "max_norm", "min_norm"
WHOLE = ""
"""The name of the set of all controls, where there is only one set."""

Norms = dict[str, tuple[float, float]]
"""The least and the largest norm, by the name of the set."""


def bounds(table: Mapping[str, Any], spec: ProblemSpec) -> tuple[Row, Row, Norms]:
    """Return lower and upper bounds in the model's order, and norms by set; infinite where none is given."""
    lower = dict.fromkeys(spec.control_names, -math.inf)
    upper = dict.fromkeys(spec.control_names, math.inf)
    norms: Norms = {}
    sets = {part.name: part for part in spec.control_parts}
    normed = [part for part in spec.control_parts if part.normed]
    for name, value in table.items():
        key = f"[control] {printable(name)}"
        if name in sets and name in spec.control_names and name not in sets[name].controls:
            others = ", ".join(sets[name].controls)
            raise BadInput(
                f"{key}: the name {printable(name)} denotes both a control and the set of {others}; give the set "
                "another name"
            )
        if name in sets and not (name in spec.control_names and isinstance(value, tuple)):
            norms |= _of_set(value, sets[name], spec, f"[control.{name}]")
        elif name in (MAX_NORM, MIN_NORM) and len(normed) == 1:
            whole = {k: v for k, v in table.items() if k in (MAX_NORM, MIN_NORM)}
            norms |= _of_set(whole, normed[0], spec, "[control]")
        elif name == MAX_NORM and spec.control_set == "ball":
            norms[WHOLE] = (0.0, _norm(value, spec.controls[0].unit, key))
        elif isinstance(value, Mapping) or name in (MAX_NORM, MIN_NORM):
            raise BadInput(f"{key}: {_control_set(spec)}")
        else:
            if name not in spec.control_names:
                taken = (*spec.control_names, *sets, *_norms_of(spec))
                raise BadInput(f"{key}: the model has no such control; {suggestion(name, taken)}")
            if spec.control_set != "box" and _part_of(name, spec) != "box":
                raise BadInput(f"{key}: {_control_set(spec)}")
            unit = spec.controls[spec.control_names.index(name)].unit
            lower[name], upper[name] = _interval(value, unit, key)
    _refuse_endless(spec, norms)
    needed = {
        c: "H need not be convex in this control" for part in spec.control_parts if part.ends for c in part.controls
    }
    switched = (
        c for part in spec.control_parts if part.branch in SWITCHED and part.kind == "box" for c in part.controls
    )
    needed |= dict.fromkeys(switched, "the cost has no term in the square of this control")
    for name, reason in needed.items():
        if not math.isfinite(lower[name]) or not math.isfinite(upper[name]):
            raise BadInput(f"[control] {name}: {reason}, so it needs both bounds; write {name} = [lower, upper]")
    for part in spec.control_parts:
        if part.turned_by and lower[part.controls[0]] < 0.0:
            (name,) = part.controls
            raise BadInput(
                f"[control] {name}: this control is the magnitude of a vector with the direction "
                f"{part.turned_by}, so it must not be negative; write {name} = [0, upper]"
            )
    return tuple(lower.values()), tuple(upper.values()), norms


def _norms_of(spec: ProblemSpec) -> tuple[str, ...]:
    """Return the keys that limit norms without naming their set."""
    kinds: list[str | None] = [part.kind for part in spec.control_parts if part.normed]
    found = {"ball": (MAX_NORM,), "annulus": (MIN_NORM, MAX_NORM)}
    return found.get((kinds or [spec.control_set])[0] or "", ()) if len(kinds) <= 1 else ()


def _refuse_endless(spec: ProblemSpec, norms: Norms) -> None:
    """Refuse a vector on which H depends linearly and whose length is not limited."""
    for part in spec.control_parts:
        if part.branch != "quadratic" and part.normed and part.name not in norms:
            raise BadInput(
                f"[control.{part.name}]: {', '.join(part.controls)} have no bounds, and the cost has no term "
                f"in their squares; write {MAX_NORM} = a number"
            )


def _of_set(value: Any, part: ControlPart, spec: ProblemSpec, key: str) -> Norms:
    """Read the norms of one set."""
    taken = {"ball": (MAX_NORM,), "annulus": (MIN_NORM, MAX_NORM)}.get(part.kind, ())
    if not isinstance(value, Mapping) or not taken:
        raise BadInput(f"{key}: {_control_set(spec)}")
    if odd := [name for name in value if name not in taken]:
        raise BadInput(f"{key} {printable(odd[0])}: {suggestion(odd[0], taken)}")
    unit = spec.controls[spec.control_names.index(part.controls[0])].unit
    least, largest = (
        _norm(value[name], unit, f"{key} {name}") if name in value else default
        for name, default in ((MIN_NORM, 0.0), (MAX_NORM, math.inf))
    )
    if least > largest:
        raise BadInput(f"{key}: {MIN_NORM} is above {MAX_NORM}; swap them")
    return {part.name: (least, largest)}


def _norm(value: Any, unit: str, key: str) -> float:
    if isinstance(value, tuple):
        raise BadInput(f"{key}: got a list of {len(value)}; give one positive number")
    number = quantity(value, unit, key)
    if number <= 0:
        raise BadInput(f"{key}: a bound of {shown(value)} admits no control; give a positive number")
    return number


def _interval(value: Any, unit: str, key: str) -> tuple[float, float]:
    if not isinstance(value, tuple):
        raise BadInput(f"{key}: got {shown(value)}; give both bounds, such as [-0.2, 0.2]")
    low, high = (quantity(bound, unit, key) for bound in value)
    if low > high:
        raise BadInput(f"{key}: the lower bound {shown(value[0])} exceeds the upper bound {shown(value[1])}; swap them")
    return low, high


def _part_of(control: str, spec: ProblemSpec) -> str:
    """Return the kind of the set that contains a control."""
    return next((part.kind for part in spec.control_parts if control in part.controls), "")


def _control_set(spec: ProblemSpec) -> str:
    """Describe the keys that the model's kind of control set allows."""
    if spec.control_parts:
        return "the model takes " + "; ".join(map(_taken, spec.control_parts))
    return {
        "box": f"the model bounds its controls one by one; write {spec.control_names[0]} = [lower, upper], and so on",
        "ball": f"the model bounds the norm of its controls; write {MAX_NORM} = a number",
        "free": "the model's controls are free; remove this bound",
        None: "the model has no cost, hence no control set; remove this bound",
    }[spec.control_set]


def _taken(part: ControlPart) -> str:
    """Describe the keys that one set allows."""
    controls = ", ".join(part.controls)
    return {
        "free": f"no bound of {controls}",
        "angle": f"no bound of the angle {controls}",
        "box": f"{part.controls[0]} = [lower, upper]",
        "ball": f"{MAX_NORM} in [control.{part.name}], of {controls}",
        "annulus": f"{MIN_NORM} and {MAX_NORM} in [control.{part.name}], of {controls}",
    }[part.kind]
