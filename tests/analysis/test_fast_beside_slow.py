"""Models with a fast mode beside a slow one are analysed, though e^(At) overflows at times that suit the slow one."""

from __future__ import annotations

import pytest
import sympy as sp

import satsym

x, y, z, u = sp.symbols("x y z u", real=True)


@pytest.mark.parametrize("fast", [100, 10_000])
@pytest.mark.parametrize("costs", [False, True])
def test_an_integrated_mode_is_marginally_stable_beside_a_fast_one(fast: int, costs: bool) -> None:
    model = satsym.FirstOrder(
        name="mode",
        title="A mode and its integral",
        states=tuple(satsym.Variable(s, s, "1") for s in "xyz"),
        controls=(satsym.Variable("u", "u", "1"),),
        parameters=(),
        rates={x: -fast * x - y + u, y: x, z: y},
    )
    problem = satsym.Problem(name="effort", title="Least effort", model=model, running_cost=u**2)
    found = satsym.analyse(problem if costs else model).to_dict()
    assert found["stability"]["verdict"] == "marginally stable"
    assert [(e["algebraic"], e["geometric"]) for e in found["eigenvalues"]] == [(1, 1)] * 3
    assert found["characteristic_polynomial"] == [1.0, fast, 1.0, 0.0]
