"""Linear equations of motion of bodies about rest, of second order and then of first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import mpmath as mp
import sympy as sp

from satsym.agreement import slopes
from satsym.spec import ModeGroup, Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy
from satsym.symbolic.checks import Point, compare, identity, numeric, numeric_along
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.derived import SpecialCase
from satsym.symbolic.kinds.multibody import Multibody
from satsym.symbolic.linear.notation import results
from satsym.symbolic.model import Line, MaybeStep, Paragraph, Problem, Requirement, symbols_of
from satsym.symbolic.motion import geometry
from satsym.symbolic.motion import steps as motion


@dataclass(frozen=True, kw_only=True)
class AboutRest(SpecialCase):
    """Linear equations of bodies about the rest that is their reference, or an independent part of these equations.

    Parameters
    ----------
    of
        The bodies; their reference must be at rest, with all coordinates zero.
    velocities
        Each coordinate that is kept with the state that is its rate of change; speeds without a coordinate are kept by
        being among the states. That what is kept moves by itself is proved.
    """

    of: Multibody
    velocities: Mapping[sp.Symbol, sp.Symbol]

    along_chain: ClassVar[bool] = True

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: equations of second order, then of first."""
        return self.motion_steps()

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps as far as the first-order form, which are all steps of this kind."""
        return (second_order, first_order, motion.linearisation)

    def picture(self) -> geometry.Picture | None:
        """Return the picture of the bodies' axes that the kept states turn."""
        return self.of.pictured(self.states)

    def misfits(self) -> Iterator[str]:
        """Yield a complaint for each state that is neither a coordinate of the bodies nor its rate nor a speed."""
        kept = set(symbols_of(self.states)) - set(self.velocities.values())
        if not (set(self.velocities) <= set(self.of.coordinates) and kept <= set(symbols_of(self.of.states))):
            yield f"the states must be coordinates of {self.of.name}, their rates, and speeds without a coordinate"
        if self.along:
            yield "a linearisation about rest lists the states that it retains; leave out the field `along`"

    def mode_groups(self) -> tuple[ModeGroup, ...]:
        """Return the bodies' groups of modes, each with its states that are kept and the rates of its coordinates."""
        kept = {v.symbol for v in self.states}
        rates = {q.name: v.name for q, v in self.velocities.items()}
        found = []
        for group in self.of.mode_groups():
            states = [s for s in group.states if s in kept]
            states += [rates[s] for s in group.states if s in rates]
            found += [replace(group, states=tuple(states))] if states else []
        return tuple(found)

    def brings(self) -> tuple[Variable, ...]:
        """Return no variables: the coordinates keep their names."""
        return ()

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of accelerations, and of what linear theory finds, to LaTeX."""
        latex = {v.symbol: v.latex for v in self.states}
        found = {n.rate_of(v).name: n.accented("ddot", latex[q.name]) for q, v in self.velocities.items()}
        return found | ({} if problem else results(self))

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Check that velocities have the dimensions of rates of their coordinates."""
        for coordinate, velocity in self.velocities.items():
            require(f"the rate of {coordinate.name}", velocity, over(known[coordinate.name], known[n.TIME.name]))

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that names the bodies, and the rest about which their equations are linearised."""
        about = (Line("reference", s, curve, f"reference.{s.name}") for s, curve in self.of.reference.items())
        return (Paragraph("about_rest", self.of, tuple(about)),)


def second_order(so_far: Derivation) -> Step:
    """Derive Kane's equations to first order in coordinates and rates: inertial terms and loads."""
    model = stated_as(AboutRest, so_far)
    rows = _linear_rows(so_far, model)
    wanted = {n.rate_of(s) for s in (*model.velocities.values(), *_own_speeds(model))}
    chosen = [k for k, (_, lhs, _) in enumerate(rows) if lhs.free_symbols & wanted]
    kept = [rows[k] for k in chosen]
    known = {*symbols_of((*model.states, *model.controls, *model.parameters)), *wanted}
    foreign = sorted({s.name for _, lhs, rhs in kept for s in (lhs - rhs).free_symbols - known})
    if foreign:
        raise DerivationError(
            f"{model.name}: its equations of motion contain undeclared symbols; they depend on {', '.join(foreign)}"
        )
    equations = tuple(Equation(name, loads, inertia) for name, inertia, loads in kept)
    return Step(
        "small_motions", "first order of Kane's equations", equations, ("motion",), (_rays(so_far, kept, chosen),)
    )


