"""Costs that consist of control effort and, perhaps, the rate of change of a function of the state.

The integral of such a rate depends on the ends alone: it changes the costates and not the control. For chains of
integrators the minimum effort has a closed form.
"""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, simplify
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over
from satsym.symbolic.factoring import factored
from satsym.symbolic.model import Model, Problem, symbols_of, t, variables_of
from satsym.symbolic.notation import free_letter, indexed, named
from satsym.symbolic.principle import parts
from satsym.symbolic.principle.parts import Part

if TYPE_CHECKING:
    from satsym.symbolic.principle.branches import Minimum


def exact_differential(so_far: Derivation) -> Step | None:
    """Find the part of the running cost that is the rate of change of a quadratic function of the state."""
    problem = so_far.problem
    assert problem is not None
    states, cost = symbols_of(so_far.model.states), sp.sympify(problem.running_cost)
    potential = _potential(so_far)
    if potential is None:
        return None
    rates = so_far.rhs("first_order").xreplace(definitions_of(so_far.model))
    gradient = [factored(sp.diff(potential, x)) for x in states]
    change = sum(g * f for g, f in zip(gradient, rates, strict=True))
    reduced = factored(sp.expand(cost.xreplace(definitions_of(so_far.model)) - change))
    costates = [n.costate_of(x) for x in states]
    shifted = {
        lam: reduced_costate_of(x) - sign(problem) * g for lam, x, g in zip(costates, states, gradient, strict=True)
    }
    hamiltonian = so_far.equation("hamiltonian.H").rhs.xreplace(definitions_of(so_far.model))
    other = sign(problem) * reduced + sum(reduced_costate_of(x) * f for x, f in zip(states, rates, strict=True))
    moving = {
        **dict(zip(states, rates, strict=True)),
        **dict(zip(costates, so_far.rhs("costate_equations"), strict=True)),
    }
    sums = [lam + sign(problem) * g for lam, g in zip(costates, gradient, strict=True)]
    drift = [
        sum(sp.diff(total, v) * rate for v, rate in moving.items())
        + sp.diff(other, x).xreplace({reduced_costate_of(y): m for y, m in zip(states, sums, strict=True)})
        for x, total in zip(states, sums, strict=True)
    ]
    checks = (
        identity("same Hamiltonian", [hamiltonian.xreplace(shifted) - other]),
        identity("costates of the rest", [d.xreplace(definitions_of(so_far.model)) for d in drift]),
    )
    equations = (
        Equation("potential", POTENTIAL, potential),
        Equation("reduced_cost", REDUCED_COST, reduced),
        *(Equation(lam.name, lam, shifted[lam]) for lam in costates),
    )
    sources = ("first_order", "hamiltonian", "costate_equations")
    said = (Conclusion("the control does not depend on it", {"potential": POTENTIAL}),)
    rule = worded("part of the cost is exact", problem)
    return Step("exact_differential", rule, equations, sources, checks, said)


