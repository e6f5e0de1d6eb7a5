"""The loops of steps: RK4, forward for the states and backward for the costates, and symplectic ones.

The former are one loop, stages unrolled: a step of signed length h from where it departs to where it arrives. Between
nodes it leaves the Hermite midpoint (y0 + y1)/2 + h/8 (f0 - f1), which is fourth order like the steps; averaging the
nodes would make the whole sweep second order (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I,
II.6).

The symplectic loop takes kicks and drifts in turn, for accelerations that depend on the coordinates only. Each of them
is the exact motion of a part of the Hamiltonian, so what they compose is symplectic and runs backward as it runs
forward: with constant steps the energy does not drift but swings (Hairer, Lubich, Wanner, Geometric Numerical
Integration, IX.8).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from satsym.codegen.block import Assignment, Block, Emitter, build, free_symbols, live
from satsym.codegen.naming import Code
from satsym.codegen.printers import ScalarPrinter
from satsym.kernels.plain import exact_weights
from satsym.symbolic.algebra import vanishes
from satsym.symbolic.decimals import DIGITS
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of, t

HALF, SIXTH, EIGHTH = sp.Rational(1, 2), sp.Rational(1, 6), sp.Rational(1, 8)


@dataclass(frozen=True)
class Loop:
    """The quantities that an RK4 loop integrates, and their rates."""

    name: str
    summary: str
    signature: str
    """Name, docstring and arguments of the generated function."""
    backward: bool
    """Whether the loop runs from the last node to the first."""
    time: sp.Symbol
    parameters: tuple[sp.Symbol, ...]
    """Symbols of the time and of the parameters."""
    integrated: tuple[sp.Symbol, ...]
    """Symbols of the integrated quantities, under the names of the arguments for their start, nodes and midpoints."""
    start: str
    nodes: str
    mids: str
    """Names of the arguments for start, nodes and midpoints."""
    given: tuple[tuple[str, str, tuple[sp.Symbol, ...]], ...]
    """For each group of given quantities: argument of nodes, argument of midpoints, symbols."""
    rates: Block
    """Block from time, integrated and given symbols to the rates; with ``sums``, one output more."""
    sums: bool
    """Whether the last output of the block is integrated to a number, which the function returns."""


def source(loop: Loop) -> str:
    """Return the source text of the loop's function."""
    names = _Names(loop)
    step = _Step(loop, names)
    return _text(loop, names, step)


class _Names:
    """The names that a loop uses besides those of its symbols; all are distinct."""

    def __init__(self, loop: Loop) -> None:
        self.given = [s for *_, group in loop.given for s in group]
        arguments = {a.strip() for a in loop.signature.split(",")}
        symbols = (loop.time, *loop.parameters, *loop.integrated, *self.given)
        taken = {s.name for s in symbols} | arguments | {"i", "len", "range", "math"}
        self.emit = Emitter(taken, loop.parameters)
        fresh = self.emit.fresh
        self.at = {s: fresh(f"{s.name}_at") for s in (*loop.integrated, *self.given)}
        self.mid = {s: fresh(f"{s.name}_mid") for s in (*loop.integrated, *self.given)}
        self.end = {s: fresh(f"{s.name}_end") for s in (loop.time, *loop.integrated, *self.given)}
        self.half = {s: fresh(f"{s.name}_half") for s in self.given}
        self.h, self.steps, self.total = fresh("h"), fresh("steps"), fresh("total")
        self.slopes = [self._slope(loop, k, output) for k, output in enumerate(loop.rates.outputs)]

    def _slope(self, loop: Loop, k: int, output: sp.Expr) -> sp.Expr:
        """Return the rate at departure, carried from step to step unless it is a number or an integrated state."""
        if output.is_Number or output in loop.integrated:
            return output
        what = loop.integrated[k].name if k < len(loop.integrated) else "total"
        return self.emit.fresh(f"slope_{what}")


