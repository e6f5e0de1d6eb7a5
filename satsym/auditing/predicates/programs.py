"""Printed Python programs: what they do when they are walked through, against what is derived."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from satsym import kernels
from satsym.arrays import Array
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.program import text as programs
from satsym.auditing.program.run import Run, run
from satsym.auditing.program.text import Program, Stops
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_SEED = 41
_TRIES = 10
_ROUNDING = 1e-12
_ALIKE = 0.8
"""Share of letters in common from which two names are taken for one that was typed in two ways."""
_PRELUDE = ("import numpy as np", "mu = 1.0")
"""What a function of its own needs: NumPy, and a number for mu, which is put in."""


def printed_program(row: Question, key: str | tuple[str, ...]) -> Program:
    """The program that another row prints, or several do one after the other.

    Raises
    ------
    BadInput
        If no row of that name prints lines.
    """
    found: list[str] = []
    for name in (key,) if isinstance(key, str) else key:
        lines = row.document.get(name)
        if not isinstance(lines, tuple) or not lines:
            raise BadInput(f"no row {shown(name)} prints a program; {suggestion(name, _programs(row))}")
        found += map(str, lines)
    return programs.read(found)


def _programs(row: Question) -> list[str]:
    return [key for key, printed in row.document.items() if isinstance(printed, tuple)]


def lines_of(row: Question) -> list[str]:
    """The lines that a row prints."""
    return [row.printed] if isinstance(row.printed, str) else [str(line) for line in row.printed]


def walked(row: Question, key: str, velocity: Sequence[float] = ()) -> Run:
    """The program of another row, walked through, with another initial velocity ``v0`` if one is given."""
    return _walked(printed_program(row, key).text, tuple(velocity))


@cache
def _walked(text: str, velocity: tuple[float, ...]) -> Run:
    return run(programs.read(text.splitlines()), {"v0": np.array(velocity)} if velocity else None)


@cache
def _alone(lines: tuple[str, ...], mu: float) -> Run:
    """Lines by themselves, after a prelude."""
    return run(programs.read([*_PRELUDE, *lines]), {"mu": mu})


def function(found: Run, name: str) -> Any:
    """A function of a program.

    Raises
    ------
    BadInput
        If it has none of that name.
    """
    value = found.values.get(name)
    if not callable(value):
        raise BadInput(f"the program has no function {shown(name)}; {suggestion(name, list(found.values))}")
    return value


def _state(rng: np.random.Generator) -> Array:
    return rng.uniform(0.4, 1.3, 6) * rng.choice([-1.0, 1.0], 6)


@predicate
def listed_rates(row: Question, name: str, model: str) -> Finding:
    """Whether a printed function gives the derived rates of a model without control, at random states and mu."""
    rng, worst = np.random.default_rng(_SEED), 0.0
    system = kernels.load(model)
    for _ in range(_TRIES):
        mu, state = float(rng.uniform(0.5, 2.0)), _state(rng)
        found = np.array(function(_alone(tuple(lines_of(row)), mu), name)(0.0, state))
        derived = np.array(system.dynamics(0.0, tuple(state), (0.0,) * len(system.spec.controls), (mu,)))
        worst = max(worst, float(np.abs(found - derived).max() / np.abs(derived).max()))
    return Finding(
        worst < _ROUNDING,
        f"the rates are those derived, but for {worst:.0e}",
        {"states": _TRIES, "largest relative difference": worst},
        f"satsym derive {model}",
    )


@predicate
def listed_jacobian(row: Question, name: str, model: str) -> Finding:
    """Whether a printed function gives the derived Jacobian, and whether it depends on the velocity it is given."""
    rng, worst, moved = np.random.default_rng(_SEED), 0.0, 0.0
    system = kernels.load(model)
    for _ in range(_TRIES):
        mu, state = float(rng.uniform(0.5, 2.0)), _state(rng)
        listed = function(_alone(tuple(lines_of(row)), mu), name)
        found = np.array(listed(state[:3], state[3:]))
        derived = np.array(system.jacobian_x(0.0, tuple(state), (0.0,) * len(system.spec.controls), (mu,)))
        worst = max(worst, float(np.abs(found - derived.reshape(6, 6)).max() / np.abs(derived).max()))
        moved = max(moved, float(np.abs(np.array(listed(state[:3], 2.0 * state[3:])) - found).max()))
    return Finding(
        worst < _ROUNDING,
        f"the matrix is that derived, but for {worst:.0e}; it does {'not ' if moved == 0.0 else ''}depend on the "
        "velocity that the function is given",
        {"states": _TRIES, "largest relative difference": worst, "change with twice the velocity": moved},
        f"satsym derive {model}",
    )


@predicate
def linearises(row: Question, program: str, jacobian: str, rates: str) -> Finding:
    """Whether a listed Jacobian is that of the listed rates: by a complex step through the printed lines."""
    found, rng, worst, step = walked(row, program), np.random.default_rng(_SEED), 0.0, 1e-20
    near = float(np.linalg.norm(found.values["r0"]))
    for _ in range(_TRIES):
        state = _state(rng) * np.array([near] * 3 + [1e4] * 3)
        given = np.array(function(found, jacobian)(state[:3], state[3:]))
        for k in range(6):
            shifted = state.astype(complex)
            shifted[k] += 1j * step * abs(state[k])
            column = np.array(function(found, rates)(0.0, shifted)).imag / (step * abs(state[k]))
            scale = np.abs(given[:, k]).max()
            worst = max(worst, float(np.abs(column - given[:, k]).max() / scale))
    return Finding(worst < _ROUNDING, f"so but for {worst:.0e}", {"states": _TRIES, "largest difference": worst})


@predicate
def runs_through(row: Question) -> Finding:
    """Whether a printed program goes from its first line to its last: it is parsed and walked through."""
    listing = programs.read(lines_of(row))
    loose = programs.loose_names(listing)
    try:
        found = _walked(listing.text, ())
    except Stops as error:  # what is not known here, or takes too much, is no fault of the program
        return Finding(False, str(error), {"statements": len(listing.statements), "names without a value": len(loose)})
    return Finding(
        not loose,
        f"its {len(listing.statements)} statements are walked through; it ends with '{found.said[-1]}'"
        if found.said
        else f"its {len(listing.statements)} statements are walked through",
        {"statements": len(listing.statements), "names without a value": len(loose), "printed": len(found.said)},
    )


@predicate
def stands_in(row: Question, program: str) -> Finding:
    """Whether every printed line stands in the whole program as well, so that what is found there holds for it."""
    whole = {line.strip() for line in printed_program(row, program).text.splitlines()}
    missing = [line.strip() for line in lines_of(row) if line.strip() not in whole]
    return Finding(
        not missing,
        f"not in the whole program: {missing[0]}" if missing else "all its lines stand there",
        {"lines": len(lines_of(row)), "not there": len(missing)},
    )


@predicate
def has_value(row: Question, program: str | tuple[str, ...], names: tuple[str, ...], elsewhere: str) -> Finding:
    """Whether names have a value where a printed line of a program uses them.

    Where they have none, but another program of the document gives them one, under which each looks like a name that
    is there, it is a slip.
    """
    listing, other = (printed_program(row, key) for key in (program, elsewhere))
    lines = {line.strip() for line in lines_of(row)}
    loose = sorted(
        {found.name for found in programs.loose_names(listing) if found.line in lines and found.name in names}
    )
    given = [name for statement in listing.statements for name in programs.given_names(statement)]
    meant = {name: difflib.get_close_matches(name, given, 1, _ALIKE) for name in loose}
    right_there = not programs.loose_names(other)
    return Finding(
        not loose,
        f"no value there for: {' and '.join(loose)}" if loose else "all of them have a value",
        {"without a value": ", ".join(loose) or "none", "right in the whole program": right_there},
        slip=bool(loose) and right_there and all(meant.values()),
        remark="; ".join(
            f"in the line that defines it, {name} is {found[0]}" if found else f"no line before gives {name} a value"
            for name, found in meant.items()
        )
        + ("; in the whole program it is right" if loose and right_there else ""),
    )


@predicate
def imports_are_used(row: Question, program: str) -> Finding:
    """Whether what is imported is there, and used by the program."""
    imported = run(programs.read(lines_of(row))).values
    whole = printed_program(row, program)
    used = {name for statement in whole.statements for name in programs.names_in(statement)}
    idle = [name for name in imported if name not in used]
    return Finding(
        not idle,
        f"{', '.join(idle)} is never used" if idle else f"{', '.join(imported)}: all used",
        {"imported": len(imported), "never used": len(idle)},
    )


@predicate
def made_from(row: Question, program: str, name: str, of: str, without: str) -> Finding:
    """Whether one value of a program is made from another and not from a third, by following where each comes from."""
    whole = programs.sources(printed_program(row, program), [name])
    return Finding(
        of in whole and without not in whole,
        f"{name} is made from {', '.join(sorted(whole - {name}))}",
        {f"from {of}": of in whole, f"from {without}": without in whole},
    )
