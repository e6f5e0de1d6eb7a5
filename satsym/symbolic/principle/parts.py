"""The control sets of a problem whose control set is their product, with the symbols of their numbers."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from satsym.control_part import PartKind
from satsym.spec import Variable
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.sets import AdmissibleSet, Angle, Annulus, Ball, Box, Free

SMOOTHING = Variable("smoothing", r"\varepsilon", meaning="weight of half the squares in it", positive=True)
"""Smoothing parameter, which follows the bounds in the ``bounds`` argument of kernels whose controls are directions."""

FRACTION = Variable("norm_factor", r"\kappa", meaning="factor of what norms add to H in it", positive=True)
"""Factor of norms in H, which follows the smoothing parameter if H depends on the norms of such directions."""


def minimum_norm_of(part: Part) -> Variable:
    """Return the variable of the minimum norm of a ball in which a vector may vanish.

    With equal minimum and maximum norms, the law gives a vector of this norm.
    """
    latex = rf"{control_sets.letter_of(part.controls)}_{{\mathrm{{{part.name}}}}}^{{\min}}"
    return Variable(f"{part.name}_least", latex, part.controls[0].unit, positive=True)


STATED: Mapping[PartKind, type[AdmissibleSet]] = {one.kind: one for one in (Free, Box, Ball, Annulus, Angle)}

SINGLE = "control"
"""Name of the only control set of a problem that is stated in the short form."""


@dataclass(frozen=True)
class Part:
    """One control set of a product.

    Attributes
    ----------
    name, kind
        As it is stated.
    controls
        Its controls.
    limits
        The variables that hold an instance's numbers.
    """

    name: str
    kind: PartKind
    controls: tuple[Variable, ...]
    limits: tuple[Variable, ...]

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """Return the symbols of the controls in this set."""
        return symbols_of(self.controls)

    @property
    def bounds(self) -> tuple[sp.Symbol, ...]:
        """Return the symbols of the numbers that limit this set."""
        return symbols_of(self.limits)


def parts_of(problem: Problem) -> tuple[Part, ...]:
    """Return the control sets of a problem, in the order in which they are stated.

    Raises
    ------
    DerivationError
        If they are not sets of the model's controls, each control in one of them.
    """
    if not problem.control_sets:
        return (_part(SINGLE, problem.control_set, problem.model.controls, ""),)
    declared = {v.symbol: v for v in problem.model.controls}
    seen: list[str] = []
    found = []
    boxed = {control for one in problem.control_sets.values() if one.kind == "box" for control in one.controls}
    # the norm of the only vector is called as that of all controls would be, unless it is the bound of a control u
    single = "u" not in boxed and sum(one.kind in ("ball", "annulus") for one in problem.control_sets.values()) == 1
    for name, one in problem.control_sets.items():
        if not one.controls or (one.kind == "angle" and len(one.controls) != 1):
            wanted = "one control" if one.kind == "angle" else "its controls"
            raise DerivationError(f"{problem.name}: control_sets {name!r}: name {wanted}, as in {_example(one.kind)}")
        for control in one.controls:
            if control not in declared:
                raise DerivationError(
                    f"{problem.name}: control_sets {name!r}: {control!r} is not a control; "
                    f"there are {', '.join(declared)}"
                )
        seen += one.controls
        mark = "" if single else name
        found.append(_part(name, one.kind, tuple(declared[c] for c in one.controls), mark))
    for control in declared:
        if (times := seen.count(control)) != 1:
            where = "in none of them" if not times else "in several"
            message = f"control_sets: {control!r} is {where}; put each control into one set"
            raise DerivationError(f"{problem.name}: {message}")
    return tuple(found)


def as_one(problem: Problem) -> Problem:
    """Return the problem with a single control set where its sets are all boxes, or all free.

    Raises
    ------
    DerivationError
        If they are not sets of the model's controls, each control in one of them.
    """
    if not problem.control_sets or problem.control_set != "free":
        return problem
    kinds = {part.kind for part in parts_of(problem)}
    if kinds == {"box"}:
        return replace(problem, control_set="box", control_sets={})
    return replace(problem, control_sets={}) if kinds == {"free"} else problem


def boxes_apart(problem: Problem, switched: Collection[str]) -> Problem:
    """Return the problem with a box of its own for each given control that shares a box with others.

    Raises
    ------
    DerivationError
        If its sets are not sets of the model's controls, each control in one of them.
    """
    every = parts_of(problem)
    found: dict[str, AdmissibleSet] = {}
    for part in every:
        names = tuple(v.symbol for v in part.controls)
        alone = [c for c in names if c in switched] if part.kind == "box" and len(names) > 1 else []
        rest = [c for c in names if c not in alone]
        taken = {other.name for other in every if other is not part} | found.keys()
        for control in alone:
            found[_free_name(control, taken | found.keys())] = Box(control)
        if rest:
            found[part.name if not alone else _free_name(part.name, taken | found.keys())] = STATED[part.kind](*rest)
    same = len(found) == len(every)
    return problem if same else replace(problem, control_set="free", control_sets=found)


def _free_name(wanted: str, taken: Collection[str]) -> str:
    """Return a name, with a number appended where it is taken."""
    numbered = (f"{wanted}{k}" for k in itertools.count(2))
    return next(name for name in itertools.chain([wanted], numbered) if name not in taken)


def limits_of(problem: Problem) -> tuple[Variable, ...]:
    """Return the variables of an instance's numbers, in the order of the ``bounds`` argument of kernels."""
    return tuple(limit for part in parts_of(problem) for limit in part.limits)


