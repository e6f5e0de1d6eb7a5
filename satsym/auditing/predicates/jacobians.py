"""Statements about Jacobians of a derived model: what they approximate, how they are made up of blocks."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.program.run import run
from satsym.auditing.program.text import read
from satsym.status import BadInput
from satsym.wording import shown

if TYPE_CHECKING:
    from satsym.symbolic.derivation import Derivation

_SEED = 59
_TRIES = 10
_ROUNDING = 1e-11


@cache
def _derivation(model: str) -> Derivation:
    from satsym.symbolic.lookup.library import derivation

    return derivation(model)


def _block(model: str, of: str, by: str) -> list[list[Any]]:
    """Derivatives of the rates of positions (``r``) or velocities (``v``) by positions or velocities."""
    found = _derivation(model)
    names = [v.symbol for v in found.model.states]
    half = len(names) // 2
    groups = {"r": names[:half], "v": names[half:]}
    if of not in groups or by not in groups:
        raise BadInput(f"no block {shown(of)} by {shown(by)}; write r or v")
    rates = {e.name: e.rhs for e in found.step("first_order").equations}
    symbols = {
        v.symbol: s for v in found.model.states for e in rates.values() for s in e.free_symbols if s.name == v.symbol
    }
    return [[rates[a].diff(symbols[b]) if b in symbols else rates[a] * 0 for b in groups[by]] for a in groups[of]]


@predicate
def block_is(model: str, of: str, by: str, printed: str) -> Finding:
    """Whether the rates of r or v have by r or v derivatives that are ``zeros``, the ``identity``, or ``not zero``."""
    block = _block(model, of, by)
    size = len(block)
    zero = all(entry.is_zero for line in block for entry in line)
    one = all((block[i][j] - int(i == j)).is_zero for i in range(size) for j in range(size))
    kinds = {"zeros": zero, "identity": one, "not zero": not zero}
    if printed not in kinds:
        raise BadInput(f"block_is: no block {shown(printed)}; write one of {', '.join(kinds)}")
    return Finding(
        kinds[printed],
        "it is "
        + ("zero" if zero else "the identity" if one else f"not zero: its first entry is {block[0][0].factor()}"),
        {"entries that are zero": sum(bool(entry.is_zero) for line in block for entry in line), "entries": size**2},
        f"satsym derive {model}",
    )


@predicate
def blocks_make_jacobian(row: Question, model: str) -> Finding:
    """Whether printed blocks, each ``rates of a by b``, put together are the derived Jacobian."""
    found = _derivation(model)
    names = [v.symbol for v in found.model.states]
    entries = {e.name: e.rhs for e in found.step("linearisation").equations}
    rows: list[list[Any]] = []
    for line in row.printed:
        blocks = [_block(model, *(part.strip() for part in str(cell).split(" by "))) for cell in line]
        rows += [[entry for block in blocks for entry in block[i]] for i in range(len(blocks[0]))]
    off = [
        f"A_{a}_{b}"
        for a, line in zip(names, rows, strict=True)
        for b, entry in zip(names, line, strict=True)
        if not exact.same(entry, entries[f"A_{a}_{b}"])
    ]
    return Finding(
        not off,
        f"{off[0]} is another" if off else f"all {len(names) ** 2} entries are those of the Jacobian",
        {"entries": len(names) ** 2, "others": len(off)},
        f"satsym derive {model}",
    )


@predicate
def derivative_is(row: Question, model: str) -> Finding:
    """Whether the derivative of a rate by what is printed is the printed formula: at random points.

    The row prints a list: what is differentiated (``v_dot``), by what (``r``, ``r_dot`` or ``v``), and the formula, in
    which rrT is the outer product, r the length, and one the identity. Where the formula is the derivative by what is
    left when a dot is taken away, it is a slip.
    """
    listed = not isinstance(row.printed, str) and len(row.printed) == 3
    of, by, formula = map(str, row.printed) if listed else ("",) * 3
    groups = {"r": slice(0, 3), "v": slice(3, 6), "r_dot": slice(3, 6)}
    if of != "v_dot" or by not in groups:
        raise BadInput("derivative_is: print v_dot, then r, r_dot or v, then a formula")
    system, rng, gaps = kernels.load(model), np.random.default_rng(_SEED), {by: 0.0, by.removesuffix("_dot"): 0.0}
    for _ in range(_TRIES):
        x, mu = rng.uniform(0.5, 1.5, 6) * rng.choice([-1.0, 1.0], 6), float(rng.uniform(0.5, 2.0))
        given = {"mu": mu, "rrT": np.outer(x[:3], x[:3]), "r": float(np.linalg.norm(x[:3])), "one": np.eye(3)}
        lines = [*(f"{name} = 0.0" for name in given), f"found = {formula}"]
        found = run(read(lines), given).values["found"]
        matrix = np.array(system.jacobian_x(0.0, tuple(x), (0.0,) * len(system.spec.controls), (mu,))).reshape(6, 6)
        for name in gaps:
            gaps[name] = max(gaps[name], float(np.abs(matrix[3:, groups[name]] - found).max()))
    right = {name: gap < _ROUNDING for name, gap in gaps.items()}
    meant = by.removesuffix("_dot")
    return Finding(
        right[by],
        f"it differs by {gaps[by]:.2g} from the derivative of {of} by {by}, by {gaps[meant]:.0e} from that by {meant}",
        {f"largest difference, derivative by {name}": gap for name, gap in gaps.items()},
        f"satsym derive {model}",
        slip=right[meant],
        remark=f"it is the derivative by {meant}, without the dot; that by {by} is zero"
        if right[meant] and not right[by]
        else "",
    )


@predicate
def newtons_two_laws(model: str) -> Finding:
    """Whether the derived rates are the law of gravitation over the mass: mu/r^2, towards the centre, and no more."""
    system, rng, size, aside = kernels.load(model), np.random.default_rng(_SEED), 0.0, 0.0
    for _ in range(_TRIES):
        x, mu = rng.uniform(0.5, 1.5, 6) * rng.choice([-1.0, 1.0], 6), float(rng.uniform(0.5, 2.0))
        moved = np.array(system.dynamics(0.0, tuple(x), (0.0,) * len(system.spec.controls), (mu,)))
        r, pull = float(np.linalg.norm(x[:3])), moved[3:]
        size = max(size, abs(float(np.linalg.norm(pull)) * r**2 / mu - 1.0), float(np.abs(moved[:3] - x[3:]).max()))
        aside = max(aside, 1.0 + float(pull @ x[:3]) / (r * float(np.linalg.norm(pull))))
    return Finding(
        max(size, aside) < _ROUNDING,
        f"the acceleration is mu/r^2 but for {size:.0e}, towards the centre but for {aside:.0e}",
        {"largest relative difference from mu/r^2": size, "largest 1 + cosine with the position": aside},
        f"satsym derive {model}",
    )


@predicate
def locally_linear(model: str) -> Finding:
    """Whether the Jacobian at a point gives the rates near it up to terms of second order, equilibrium or not.

    Half the deviation must leave a quarter of what f(x) + J dx misses.
    """
    system, rng, ratios, rates = kernels.load(model), np.random.default_rng(_SEED), [], []
    controls = (0.0,) * len(system.spec.controls)
    for _ in range(_TRIES):
        x, way = rng.uniform(0.5, 1.5, 6), rng.normal(size=6)
        start = np.array(system.dynamics(0.0, tuple(x), controls, (1.0,)))
        matrix = np.array(system.jacobian_x(0.0, tuple(x), controls, (1.0,))).reshape(6, 6)
        misses = [
            float(
                np.abs(
                    np.array(system.dynamics(0.0, tuple(x + h * way), controls, (1.0,))) - start - h * matrix @ way
                ).max()
            )
            for h in (2e-3, 1e-3)
        ]
        ratios.append(misses[0] / misses[1])
        rates.append(float(np.abs(start).max()))
    return Finding(
        all(abs(ratio - 4.0) < 0.2 for ratio in ratios),
        f"half the deviation leaves 1/{np.mean(ratios):.2f} of what is missed, at points that are no equilibria",
        {
            "points": _TRIES,
            "least ratio": min(ratios),
            "largest ratio": max(ratios),
            "least of the largest rates": min(rates),
        },
        f"satsym derive {model}",
    )


@predicate
def linear_about_rest() -> Finding:
    """Whether x' = J(x*) dx with dx = x - x* gives the motion near an equilibrium x*, up to terms of second order.

    A pendulum with friction is followed from near both of its equilibria, and from twice as near.
    """
    from scipy.integrate import solve_ivp
    from scipy.linalg import expm

    def rates(_: float, x: np.ndarray[Any, Any]) -> list[float]:
        return [x[1], float(-np.sin(x[0]) - 0.2 * x[1] + 0.3 * x[0] * x[1] * np.sin(x[0]))]

    ratios = []
    for rest in (0.0, np.pi):
        slope = -np.cos(rest)
        matrix = np.array([[0.0, 1.0], [slope, -0.2]])
        misses = []
        for size in (2e-3, 1e-3):
            moved = np.array([rest, 0.0]) + size * np.array([0.6, 0.8])
            end = solve_ivp(rates, (0.0, 1.0), moved, rtol=1e-12, atol=1e-14).y[:, -1]
            misses.append(float(np.abs(end - [rest, 0.0] - expm(matrix) @ (moved - [rest, 0.0])).max()))
        ratios.append(misses[0] / misses[1])
    return Finding(
        all(ratio > 3.8 for ratio in ratios),
        f"half the deviation leaves 1/{min(ratios):.1f} of the difference, or less",
        {"equilibria": len(ratios), "least ratio": min(ratios)},
    )
