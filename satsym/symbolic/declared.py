"""Checks of what a derivation file states: misfits, foreign symbols and clashes of names are refused before any step.

Whether two problems state the same, also in different processes, is decided by a digest of all declarations.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any, get_args

import sympy as sp
from sympy.core.function import AppliedUndef

from satsym.spec import NAMES, ControlSetKind, Variable, is_name
from satsym.symbolic import notation as n
from satsym.symbolic import unsupported
from satsym.symbolic.algebra import constants_of
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.linear import notation as linear_notation
from satsym.symbolic.model import Model, Problem, symbols_of, variables_of
from satsym.symbolic.principle import effort as principle_notation
from satsym.symbolic.principle.parts import limits_of, parts_of
from satsym.symbolic.principle.path import interior
from satsym.symbolic.principle.path import notation as path_notation
from satsym.symbolic.switching import notation as switching_notation
from satsym.wording import shown


def refuse_misfits(model: Model, problem: Problem | None) -> None:
    """Refuse declarations that do not fit together: states, rates, references, sizes of vectors.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    for subject in (problem, model) if problem else (model,):
        if not is_name(subject.name):
            raise DerivationError(f"name: got {shown(subject.name)}; the name of a model must be {NAMES}", ("name",))
    for complaint in model.misfits():
        raise DerivationError(f"{model.name}: {complaint}")
    states = symbols_of(model.states)
    if model.reference and set(states) != set(model.reference):
        odd = sorted(s.name for s in set(states) ^ set(model.reference))
        raise DerivationError(
            f"{model.name}: the reference must have one curve for each state; look at {', '.join(odd)}"
        )
    if problem and problem.control_set not in get_args(ControlSetKind):
        kinds = " or ".join(f'"{kind}"' for kind in get_args(ControlSetKind))
        raise DerivationError(
            f"{problem.name}: control_set: got {shown(problem.control_set)}; give {kinds}", ("control_set",)
        )
    if problem and problem.control_sets and problem.control_set != "free":
        raise DerivationError(
            f"{problem.name}: control_set: control_sets already defines each control set; leave it out",
            ("control_set",),
        )
    if problem and not isinstance(problem.maximise, bool):
        raise DerivationError(
            f"{problem.name}: maximise: got {shown(problem.maximise)}; write True or False", ("maximise",)
        )
    if problem and problem.running_cost == 0 and problem.terminal_cost == 0:
        raise DerivationError(
            f"{problem.name}: no objective; give a running_cost (1 for minimum time) or a terminal_cost"
        )
    if problem:
        _refuse_inequalities(problem)
        _refuse_constraints(problem)
        _refuse_interior(problem)
    if problem and not model.controls:
        raise DerivationError(f"{problem.name}: the model has no controls, so there is nothing to optimise")


def _refuse_inequalities(problem: Problem) -> None:
    """Refuse inequalities without names, and inequalities at the end that have the name of a state."""
    for field in ("path_constraints", "terminal_inequalities"):
        stated, what = getattr(problem, field), f"{problem.name}: {field}"
        if not isinstance(stated, Mapping):
            raise DerivationError(f'{what}: write a name for each of them, {{"ceiling": h - h_max}}', (field,))
        for name in stated:
            if not is_name(name) or "__" in name:
                raise DerivationError(f"{what}: got {shown(name)}; the name of a constraint must be {NAMES}", (field,))
    states = {v.symbol for v in problem.model.states}
    for name in problem.terminal_inequalities:
        if name in states:
            message = f"{problem.name}: terminal_inequalities: {name} is the name of a state; choose another"
            raise DerivationError(message, ("terminal_inequalities",))


def _refuse_constraints(problem: Problem) -> None:
    """Refuse path constraints in problems with features that exclude them."""
    constraints, what = problem.path_constraints, f"{problem.name}: path_constraints"
    parts = parts_of(problem) if constraints else ()
    if taken := [b.symbol for part in parts if part.kind == "box" for b in part.limits if b.symbol in constraints]:
        message = f"{taken[0]} is the name of a bound of the controls; choose another"
        raise DerivationError(f"{what}: {message}", ("path_constraints",))
    if any(part.kind in ("ball", "annulus") for part in parts):
        message = (
            "bounds on the norm of controls are not supported together with path constraints; use a box or an angle, "
            "or leave out the path constraints"
        )
        raise DerivationError(f"{what}: {message}", ("path_constraints", "control_set", "control_sets"))