def _part(name: str, kind: PartKind, controls: tuple[Variable, ...], mark: str) -> Part:
    index = rf"_{{\mathrm{{{mark}}}}}" if mark else ""
    prefix = f"{mark}_" if mark else "u_"
    letter = control_sets.letter_of(controls)
    largest = Variable(f"{prefix}max", rf"{letter}{index}^{{\max}}", controls[0].unit, positive=True)
    if kind in ("free", "box"):
        return Part(name, kind, controls, control_sets.bounds("box" if kind == "box" else "free", controls))
    if kind == "angle":
        (angle,) = controls
        reach = Variable(f"{angle.symbol}_reach", rf"\varrho_{{{angle.latex}}}", positive=True)
        return Part(name, kind, controls, (reach,))
    if len(units := {v.unit for v in controls}) > 1:
        raise DerivationError(
            f"control_sets {name!r}: a norm requires controls with the same unit, not {', '.join(sorted(units))}"
        )
    if kind == "ball":
        return Part(name, kind, controls, (largest,))
    smallest = Variable(f"{prefix}min", rf"{letter}{index}^{{\min}}", controls[0].unit, positive=True)
    return Part(name, kind, controls, (smallest, largest))


def _example(kind: PartKind) -> str:
    return {"angle": 'Angle("beta")', "free": 'Free("u")', "box": 'Box("u1", "u2")'}.get(
        kind, f'{kind.capitalize()}("ux", "uy")'
    )


def weighed(weight: sp.Symbol, symbols: Sequence[sp.Symbol], controls: Sequence[Variable]) -> sp.Expr:
    """Return half the squares of controls times a weight, separately where the units of controls differ.

    Parameters
    ----------
    symbols
        What stands for the controls.
    controls
        Whose units they have.
    """
    if len({v.unit for v in controls}) == 1:
        return weight / 2 * sp.Add(*(u**2 for u in symbols))
    return sp.Add(*(weight * u**2 / 2 for u in symbols))


def unsigned(problem: Problem, curvatures: sp.Matrix) -> str:
    """Advise what to do where H is not known to be convex, because parameters have no known sign."""
    declared = problem.model.parameters
    symbols = zip(declared, symbols_of(declared), strict=True)
    found = [v.symbol for v, symbol in symbols if curvatures.has(symbol) and not symbol.is_positive]
    if not found:
        return "add the square of each control to the cost"
    return f'declare {", ".join(found)} positive: Variable("{found[0]}", ..., positive=True)'
