"""The text of a generated module, from a derivation, with the units of its cost and of conserved quantities.

These units are composed of the author's own units alone: a model in km and s has a cost in km**2/s**3. Where the
author's units can be combined to units of several sizes, as m and km can, or count angles other than in radians, no
unit is stated.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence

import sympy as sp

from satsym import units
from satsym.codegen import loops, searching
from satsym.codegen.block import Assignment, Emitter, build
from satsym.codegen.functions import Function, Symbols, symbols
from satsym.codegen.linear import linear_functions
from satsym.codegen.naming import NEEDED, Code, code_of
from satsym.codegen.printers import BatchPrinter, ScalarPrinter
from satsym.codegen.switching import switches
from satsym.control_part import ControlPart
from satsym.kernels.contract import TUPLES
from satsym.kernels.digest import sealed
from satsym.spec import PRODUCT, Condition, InteriorPoint, PathConstraint, ProblemSpec, Variable, names
from satsym.status import BadInput
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.dimension_algebra import Dimension, Disagreement, dimension_of
from satsym.symbolic.dimensions import declared, of_unit
from satsym.symbolic.functions.roots import Argmin, Root, Vertex
from satsym.symbolic.model import Demand, t, variables_of
from satsym.symbolic.motion.central_force import strength_of
from satsym.symbolic.principle import product, set_laws
from satsym.symbolic.principle.path import mixed_constraints
from satsym.symbolic.switching.curve import states_of
from satsym.symbolic.switching.functions import moving_magnitudes
from satsym.symbolic.switching.singular import chattering

UNKNOWN = ""
SIZE_TOLERANCE = 1e-9
"""Largest relative difference of the sizes of two equal units."""


def unit_of_objective(derivation: Derivation) -> str:
    """Return the unit of the cost: the stated one, or that of its terms; empty where it is not clear."""
    problem = derivation.problem
    if problem is None or problem.unit:
        return problem.unit if problem else UNKNOWN
    return unit_of(declared(derivation)[n.TERMINAL_COST.name], _names(derivation))


def units_of_expressions(derivation: Derivation, expressions: Iterable[sp.Expr]) -> list[str]:
    """Return the units of expressions in the symbols of a model, ``"1"`` where a unit is not clear."""
    known, names = declared(derivation), _names(derivation)
    found = []
    for expression in expressions:
        try:
            found.append(unit_of(dimension_of(expression, known), names) or "1")
        except Disagreement:
            found.append("1")
    return found


def unit_of(dimension: Dimension | None, names: Sequence[str]) -> str:
    """Return the shortest unit of a dimension that is composed of the given names.

    Returns
    -------
    str
        ``"1"`` for a plain number; empty where there is none, or units of several sizes.
    """
    if dimension is None:
        return UNKNOWN
    if not dimension:
        return "1"
    by_name = {name: found for name in names if (found := of_unit(name))}
    bases = sorted({base for found in by_name.values() for base in found} | set(dimension))
    wanted = sp.Matrix([dimension.get(base, 0) for base in bases])
    candidates: list[dict[str, int]] = []
    for count in range(1, len(bases) + 1):
        for chosen in itertools.combinations(by_name, count):
            columns = sp.Matrix([[by_name[name].get(base, 0) for name in chosen] for base in bases])
            if columns.rank() < count or columns.row_join(wanted).rank() > count:
                continue
            exponents = (columns.T * columns).LUsolve(columns.T * wanted)
            if all(e.is_Integer for e in exponents) and all(exponents):
                candidates.append({name: int(e) for name, e in zip(chosen, exponents, strict=True)})
    sizes = [math.prod(units.in_base_units(name) ** e for name, e in one.items()) for one in candidates]
    if not candidates or max(sizes) > (1.0 + SIZE_TOLERANCE) * min(sizes):
        return UNKNOWN
    shortest = min(candidates, key=lambda one: sum(map(abs, one.values())))
    # such as N*m*s: what is made of most comes first, time last
    order = sorted(shortest, key=lambda name: (list(by_name[name]) == ["[time]"], -len(by_name[name])))
    return units.expression({name: shortest[name] for name in order})


def _names(derivation: Derivation) -> list[str]:
    """Return the names of the author's units, in order of first use; none where angles are not in radians."""
    stated = [v.unit for v in variables_of(derivation.model)]
    try:
        names = list(dict.fromkeys(name for unit in stated for name in units.factors(unit)))
        angular = {name for name in names if not of_unit(name) and units.in_base_units(name) != 1.0}
    except BadInput:
        return []
    return [] if angular else names


def render(derivation: Derivation, source: str) -> str:
    """Return the source text of the module generated from a derivation.

    Parameters
    ----------
    source
        Name of the derivation file, for the header.

    Returns
    -------
    str
        Straight-line Python that imports only ``math`` and ``numpy``, with a digest of itself; the same text for
        the same derivation, always.
    """
    code = code_of(derivation)
    s, constants = code.symbols, list(code.constants.items())
    parts_of_motion = loops.split(derivation)
    written = [(f, *_straight_line(f, s, constants, code.chain)) for f in code.functions]
    parts = [
        _header(derivation, source),
        _literal(spec(derivation, source)),
        *(_scalar_form(f, s, assignments, outputs) for f, assignments, outputs in written),
        *(loops.source(loop) for loop in _loops(derivation, code, constants)),
        *([loops.kicks_and_drifts(code, parts_of_motion, constants)] if parts_of_motion else []),
        *(_batch_form(f, s, assignments, outputs) for f, assignments, outputs in written),
    ]
    return sealed("\n\n".join(parts))