def first_order(so_far: Derivation) -> Step:
    """Solve the linear equations for the accelerations."""
    model = stated_as(AboutRest, so_far)
    moving = [n.rate_of(s) for s in (*model.velocities.values(), *_own_speeds(model))]
    law = [e.lhs - e.rhs for e in so_far.step("small_motions").equations]
    mass, load = sp.linear_eq_to_matrix(law, moving)
    if mass.rows != mass.cols or mass.det() == 0:
        raise DerivationError(f"{model.name}: the equations do not determine {', '.join(s.name for s in moving)}")
    solved = dict(zip(moving, mass.applyfunc(factored).LUsolve(load), strict=True))
    variables = symbols_of((*model.states, *model.controls))
    rates = {n.rate_of(q): v for q, v in model.velocities.items()}
    for symbol, value in solved.items():
        whole = sp.expand(value)
        rates[symbol] = sp.Add(*(factored(whole.coeff(v)) * v for v in variables))
    states = symbols_of(model.states)
    equations = tuple(Equation(s.name, n.rate_of(s), rates[n.rate_of(s)]) for s in states)
    proof = identity("satisfies the linear equations", [sp.together(e.xreplace(rates)) for e in law])
    return Step("first_order", "solve for accelerations and reduce", equations, ("small_motions",), (proof,))


def _own_speeds(model: AboutRest) -> list[sp.Symbol]:
    """Return the speeds among the kept states that belong to no coordinate."""
    return [s for s in symbols_of(model.states) if s not in model.velocities and s not in model.velocities.values()]