def _refuse_interior(problem: Problem) -> None:
    """Refuse points on the way that have no names, or whose problem has features that exclude them."""
    stated, what = problem.interior, f"{problem.name}: interior"
    if not isinstance(stated, Mapping) or not all(isinstance(one, tuple) and one for one in stated.values()):
        raise DerivationError(
            f'{what}: give each point a name and the expressions that vanish there, such as {{"flyby": (x - a, y - b)}}'
        )
    for name, conditions in stated.items():
        if not is_name(name) or "__" in name:
            raise DerivationError(f"{what}: got {shown(name)}; the name of a point must be {NAMES}", ("interior",))
        if len(conditions) > len(problem.model.states):
            message = f"{name} has more conditions than there are states; give fewer"
            raise DerivationError(f"{what}: {message}", ("interior",))
    beside = [("path_constraints", bool(problem.path_constraints)), ("control_sets", bool(problem.control_sets))]
    beside += [(f'control_set "{problem.control_set}"', problem.control_set == "ball")]
    for other, there in beside if stated else ():
        if there:
            message = f"waypoints are not supported together with {other}; leave out one of the two"
            raise DerivationError(f"{what}: {message}", ("interior", other))


def refuse_foreign_symbols(derivation: Derivation) -> None:
    """Refuse expressions with symbols that were not declared, or that are not allowed in that place.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    model, problem = derivation.model, derivation.problem
    parameters, constants = set(symbols_of(model.parameters)), constants_of(model)
    motion = constants | set(symbols_of(model.states))
    everything = motion | set(symbols_of(model.controls))
    moving = {*symbols_of(model.states), *symbols_of(model.controls)}
    magnitudes = {sp.Abs(u) for u in symbols_of(model.controls)}
    fixed = parameters | set(symbols_of(one.variable for one in model.definitions))

    def refuse(what: str, stated: Iterable[Any], allowed: set[sp.Symbol], field: str = "") -> None:
        expressions = list(stated)
        if any(sp.sympify(e).has(sp.nan, sp.oo, -sp.oo, sp.zoo) for e in expressions):
            message = f"{derivation.name}: {what} is not finite, because of a division by zero"
            raise DerivationError(message, (field,))
        foreign = set().union(*(sp.sympify(e).free_symbols for e in expressions)) - allowed
        if foreign:
            message = f"{derivation.name}: {what} {_complaint(foreign, everything)}"
            raise DerivationError(message, (field, *sorted(s.name for s in foreign)))
        for e in map(sp.sympify, expressions):
            if complaint := unsupported.complaint(e, moving, magnitudes):
                raise DerivationError(f"{derivation.name}: {what} {complaint}", (field,))

    for definition in model.definitions:
        refuse(f"the value of {definition.variable.symbol}", [definition.value], parameters, "definitions")
    for what, expressions, allowed in model.stated():
        refuse(what, expressions, allowed)
    refuse("an output", [o.value for o in model.outputs], constants | set(symbols_of(model.measured())), "outputs")
    for state, curve in model.reference.items():
        refuse(f"the reference of {state}", [curve], constants, "reference")
    if problem:
        derived = set(symbols_of(o.variable for o in model.carried()))
        refuse("the running cost", [problem.running_cost], everything | derived, "running_cost")
        refuse("the terminal cost", [problem.terminal_cost], motion, "terminal_cost")
        refuse("a terminal constraint", problem.terminal_constraints, motion, "terminal_constraints")
        for name, stated in problem.terminal_inequalities.items():
            refuse(f"the terminal inequality {name}", [stated], motion, "terminal_inequalities")
        for name, stated in problem.path_constraints.items():
            refuse(f"the path constraint {name}", [stated], everything, "path_constraints")
        for name, conditions in problem.interior.items():
            refuse(f"the interior point {name}", conditions, motion, "interior")
            if idle := [e for e in conditions if sp.sympify(e).free_symbols <= fixed]:
                message = (
                    f"{name} requires {idle[0]} = 0, but this condition does not depend on the motion; give a "
                    f"condition on the states or on time"
                )
                raise DerivationError(f"{derivation.name}: interior: {message}", ("interior",))


def _complaint(foreign: set[sp.Symbol], everything: set[sp.Symbol]) -> str:
    """Describe the worst kind of fault among some foreign symbols."""
    names = {s.name for s in everything}
    if undeclared := sorted(s.name for s in foreign if s.name not in names):
        return f"uses undeclared symbols: {', '.join(undeclared)}"
    if twins := {s.name for s in foreign - everything}:
        meant = sorted((s for s in everything if s.name in twins), key=lambda s: s.name)
        written = (f'symbols("{s.name}", {"positive" if s.is_positive else "real"}=True)' for s in meant)
        return (
            "uses symbols with the declared names but other assumptions; take the symbols from symbols_of, or "
            f"write {', '.join(written)}"
        )
    return f"cannot depend on {', '.join(sorted(s.name for s in foreign))}"


def begin(model: Model, problem: Problem | None) -> Derivation:
    """Begin a derivation: no steps yet, with the notation of a model or problem.

    Raises
    ------
    DerivationError
        If two things have the same name.
    """
    variables, notation = _variables(model, problem), _notation(model, problem)
    _refuse_clashes(variables, {*notation, *_entries(model)})
    _refuse_letters(variables, _letters(problem, notation))
    results = {} if problem else linear_notation.results(model)
    return Derivation(model, problem, results | notation | {v.symbol: v.latex for v in variables})


def given_names(model: Model, problem: Problem | None) -> set[str]:
    """Return the names that a derivation introduces, which none of its variables may have."""
    limits = {v.symbol for v in limits_of(problem)} if problem else set()
    return {*_notation(model, problem), *_entries(model), *limits}


def _variables(model: Model, problem: Problem | None) -> list[Variable]:
    """Return the declared variables, and those that an instance gives values besides."""
    return [*variables_of(model), *(limits_of(problem) if problem else ())]


def _notation(model: Model, problem: Problem | None) -> dict[str, str]:
    """Map the names of derived quantities to their LaTeX."""
    notation = {s.name: latex for s, latex in n.FIXED.items()}
    for state, own in zip(symbols_of(model.states), (v.latex for v in model.states), strict=True):
        notation[n.rate_of(state).name] = rf"\frac{{d {own}}}{{dt}}"
        notation[n.initial(state).name] = n.indexed(own, "0")
        if problem:
            notation[n.costate_of(state).name] = rf"\lambda_{{{own}}}"
            notation[n.rate_of(n.costate_of(state)).name] = rf"\dot\lambda_{{{own}}}"
            notation[n.given(state).name] = rf"\iota_{{{own}}}"
            notation[n.on_reference(state).name] = rf"\iota^{{\mathrm{{r}}}}_{{{own}}}"
            notation[n.target(state).name] = n.barred(own)
            notation[n.residual_of(state).name] = rf"\mathcal{{B}}_{{{own}}}"
            notation[n.residual_of(n.costate_of(state)).name] = rf"\mathcal{{B}}_{{\lambda_{{{own}}}}}"
    for k, multiplier in enumerate(n.multipliers(problem) if problem else (), start=1):
        notation[multiplier.name] = rf"\nu_{{{k}}}"
        notation[n.residual_of(multiplier).name] = rf"\mathcal{{B}}_{{\psi_{{{k}}}}}"
    notation |= switching_notation.names(problem) if problem else {}
    if problem:
        notation |= principle_notation.product_names(problem) | path_notation.names(problem)
        notation |= interior.names(problem)
    for control in model.controls:
        notation[f"{control.symbol}_star"] = rf"{control.latex}^*"
        notation[f"{control.symbol}_hat"] = rf"\hat {control.latex}"
    notation |= model.names(problem)
    return notation | (principle_notation.names(model, notation[n.TIME.name]) if problem else {})


def _entries(model: Model) -> Iterable[str]:
    """Map the names of matrix entries to LaTeX: A = f_x, B = f_u, C = g_x, D = g_u, H_uu."""
    states, controls = ([v.symbol for v in group] for group in (model.states, model.controls))
    outputs = [o.variable.symbol for o in model.outputs]
    dynamic = (("A", states, states), ("B", states, controls), ("H", controls, controls))
    for letter, rows, columns in (*dynamic, ("C", outputs, states), ("D", outputs, controls)):
        yield from (f"{letter}_{row}_{column}" for row in rows for column in columns)


def _letters(problem: Problem | None, notation: Mapping[str, str]) -> set[str]:
    """Map the names that every problem introduces, such as H and the costates, to LaTeX, with those of its costs."""
    if problem is None:
        return set()
    costates = map(n.costate_of, symbols_of(problem.model.states))
    derived = (n.HAMILTONIAN, n.RUNNING_COST, n.TERMINAL_COST, n.FINAL_TIME, n.TIME, *costates, *n.multipliers(problem))
    return {_bare(notation[symbol.name]) for symbol in derived}


def _bare(latex: str) -> str:
    """Return LaTeX without what is not visible in print."""
    return re.sub(r"[{}\s]", "", latex)


def _refuse_letters(variables: Iterable[Variable], derived: Collection[str]) -> None:
    for v in variables:
        if _bare(v.latex) in derived:
            message = f"the LaTeX of {v.symbol!r}, {v.latex}, is reserved for a derived quantity; choose another"
            raise DerivationError(message, (v.symbol,))


def _refuse_clashes(variables: Iterable[Variable], derived: Collection[str]) -> None:
    seen: set[str] = set()
    for name in (v.symbol for v in variables):
        if name in seen:
            raise DerivationError(f"the name {name!r} is used twice; choose another name for one of the two", (name,))
        if name in derived:
            raise DerivationError(f"the name {name!r} is reserved for a derived quantity; choose another", (name,))
        seen.add(name)


_OURS = ("satsym.", "sympy.")


class _Unknown(Exception):
    """A declared object whose behaviour its content does not tell: a function, or an instance of a user's own class."""


