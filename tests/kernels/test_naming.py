"""Names of variables that generated code uses itself, or that Python does: legal, and of no consequence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from satsym import kernels
from satsym.codegen import module
from satsym.codegen.verify import verify
from satsym.spec import Variable
from satsym.symbolic import FirstOrder, Problem, symbols_of
from tests.support.derived import derived

CLASHING = ("x u lam p h i nu bounds final out shape times x0 lam_f x_mid u_mid math np float len range "
            "gain original lambda for t_end x_value").split()  # fmt: skip


def problem(first: str, second: str, control: str, parameter: str) -> Problem:
    """A pendulum with a motor, under these names."""
    states = (Variable(first, "q"), Variable(second, "v"))
    controls, parameters = (Variable(control, "w"),), (Variable(parameter, "k", default=2.0),)
    q, v, w, k = symbols_of((*states, *controls, *parameters))
    model = FirstOrder(
        name="pendulum",
        title="A pendulum",
        states=states,
        controls=controls,
        parameters=parameters,
        rates={q: v, v: -k * sp.sin(q) + w},
    )
    return Problem(
        name="swing",
        title="A pendulum at least effort",
        model=model,
        running_cost=w**2 / 2,
        terminal_cost=k * q**2 / 2,
        control_set="box",
    )


def generated(case: Problem, folder: Path) -> kernels.Kernels:
    derivation = derived(case)
    (folder / "swing.py").write_text(module.render(derivation, "swing.py"))
    found = kernels.load("./swing", folder)
    verify(derivation, found)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("k", range(0, len(CLASHING) - 3, 4))
def test_any_name_may_be_used_for_a_variable(k: int, tmp_path: Path) -> None:
    names = CLASHING[k : k + 4]
    plain, clashing = tmp_path / "plain", tmp_path / "clashing"
    for folder in (plain, clashing):
        folder.mkdir()
    there = generated(problem("q", "v", "w", "k"), plain)
    here = generated(problem(*names), clashing)
    assert [*here.spec.state_names, *(v.symbol for v in (*here.spec.controls, *here.spec.parameters))] == names
    arguments = (0.3, (0.4, -0.2), (0.1, 0.7), (1.7,), (-0.5, 0.5))
    assert np.allclose(here.canonical(*arguments), there.canonical(*arguments), rtol=0, atol=1e-15)
