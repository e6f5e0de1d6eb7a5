"""What a printed program answers: its rule of stability, its integration, and what it says of other orbits."""

from __future__ import annotations

import ast

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.orbits.elements import elements
from satsym.analysis.orbits.kepler import propagate
from satsym.auditing import quantities
from satsym.auditing.constants import PUBLISHED
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.linear_rules import BLOCKS
from satsym.auditing.predicates.pictures import along
from satsym.auditing.predicates.programs import lines_of, walked
from satsym.auditing.program import text as programs
from satsym.auditing.program.run import Run, run
from satsym.status import BadInput
from satsym.wording import shown

_PIXELS = 1000
"""Across the picture that the program draws, ten inches wide."""
_YEARS = {
    "a calendar year": "365 d",
    "a Julian year": "365.25 d",
    "a sidereal year": PUBLISHED["sidereal_year"].quantity,
}


def spectrum(block: str) -> NDArray[np.complex128]:
    """The eigenvalues of a block of :data:`BLOCKS`; a root that is double is computed to half the digits only."""
    return np.round(np.linalg.eigvals(np.array(BLOCKS[block][0])).astype(complex), 6)


@predicate
def rule_decides(row: Question) -> Finding:
    """Whether the printed line ``stability = ...`` calls linear systems stable exactly where motions stay bounded.

    It is given the eigenvalues of blocks whose motions are known.
    """
    wrong, right = [], 0
    for block, (_, behaviour) in BLOCKS.items():
        program = programs.read(["eigenvalues = 0.0", *lines_of(row)])
        said = bool(run(program, {"eigenvalues": spectrum(block)}).values["stability"])
        right += said == (behaviour != "grows")
        wrong += [block] if said != (behaviour != "grows") else []
    return Finding(
        not wrong,
        f"right for {right} of {len(BLOCKS)} kinds of systems"
        + (f", wrong for: {'; '.join(wrong)}, whose motions grow" if wrong else ""),
        {"kinds": len(BLOCKS), "right": right},
        remark="where a real part is zero, eigenvalues alone leave it open, as section II.4 says itself"
        if wrong
        else "",
    )


@predicate
def rule_is_that_of(row: Question, rule: str, line: str) -> Finding:
    """Whether a stated rule is the one in a line of the program: asked with the eigenvalues of known blocks.

    Parameters
    ----------
    rule
        The real parts that stable systems are said to have: ``negative``, or ``not positive``.
    line
        The row that prints the line.
    """
    if rule not in ("negative", "not positive"):
        raise BadInput(f"rule_is_that_of: no rule {shown(rule)}; write negative, or not positive")
    differ = []
    for block in BLOCKS:
        roots = spectrum(block)
        program = programs.read(["eigenvalues = 0.0", str(row.document[line])])
        coded = bool(run(program, {"eigenvalues": roots}).values["stability"])
        stated = bool((roots.real < 0.0).all() if rule == "negative" else (roots.real <= 0.0).all())
        differ += [block] if coded != stated else []
    return Finding(
        not differ,
        f"they differ for {len(differ)} of {len(BLOCKS)} kinds of systems: {'; '.join(differ)}"
        if differ
        else "they agree",
        {"kinds": len(BLOCKS), "differ": len(differ)},
        remark="the program counts a real part of zero as stable, the conclusion does not" if differ else "",
    )


@predicate
def says(row: Question, program: str, answer: str) -> Finding:
    """Whether the last line that the program prints ends with an answer, when it is walked through as it stands."""
    found = walked(row, program)
    largest = float(np.asarray(found.values["eigenvalues"]).real.max())
    return Finding(
        found.said[-1].rstrip().endswith(answer),
        f"it prints '{found.said[-1]}'",
        {"printed": found.said[-1], "largest real part, 1/s": largest},
        remark=f"one eigenvalue is {largest:.4g} 1/s, which its own rule calls unstable" if largest > 0.0 else "",
    )


@predicate
def prints_lines(row: Question, program: str, begins: str) -> Finding:
    """Whether a printed line of the program puts out a line that begins so; and what it is."""
    found = [line for line in walked(row, program).said if line.startswith(begins)]
    return Finding(
        len(found) == 1,
        f"it prints '{' '.join(found[0].split())}'" if found else "it prints no such line",
        {"lines": len(found)},
    )


@predicate
def tells_bound_orbits(row: Question, program: str, speeds: tuple[str, ...]) -> Finding:
    """Whether the program's answer is Yes for bound orbits and No for others: its own orbit, and other speeds."""
    answers, bound = [], []
    for speed in (None, *speeds):
        found = walked(row, program, along(row, program, speed) if speed else ())
        answers.append(found.said[-1].rstrip().endswith("Yes"))
        bound.append(_energy(found) < 0.0)
    right = sum(a == b for a, b in zip(answers, bound, strict=True))
    listed = "; ".join(
        f"{'Yes' if answer else 'No'} for one that is {'bound' if closed else 'not bound'}"
        for answer, closed in zip(answers, bound, strict=True)
    )
    return Finding(
        right == len(answers),
        f"it answers {listed}",
        {"orbits": len(answers), "bound": sum(bound), "different answers": len(set(answers))},
        "satsym analyse itb-earth",
        remark="one answer for all: the eigenvalues at a point depend on the distance alone"
        if len(set(answers)) == 1
        else "",
    )