def spec(derivation: Derivation, source: str) -> ProblemSpec:
    """Return the description of the model that its module contains."""
    model, problem = derivation.model, derivation.problem
    conserved = derivation.step("conserved").equations if "conserved" in derivation else ()
    particle = model.particle()
    return ProblemSpec(
        name=derivation.name,
        title=derivation.title,
        source=source,
        states=model.states,
        controls=model.controls,
        parameters=model.parameters,
        control_set=(PRODUCT if product.STEP in derivation else problem.control_set) if problem else None,
        control_parts=_parts(derivation),
        has_cost=problem is not None,
        has_terminal_cost=bool(problem and problem.terminal_cost != 0),
        maximise=bool(problem and problem.maximise),
        objective_unit=unit_of_objective(derivation),
        has_reference=bool(model.reference),
        terminal_inequalities=tuple(problem.terminal_inequalities) if problem else (),
        path_constraints=tuple(PathConstraint(one.name, one.order) for one in mixed_constraints.every(derivation)),
        interior=tuple(InteriorPoint(name, len(stated)) for name, stated in problem.interior.items())
        if problem
        else (),
        linear_quadratic=mixed_constraints.linear_quadratic(derivation),
        autonomous=not any(
            e.has(t) for e in (*derivation.rhs("first_order"), sp.sympify(problem.running_cost if problem else 0))
        ),
        invariants=tuple(
            Variable(e.name, derivation.notation[e.name], unit)
            for e, unit in zip(conserved, units_of_expressions(derivation, (e.rhs for e in conserved)), strict=True)
        ),
        multipliers=tuple(Variable(v.name, derivation.notation[v.name]) for v in symbols(derivation).nu),
        position=tuple(Variable(axis, axis) for axis in ("x", "y", "z")[: len(particle.position) if particle else 0]),
        outputs=tuple(o.variable for o in model.outputs) if (linear := linear_functions(derivation)) else (),
        linear=tuple(f.name for f in linear),
        keplerian=strength_of(derivation) is not None,
        switching=switches(derivation),
        switching_curve=states_of(derivation) or (),
        chattering=chattering(derivation),
        moving_magnitudes=tuple(u.name for u in moving_magnitudes(derivation)) if switches(derivation) else (),
        coordinates=tuple(q.name for q in parts.coordinates) if (parts := loops.split(derivation)) else (),
        velocities=tuple(v.name for v in parts.velocities) if parts else (),
        quantities=_quantities(derivation),
        equilibria=model.followed(),
        mode_groups=model.mode_groups(),
        conditions=tuple(_condition(d) for d in model.demanded()),
        balances=tuple(
            Variable(e.name, derivation.notation[e.name])
            for e in (derivation.step("balance").equations if "balance" in derivation else ())
        ),
    )


def _parts(derivation: Derivation) -> tuple[ControlPart, ...]:
    """Return the sets of a product of control sets as plain data."""
    if product.STEP not in derivation:
        return ()
    return tuple(
        ControlPart(
            one.part.name,
            one.part.kind,
            names(one.part.controls),
            one.branch,
            one.part.kind == "box" and any(e.has(Vertex, Argmin) for e in one.laws),
            one.turned_by.name if one.turned_by else "",
        )
        for one in set_laws.found(derivation)
    )


def _condition(demand: Demand) -> Condition:
    """Return a demand on parameters as plain numbers."""
    weights = {s.name: float(sp.diff(demand.margin, s)) for s in demand.margin.free_symbols}
    return Condition(tuple(sorted(weights.items())), demand.strict, demand.reason)


def _quantities(derivation: Derivation) -> tuple[Variable, ...]:
    """Return the variables of the equations in the step that derived quantities."""
    if "quantities" not in derivation:
        return ()
    declared = {v.symbol: v for v in variables_of(derivation.model)}
    return tuple(declared[e.name] for e in derivation.step("quantities").equations)


def _header(derivation: Derivation, source: str) -> str:
    return f'''"""{derivation.title}.

Written by satsym from {source}. Do not edit this file; edit that file instead, then run
    satsym derive {source}
"""

import math

import numpy as np
'''


def _literal(described: ProblemSpec) -> str:
    """Return the lines of ``MODEL``, one for each variable."""
    lines = []
    for key, value in described.to_literal().items():
        if isinstance(value, tuple) and value:
            lines += [f"    {key!r}: (", *(f"        {entry!r}," for entry in value), "    ),"]
        else:
            lines.append(f"    {key!r}: {value!r},")
    return "\n".join(["MODEL = {", *lines, "}", ""])