def identity(subject: Problem | Model) -> str:
    """Return a digest of what is declared; empty where it contains code of its own, which no digest covers."""
    try:
        parts = "\n".join(_parts(subject))
    except _Unknown:
        return ""
    return hashlib.blake2b(parts.encode(), digest_size=16).hexdigest()


def _parts(value: Any) -> Iterator[str]:
    """Yield a line for each declared thing, in order; nested things are enclosed by brackets."""
    kind = type(value)
    if value is None or kind in (bool, int, float, str):
        yield repr(value)
    elif isinstance(value, sp.Basic | sp.MatrixBase):
        yield from _expression(value)
    elif isinstance(value, Enum) and kind.__module__.startswith(_OURS):
        yield f"{kind.__qualname__}.{value.name}"
    elif kind in (tuple, list):
        yield from ("(", *(part for each in value for part in _parts(each)), ")")
    elif isinstance(value, Mapping):
        yield from ("{", *(part for pair in value.items() for each in pair for part in _parts(each)), "}")
    elif is_dataclass(value) and kind.__module__.startswith(_OURS):
        yield f"{kind.__qualname__}("
        for field in fields(value):
            yield field.name
            yield from _parts(getattr(value, field.name))
        yield ")"
    else:
        raise _Unknown


def _expression(value: sp.Basic | sp.MatrixBase) -> Iterator[str]:
    yield sp.srepr(value)
    entries = [value] if isinstance(value, sp.Basic) else list(value)
    for node in (node for entry in entries for node in sp.preorder_traversal(entry)):
        if isinstance(node, AppliedUndef):
            yield repr((node.func.__name__, sorted(node.func._kwargs.items())))
        elif isinstance(node, sp.Basic) and not type(node).__module__.startswith(_OURS):
            raise _Unknown
