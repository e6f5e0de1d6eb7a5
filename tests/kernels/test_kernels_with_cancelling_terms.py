"""Kernels that are right load, although terms of what is compared cancel; wrong ones of the same kind do not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from satsym.kernels import Kernels, consistency, load, many_digits
from satsym.kernels.core import Function
from satsym.kernels.evaluation import Evaluation, with_copies
from satsym.kernels.many_digits import LongEvaluation
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


def with_rounding(kernels: Kernels, *names: str) -> Kernels:
    """Kernels in which a function on floats is off, as if terms had cancelled, while its text is right."""

    def off(function: Function) -> Function:
        def found(*arguments: object, **more: object) -> object:
            value = function(*arguments, **more)
            return value * (1 + 1e-6) if isinstance(value, float) else tuple(v * (1 + 1e-6) for v in value)

        return found

    return replace(kernels, functions={**kernels.functions, **{name: off(kernels.functions[name]) for name in names}})


def test_the_text_decides_where_floats_seem_to_contradict_each_other() -> None:
    text, kernels = generated(derive(constrained(sp.sin(th) ** 2 + sp.Integer(10) ** 9 * (v - th) ** 3)), "bank.py")
    rough, places = with_rounding(kernels, "dynamics", "costate_rate"), consistency.random_places(kernels)
    seen, right = (consistency.worst(each, places) for each in (replace(rough, text=None), rough))
    assert seen is not None
    assert seen.deviation > 1e-7
    assert right is not None
    assert right.deviation < 1e-12
    head, rate = text.split("def dynamics_batch", 1)
    wrong = replace(rough, text=f"{head}def dynamics_batch{rate.replace('1000000000.0', '1000010000.0', 1)}")
    found = consistency.worst(wrong, places)
    assert wrong.text != text
    assert found is not None
    assert found.deviation > consistency.LIMIT


def test_values_and_slopes_have_the_digits_that_floats_lose() -> None:
    rate = sp.Integer(10) ** 18 * (sp.tanh(v) - sp.sinh(v) / sp.cosh(v)) + v**2 * th
    _, kernels = generated(derive(constrained(rate)), "bank.py")
    of = LongEvaluation(kernels, with_copies(consistency.random_places(kernels), 0))
    angle, speed = of.at["x"][1], of.at["x"][0]
    assert np.abs(Evaluation(kernels, of.at)("dynamics")[0] - speed**2 * angle).max() > 1.0
    assert of("dynamics")[0] == pytest.approx(speed**2 * angle, rel=1e-15)
    assert of.slope("dynamics", "x")[0] == pytest.approx(np.array([2 * speed * angle, speed**2]), rel=1e-15)
    assert of.single("dynamics")(0.0, (0.5, 0.25), (0.1,), ())[0] == 0.0625


def test_sums_may_be_longer_than_python_may_recurse() -> None:
    terms = " + ".join(f"{k}.5*t" for k in range(2000))
    text = f"def running_cost(t):\n    return {terms} if t > 0.0 else 0.0\n"
    with mp.workdps(30):
        assert many_digits.functions_of(text, {})["running_cost"](mp.mpf(1)) == 2000 * mp.mpf("1000")
        function, seen = many_digits.watched(text, {})["running_cost"]
        assert function(mp.mpf(3)) == 3 * 2000 * mp.mpf("1000")
    assert seen == {0: 3}