def minimum_effort(so_far: Derivation) -> Step | None:
    """Derive the unbounded control to rest at zero in a given time, and its cost, for a chain of integrators."""
    found = _chain(so_far)
    if found is None:
        return None
    a, b, weight = found
    model = so_far.model
    states, (control,) = symbols_of(model.states), symbols_of(model.controls)
    end = n.FINAL_TIME
    power = _flow(a, end - t)
    gramian = (power * b * b.T * power.T).applyfunc(lambda e: sp.integrate(sp.expand(e), (t, 0, end)))
    start = sp.Matrix([n.initial(x) for x in states])
    pull = gramian.LUsolve(_flow(a, end) * start)
    law = sp.expand(simplify((-b.T * power.T * pull)[0]))
    later = sp.Dummy("z")
    path = (_flow(a, t) * start + _integral(_flow(a, t - later) * b * law.xreplace({t: later}), later)).applyfunc(
        lambda e: sp.collect(sp.expand(e), t, factored)
    )
    spent = factored(simplify(weight * sp.integrate(sp.expand(law**2), (t, 0, end))))
    rest = dict.fromkeys(start[1:], sp.Integer(0))
    from_rest = factored(law.xreplace(rest))
    peak = sp.Abs(from_rest.subs(t, 0))
    equations = [
        Equation(control.name, control, sp.collect(law, t, factored)),
        *(Equation(x.name, x, value) for x, value in zip(states, path, strict=True)),
        Equation("cost", MINIMUM_COST, spent),
        Equation("from_rest", n.answer_of(control), from_rest),
        Equation("peak", peak_of(control), simplify(peak)),
        Equation("cost_from_rest", COST_FROM_REST, factored(spent.xreplace(rest))),
    ]
    value, slopes = numeric([*path, law]), a * path + b * law
    proofs = identity(
        "obeys the motion and ends at zero",
        [
            *(sp.diff(x, t) - f for x, f in zip(path, slopes, strict=True)),
            *path.subs(t, end),
            *(path.subs(t, 0) - start),
        ],
    )
    multiplier = _flow(-a.T, t) * _flow(a.T, end) * pull
    adjoint = [*(sp.diff(multiplier, t) + a.T * multiplier), (b.T * multiplier)[0] + law]
    optimal = identity("costates of such a control", adjoint)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Compute the cost by numeric quadrature, beside the closed form."""
        here = {**point, n.FINAL_TIME: abs(point[n.FINAL_TIME])}
        found_cost = numeric([spent])(here)
        scale = numeric([weight])(here)[0]
        return found_cost, [scale * mp.quad(lambda time: value({**here, t: time})[-1] ** 2, [0, here[n.FINAL_TIME]])]

    symbols = {n.FINAL_TIME, *start}.union(*(e.free_symbols for e in (*path, law, spent, weight))) - {t}
    check = compare("cost by quadrature", symbols, sides)
    said = []
    if sp.limit(equations[-1].rhs, end, sp.oo) == 0:
        said.append(Conclusion("longer is always cheaper", {"cost": equations[-1].rhs}))
    return Step(
        "least_effort",
        "steer with less of the cost" if "exact_differential" in so_far else "steer with least effort",
        tuple(equations),
        ("first_order", *(("exact_differential",) if "exact_differential" in so_far else ())),
        (proofs, optimal, check),
        tuple(said),
    )


def _potential(so_far: Derivation) -> sp.Expr | None:
    """Return a quadratic function of the state whose rate of change removes the states from the running cost."""
    problem, model = so_far.problem, so_far.model
    assert problem is not None
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    constants = definitions_of(model)
    cost = sp.sympify(problem.running_cost).xreplace(constants)
    rates = so_far.rhs("first_order").xreplace(constants)
    moving = (*states, *controls)
    if not cost.free_symbols & set(states) or any(e.has(t) or not e.is_polynomial(*moving) for e in (cost, *rates)):
        return None
    terms = [*states, *(x * y for x, y in combinations_with_replacement(states, 2))]
    unknown = sp.symbols(f"c0:{len(terms)}", cls=sp.Dummy)
    ansatz = sum(c * term for c, term in zip(unknown, terms, strict=True))
    left = sp.expand(cost - sum(sp.diff(ansatz, x) * f for x, f in zip(states, rates, strict=True)))
    parts = sp.Poly(left, *moving).terms()
    with_states = [c for m, c in parts if any(m[: len(states)])]
    linear = [c for m, c in parts if not any(m[: len(states)]) and sum(m) == 1]
    # what is linear in the controls goes as well where it can; of several functions, one of later states
    tried = (sp.solve(conditions, unknown[::-1], dict=True) for conditions in ([*with_states, *linear], with_states))
    solution = next((found[0] for found in tried if len(found) == 1), None)
    if solution is None:
        return None
    found = ansatz.xreplace(solution).xreplace(dict.fromkeys(unknown, sp.Integer(0)))
    return factored(found) if found != 0 else None


def _chain(so_far: Derivation) -> tuple[sp.Matrix, sp.Matrix, sp.Expr] | None:
    """Return A, B and the weight of u^2 of a chain of integrators with one control, if only u^2 costs something."""
    problem, model = so_far.problem, so_far.model
    assert problem is not None
    if len(model.controls) != 1 or problem.terminal_cost != 0 or problem.interior:
        return None
    constants = definitions_of(model)
    states, (control,) = symbols_of(model.states), symbols_of(model.controls)
    reduced = "exact_differential" in so_far
    cost = so_far.equation("exact_differential.reduced_cost").rhs if reduced else sp.sympify(problem.running_cost)
    cost, rates = cost.xreplace(constants), so_far.rhs("first_order").xreplace(constants)
    weight = sp.expand(cost).coeff(control, 2)
    if weight == 0 or sp.expand(cost - weight * control**2) != 0 or weight.has(*states, t):
        return None
    a, b = rates.jacobian(states), rates.jacobian([control])
    moving = {*states, control, t}
    linear = sp.expand(a * sp.Matrix(states) + b * control - rates)
    if any(e != 0 for e in linear) or any(e.free_symbols & moving for e in (*a, *b)) or a ** len(states) != 0 * a:
        return None
    reached = sp.Matrix.hstack(*(a**k * b for k in range(len(states))))
    return (a, b, weight) if reached.rank() == len(states) else None


def _flow(a: sp.Matrix, time: sp.Expr) -> sp.Matrix:
    """Return e^(A t) of a nilpotent matrix as a finite series."""
    return sum((a**k * time**k / sp.factorial(k) for k in range(1, a.rows)), sp.eye(a.rows))


def _integral(vector: sp.Matrix, by: sp.Symbol) -> sp.Matrix:
    return vector.applyfunc(lambda e: sp.integrate(sp.expand(e), (by, 0, t)))


POTENTIAL, REDUCED_COST = sp.Symbol("cost_potential", real=True), sp.Symbol("reduced_cost", real=True)
MINIMUM_COST, COST_FROM_REST = sp.Symbol("least_cost", real=True), sp.Symbol("cost_from_rest", real=True)


reduced_costate_of = named("reduced_lambda_{}")
"""The symbol for the costate of a state in the problem without the exact-differential part of the cost."""
peak_of = named("{}_peak")
"""The symbol for the largest magnitude of a control."""


def cost_letter(model: Model) -> str:
    """Return the letter of the cost functional: J, unless a variable such as a moment of inertia has it."""
    return free_letter(("J", r"\mathcal{C}"), variables_of(model))


def names(model: Model, time: str) -> dict[str, str]:
    """Map the names of all symbols of such costs to LaTeX, with the given letter for time."""
    found = {
        POTENTIAL.name: r"\mathcal{V}",
        REDUCED_COST.name: "L_0",
        MINIMUM_COST.name: f"{cost_letter(model)}_0",
        COST_FROM_REST.name: rf"{cost_letter(model)}_{{\mathrm{{rest}}}}",
    }
    found |= {f"reduced_lambda_{v.symbol}": rf"\mu_{{{v.latex}}}" for v in model.states}
    for v in model.controls:
        from_rest = indexed(v.latex, r"{\mathrm{rest}}")
        found |= {f"{v.symbol}_peak": rf"|{from_rest}|_{{\max}}", f"{v.symbol}_answer": f"{from_rest}({time})"}
    return found


REGULARISED_H = sp.Symbol("H_regularised", real=True)
"""The Hamiltonian of the regularised problem with directions."""

slope_by = named("slope_by_{}")
"""H_u of a control on which H depends neither linearly nor quadratically."""
MOST_PARTS = 200
"""Largest number of named parts of control laws."""


def part_of_law(number: int) -> sp.Symbol:
    """Return the symbol for the part of a control law with this number."""
    return sp.Symbol(f"law_part_{number}", real=True)


def letter_of_parts(problem: Problem) -> str:
    """Return the letter for parts of control laws, one that no variable has."""
    return free_letter("qkdgs", variables_of(problem.model))


primer_of = named("primer_{}")
"""The slope of H by a control on which it depends linearly, in a ball."""
weight_of = named("norm_weight_{}")
"""The factor of a vector's norm in H, named after the first control of the vector."""
cosine_of, sine_of = named("cosine_of_{}"), named("sine_of_{}")
"""The factors of the cosine and the sine of an angle in H."""
along_of, across_of = named("along_{}"), named("across_{}")
"""The components that replace cosine and sine in the regularised problem."""


