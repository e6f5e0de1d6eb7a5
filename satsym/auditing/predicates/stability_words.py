"""Statements about stability, tried as they are printed on systems whose behaviour is known or can be followed."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from satsym.arrays import Array
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.answers import spectrum
from satsym.auditing.predicates.flows import expm, well_conditioned
from satsym.auditing.predicates.linear_rules import BLOCKS

_SEED = 53
_TRIES = 20
_EQUAL = 1e-9


def _followed(rates: Callable[[float, Array], Array], start: Array, t: Array) -> Array:
    """States at some times, shape (n, times)."""
    from scipy.integrate import solve_ivp

    return np.asarray(solve_ivp(rates, (t[0], t[-1]), start, t_eval=t, rtol=1e-9, atol=1e-12).y)


def _whirl(_: float, x: Array) -> Array:
    """In polar coordinates r' = r (1 - r), angle' = 1 - cos(angle): whatever starts off the origin tends to (1, 0)."""
    r = math.hypot(x[0], x[1])
    grow, turn = 1.0 - r, 1.0 - x[0] / r
    return np.array([grow * x[0] - turn * x[1], grow * x[1] + turn * x[0]])


@predicate
def convergence_is_enough() -> Finding:
    """Whether an equilibrium to which motions converge is stable: tried on one to which all motions nearby converge."""
    rest, t = np.array([1.0, 0.0]), np.linspace(0.0, 4000.0, 4001)
    ends, farthest = [], []
    for angle in (0.1, 0.03, 0.01):
        moved = _followed(_whirl, np.array([math.cos(angle), math.sin(angle)]), t)
        away = np.linalg.norm(moved - rest[:, None], axis=0)
        ends.append(float(away[-1]))
        farthest.append(float(away.max()))
    converges = max(ends) < 0.05 * min(farthest)
    return Finding(
        not (converges and min(farthest) > 1.0),
        f"motions of r' = r (1 - r), angle' = 1 - cos(angle) converge to (1, 0), and yet go {min(farthest):.2f} away "
        f"from it first, however near they start",
        {"nearest start": 0.01, "farthest from the equilibrium": min(farthest), "at the end": max(ends)},
        remark="to converge is not enough: that the equilibrium is stable belongs to the definition",
    )


@predicate
def unstable_goes_on_growing() -> Finding:
    """Whether deviations from every unstable equilibrium keep on growing: tried on a pendulum that stands upright."""
    t = np.linspace(0.0, 60.0, 6001)
    moved = _followed(lambda _, x: np.array([x[1], math.sin(x[0])]), np.array([1e-3, 0.0]), t)
    away = np.linalg.norm(np.array([np.sin(moved[0] / 2.0) * 2.0, moved[1]]), axis=0)
    falls = int((np.diff(np.sign(np.diff(away))) < 0).sum())
    left = float(away.max())
    return Finding(
        not (left > 1.0 and falls > 0),
        f"a pendulum that is let go 0.001 from upright goes {left:.1f} away and comes back, {falls} times in the time "
        "it is followed: unstable, though the deviation does not keep on growing",
        {"largest deviation": left, "times it falls again": falls},
        remark="unstable is what is not stable: some neighbourhood is left from starts however near",
    )


@predicate
def sign_decides() -> Finding:
    """Whether the signs of real parts alone tell systems that stay bounded from others: on blocks that are known."""
    by_signs: dict[tuple[int, ...], dict[str, str]] = {}
    for block, (_, behaviour) in BLOCKS.items():
        signs = tuple(sorted({int(np.sign(root.real)) for root in spectrum(block)}))
        by_signs.setdefault(signs, {})[block] = behaviour
    torn = [blocks for blocks in by_signs.values() if len({b == "grows" for b in blocks.values()}) > 1]
    listed = "; ".join(f"{block}: {behaviour}" for blocks in torn for block, behaviour in blocks.items())
    return Finding(
        not torn,
        f"systems of the same signs behave differently ({listed})" if torn else "each sign has one behaviour",
        {"kinds": len(BLOCKS), "sets of signs": len(by_signs), "that leave it open": len(torn)},
        remark="where a real part is zero, the number of eigenvectors counts, and then terms of higher order"
        if torn
        else "",
    )


@predicate
def imaginary_swings() -> Finding:
    """Whether linear systems with imaginary eigenvalues alone swing: each state changes sign again and again."""
    t, least = np.linspace(0.0, 60.0, 1201), math.inf
    blocks = [np.array(BLOCKS[name][0]) for name in BLOCKS if "imaginary" in name]
    for a in blocks:
        start = np.random.default_rng(_SEED).uniform(0.5, 1.0, len(a))
        step, x, places = expm((t[1] - t[0]) * a), start, []
        for _ in t:
            places.append(x)
            x = step @ x
        signs = np.sign(np.array(places))
        least = min(least, float((np.diff(signs, axis=0) != 0).sum(axis=0).min()))
    return Finding(
        least > 2.0,
        f"each state of {len(blocks)} systems changes sign {least:.0f} times at least",
        {"systems": len(blocks), "fewest changes of sign": least},
    )


@predicate
def imaginary_keeps_size() -> Finding:
    """Whether oscillations neither grow nor die out where all real parts are zero: on linear systems, and another."""
    sizes = {}
    for name, (entries, _) in BLOCKS.items():
        a = np.array(entries)
        if np.abs(spectrum(name).imag).min() > 0.0 and np.abs(spectrum(name).real).max() == 0.0:
            late = max(float(np.linalg.norm(expm(time * a))) for time in np.linspace(80.0, 85.0, 11))
            early = max(float(np.linalg.norm(expm(time * a))) for time in np.linspace(20.0, 25.0, 11))
            sizes[name] = late / early
    t = np.linspace(0.0, 200.0, 2001)
    damped = _followed(lambda _, x: np.array([x[1], -x[0] - x[1] ** 3]), np.array([1.0, 0.0]), t)
    sizes["x'' = -x - x'^3, whose linearisation is imaginary"] = float(
        np.hypot(*damped[:, -100:]).max() / np.hypot(*damped[:, :100]).max()
    )
    changed = [name for name, ratio in sizes.items() if not 0.9 < ratio < 1.1]
    return Finding(
        not changed,
        f"they do not for: {'; '.join(changed)}" if changed else "they keep their size",
        {f"later over earlier, {name}": ratio for name, ratio in sizes.items()},
        remark="the point before it in the document says rightly that real parts of zero leave it open"
        if changed
        else "",
    )


@predicate
def zero_real_part_open() -> Finding:
    """Whether systems with one and the same linearisation, with real parts zero, can be stable and unstable."""
    t, sizes = np.linspace(0.0, 40.0, 401), []
    for sign in (-1.0, 1.0):
        moved = _followed(lambda _, x, s=sign: np.array([x[1], -x[0] + s * x[1] ** 3]), np.array([0.15, 0.0]), t)  # type: ignore[misc]
        sizes.append(float(np.hypot(*moved[:, -1]) / np.hypot(*moved[:, 0])))
    return Finding(
        sizes[0] < 0.9 and sizes[1] > 1.1,
        f"x'' = -x - x'^3 shrinks to {sizes[0]:.2f} of its size, x'' = -x + x'^3 grows to {sizes[1]:.2f}, and both "
        "have the eigenvalues +-i",
        {"size after a while, damped": sizes[0], "driven": sizes[1]},
    )


@predicate
def stretches() -> Finding:
    """Whether a matrix makes its eigenvectors |lambda| times as long, and turns them about where lambda is negative."""
    rng, agree = np.random.default_rng(_SEED), 0
    for _ in range(_TRIES):
        basis = well_conditioned(rng, 3)
        roots = rng.uniform(0.2, 2.0, 3) * rng.choice([-1.0, 1.0], 3)
        a = basis @ np.diag(roots) @ np.linalg.inv(basis)
        for root, vector in zip(roots, basis.T, strict=True):
            image = a @ vector
            length = float(np.linalg.norm(image) / np.linalg.norm(vector))
            cosine = float(image @ vector / (np.linalg.norm(image) * np.linalg.norm(vector)))
            agree += bool(abs(length - abs(root)) < _EQUAL and abs(cosine - np.sign(root)) < _EQUAL)
    return Finding(
        agree == 3 * _TRIES, f"so for {agree} of {3 * _TRIES} real eigenvalues", {"tried": 3 * _TRIES, "agree": agree}
    )