def _unpack(function: Function, s: Symbols) -> list[str]:
    """Return lines that give the arguments' components their names."""
    groups = [(a, s.of(a)) for a in function.arguments if a != "t"]
    return [f"{loops.unpacking(names)} = {a}" for a, names in groups if names]


def _straight_line(
    function: Function, s: Symbols, constants: Sequence[Assignment], chain: Sequence[Assignment]
) -> tuple[list[Assignment], list[sp.Expr]]:
    """Return assignments and outputs of a function under their final names."""
    names = {symbol.name for a in function.arguments for symbol in s.of(a)} | NEEDED
    emit = Emitter(names)
    outputs = emit.inline(build(function.outputs, constants, (), chain), {}, function.hints)
    return emit.before + emit.lines, outputs


def _lines(symbol: sp.Symbol, value: sp.Expr, form: str, code: Callable[[sp.Expr], str]) -> list[str]:
    """Return the statements that assign a value to a symbol."""
    written = (
        searching.root_lines
        if isinstance(value, Root)
        else searching.minimum_lines
        if isinstance(value, Argmin)
        else None
    )
    return written(symbol.name, value, form, code) if written else [f"{symbol} = {code(value)}"]


def _scalar_form(function: Function, s: Symbols, assignments: Sequence[Assignment], outputs: Sequence[sp.Expr]) -> str:
    code = ScalarPrinter().doprint
    results = [code(o) for o in outputs]
    body = [*_unpack(function, s), *(line for a, e in assignments for line in _lines(a, e, "math", code))]
    if function.kind == "scalar":
        body.append(f"return {results[0]}")
    else:
        body += ["return (", *(f"    {r}," for r in results), ")"]
    return _function(f"{function.name}({', '.join(function.arguments)})", function.summary, body)


def _batch_form(function: Function, s: Symbols, assignments: Sequence[Assignment], outputs: Sequence[sp.Expr]) -> str:
    code = BatchPrinter().doprint
    rows, columns = function.value.shape
    shape = {"scalar": "shape", "vector": f"({rows}, *shape)", "matrix": f"({rows}, {columns}, *shape)"}[function.kind]
    sizes = [a if a == "t" else f"{a}[0]" for a in function.arguments if a not in TUPLES and s.of(a)]
    sizes += [f"p[{k}]" for k in range(len(s.p))] if function.over_parameters else []
    types = [f"*{a}" if a in TUPLES else a for a in function.arguments]
    blank = function.kind == "matrix" and 2 * outputs.count(sp.S.Zero) > len(outputs)
    body = [
        *_unpack(function, s),
        "if out is None:",
        f"    shape = np.broadcast_shapes({', '.join(f'np.shape({a})' for a in sizes)})",
        f"    out = np.empty({shape}, np.result_type(float, {', '.join(types)}))",
        *(["out[...] = 0.0"] if blank else []),
        *(line for a, e in assignments for line in _lines(a, e, "np", code)),
    ]
    for k, output in enumerate(outputs):
        place = {"scalar": "...", "vector": str(k), "matrix": f"{k // columns}, {k % columns}"}[function.kind]
        if not (blank and output == 0):
            body.append(f"out[{place}] = {code(output)}")
    return _function(
        f"{function.name}_batch({', '.join(function.arguments)}, out=None)",
        f"{function.summary} Batch form.",
        [*body, "return out"],
    )


def _function(signature: str, summary: str, body: Sequence[str]) -> str:
    return "\n".join([f"def {signature}:", f'    """{summary}"""', *(f"    {line}" for line in body), ""])


def _loops(derivation: Derivation, code: Code, constants: Sequence[Assignment]) -> list[loops.Loop]:
    """Return the text of the forward loop and, where there is a cost, the backward one."""
    problem, s = derivation.problem, code.symbols
    fixed = {*s.p, *(c for c, _ in constants)}
    rates = [*derivation.rhs("first_order"), *([sp.sympify(problem.running_cost)] if problem else [])]
    forward = loops.Loop(
        name="forward",
        summary="RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."
        if problem
        else "RK4 over the nodes from x0 at times[0].",
        signature="times, x0, u, u_mid, p, x, x_mid",
        backward=False,
        time=s.t,
        parameters=s.p,
        integrated=s.x,
        start="x0",
        nodes="x",
        mids="x_mid",
        given=(("u", "u_mid", s.u),),
        rates=build([code.renamed(e) for e in rates], constants, (fixed,), code.chain),
        sums=problem is not None,
    )
    if not problem:
        return [forward]
    return [
        forward,
        loops.Loop(
            name="backward",
            summary="RK4 over the nodes, from the costates lam_f at times[-1] back to times[0].",
            signature="times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid",
            backward=True,
            time=s.t,
            parameters=s.p,
            integrated=s.lam,
            start="lam_f",
            nodes="lam",
            mids="lam_mid",
            given=(("x", "x_mid", s.x), ("u", "u_mid", s.u)),
            rates=build(
                [code.renamed(e) for e in derivation.rhs("costate_equations")], constants, (fixed, {*s.x, *s.u, s.t})
            ),
            sums=False,
        ),
    ]