class _Step:
    """The assignments of a loop: before it, at its first node, and in one step."""

    def __init__(self, loop: Loop, names: _Names) -> None:
        self.loop, self.names, self.emit = loop, names, names.emit
        carries = [isinstance(k, sp.Symbol) and k not in loop.integrated for k in names.slopes]

        first = self.emit.inline(loop.rates, {})
        self.first_slopes = [(k, v) for k, v, c in zip(names.slopes, first, carries, strict=True) if c]
        self.opening = live(self.emit.take_lines(), [v for _, v in self.first_slopes])

        means = self._stages()
        moves = list(zip(loop.integrated, means, strict=False))
        self.arrival = [names.end[y] if mean else y for y, mean in moves]
        self.emit.lines += [(names.end[y], y + mean) for y, mean in moves if mean]
        final = self._rates(names.end[loop.time], self.arrival, names.end, "slope_end")
        self.slopes = [(k, v) for k, v, c in zip(names.slopes, final, carries, strict=True) if c]
        self.middles = self._middles(final)
        self.added = means[-1] if loop.sums else sp.Integer(0)

        roots = [*self.arrival, *self.middles, *(v for _, v in self.slopes), self.added]
        self.body = live(self.emit.lines, roots)
        self.used = free_symbols([*roots, *(e for _, e in self.body)])
        self.used_first = free_symbols([*(v for _, v in self.first_slopes), *(e for _, e in self.opening)])
        self.before = live(self.emit.before, self.used | self.used_first)

    def _stages(self) -> list[sp.Expr]:
        """Emit the stages; return h times the mean slope of each integrated quantity."""
        loop, names, emit = self.loop, self.names, self.emit
        half, sixth = emit.assign(HALF * names.h, "half"), emit.assign(SIXTH * names.h, "sixth")
        middle, end = (half, loop.time + half, names.half), (names.h, names.end[loop.time], names.end)
        slopes = [names.slopes]
        for stage, (length, time, given) in enumerate((middle, middle, end), start=2):
            steps = zip(loop.integrated, slopes[-1], strict=False)
            reached = [emit.assign(y + length * k, f"{y}_{stage}") for y, k in steps]
            slopes.append(self._rates(time, reached, given, f"k{stage}"))
        return self._means(sixth, list(zip(*slopes, strict=True)))

    def _rates(
        self, time: sp.Expr, values: Sequence[sp.Expr], given: dict[sp.Symbol, sp.Symbol], name: str
    ) -> list[sp.Expr]:
        loop = self.loop
        place = dict(zip(loop.integrated, values, strict=True)) | {s: given[s] for s in self.names.given}
        if loop.time in loop.rates.inputs:
            place[loop.time] = self.emit.assign(time)
        hints = [f"{name}_{y}" for y in (*loop.integrated, self.names.total)]
        rates = self.emit.inline(loop.rates, place, hints)
        return [self.emit.assign(r, hint) for r, hint in zip(rates, hints, strict=False)]

    def _means(self, sixth: sp.Expr, slopes: Sequence[Sequence[sp.Expr]]) -> list[sp.Expr]:
        """Return h/6 (k1 + 2 k2 + 2 k3 + k4) of each quantity.

        Where the rate of y is itself an integrated v, this is h (v + h/6 (k1 + k2 + k3)) with the slopes of v: RK4
        takes Nystrom's form (II.14 of the same book), whose sums serve y and v.
        """
        integrated = self.loop.integrated
        means = [sixth * (k1 + _scaled(2, k2 + k3) + k4) for k1, k2, k3, k4 in slopes]
        for k, v in enumerate(self.loop.rates.outputs):
            if v in integrated:
                j = integrated.index(v)
                k1, k2, k3, k4 = slopes[j]
                inner = self.emit.assign(k2 + k3, f"k23_{v}")
                first = self.emit.assign(k1 + inner, f"k123_{v}")
                means[k] = self.names.h * (v + sixth * first)
                if self.loop.rates.outputs[j] not in integrated:
                    means[j] = sixth * (first + inner + k4)
        return means

    def _middles(self, final: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return the Hermite midpoints."""
        eighth = self.emit.assign(EIGHTH * self.names.h, "eighth")
        ends = zip(self.loop.integrated, self.arrival, self.names.slopes, final, strict=False)
        return [_scaled(HALF, a + b) + eighth * (p - q) for a, b, p, q in ends]


def _scaled(factor: sp.Expr | int, total: sp.Expr) -> sp.Expr:
    """Return a number times a sum without expanding it, which saves an operation."""
    return sp.Mul(factor, total, evaluate=not total.is_Add)


def _text(loop: Loop, names: _Names, step: _Step) -> str:
    code = ScalarPrinter().doprint
    lines: list[str] = []

    def put(indent: int, target: object, value: object) -> None:
        lines.append("    " * indent + f"{target} = {code(value) if isinstance(value, sp.Basic) else value}")

    for argument, symbols in (
        ("p", loop.parameters),
        (loop.nodes, [names.at[s] for s in loop.integrated]),
        (loop.mids, [names.mid[s] for s in loop.integrated]),
        *((nodes, [names.at[s] for s in group]) for nodes, _, group in loop.given),
        *((mids, [names.mid[s] for s in group]) for _, mids, group in loop.given),
        (loop.start, loop.integrated),
    ):
        if symbols:
            put(1, unpacking(symbols), argument)
    for symbol, expression in step.before:
        put(1, symbol, expression)
    put(1, names.steps, "len(times) - 1")
    origin = names.steps if loop.backward else "0"
    put(1, loop.time, f"times[{origin}]")
    for y in loop.integrated:
        put(1, f"{names.at[y]}[{origin}]", y)
    for s in names.given:
        if s in step.used_first:
            put(1, s, f"{names.at[s]}[{origin}]")
    for symbol, expression in (*step.opening, *step.first_slopes):
        put(1, symbol, expression)
    if loop.sums:
        put(1, names.total, sp.Integer(0))

    arrives = "i" if loop.backward else "i + 1"
    lines.append(f"    for i in range({f'{names.steps} - 1, -1, -1' if loop.backward else names.steps}):")
    put(2, names.end[loop.time], f"times[{arrives}]")
    put(2, names.h, f"{names.end[loop.time]} - {loop.time}")
    if not loop.backward:  # stored at departure, where the index is i itself; backward that is at arrival
        for y in loop.integrated:
            put(2, f"{names.at[y]}[i]", y)
    for s in names.given:
        if names.half[s] in step.used:
            put(2, names.half[s], f"{names.mid[s]}[i]")
        if names.end[s] in step.used:
            put(2, names.end[s], f"{names.at[s]}[{arrives}]")
    for symbol, expression in step.body:
        put(2, symbol, expression)
    for y, middle, value in zip(loop.integrated, step.middles, step.arrival, strict=True):
        put(2, f"{names.mid[y]}[i]", middle)
        if loop.backward:
            put(2, f"{names.at[y]}[i]", value)
    if loop.sums:
        put(2, names.total, names.total + step.added)
    put(2, loop.time, names.end[loop.time])
    for y, value in zip(loop.integrated, step.arrival, strict=True):
        if value != y:
            put(2, y, value)
    for symbol, expression in step.slopes:
        put(2, symbol, expression)
    if not loop.backward:
        for y in loop.integrated:
            put(1, f"{names.at[y]}[{names.steps}]", y)
    if loop.sums:
        lines.append(f"    return {names.total}")
    return "\n".join([f"def {loop.name}({loop.signature}):", f'    """{loop.summary}"""', *lines, ""])


def unpacking(names: Iterable[object]) -> str:
    """Write the left-hand side that unpacks a tuple, also one of length one."""
    found = [str(n) for n in names]
    return f"({found[0]},)" if len(found) == 1 else ", ".join(found)


@dataclass(frozen=True)
class Split:
    """A separable motion q' = v, v' = a(q) without control."""

    coordinates: tuple[sp.Symbol, ...]
    velocities: tuple[sp.Symbol, ...]
    """The coordinates q, and the velocities v in the same order."""
    accelerations: tuple[sp.Expr, ...]
    """The accelerations a(q)."""


def split(derivation: Derivation) -> Split | None:
    """Return coordinates, velocities and accelerations of a separable motion; ``None`` for other motions.

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


def kicks_and_drifts(code: Code, of: Split, constants: Sequence[Assignment]) -> str:
    """Return the source text of the symplectic loop."""
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
    summary = '"""Symplectic integration of order six over the nodes from x0 at times[0], without control."""'
    return "\n".join(["def symplectic(times, x0, p, x):", *(f"    {line}" for line in (summary, *lines)), ""])


def _assigned(pairs: Sequence[Assignment]) -> list[str]:
    code = ScalarPrinter().doprint
    return [f"{symbol} = {code(value)}" for symbol, value in pairs if symbol != value]
