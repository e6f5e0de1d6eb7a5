"""The names that derivations give to what they derive, which no variable may have: what `docs/models.md` lists."""

from __future__ import annotations

import re
from collections.abc import Mapping

from satsym.spec import ControlSetKind, Variable
from satsym.symbolic.declared import given_names
from satsym.symbolic.model import Model, Output, Problem, symbols_of
from satsym.symbolic.sets import AdmissibleSet, Angle, Annulus, Ball, Box

_NUMBER = re.compile(r"_[1-9]\d*(?![0-9a-zA-Z])")
_SETS: tuple[Mapping[str, AdmissibleSet], ...] = (
    {"SET": Ball("CONTROL", "OTHER")},
    {"SET": Annulus("CONTROL", "OTHER")},
    {"SET": Box("CONTROL")},
    {"SET": Angle("CONTROL")},
)
_KINDS: tuple[ControlSetKind, ...] = ("free", "box", "ball")


def reserved() -> list[str]:
    """List the names that problems take; ``STATE``, ``CONTROL``, ``OUTPUT``, ``SET`` and ``N`` stand for parts."""
    problems = [_problem(kind, {}) for kind in _KINDS] + [_problem("free", sets) for sets in _SETS]
    names = {name for problem in problems for name in given_names(problem.model, problem)}
    return sorted({_NUMBER.sub("_N", name).replace("OTHER", "CONTROL") for name in names})


def _problem(kind: ControlSetKind, sets: Mapping[str, AdmissibleSet]) -> Problem:
    """One that has everything that gives names."""
    several = not sets or len(sets["SET"].controls) > 1
    controls = tuple(Variable(name, name) for name in ("CONTROL", "OTHER")[: 1 + several])
    state, output = Variable("STATE", "x"), Variable("OUTPUT", "y")
    (x,), (u, *_) = symbols_of((state,)), symbols_of(controls)
    outputs = (Output(output, x),)
    model = Model(name="model", title="", states=(state,), controls=controls, parameters=(), outputs=outputs)
    return Problem(
        name="problem",
        title="",
        model=model,
        running_cost=u,
        terminal_constraints=(x,),
        control_set=kind,
        control_sets=sets,
    )