def _linear_rows(so_far: Derivation, model: AboutRest) -> list[tuple[str, sp.Expr, sp.Expr]]:
    """Return each equation to first order: its name, and M u' + b and Q by coordinates, rates and speeds."""
    of, original, special = model.of, so_far.original, model.special()
    assert original is not None
    rest = {s: sp.sympify(e) for s, e in of.reference.items()}
    if any(rest.get(q, 1) != 0 for q in of.coordinates):
        raise DerivationError(f"{model.name}: {of.name} has no reference that is at rest with all coordinates zero")
    velocity = {q: model.velocities.get(q, sp.Symbol(f"{q.name}_rate", real=True)) for q in of.coordinates}
    chain = [*of.named.items(), *((e.lhs, e.rhs) for e in original.step("kane").equations if _is_part(e))]
    moving = [*of.coordinates, *of.speeds, *symbols_of(of.controls)]
    values, by_all = _first_order_of(chain, moving, rest | dict.fromkeys(symbols_of(of.controls), sp.Integer(0)))

    def linear(expression: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
        """Return the derivatives of an expression at rest by coordinates, speeds and controls."""
        return {x: _slope(expression, x, values, by_all) for x in moving}

    turning = [linear(sp.sympify(rate)) for rate in of.coordinates.values()]
    paired = [u for u in of.speeds if any(row[u] != 0 for row in turning)]
    by_speed = sp.Matrix([[row[u] for u in paired] for row in turning])
    by_place = sp.Matrix([sp.Add(*(row[q] * q for q in of.coordinates)) for row in turning])
    changes = by_speed.inv() * (sp.Matrix(list(velocity.values())) - by_place)
    along = dict(zip(of.coordinates, velocity.values(), strict=True)) | {v: n.rate_of(v) for v in velocity.values()}
    change = dict(zip(paired, changes, strict=True)) | {u: u - rest[u] for u in of.speeds if u not in paired}
    speeding = {u: sp.Add(*(sp.diff(change[u], x) * rate for x, rate in along.items())) for u in paired}
    speeding |= {u: n.rate_of(u) for u in of.speeds if u not in paired}
    small = {q: q for q in of.coordinates} | change | {c: c for c in symbols_of(of.controls)}
    known = {e.name: e.rhs for e in original.step("kane").equations}
    rows = []
    for i, speed in enumerate(of.speeds, 1):
        inertial = sp.Add(*(v * small[x] for x, v in linear(known[f"bias_{i}"]).items()))
        for k, other in enumerate(of.speeds, 1):
            inertial += known.get(f"mass_{max(i, k)}_{min(i, k)}", sp.Integer(0)).xreplace(values) * speeding[other]
        active = sp.Add(*(v * small[x] for x, v in linear(known[f"force_{i}"]).items()))
        mine = [velocity[q] for q, row in zip(of.coordinates, turning, strict=True) if row[speed] != 0]
        by = [*small, *along, *along.values(), *speeding.values()]
        sides = (
            tidy(e.xreplace(special), tuple(dict.fromkeys(s for s in by if s.is_Symbol))) for e in (inertial, active)
        )
        rows.append((mine[0].name if len(mine) == 1 else speed.name, *sides))
    return rows


def _is_part(equation: Equation) -> bool:
    return equation.name.startswith("part_")


def _first_order_of(
    chain: list[tuple[sp.Symbol, sp.Expr]], moving: list[sp.Symbol], rest: Mapping[sp.Symbol, sp.Expr]
) -> tuple[dict[sp.Symbol, sp.Expr], dict[sp.Symbol, dict[sp.Symbol, sp.Expr]]]:
    """Return values at rest, and derivatives there by all that moves, along a chain of named parts."""
    values = {s: sp.sympify(v) for s, v in rest.items()}
    by_all: dict[sp.Symbol, dict[sp.Symbol, sp.Expr]] = {s: {s: sp.Integer(1)} for s in moving}
    for symbol, value in chain:
        by_all[symbol] = {x: d for x in moving if (d := _slope(value, x, values, by_all)) != 0}
        values[symbol] = sp.sympify(value).xreplace(values)
    return values, by_all


def _slope(
    expression: sp.Expr,
    by: sp.Symbol,
    values: Mapping[sp.Symbol, sp.Expr],
    by_all: Mapping[sp.Symbol, Mapping[sp.Symbol, sp.Expr]],
) -> sp.Expr:
    found = (s for s in expression.free_symbols if by in by_all.get(s, {}))
    parts = (sp.diff(expression, s).xreplace(values) * by_all[s][by] for s in sorted(found, key=lambda s: s.name))
    return sp.expand(sp.Add(*parts))


def _rays(so_far: Derivation, kept: list[tuple[str, sp.Expr, sp.Expr]], chosen: list[int]) -> Check:
    """Differentiate the exact equations at rest along a motion that is scaled down to rest, by its size."""
    model = stated_as(AboutRest, so_far)
    of, original, special = model.of, so_far.original, model.special()
    assert original is not None
    known = {e.name: e.rhs for e in original.step("kane").equations}
    chain = [*of.named.items(), *((e.lhs, e.rhs) for e in original.step("kane").equations if _is_part(e))]
    rates, _ = numeric_along(of.named.items(), of.coordinates.values())
    numbers = range(1, len(of.speeds) + 1)
    masses = [known.get(f"mass_{max(i, k)}_{min(i, k)}", sp.Integer(0)) for i in numbers for k in numbers]
    rests = [known[f"{kind}_{i}"] for kind in ("bias", "force") for i in numbers]
    exact, _ = numeric_along(chain, [*masses, *rests])
    at_rest = numeric([sp.sympify(of.reference[s]) for s in symbols_of(of.states)])
    paired = [u for u in of.speeds if any(sp.sympify(r).has(u) for r in of.coordinates.values())]
    found = numeric([e for _, lhs, rhs in kept for e in (lhs, rhs)])

    def speeds(point: Point, places: Mapping[sp.Symbol, Any], wanted: list[Any]) -> list[Any]:
        """Return the speeds that give the coordinates these rates, which are linear in the speeds."""

        def at(values: list[Any]) -> mp.matrix:
            return mp.matrix(rates({**point, **places, **dict(zip(paired, values, strict=True))}))

        zero = at([mp.mpf(0)] * len(paired))
        matrix = mp.matrix(len(wanted), len(paired))
        for k in range(len(paired)):
            matrix[:, k] = at([mp.mpf(int(j == k)) for j in range(len(paired))]) - zero
        return list(mp.lu_solve(matrix, mp.matrix(wanted) - zero))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        point = point | dict(zip(special, numeric(list(special.values()))(point), strict=True))
        resting = dict(zip(symbols_of(of.states), at_rest(point), strict=True))

        def residual(size: Any) -> list[Any]:
            def moved(time: Any) -> tuple[dict[sp.Symbol, Any], list[Any]]:
                places, wanted = {}, []
                for q in of.coordinates:
                    v = model.velocities.get(q)
                    own = (point[q], point[v], point[n.rate_of(v)]) if v is not None else (0, 0, 0)
                    places[q] = size * (own[0] + own[1] * time + own[2] * time**2 / 2)
                    wanted.append(size * (own[1] + own[2] * time))
                return places, speeds(point, places, wanted)

            places, now = moved(mp.mpf(0))
            change = slopes(lambda s: moved(s)[1])
            others = {
                u: resting[u] + size * (point[u] - resting[u] if u in _own_speeds(model) else 0) for u in of.speeds
            }
            state = {**point, **others, **places, **dict(zip(paired, now, strict=True))}
            state |= {c: size * point.get(c, 0) for c in symbols_of(of.controls)}
            values, count = exact(state), len(of.speeds)
            rate = dict(zip(paired, change, strict=True))
            moving = [rate.get(u, size * point.get(n.rate_of(u), 0)) for u in of.speeds]
            inertial = [
                sum(values[i * count + k] * moving[k] for k in range(count)) + values[count * count + i]
                for i in range(count)
            ]
            return [e for pair in zip(inertial, values[count * count + count :], strict=True) for e in pair]

        change = slopes(residual)
        return found(point), [change[2 * k + side] for k in chosen for side in (0, 1)]

    symbols = {*symbols_of((*of.states, *of.controls, *of.parameters, *model.states)), n.TIME}
    symbols |= {n.rate_of(s) for s in (*model.velocities.values(), *_own_speeds(model))}
    return compare("first order along rays to rest", symbols, sides)
