"""Small problems with known answers, put through the whole tool: derived, generated, loaded by path, solved."""

from __future__ import annotations

from pathlib import Path

from sympy import Expr

from satsym import instance
from satsym.codegen import module
from satsym.instance import Instance
from satsym.spec import ControlSetKind
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.derived import derived

q, w, k = symbols_of(Variable(name, name) for name in "qwk")


def build(folder: Path, problem: Problem, instance_text: str) -> Instance:
    """Derive and generate a problem into a folder, write an instance beside it, and read that."""
    (folder / f"{problem.name}.py").write_text(_rendered(problem), encoding="utf-8")
    path = folder / f"case_{problem.name}.toml"
    path.write_text(f'model = "./{problem.name}"\n{instance_text}', encoding="utf-8")
    return instance.load(path)


_RENDERED: dict[int, tuple[Problem, str]] = {}
"""Generated text by the identity of its problem, which is kept so that no other gets it."""


def _rendered(problem: Problem) -> str:
    if id(problem) not in _RENDERED:
        _RENDERED[id(problem)] = problem, module.render(derived(problem), "a test")
    return _RENDERED[id(problem)][1]


def scalar(name: str, rate: Expr, running_cost: Expr, terminal_cost: Expr, control_set: ControlSetKind) -> Problem:
    """One state q, one control w, one parameter k."""
    return Problem(
        name=name,
        title=f"q' = {rate}",
        model=FirstOrder(
            name=f"{name}_motion",
            title="One state",
            states=(Variable("q", "q"),),
            controls=(Variable("w", "w"),),
            parameters=(Variable("k", "k", default=1.0),),
            rates={q: rate},
        ),
        running_cost=running_cost,
        terminal_cost=terminal_cost,
        control_set=control_set,
    )
