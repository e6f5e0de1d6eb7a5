"""Which unstated choices make the printed program print what it printed: a search over a stated range."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from satsym.auditing.predicates import its_listing

GUESSES = (0.0, *(m * 10.0**-k for k in (4, 3, 2, 1) for m in (1.0, 2.0, 5.0)), 1.0)
"""Constant controls to begin with that are tried."""
STEPS = range(10, 2001)
"""Numbers of steps that are tried."""
RULES: Mapping[str, str] = {
    "all nodes": "sum over all n + 1 nodes, times h",
    "all but the last": "sum over the nodes but the last, times h",
    "trapezium": "trapezium rule",
}
"""Ways to integrate c1 u1^2 + c2 u2^2 that are tried; the listing does not show the one that was used."""
TRIAL_STEPS = 300
TF, START, SIGMA, OMEGA = 60.0, (1.0, 1.0, 1.0, 1.0), 1.0, 1.0
"""What the thesis states: section 4.5 and table 4.1."""


@dataclass(frozen=True)
class Process:
    """A way to get the printed numbers.

    Attributes
    ----------
    guess
        The constant control to begin with.
    rule
        Key of :data:`RULES`.
    fewest, most
        Smallest and largest number of steps that gives them all; every number between does, too.
    sweeps
        How often the loop is executed before it ends.
    """

    guess: float
    rule: str
    fewest: int
    most: int
    sweeps: int


@cache
def run(c1: float, c2: float, n: int, guess: float) -> its_listing.Run:
    """The printed program for weights, a number of steps and a constant guess."""
    return its_listing.run((c1, c2), n, [(guess, guess)] * (n + 1), tf=TF, start=START, sigma=SIGMA, omega=OMEGA)


def cost(u: Sequence[tuple[float, float]], c1: float, c2: float, step: float, rule: str) -> float:
    """J of controls at nodes."""
    density = [0.5 * (c1 * a * a + c2 * b * b) for a, b in u]
    total = sum(density)
    if rule == "all but the last":
        total -= density[-1]
    elif rule == "trapezium":
        total -= 0.5 * (density[0] + density[-1])
    return total * step


def processes(table: Sequence[tuple[float, float, str]], control: str) -> list[Process]:
    """All ways within the range that give the printed costs and the printed control, to half a unit in the last place.

    Parameters
    ----------
    table
        c1, c2 and the printed J.
    control
        The printed control.
    """
    found = []
    for guess in guesses_for(control):
        trial = run(*table[0][:2], TRIAL_STEPS, guess)
        for rule in RULES:
            good = [n for n in STEPS if all(agrees(_constant(trial, c1, c2, n, rule), j) for c1, c2, j in table)]
            if good and len(good) == good[-1] - good[0] + 1:
                found.append(Process(guess, rule, good[0], good[-1], trial.sweeps))
    return found


def guesses_for(control: str) -> list[float]:
    """Guesses from which the printed program ends with the printed control at all nodes, whatever the weights."""
    ends = {guess: run(1.0, 1.0, TRIAL_STEPS, guess).u for guess in GUESSES}
    return [guess for guess, u in ends.items() if all(agrees(value, control) for node in u for value in node)]


def _constant(trial: its_listing.Run, c1: float, c2: float, n: int, rule: str) -> float:
    """J with the constant control of a trial, on another number of steps."""
    (a, b), h = trial.u[0], TF / n
    nodes = {"all nodes": n + 1, "all but the last": n, "trapezium": n}[rule]
    return 0.5 * (c1 * a * a + c2 * b * b) * nodes * h


def agrees(value: float, printed: str) -> bool:
    """Whether a number is what is printed, give or take half a unit in the last place."""
    decimals = len(printed.partition(".")[2])
    # a little more, for values that lie half way and that rounding puts on one side or the other
    return abs(value - float(printed)) <= 0.5 * 10.0**-decimals * (1.0 + 1e-9)