@predicate
def integrates(row: Question, program: str) -> Finding:
    """Whether the listed integration follows the orbit in closed form, to less than a pixel of its picture."""
    found = walked(row, program)
    solution, mu = found.values["solution"].attributes, float(found.values["mu"])
    t, y = np.asarray(solution["t"]), np.asarray(solution["y"])
    position, _ = propagate(y[:3, :1], y[3:, :1], mu, t)
    size = float(np.abs(y[:3]).max())
    off = float(np.linalg.norm(y[:3] - position, axis=0).max())
    energy = 0.5 * (y[3:] ** 2).sum(axis=0) - mu / np.linalg.norm(y[:3], axis=0)
    drift = float(np.abs(energy / energy[0] - 1.0).max())
    gap = float(np.spacing(size))
    asked = _tolerances(row)
    return Finding(
        off < 2.0 * size / _PIXELS,
        f"it is off by {off:.2g} m at most, {off / size:.1e} of the distance; the energy by {drift:.1e} of itself",
        {
            "relative error of the energy": drift,
            "error of the position, m": off,
            "evaluations of the rates": found.evaluations[0],
            "gap between neighbouring floats there, m": gap,
            **({"absolute tolerance, share of the relative one": asked[1] / (asked[0] * size)} if asked else {}),
        },
        "satsym analyse itb-earth",
    )


def _tolerances(row: Question) -> tuple[float, float] | None:
    """The relative and the absolute tolerance that the printed line asks for, if it is a line that does."""
    lines = lines_of(row)
    if "solve_ivp" not in lines[0]:
        return None
    calls = [node for node in ast.walk(programs.read(lines).statements[0]) if isinstance(node, ast.Call)]
    named = {keyword.arg: ast.unparse(keyword.value) for call in calls for keyword in call.keywords}
    return float(named["rtol"]), float(named["atol"])


@predicate
def one_year(row: Question) -> Finding:
    """Whether a printed time is a year, of whatever kind, to the printed digits."""
    printed = quantities.printed_number(str(row.printed))
    unit = quantities.scale(printed.unit)
    years = {name: quantities.in_base_units(text).value / unit for name, text in _YEARS.items()}
    fits = [n for n, value in years.items() if abs(value - float(printed.value)) <= float(printed.half_unit)]
    listed = ", ".join(f"{name} {value:.6g} {printed.unit}" for name, value in years.items())
    return Finding(bool(fits), f"{' and '.join(fits) or 'none of them'} rounded so: {listed}", years)


@predicate
def turns_once(row: Question, program: str) -> Finding:
    """Whether the program follows its orbit for one revolution, to the digits of the printed time."""
    found = walked(row, program)
    orbit = elements(found.values["r0"], found.values["v0"], float(found.values["mu"]))
    last = float(found.values["t_span"][1])
    turns = last / orbit.period if orbit.period else 0.0
    return Finding(
        abs(turns - 1.0) < 1e-3,
        f"its period is {orbit.period:.5g} s, so that it is followed for {turns:.5f} revolutions",
        {"period, s": float(orbit.period or 0.0), "revolutions": turns, "eccentricity": float(orbit.eccentricity)},
        "satsym analyse itb-earth",
    )


@predicate
def becomes_unbound(row: Question, program: str, readings: tuple[str, ...]) -> Finding:
    """Whether raising the speed lets the body leave, for any reading of what is added, and what the rule says then."""
    own = walked(row, program)
    start, mu = np.asarray(own.values["r0"]), float(own.values["mu"])
    escape = float(np.sqrt(2.0 * mu / np.linalg.norm(start)))
    short = escape - float(np.linalg.norm(own.values["v0"]))
    leaves, parts = [], {}
    for reading in readings:
        speed = float(np.linalg.norm(own.values["v0"])) + quantities.in_base_units(reading).value
        found = walked(row, program, along(row, program, f"{speed!r} m/s"))
        orbit = elements(start, found.values["v0"], mu)
        leaves.append(not orbit.bound)
        parts[f"eccentricity with {reading} more"] = float(orbit.eccentricity)
        parts[f"largest real part with {reading} more, 1/s"] = float(np.asarray(found.values["eigenvalues"]).real.max())
    same = len({value for name, value in parts.items() if name.startswith("largest")}) == 1
    return Finding(
        any(leaves),
        f"it stays on a closed ellipse: only {short:.0f} m/s more would let it leave, at {escape:.0f} m/s",
        {**parts, "speed of escape, m/s": escape},
        "satsym analyse itb-earth-kicked",
        remark="the eigenvalues are the same as before, too" if same else "",
    )


def _energy(found: Run) -> float:
    r0, v0 = (np.asarray(found.values[name], dtype=float) for name in ("r0", "v0"))
    return float(0.5 * v0 @ v0 - float(found.values["mu"]) / np.linalg.norm(r0))
