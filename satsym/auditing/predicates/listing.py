"""Lines of the printed program in appendix B of the ITS thesis: what they do when they are executed."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np

from satsym.auditing.predicates import Finding, Question, exact, its_listing, predicate, reproduction
from satsym.auditing.predicates.motion import solved

_COUNTS = (100, 200, 400, 800)
_TF = 1.0
_START = (1.1, 0.1, 0.3, 0.9)
_END = (0.4, -0.3, 0.2, 0.5)
_SEED = 11
_NAME = re.compile(r"[A-Za-z_]\w*")
_STEPS = 300


@predicate
def loop_begins(row: Question) -> Finding:
    """Whether the printed first values let the loop begin, which asks that err1 and err2 be greater than tol."""
    values: dict[str, float] = {}
    for line in row.printed:
        name, _, text = str(line).rstrip(";").partition("=")
        values[name.strip()] = _number(text, values)
    errors = {name: value for name, value in values.items() if name.startswith("err")}
    return Finding(
        bool(errors) and min(errors.values()) > values["tol"],
        f"{', '.join(f'{name} = {value:g}' for name, value in errors.items())}; tol = {values['tol']:g}",
        dict(values),
    )


@predicate
def loop_ends_when_converged(instance: str) -> Finding:
    """Whether the loop ends where the controls change no more, and not before: executed from several guesses."""
    optimum = solved(instance).u
    ends: list[tuple[int, float, float]] = []
    for guess in (g for g in reproduction.GUESSES if g > 0.0):
        done = reproduction.run(10.0, 10.0, _STEPS, guess)
        off = float(np.abs(np.array(done.u)).max() - np.abs(optimum).max())
        ends.append((done.sweeps, abs(guess - done.u[0][0]) / done.u[0][0], off))
    # a converged control: nothing changes
    settled = its_listing.error([(0.2, 0.2)] * (_STEPS + 1), [(0.2, 0.2)] * (_STEPS + 1), 0)
    smallest = min(change for _, change, _ in ends)
    holds = smallest <= its_listing.TOLERANCE and settled <= its_listing.TOLERANCE
    return Finding(
        holds,
        f"it ends after {max(sweeps for sweeps, _, _ in ends)} sweep from every guess, although the controls changed "
        f"by {100.0 * smallest:.0f} % in it, and goes on where they change no more",
        {
            "guesses tried": len(ends),
            "smallest relative change at the end": smallest,
            "err1 where nothing changes": settled,
            "largest distance from the optimum at the end": max(off for _, _, off in ends),
        },
        remark="err1 and err2 are positive where the change is small, so the loop should go on while they are negative",
    )


@predicate
def error_measures_change() -> Finding:
    """Whether err is positive exactly where the controls changed by less than tol of their size: on random controls."""
    rng, agree = np.random.default_rng(_SEED), 0
    shares = np.linspace(0.1, 3.0, 30) * its_listing.TOLERANCE
    for share in shares:
        new = rng.uniform(0.1, 1.0, 50)
        old = new + share * new * rng.choice([-1.0, 1.0], 50)
        now, before = ([(float(v), 0.0) for v in row] for row in (new, old))
        agree += (its_listing.error(now, before, 0) > 0.0) == bool(
            np.abs(new - old).sum() < its_listing.TOLERANCE * new.sum()
        )
    return Finding(
        agree == len(shares), f"so in {agree} of {len(shares)} cases", {"cases": len(shares), "agree": agree}
    )


@predicate
def update_keeps_law(relaxation: str) -> Finding:
    """Whether the update leaves the law where it is, and brings every other control nearer to it."""
    share = float(relaxation)
    law, old = 0.3, 0.7
    new, kept = share * law + (1.0 - share) * old, share * law + (1.0 - share) * law
    return Finding(
        math.isclose(kept, law) and abs(new - law) < abs(old - law),
        f"the distance from the law shrinks by the factor {abs(new - law) / abs(old - law):g} in one update",
        {"factor": abs(new - law) / abs(old - law)},
    )


@predicate
def entry_by_entry() -> Finding:
    """Whether ``-lambda4/(c2.*x1s)`` is the law at each node: as MATLAB divides two rows, and entry by entry."""
    rng = np.random.default_rng(_SEED)
    lambda4, x1 = rng.uniform(-1.0, 1.0, 6), rng.uniform(0.5, 2.0, 6)
    quotient = its_listing.right_division((-lambda4).tolist(), x1.tolist())
    off = float(np.abs(quotient + lambda4 / x1).max())
    return Finding(
        off < 1e-12,
        "one number for all nodes: the q for which q c2 x1s comes closest to -lambda4",
        {"for six random nodes": quotient, "off by up to": off},
        remark="/ between two rows is a least-squares quotient, ./ goes entry by entry; as lambda4 is 0 here, it does "
        "not show",
    )


@predicate
def defined_before_use(row: Question) -> Finding:
    """Whether every name that the printed lines give a value has it before they use it."""
    lines = [row.printed] if isinstance(row.printed, str) else [str(line) for line in row.printed]
    sides = [line.partition("=") for line in lines]
    targets = [_NAME.findall(left)[0] for left, _, _ in sides]
    early = sorted(
        {
            name
            for i, (_, _, right) in enumerate(sides)
            for name in _NAME.findall(right)
            if name in targets[i:] and name not in targets[:i] and name != targets[i]
        }
    )
    return Finding(
        not early,
        f"{', '.join(early)} has no value yet" if early else "every name has a value",
        {"lines": len(lines), "used too early": ", ".join(early) or "none"},
        remark="MATLAB would stop here in the first pass; the line comes once more where it belongs" if early else "",
    )


@predicate
def index_runs_back(row: Question) -> Finding:
    """Whether the printed j goes from n down to 1 while i goes from 1 to n."""
    n, text = 7, str(row.printed).partition("j=")[2].rstrip(";")
    indices = [_number(text, {"n": n, "i": i}) for i in range(1, n + 1)]
    listed = " ".join(f"{index:g}" for index in indices)
    return Finding(indices == list(range(n, 0, -1)), f"for n = 7 j is {listed}", {"for n = 7": listed})


def _number(text: str, values: Mapping[str, float]) -> float:
    """What a printed right-hand side comes to."""
    found = exact.expression(text.strip())
    return float(found.subs({symbol: values[symbol.name] for symbol in found.free_symbols}))


@predicate
def law_from_zero_vectors(nodes: int) -> Finding:
    """Whether the law has a value at all nodes when it is evaluated with the vectors of step 2, x1 = lambda4 = 0."""
    x1, lambda4 = np.zeros(nodes), np.zeros(nodes)
    x1[0] = 1.0
    with np.errstate(invalid="ignore", divide="ignore"):
        law = np.minimum(1.0, np.maximum(0.0, -lambda4 / x1))
    lost = int(np.isnan(law).sum())
    return Finding(
        lost == 0,
        f"0/0 at {lost} of {nodes} nodes",
        {"nodes": nodes, "without a value": lost},
        remark="MATLAB's max and min pass over what is not a number, and would give 0" if lost else "",
    )
