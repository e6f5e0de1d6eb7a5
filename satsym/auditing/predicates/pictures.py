"""What a printed program draws: where it comes from, in which units, and whether it shows what it is said to show."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.programs import function, lines_of, printed_program, walked
from satsym.auditing.program import text as programs
from satsym.auditing.program.run import run
from satsym.status import BadInput

_SEED = 43
_TRIES = 10
_IMPORT = "import matplotlib.pyplot as plt"
_BRACKET = re.compile(r"\(([^)]*)\)")


@predicate
def picture_depends_on(row: Question, program: str, name: str) -> Finding:
    """Whether what is drawn is made from a name at all, by following where each value comes from."""
    whole = printed_program(row, program)
    calls = programs.calls_on(whole, "plt")
    drawn = set().union(*(programs.names_in(part) for call, _ in calls for part in (*call.args, *call.keywords)))
    made_from = programs.sources(whole, drawn)
    shown_by = [called for _, called in calls if called in ("show", "savefig")]
    return Finding(
        name in made_from,
        f"it is drawn from {', '.join(sorted(drawn))}, which come from {', '.join(sorted(made_from - drawn))}",
        {"calls of matplotlib": len(calls), "calls that show or save": len(shown_by)},
        remark=f"it looks the same whatever {name} is, so that it can neither prove nor refute what is said of it",
    )


@predicate
def draws_undistorted(row: Question) -> Finding:
    """Whether the picture keeps shapes: one unit is as long along both axes."""
    found = run(programs.read([_IMPORT, *lines_of(row)]))
    equal = any(d.name == "axis" and d.arguments == ("equal",) for d in found.drawn)
    size = next((d.named["figsize"] for d in found.drawn if "figsize" in d.named), (1, 1))
    return Finding(
        equal,
        f"both axes have one scale; without it a circle would be drawn {size[0]} wide and {size[1]} high"
        if equal
        else f"a circle is drawn {size[0]} wide and {size[1]} high",
        {"width": float(size[0]), "height": float(size[1]), "axis equal": equal},
    )


@predicate
def marks_the_centre(row: Question, program: str, rates: str) -> Finding:
    """Whether the printed point is where the listed pull points to, from wherever one stands."""
    found = walked(row, program)
    (mark,) = run(programs.read([_IMPORT, *lines_of(row)])).drawn
    point = np.array([float(np.ravel(mark.arguments[0])[0]), float(np.ravel(mark.arguments[1])[0]), 0.0])
    rng, worst = np.random.default_rng(_SEED), 0.0
    near = float(np.linalg.norm(found.values["r0"]))
    for _ in range(_TRIES):
        state = np.concatenate([near * rng.uniform(-1.0, 1.0, 3), np.zeros(3)])
        pull, way = np.array(function(found, rates)(0.0, state))[3:], point - state[:3]
        worst = max(worst, 1.0 - float(pull @ way / np.linalg.norm(pull) / np.linalg.norm(way)))
    return Finding(worst < 1e-9, f"so, but for {worst:.0e}", {"largest 1 - cosine": worst})


@predicate
def axis_unit(row: Question, name: str) -> Finding:
    """Whether a coordinate is divided by the unit that its axis is labelled with: a line that draws, and a label."""
    lines = lines_of(row)
    factor = _divisor(lines, name)
    labels = [match[1] for d in run(programs.read([_IMPORT, *_labels(lines)])).drawn
              for match in [_BRACKET.search(str(d.arguments[0]))] if match]  # fmt: skip
    if factor is None or len(labels) != 1:
        raise BadInput("axis_unit: print the line that draws name/number, and one label with a unit in brackets")
    unit = quantities.in_base_units(f"1 {labels[0].lower()}")
    drawn, length = factor / unit.value, dict(quantities.in_base_units("1 m").dimension)
    return Finding(
        abs(drawn - 1.0) < 1e-3,
        f"{factor:g} m is {drawn:.4f} {labels[0]}, so that the mean distance of the Earth is drawn at "
        f"{quantities.in_base_units('1 au').value / factor:.4f}",
        {"drawn unit, in the unit of the label": drawn},
        unit=dict(unit.dimension) == length,
        remark=f"the axis is in units of {factor:g} m; divide by {unit.value:.10g} to have {labels[0]}",
    )


@predicate
def label_is_true(row: Question, program: str, word: str, velocities: tuple[str, ...]) -> Finding:
    """Whether the picture is labelled with a word exactly where the program's own rule finds it.

    The program is walked through with its own initial velocity and with others. A label that is the same whatever is
    drawn comes from the program's text, and not from any computation.

    Parameters
    ----------
    word
        That the label has and that means stable.
    velocities
        Others, with their units, along the program's own.
    """
    said = next(d.named["label"] for d in run(programs.read([_IMPORT, "x = 1.0", "y = 1.0", *lines_of(row)])).drawn)
    labels, verdicts = [], []
    for velocity in [None, *velocities]:
        found = walked(row, program, along(row, program, velocity) if velocity else ())
        labels.append(next(d.named["label"] for d in found.drawn if d.name == "plot"))
        verdicts.append(bool(found.values["stability"]))
    agree = sum((word in str(label)) == verdict for label, verdict in zip(labels, verdicts, strict=True))
    fixed = set(labels) == {said}
    return Finding(
        agree == len(labels),
        f"in {len(labels) - agree} of {len(labels)} runs the rule of the program says otherwise",
        {
            "runs": len(labels),
            "labelled so": sum(word in str(label) for label in labels),
            "stable by the rule": sum(verdicts),
        },
        artefact=fixed,
        remark="the label is written into the program, and the same for whatever is drawn" if fixed else "",
    )


def along(row: Question, program: str, speed: str) -> tuple[float, ...]:
    """A velocity of another size in the direction of the program's own."""
    own = np.asarray(walked(row, program).values["v0"])
    return tuple(float(v) for v in own / np.linalg.norm(own) * quantities.in_base_units(speed).value)


def _divisor(lines: Sequence[str], name: str) -> float | None:
    """The number by which a name is divided where it is drawn."""
    for statement in programs.read(lines).statements:
        for node in ast.walk(statement):
            if (
                isinstance(node, ast.BinOp)
                and isinstance(node.op, ast.Div)
                and isinstance(node.left, ast.Name)
                and node.left.id == name
                and isinstance(node.right, ast.Constant)
                and isinstance(node.right.value, int | float)
            ):
                return float(node.right.value)
    return None


def _labels(lines: Sequence[str]) -> list[str]:
    return [line for line in lines if "label(" in line]
