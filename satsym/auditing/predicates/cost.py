"""Claims about least costs and optimal controls, held against the solved problem; and where the numbers come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, Question, predicate, reproduction
from satsym.auditing.predicates.motion import loaded, solved
from satsym.auditing.predicates.reproduction import Process
from satsym.solution import Solution
from satsym.status import BadInput, Status

_SEED = 5
_POINTS = 50


@cache
def weighed(instance: str, c1: float, c2: float) -> Solution:
    """The optimum of an instance with other weights."""
    from satsym.solvers import solve

    case = loaded(instance)
    names = [v.symbol for v in case.model.spec.parameters]
    values = dict(zip(names, case.parameters, strict=True)) | {"c1": c1, "c2": c2}
    return solve(replace(case, parameters=tuple(values[name] for name in names)))


@predicate
def cost_table(row: Question, instance: str, control: str) -> Finding:
    """Whether a table of weights and least costs is right; else, whether the printed program produces all of it.

    Parameters
    ----------
    row
        Each line of it c1, c2, J.
    instance
        The printed problem; its weights are replaced.
    control
        The control that is printed beside the table, which the program has to produce as well.
    """
    lines = [(float(c1), float(c2), j) for c1, c2, j in row.printed]
    return _judged(instance, lines, control)


@predicate
def least_cost(instance: str, printed: str, control: str) -> Finding:
    """Whether a printed cost is the least one of an instance; else, whether the printed program produces it."""
    case = loaded(instance)
    values = dict(zip((v.symbol for v in case.model.spec.parameters), case.parameters, strict=True))
    return _judged(instance, [(values["c1"], values["c2"], printed)], control)


@predicate
def least_over_weights(row: Question, instance: str, table: tuple[str, ...], printed: str) -> Finding:
    """Whether equal weights make the cost least, with the printed value.

    The weights belong to the question, not to the answer: a cost of other weights is the cost of another problem.

    Parameters
    ----------
    table
        The pairs of weights that were compared, such as ``"50, 10"``.
    """
    pairs = [tuple(float(part) for part in text.split(",")) for text in table]
    found = {pair: weighed(instance, *pair) for pair in pairs}
    least = min(solution.objective for solution in found.values())
    right = all(s.status is Status.CONVERGED for s in found.values()) and reproduction.agrees(least, printed)
    evidence = {f"least J for {c1:g} and {c2:g}": found[c1, c2].objective for c1, c2 in pairs}
    heavier = [pair for pair in pairs if pair[0] == pair[1] and pair != min(pairs)]
    remark = (
        "J is proportional to its weights: what is compared are four problems, of which the one with the smallest "
        f"weights is always the cheapest; equal weights of {heavier[0][0]:g} are among the four as well"
        if heavier
        else ""
    )
    return Finding(
        right and not heavier,
        f"the least J is {least:.4g} for all of these weights",
        evidence,
        f"satsym solve {instance}",
        remark=remark,
    )


@predicate
def optimal_control(instance: str, printed: str) -> Finding:
    """Whether the optimal controls have the printed value throughout; else, whether the printed program produces it."""
    found = solved(instance)
    low, high = float(found.u.min()), float(found.u.max())
    holds = found.status is Status.CONVERGED and all(reproduction.agrees(value, printed) for value in (low, high))
    guesses = [] if holds else reproduction.guesses_for(printed)
    return Finding(
        holds,
        f"the optimal controls are {low:g}" if low == high else f"the optimal controls go from {low:g} to {high:g}",
        {"smallest": low, "largest": high, "guess that leads to it": ", ".join(f"{g:g}" for g in guesses) or "none"},
        f"satsym solve {instance}",
        artefact=bool(guesses),
        remark=f"it is half of {guesses[0]:g}, if that was the guess: the printed loop ends after one sweep, in which "
        "it takes the mean of the guess and of the law, which is 0"
        if guesses
        else "",
    )


@predicate
def has_extremal(instance: str) -> Finding:
    """Whether the necessary conditions of an instance have a solution."""
    found = solved(instance)
    largest = max(float(np.abs(found.lam).max()), float(np.abs(found.u).max()))
    return Finding(
        found.status is Status.CONVERGED,
        f"{found.status}: J = {found.objective:.4g}",
        {"J": found.objective, "largest control or costate": largest},
        f"satsym solve {instance}",
    )


@predicate
def final_costates_known(instance: str) -> Finding:
    """Whether all costates are given at the final time: where the final state is free and the time is not."""
    case = loaded(instance)
    found = solved(instance)
    final = np.array(case.model.terminal_gradient(float(found.times[-1]), found.x[:, -1], case.parameters))
    return Finding(
        case.tf is not None and not case.final,
        "the final state is free, so they are "
        + ", ".join(f"{value:g}" for value in final)
        + (": with these, no costate ever differs from 0" if not final.any() else ""),
        {"boundary type": case.boundary_type, "largest final costate": float(np.abs(final).max())},
        f"satsym solve {instance}",
    )


@predicate
def cost_is_sum(instance: str) -> Finding:
    """Whether J is the terminal cost and the integral of the running cost: by another quadrature, on a motion."""
    case = loaded(instance)
    assert case.tf is not None
    times = np.linspace(case.t0, case.tf, 4001)
    u = 0.1 * np.cos(np.outer(np.arange(1.0, len(case.model.spec.controls) + 1.0), times))
    middle = 0.1 * np.cos(np.outer(np.arange(1.0, len(u) + 1.0), 0.5 * (times[1:] + times[:-1])))
    x, _, integral = case.model.forward(times, case.initial, u, middle, case.parameters)
    density = [
        case.model.running_cost(t, tuple(a), tuple(b), case.parameters) for t, a, b in zip(times, x.T, u.T, strict=True)
    ]
    other = float(np.trapezoid(density, times))
    final = float(case.model.terminal_cost(case.tf, tuple(x[:, -1]), case.parameters))
    error = abs(integral - other) / max(abs(other), 1e-300)
    return Finding(
        error < 1e-5,
        f"S = {final:.4g} and the integral {integral:.4g} make up J",
        {"S": final, "integral": integral, "by the trapezium rule": other},
        f"satsym simulate {instance}",
    )


@predicate
def stationary_minimum(model: str) -> Finding:
    """Whether the Hamiltonian is least at its stationary controls: at random points, with positive weights."""
    system = kernels.load(model)
    spec, rng, least = system.spec, np.random.default_rng(_SEED), np.inf
    if not spec.has_cost:
        raise BadInput(f"stationary_minimum: {model} has no cost")
    free = (-np.inf,) * len(spec.controls) + (np.inf,) * len(spec.controls)
    for _ in range(_POINTS):
        x, lam = (tuple(rng.uniform(0.5, 2.0, len(spec.states))) for _ in range(2))
        p = tuple(rng.uniform(0.5, 2.0, len(spec.parameters)))
        best = np.array(system.control_law(0.0, x, lam, p, free))
        lowest = system.hamiltonian(0.0, x, tuple(best), lam, p)
        for _ in range(4):
            other = best + rng.normal(size=len(best))
            rise = (system.hamiltonian(0.0, x, tuple(other), lam, p) - lowest) / float(((other - best) ** 2).sum())
            least = min(least, rise)
    return Finding(
        least > 0.0,
        f"H rises by at least {least:.2g} times the square of the distance from them",
        {"points": _POINTS, "smallest rise over distance squared": least},
    )


def _judged(instance: str, lines: Sequence[tuple[float, float, str]], control: str) -> Finding:
    """Printed costs against the least ones; and the printed program, where they differ."""
    least = [weighed(instance, c1, c2) for c1, c2, _ in lines]
    holds = all(
        found.status is Status.CONVERGED and reproduction.agrees(found.objective, j)
        for found, (_, _, j) in zip(least, lines, strict=True)
    )
    derived = "J = " + ", ".join(f"{found.objective:.4g}" for found in least)
    evidence: dict[str, float | int | bool | str] = {
        f"least J for {c1:g} and {c2:g}": found.objective for found, (c1, c2, _) in zip(least, lines, strict=True)
    }
    ways = [] if holds else reproduction.processes(lines, control)
    remark = ""
    if ways:
        way = ways[0]
        remark, numbers = _explained(way, lines)
        evidence |= numbers
        evidence["other ways within the range searched"] = len(ways) - 1
    return Finding(holds, derived, evidence, f"satsym solve {instance}", artefact=bool(ways), remark=remark)


def _explained(
    way: Process, lines: Sequence[tuple[float, float, str]]
) -> tuple[str, dict[str, float | int | bool | str]]:
    """The process in a sentence, and the numbers that the whole program gives with it."""
    n = (way.fewest + way.most) // 2
    evidence: dict[str, float | int | bool | str] = {
        "guess": way.guess,
        "fewest steps": way.fewest,
        "most steps": way.most,
        "rule": reproduction.RULES[way.rule],
        "sweeps": way.sweeps,
    }
    for c1, c2, _ in lines:
        done = reproduction.run(c1, c2, n, way.guess)
        evidence[f"printed program, J for {c1:g} and {c2:g}, {n} steps"] = reproduction.cost(
            done.u, c1, c2, done.step, way.rule
        )
        evidence["printed program, r at the end"] = done.x[-1][0]
    sentence = (
        f"the printed program gives these digits from the guess u = {way.guess:g} with {way.fewest} to {way.most} "
        f"steps ({reproduction.RULES[way.rule]}): it ends after {way.sweeps} sweep, at half the guess"
    )
    return sentence, evidence
