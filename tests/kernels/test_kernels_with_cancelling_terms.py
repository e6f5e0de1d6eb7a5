"""Kernels that are right load, although terms of what is compared cancel; wrong ones of the same kind do not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from satsym.kernels import consistency, load
from satsym.report.artefacts import generated
from satsym.spec import Variable
from satsym.symbolic import FirstOrder, Problem, derive, symbols_of

STATES = (Variable("v", "v"), Variable("th", r"\theta"))
CONTROLS = (Variable("w", "w"),)
v, th = symbols_of(STATES)
(w,) = symbols_of(CONTROLS)


def constrained(rate: sp.Expr) -> Problem:
    model = FirstOrder(
        name="bank", title="A bank angle", states=STATES, controls=CONTROLS, parameters=(), rates={v: rate, th: w}
    )
    return Problem(name="banked", title="Banked", model=model, running_cost=w**2, path_constraints={"front": th - 1})


@pytest.mark.parametrize("rate", [sp.sin(th) ** 2, sp.Float("1e-5") * sp.cos(3 * th) + sp.Integer(10) ** 5 * th**3])
def test_the_multiplier_of_a_boundary_may_cancel_all_of_the_costates_rate(rate: sp.Expr, tmp_path: Path) -> None:
    text, kernels = generated(derive(constrained(rate)), "bank.py")
    (tmp_path / "banked.py").write_text(text)
    assert load("banked", tmp_path).spec == kernels.spec
    places = consistency.random_places(kernels)

    def doubled(*arguments: object, out: object = None) -> object:
        found = kernels.functions["path_multiplier_batch"](*arguments)
        found = found * (1 + 1e-6)
        if out is None:
            return found
        out[...] = found  # type: ignore[index]
        return out

    wrong = replace(kernels, functions={**kernels.functions, "path_multiplier_batch": doubled}, text=None)
    found = consistency.worst(wrong, places)
    assert found is not None
    assert found.deviation > consistency.LIMIT
