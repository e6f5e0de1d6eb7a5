"""The geometry of a model as a TikZ picture."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from math import cos, degrees, hypot, sin

from satsym.report.latex.tex import escape
from satsym.report.texts import Texts
from satsym.symbolic.model import Model
from satsym.symbolic.motion.geometry import Arrow, Picture, Place
from satsym.symbolic.switching.phase_plane import PhasePlane

SIZE = 2.6
"""Distance of the body from the centre, in cm."""

WIDE, HIGH = 3.2, 2.2
"""Coordinates of the ends of the switching curve in a phase plane, in cm from the target."""

COVERING = "fill=white,inner sep=1pt,outer sep=3pt"
"""TikZ options of a name that covers the lines below it."""

_WORD = re.compile(r"\\text\{([^}]*)\}")


def figure(model: Model, texts: Texts, label: str) -> str:
    """Return a sentence and the figure of a model's geometry, with a caption; empty without a drawable geometry."""
    found = model.picture()
    if found is None:
        return ""
    caption = texts.get("figures", found.kind) + (f" {texts.get('figures', 'path')}" if found.path else "")
    return f"{texts.get('figures', 'shown', label=label)}\n{_floating(DRAWN[found.kind](found), caption, texts, label)}"


def phase_figure(shown: PhasePlane, named: Callable[[str], str], texts: Texts, label: str) -> str:
    """Draw the phase plane of a switching curve, with the sentence that leads to it.

    Parameters
    ----------
    named
        Returns the LaTeX of a symbol by its name.
    """
    caption = texts.get("figures", "phase_plane", control=named(shown.control))
    sentence = texts.get("figures", "phase_plane_shown", label=label)
    return f"{sentence}\n{_floating(_phase_plane(shown, named), caption, texts, label)}"


def _floating(lines: Iterator[str], caption: str, texts: Texts, label: str) -> str:
    body = "\n".join(f"  {line};" for line in lines)
    body = _WORD.sub(lambda word: rf"\text{{{escape(texts.phrase(word[1]))}}}", body)
    return (
        f"\\begin{{figure}}[!htb]\n\\centering\n\\begin{{tikzpicture}}[>=stealth]\n{body}\n"
        f"\\end{{tikzpicture}}\n\\caption{{{caption}}}\\label{{{label}}}\n\\end{{figure}}"
    )


def _phase_plane(shown: PhasePlane, named: Callable[[str], str]) -> Iterator[str]:
    """Draw axes, trajectories, the switching curve, and on either side of it the bound that applies."""
    far = max(abs(q) for q, _ in shown.curve)
    high = max(abs(v) for _, v in shown.curve)

    def at(place: Place) -> str:
        x, y = (round(part, 3) + 0.0 for part in (WIDE * place[0] / far, HIGH * place[1] / high))
        return f"({x:.3f},{y:.3f})"

    def through(points: tuple[Place, ...]) -> str:
        return "plot coordinates {" + " ".join(map(at, points)) + "}"

    yield rf"\draw[->,black!50] {at((-1.6 * far, 0))} -- {at((1.6 * far, 0))} node[right] {{${named(shown.position)}$}}"
    yield rf"\draw[->,black!50] {at((0, -1.15 * high))} -- {at((0, 1.2 * high))} node[above] {{${named(shown.rate)}$}}"
    for first, second in shown.trajectories:
        half = len(first) // 2
        yield rf"\draw[->,blue!60!black] {through(first[: half + 1])}"
        yield rf"\draw[blue!60!black] {through(first[half:])}"
        yield rf"\draw[->,blue!60!black,thick] {through(second[: len(second) // 2])}"
    yield rf"\draw[very thick] {through(shown.curve)}"
    control = named(shown.control)
    yield rf"\node at {at((-1.0 * far, -0.75 * high))} {{${control} = {named(shown.rising)}$}}"
    yield rf"\node at {at((1.0 * far, 0.75 * high))} {{${control} = {named(shown.falling)}$}}"
    yield r"\fill (0,0) circle (2pt)"