def slopes_of(one: Minimum) -> tuple[sp.Symbol, ...]:
    """Return symbols for the slope of H where it is linear in a vector."""
    if one.part.kind == "angle" or one.turned_by:
        return cosine_of(one.part.symbols[0]), sine_of(one.part.symbols[0])
    return tuple(map(primer_of, one.part.symbols))


def components_of(part: Part) -> tuple[sp.Symbol, ...]:
    """Return the vector in which H is linear: controls, or the components that replace cosine and sine."""
    if part.kind == "angle":
        return along_of(part.symbols[0]), across_of(part.symbols[0])
    return part.symbols


def product_names(problem: Problem) -> dict[str, str]:
    """Map the names of all symbols in the law over a product of sets to LaTeX."""
    found = {REGULARISED_H.name: r"H_\varepsilon"}
    found |= {v.symbol: v.latex for v in (parts.SMOOTHING, parts.FRACTION)}
    if problem.control_sets or problem.control_set == "box":
        found |= {part_of_law(k).name: f"{letter_of_parts(problem)}_{{{k}}}" for k in range(1, MOST_PARTS + 1)}
    angles = {v.symbol for part in parts.parts_of(problem) if part.kind == "angle" for v in part.controls}
    for v in problem.model.controls:
        found |= {f"slope_by_{v.symbol}": f"H_{{{v.latex}}}", f"primer_{v.symbol}": f"p_{{{v.latex}}}"}
        turned = v.symbol in angles
        for name, of in (("cosine", r"\cos"), ("sine", r"\sin")):
            found[f"{name}_of_{v.symbol}"] = f"H_{{{of} {v.latex}}}" if turned else f"H_{{{v.latex}{of}}}"
        found[f"along_{v.symbol}"] = f"c_{{{v.latex}}}"
        found |= {f"across_{v.symbol}": f"s_{{{v.latex}}}", f"norm_weight_{v.symbol}": f"w_{{{v.latex}}}"}
    for part in parts.parts_of(problem):
        squares = " + ".join(f"{v.latex}^2" for v in part.controls)
        found[f"norm_of_{part.name}"] = rf"\sqrt{{{squares}}}"
    return found


