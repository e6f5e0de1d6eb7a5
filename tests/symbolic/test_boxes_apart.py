"""Controls that switch beside weighed ones, in boxes of any grouping, against scipy and minima of H."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_bvp

import satsym
from satsym.status import BadInput, Status
from satsym.symbolic import Ball, Box, FirstOrder, Free, Problem, Variable, symbols_of
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.pipeline import derive
from satsym.symbolic.sets import AdmissibleSet

STATES = (Variable("x", "x"), Variable("y", "y"))
CONTROLS = tuple(Variable(name, name) for name in ("u", "v", "w"))
WEIGHT = Variable("q", "q", default=2.0, positive=True)
x, y = symbols_of(STATES)
u, v, w = symbols_of(CONTROLS)
(q,) = symbols_of((WEIGHT,))

GROUPED: list[Mapping[str, AdmissibleSet]] = [
    {},
    {"all": Box("u", "v", "w")},
    {"a": Box("u", "w"), "b": Box("v")},
    {"a": Box("u"), "b": Box("v"), "c": Box("w")},
    {"u": Box("w", "v"), "w": Box("u")},
]


def stated(sets: Mapping[str, AdmissibleSet] | None = None, **fields: object) -> Problem:
    model = FirstOrder(
        name="two",
        title="T",
        states=STATES,
        controls=CONTROLS,
        parameters=(WEIGHT,),
        rates={x: u - 2 * v, y: w - x * v},
    )
    given = {"control_sets": sets} if sets else {"control_set": "box"}
    given = {"running_cost": x**2 + y**2 + q * w**2, **given, **fields}
    return Problem(name="mixed", title="M", model=model, **given)


@pytest.mark.parametrize("sets", GROUPED, ids=["box", "one", "two", "three", "other names"])
@pytest.mark.parametrize("convention", ["minimum", "maximum"])
def test_the_law_is_where_h_is_least_in_whatever_boxes_the_controls_are(sets, convention):
    found = derive(stated(sets, convention=convention))
    side = 1 if convention == "minimum" else -1
    laws = {e.lhs.name.removesuffix("_star"): e.rhs for e in found.step("control_law").equations}
    slopes = {e.lhs: e.rhs for e in found.step("control_parts").equations}
    h = found.equation("hamiltonian.H").rhs
    rng = np.random.default_rng(3)
    lows, highs = (-1.0, -0.5, -0.3), (0.7, 0.5, 0.4)
    bounds = {sp.Symbol(f"{c}_min", real=True): low for c, low in zip("uvw", lows, strict=True)}
    bounds |= {sp.Symbol(f"{c}_max", real=True): high for c, high in zip("uvw", highs, strict=True)}
    moving = (x, y, sp.Symbol("lambda_x", real=True), sp.Symbol("lambda_y", real=True))
    for _ in range(8):
        drawn = dict(zip(moving, rng.normal(size=4), strict=True)) | {q: rng.uniform(0.5, 2)}
        chosen = []
        for name, low, high in zip("uvw", lows, highs, strict=True):
            law = laws[name].xreplace(slopes).xreplace({**bounds, **drawn})
            if law.func.__name__ == "Switch":
                chosen.append(low if law.args[0] > 0 else high)
            else:
                chosen.append(float(np.clip(float(law.args[0]), low, high)))
        value = sp.lambdify((u, v, w), side * h.xreplace(drawn))
        grids = [np.linspace(low, high, 9) for low, high in zip(lows, highs, strict=True)]
        assert value(*chosen) <= min(value(*other) for other in itertools.product(*grids)) + 1e-12


def test_it_is_solved_as_the_linear_quadratic_problem_that_is_left_where_nothing_switches():
    # from x = 10 the control u is -1 for all of three units of time; what is left is y' = w - 10 + t with y^2 + w^2
    model = FirstOrder(
        name="m", title="m", states=STATES, controls=(CONTROLS[0], CONTROLS[2]), parameters=(), rates={x: u, y: w - x}
    )
    problem = Problem(name="r", title="r", model=model, running_cost=x**2 + y**2 + w**2, control_set="box")
    given = {"initial": {"x": 10, "y": 1}, "tf": 3}
    found = satsym.solve(satsym.Instance.of(problem, **given, control={"u": [-1, 1], "w": [-50, 50]}))

    def rates(t: np.ndarray, z: np.ndarray) -> np.ndarray:
        return np.array([-z[1] / 2 - 10 + t, -2 * z[0], z[0] ** 2 + z[1] ** 2 / 4 + (10 - t) ** 2])

    mesh = np.linspace(0, 3, 41)
    answer = solve_bvp(rates, lambda a, b: np.array([a[0] - 1, b[1], a[2]]), mesh, np.zeros((3, 41)), tol=1e-10)
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(answer.y[2, -1], rel=1e-8)
    assert found.u(1.5)[0] == -1.0
    assert found.u(1.5)[1] == pytest.approx(-answer.sol(1.5)[1] / 2, rel=1e-7)


def test_a_vector_beside_a_box_of_a_control_u_has_a_norm_of_its_own():
    found = derive(stated({"valve": Box("u"), "thrust": Ball("v", "w")}, running_cost=x**2 + v**2 + w**2))
    law = {e.lhs.name: e.rhs for e in found.step("control_law").equations}
    assert sp.Symbol("thrust_max", positive=True) in law["w_star"].free_symbols
    assert sp.Symbol("u_max", real=True) in law["u_star"].free_symbols


def test_points_on_the_way_are_refused_with_the_reason_beside_what_switches():
    with pytest.raises(DerivationError, match="interior: waypoints are derived where H is quadratic"):
        derive(stated(interior={"gate": (x - 1,)}))


def test_a_set_may_have_the_name_of_its_control():
    sets = {"u": Box("u"), "v": Box("v"), "w": Free("w")}
    given = {"initial": {"x": 1, "y": 1}, "tf": 3}
    one = satsym.Instance.of(stated(sets), **given, control={"u": [-1, 2], "v": [0, 1]})
    assert one.case.lower[:2] == (-1.0, 0.0)
    assert one.case.upper[:2] == (2.0, 1.0)
    with pytest.raises(BadInput, match=r"the model takes u = \[lower, upper\]; .*no bound of w"):
        satsym.Instance.of(stated(sets), **given, control={"u": [-1, 2], "v": [0, 1], "w": [0, 1]})


def test_a_set_that_has_the_name_of_another_control_takes_no_bound():
    sets = {"u": Box("w"), "v": Box("v"), "w": Box("u")}
    with pytest.raises(BadInput) as caught:
        satsym.Instance.of(stated(sets), initial={"x": 1, "y": 1}, tf=3, control={"u": [-1, 1], "v": [0, 1]})
    assert (
        str(caught.value)
        == "mixed: [control] u: the name u denotes both a control and the set of w; give the set another name"
    )