def _space(shown: Picture) -> Iterator[str]:
    """Draw inertial axes, the reference, and arrows with their names."""
    first, *others = shown.arrows
    scale = SIZE / hypot(*first.end)
    far = 1.25 * SIZE
    for axis in shown.axes:
        yield rf"\draw[->,black!50] (0,0) -- {_at(axis, far)}"
    for one, other in shown.guides:
        yield rf"\draw[densely dotted,black!50] {_at(one, scale)} -- {_at(other, scale)}"
    if shown.path:
        yield r"\draw[dashed,black!50] plot[smooth] coordinates {" + " ".join(_at(p, scale) for p in shown.path) + "}"
    yield rf"\draw (0,0) -- {_at(first.end, scale)}" + (
        rf" node[{'pos=0.3' if shown.guides else 'midway'},above left] {_names(first)}" if first.labels else ""
    )
    if shown.angle:
        turn, name = degrees(shown.angle[0]), shown.angle[1]
        yield rf"\draw[->] (0.9,0) arc (0:{turn:.1f}:0.9)"
        yield rf"\node at ({turn / 2:.1f}:1.15) {{${name}$}}"
    beside = "above left" if shown.guides else "below right"
    for arrow in others:
        start, end = _at(arrow.start, scale), _at(arrow.end, scale)
        yield rf"\draw[->,thick] {start} -- {end}"
    for arrow in others:  # after all lines, none of which crosses a name
        yield rf"\node[{_side(arrow, beside)},{COVERING}] at {_at(arrow.end, scale)} {_names(arrow)}"
    yield rf"\fill (0,0) circle (1.5pt) {_at(first.end, scale)} circle (2pt)"


def _bodies(shown: Picture) -> Iterator[str]:
    """Draw concentric bodies, each with the sense of its turn, and the angle from its reference direction."""
    for k, name in enumerate(shown.bodies):
        radius = SIZE * (len(shown.bodies) - k) / (len(shown.bodies) + 0.5)
        yield rf"\draw (0,0) circle ({radius:.2f})"
        yield rf"\draw[->,thick] (100:{radius:.2f}) arc (100:150:{radius:.2f})"
        yield rf"\node[above] at (-90:{radius:.2f}) {{$\omega_{{\text{{{name}}}}}$}}"
    if shown.angle:
        turn, name = degrees(shown.angle[0]), shown.angle[1]
        far, arc = 1.25 * SIZE, 1.1 * SIZE
        yield rf"\draw[dashed,black!50] (0,0) -- ({far:.2f},0)"
        yield rf"\draw (0,0) -- ({far * cos(shown.angle[0]):.2f},{far * sin(shown.angle[0]):.2f})"
        yield rf"\draw[->] ({arc:.2f},0) arc (0:{turn:.1f}:{arc:.2f}) node[midway,right] {{${name}$}}"
    yield r"\fill (0,0) circle (1.5pt)"


def _attitude(shown: Picture) -> Iterator[str]:
    """Draw axes of the orbit, those of the body, and the sense of each angle."""
    far = 1.3 * SIZE
    for k, arrow in enumerate(shown.arrows):
        look, along = (",black!50", 1.3) if k < 3 else (",thick", 0.95)
        x, y = arrow.end
        side = "right" if x > abs(y) else "below" if abs(x) < abs(y) and y < 0 else "left" if x < 0 else "above"
        side = "below" if side == "left" and k >= 3 else side  # not on the name of the orbit's axis beside it
        yield rf"\draw[->{look}] (0,0) -- {_at(arrow.end, along * far)} node[{side}] {_names(arrow)}"
    for points, name in shown.turns:
        yield r"\draw[->] plot[smooth] coordinates {" + " ".join(_at(p, far) for p in points) + "}"
        x, y = points[0]
        yield rf"\node at {_at((x + 0.08, y + 0.05), far)} {{${name}$}}"
    yield r"\fill (0,0) circle (1.5pt)"


DRAWN: dict[str, Callable[[Picture], Iterator[str]]] = {
    "motion": _space,
    "deviations": _space,
    "bodies": _bodies,
    "attitude": _attitude,
}


def _at(place: Place, scale: float) -> str:
    x, y = (round(scale * part, 3) + 0.0 for part in place)
    return f"({x:.3f},{y:.3f})"


def _names(arrow: Arrow) -> str:
    return "{$" + r",\, ".join(arrow.labels) + "$}"


def _side(arrow: Arrow, beside: str) -> str:
    """Return the side of an arrow's name: beyond its head, or beside an arrow that points back to the centre."""
    x, y = (b - a for a, b in zip(arrow.start, arrow.end, strict=True))
    if x * arrow.start[0] + y * arrow.start[1] < 0 and abs(x * arrow.start[1] - y * arrow.start[0]) < 1e-6:
        return beside
    return f"{'above' if y > 0 else 'below'} {'right' if x > 0 else 'left'}"
