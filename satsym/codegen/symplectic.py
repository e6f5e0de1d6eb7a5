"""The symplectic loop: kicks and drifts in turn, for accelerations that depend on the coordinates only.

Each kick and each drift is the exact motion of a part of the Hamiltonian, so what they compose is symplectic and runs
backward as it runs forward: with constant steps the energy does not drift but swings (Hairer, Lubich, Wanner, Geometric
Numerical Integration, IX.8).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from satsym.codegen.block import Assignment, Emitter, build, live
from satsym.codegen.naming import Code
from satsym.codegen.printers import ScalarPrinter
from satsym.codegen.rk4 import unpacking
from satsym.kernels.composition import exact_weights
from satsym.symbolic.algebra import vanishes
from satsym.symbolic.decimals import DIGITS
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of, t


@dataclass(frozen=True)
class Split:
    """A motion q' = v, v' = a(q) without control."""

    coordinates: tuple[sp.Symbol, ...]
    velocities: tuple[sp.Symbol, ...]
    """The states q, and v in the same order."""
    accelerations: tuple[sp.Expr, ...]
    """a, as the derivation has it."""


def split(derivation: Derivation) -> Split | None:
    """Coordinates, velocities and accelerations of a separable motion; None where the motion is no such.

    Without control each coordinate's rate must be a state of its own, whose rate depends on the coordinates and on
    nothing else but parameters, as the gradient of some function: then the motion has a Hamiltonian v^2/2 + V(q).
    """
    states = symbols_of(derivation.model.states)
    coast = dict.fromkeys(symbols_of(derivation.model.controls), sp.Integer(0))
    rates = dict(zip(states, derivation.rhs("first_order").xreplace(coast), strict=True))
    pairs: dict[sp.Symbol, sp.Symbol] = {}
    for q, rate in rates.items():
        if rate in rates and rate not in {q, *pairs, *pairs.values()} and q not in pairs.values():
            pairs[q] = rate
    velocities = tuple(pairs.values())
    if {*pairs, *velocities} != set(states):
        return None
    accelerations = tuple(rates[v] for v in velocities)
    used = set().union(*(a.free_symbols for a in accelerations))
    if used & {t, *velocities} or not used & set(pairs):
        return None
    jacobian = sp.Matrix(accelerations).jacobian(list(pairs))
    if not all(vanishes(e) for e in jacobian - jacobian.T):
        return None
    return Split(tuple(pairs), velocities, accelerations)


def source(code: Code, of: Split, constants: Sequence[Assignment]) -> str:
    """Source text of the loop."""
    s, names = code.symbols, code.names
    states = s.x
    q, v = ([names.get(y, y) for y in group] for group in (of.coordinates, of.velocities))
    fixed = {*s.p, *(c for c, _ in constants)}
    force = build([code.renamed(a) for a in of.accelerations], constants, (fixed,))
    taken = {y.name for y in (s.t, *s.p, *states)} | {"times", "x0", "x", "p", "i", "len", "range", "math"}
    emit = Emitter(taken, s.p)
    fresh = emit.fresh
    at = {y: fresh(f"{y}_at") for y in states}
    end, h, steps = fresh(f"{s.t}_end"), fresh("h"), fresh("steps")
    slopes = [fresh(f"slope_{y}") for y in v]

    first = emit.inline(force, {})
    opening = live(emit.take_lines(), first)
    place, pace, pull = [*q], [*v], [*slopes]
    kicks, drifts = ([sp.Float(sp.Rational(share), DIGITS) for share in group] for group in exact_weights())
    for k, kick in enumerate(kicks, start=1):
        fraction = emit.assign(kick * h, f"kick_{k}")
        pace = [emit.assign(b + fraction * a, f"{y}_{k}") for y, b, a in zip(v, pace, pull, strict=True)]
        if k <= len(drifts):
            fraction = emit.assign(drifts[k - 1] * h, f"drift_{k}")
            place = [emit.assign(b + fraction * a, f"{y}_{k}") for y, b, a in zip(q, place, pace, strict=True)]
            pulls = emit.inline(force, dict(zip(q, place, strict=True)))
            pull = [emit.assign(a, f"a{k}_{y}") for y, a in zip(v, pulls, strict=True)]
    arrival = dict(zip((*q, *v), (*place, *pace), strict=True))
    body = live(emit.lines, [*arrival.values(), *pull])

    lines = [
        *(f"{unpacking(group)} = {argument}" for group, argument in ((s.p, "p"), (at.values(), "x")) if group),
        f"{unpacking(states)} = x0",
        *_assigned(emit.before),
        f"{steps} = len(times) - 1",
        f"{s.t} = times[0]",
        *(f"{at[y]}[0] = {y}" for y in states),
        *_assigned([*opening, *zip(slopes, first, strict=True)]),
        f"for i in range({steps}):",
        f"    {end} = times[i + 1]",
        f"    {h} = {end} - {s.t}",
        *(f"    {at[y]}[i] = {y}" for y in states),
        *(f"    {line}" for line in _assigned(body)),
        f"    {s.t} = {end}",
        *(f"    {line}" for line in _assigned([*arrival.items(), *zip(slopes, pull, strict=True)])),
        *(f"{at[y]}[{steps}] = {y}" for y in states),
    ]
    summary = '"""Kicks and drifts of sixth order over the nodes from x0 at times[0], without control."""'
    return "\n".join(["def symplectic(times, x0, p, x):", *(f"    {line}" for line in (summary, *lines)), ""])


def _assigned(pairs: Sequence[Assignment]) -> list[str]:
    code = ScalarPrinter().doprint
    return [f"{symbol} = {code(value)}" for symbol, value in pairs if symbol != value]