def declare_product(known: dict[str, Dimension | None], problem: Problem, running: Dimension | None) -> None:
    """Enter the dimensions of all symbols in the law over a product of sets."""
    known[REGULARISED_H.name], known[parts.FRACTION.symbol] = running, PLAIN
    efforts = []
    for part in parts.parts_of(problem):
        for v in part.controls:
            known[f"slope_by_{v.symbol}"] = known[f"primer_{v.symbol}"] = known[f"norm_weight_{v.symbol}"] = over(
                running, known[v.symbol]
            )
            known[f"norm_of_{part.name}"] = known[v.symbol]
            turned = running if part.kind == "angle" else over(running, known[v.symbol])
            known[f"cosine_of_{v.symbol}"] = known[f"sine_of_{v.symbol}"] = turned
            known[f"along_{v.symbol}"] = known[f"across_{v.symbol}"] = PLAIN
        switched = part.kind == "box" and sp.diff(problem.running_cost, part.symbols[0], 2) == 0
        if switched or part.kind in ("ball", "annulus", "angle"):
            units = (PLAIN if part.kind == "angle" else known[v.symbol] for v in part.controls)
            efforts += [over(over(running, unit), unit) for unit in units]
    # one number smooths all directions: where their units differ it has none that would suit them all
    known[parts.SMOOTHING.symbol] = efforts[0] if efforts and all(e == efforts[0] for e in efforts) else None
