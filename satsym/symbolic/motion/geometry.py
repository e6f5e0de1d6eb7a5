"""The geometry that a model declares, as the points and arrows of a picture.

A particle has its position, unit vectors and forces; deviations from a reference are arrows along which they move the
particle; bodies that turn about one axis have their angle and the sense of their turns; a body that turns in space has
its axes, turned from those of the orbit, and the sense of each angle.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import atan2, cos, hypot, isclose, pi, sin
from typing import Any

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.model import Model, Particle, symbols_of, t, variables_of

TIME, ANGLE, FACTOR_OFF_REFERENCE = 0.6, 0.75, 1.3
"""Time at which the reference is drawn, drawn value of angles, and factor of positive states off the reference."""
CURVE = tuple(2 * pi * k / 48 for k in range(49))
"""Times of the points on the drawn reference curve."""
TURNED = 0.25
"""Drawn value of each angle of a body in space, in rad."""
OBLIQUE = ((1.0, 0.0), (-0.62, -0.42), (0.0, -1.0))
"""Directions on the page of axes that point forward, towards the reader and down."""
AXES_ON_PAGE = ((-0.35, -0.5), (1.0, 0.0), (0.0, 1.0))
"""Directions on the page of inertial axes: towards the reader, to the right and up."""
SPREAD = (0.7, 1.7, 1.3)
"""Drawn values of the components of a position in space, where they are coordinates."""
ROUND = tuple(-2.1 + 0.2 * k for k in range(22))
"""Angles of the points of an arrow about an axis, in rad."""


def bodies(model: Model, angle: sp.Symbol, names: tuple[str, ...]) -> Picture:
    """Draw bodies about a common axis, and one of their angles."""
    latex = next(v.latex for v in model.states if v.symbol == angle.name)
    return Picture("bodies", angle=(ANGLE, latex), bodies=names)


def attitude(matrix: sp.Matrix, angles: Iterable[Variable]) -> Picture | None:
    """Draw the axes of the orbit and of a body, whose matrix of direction cosines has orbital axes as rows."""
    turned = {s: v for v in angles for s in symbols_of((v,)) if s in matrix.free_symbols}
    rest = dict.fromkeys(matrix.free_symbols, sp.Integer(0))
    if matrix.subs(rest) != sp.eye(3):
        return None
    turns = []
    for symbol, variable in turned.items():
        rate = matrix.diff(symbol).subs(rest)
        axis = (float(rate[2, 1]), float(rate[0, 2]), float(rate[1, 0]))
        if sorted(map(abs, axis)) == [0.0, 0.0, 1.0]:
            turns.append((_about(axis), variable.latex))
    shown = matrix.subs(rest | dict.fromkeys(turned, TURNED))
    arrows = [Arrow((0, 0), OBLIQUE[k], (f"{name}_0",)) for k, name in enumerate("xyz")]
    arrows += [Arrow((0, 0), _on_page(shown[:, k]), (name,)) for k, name in enumerate("xyz")]
    return Picture("attitude", arrows=tuple(arrows), turns=tuple(turns)) if turns else None


def _about(axis: tuple[float, float, float]) -> tuple[Place, ...]:
    """Return an arrow that turns about an axis in the positive sense, near the end of the axis."""
    k = next(k for k, part in enumerate(axis) if part)
    one, other = (k + 1) % 3, (k + 2) % 3
    points = []
    for angle in ROUND:
        place = [0.0, 0.0, 0.0]
        place[k] = 1.1
        place[one], place[other] = 0.14 * cos(angle), 0.14 * axis[k] * sin(angle)
        points.append(_on_page(place))
    return tuple(points)


def _on_page(vector: Any) -> Place:
    x, y = (sum(float(part) * towards[i] for part, towards in zip(vector, OBLIQUE, strict=True)) for i in range(2))
    return x, y


def motion(model: Particle, directions: Mapping[str, sp.Matrix]) -> Picture | None:
    """Draw a particle in a plane or in space, with unit vectors and forces."""
    if len(model.position) not in (2, 3):
        return None
    values = _values(model)
    moving = symbols_of(v for v in model.states if v.positive)
    values |= {s: values[s] * FACTOR_OFF_REFERENCE for s in moving}
    values |= {
        s: far for s, far in zip(model.position, SPREAD, strict=False) if len(model.position) == 3 and s.is_Symbol
    }
    place, flat = _at(model.position, values), len(model.position) == 2
    if hypot(*place) == 0:
        return None
    pointing: dict[tuple[float, ...], list[str]] = {}
    for direction, label in _labelled(model, directions):
        parts = tuple(float(part) for part in sp.Matrix(direction).subs(values))
        if size := hypot(*parts):
            pointing.setdefault(tuple(round(part / size, 6) for part in parts), []).append(label)
    size = 0.45 * hypot(*place)
    arrows = [Arrow((0, 0), place, (_distance(model, values),))]
    for parts, labels in pointing.items():
        x, y = parts if flat else _from_aside(parts)
        arrows.append(Arrow(place, (place[0] + size * x, place[1] + size * y), tuple(labels)))
    if flat:
        return Picture("motion", _path(model), tuple(arrows), _angle(model, values, place))
    below = _at([*model.position[:2], 0], values)
    return Picture("motion", _path(model), tuple(arrows), axes=AXES_ON_PAGE, guides=((place, below), (below, (0, 0))))


def _labelled(model: Particle, directions: Mapping[str, sp.Matrix]) -> Iterator[tuple[Any, str]]:
    """Return unit vectors and forces with labels; a force of a single control has the name of the control."""
    latex = {v.symbol: v.latex for v in model.controls}
    for name, direction in directions.items():
        yield direction, model.names(None)[name]
    for name, force in model.forces.items():
        controls = [latex[s.name] for s in sp.Matrix(force).free_symbols if s.name in latex]
        if len(controls) < 2:
            yield force, controls[0] if controls else rf"\mathbf{{F}}_{{\text{{{name}}}}}"


def _distance(model: Particle, values: Mapping[sp.Symbol, Any]) -> str:
    """Return the coordinate that is the distance from the centre, or else the position vector."""
    far = hypot(*(float(part) for part in model.position.subs(values)))
    lengths = [v for v in model.states if isclose(float(values[symbols_of((v,))[0]]), far, rel_tol=1e-9)]
    return lengths[0].latex if len(lengths) == 1 else r"\mathbf{r}"


def _angle(model: Particle, values: Mapping[sp.Symbol, Any], place: Place) -> tuple[float, str] | None:
    angles = [v for v in model.states if v.kind == "angle"]
    seen = atan2(place[1], place[0])
    return next(((seen, v.latex) for v in angles if isclose(float(values[symbols_of((v,))[0]]), seen)), None)


def deviations(
    model: Model, of: Particle, about: Mapping[sp.Symbol, Any], changed: Mapping[sp.Symbol, Any]
) -> Picture | None:
    """Draw where each deviation alone moves the body, to first order, from a point of the reference."""
    old, new = symbols_of(of.states), symbols_of(model.states)
    values = _values(of) | {s: sp.sympify(about[s]).subs(_numbers(of)).subs(t, TIME) for s in old}
    changes = sp.Matrix([changed[s] for s in new]).jacobian(old).subs(values)
    if changes.rows != changes.cols or changes.det() == 0:
        return None
    moves = of.position.jacobian(old).subs(values) * changes.inv()
    place, heights = _at(of.position[:2], values), of.position[2:]
    if any(sp.sympify(height).subs(about).subs(values) != 0 for height in heights):
        return None  # the reference does not lie in the plane of the picture
    far = 0.45 * hypot(*place)
    arrows = [Arrow((0, 0), place, ())]
    for k, v in enumerate(model.states):
        x, y = (float(moves[i, k]) for i in range(2))
        if size := hypot(x, y):
            arrows.append(Arrow(place, (place[0] + far * x / size, place[1] + far * y / size), (v.latex,)))
    return Picture("deviations", _path(of, about), tuple(arrows)) if hypot(*place) and len(arrows) > 1 else None


def _path(model: Particle, about: Mapping[sp.Symbol, Any] | None = None) -> tuple[Place, ...]:
    """Return points of the reference at equal steps of time."""
    curve = about or model.reference
    if not curve:
        return ()
    position = model.position.subs(curve).subs(_numbers(model))
    return tuple(_at(position[:2] if about else position, {t: time}) for time in CURVE)


def _numbers(model: Model) -> dict[sp.Symbol, Any]:
    """Return the default values of parameters, one where there is none, and the constants that follow."""
    numbers: dict[sp.Symbol, Any] = {
        s: 1 if v.default is None else v.default
        for s, v in zip(symbols_of(model.parameters), model.parameters, strict=True)
    }
    return numbers | {symbols_of((d.variable,))[0]: d.value.subs(numbers) for d in model.definitions}


def _values(model: Model) -> dict[sp.Symbol, Any]:
    """Return numbers for all moving variables: those of the reference where there is one."""
    numbers = _numbers(model) | {t: TIME}
    everything = variables_of(model)
    values = {s: ANGLE if v.kind == "angle" else 1 for s, v in zip(symbols_of(everything), everything, strict=True)}
    return values | numbers | {s: sp.sympify(c).subs(numbers) for s, c in model.reference.items()}


def _at(vector: Any, values: Mapping[sp.Symbol, Any]) -> Place:
    """Return the place of a vector on the page; vectors in space are projected obliquely."""
    parts = [float(part) for part in sp.Matrix(vector).subs(values)]
    return (parts[0], parts[1]) if len(parts) == 2 else _from_aside(parts)


def _from_aside(parts: Iterable[float]) -> Place:
    x, y = (sum(part * towards[i] for part, towards in zip(parts, AXES_ON_PAGE, strict=True)) for i in range(2))
    return x, y


Place = tuple[float, float]


@dataclass(frozen=True)
class Arrow:
    """An arrow with its ends and the names, as LaTeX, of what it shows."""

    start: Place
    end: Place
    labels: tuple[str, ...]


@dataclass(frozen=True)
class Picture:
    """The parts of a drawing, in a unit of length that suits it.

    Attributes
    ----------
    kind
        Key of what it shows: a motion, deviations, bodies, an attitude.
    path
        Points of the reference.
    arrows
        From the centre, and where the body is.
    angle
        That of the body as seen from the centre, and its name; none if no coordinate is that angle.
    bodies
        Names of concentric bodies.
    turns
        Arrows about axes, each with the name of the angle.
    axes
        Where the inertial axes point.
    guides
        Lines that show depth, from where to where.
    """

    kind: str
    path: tuple[Place, ...] = ()
    arrows: tuple[Arrow, ...] = ()
    angle: tuple[float, str] | None = None
    bodies: tuple[str, ...] = ()
    turns: tuple[tuple[tuple[Place, ...], str], ...] = ()
    axes: tuple[Place, ...] = ((1.0, 0.0), (0.0, 1.0))
    guides: tuple[tuple[Place, Place], ...] = ()
