"""Generated functions of problems that are linear in the controls, held against plain minimisation and differences."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satsym import kernels
from satsym.codegen import module, verify
from satsym.kernels import Kernels
from satsym.kernels.bodies import Unexpected
from satsym.kernels.checking import check
from satsym.symbolic import DerivationError, Problem
from tests.support.switching_models import BURNING, LEAST_FUEL, MINIMUM_TIME, OSCILLATOR, TWO_ENGINES, derived

PROBLEMS = {"time": MINIMUM_TIME, "fuel": LEAST_FUEL, "two engines": TWO_ENGINES, "burning": BURNING}
SHIPPED = ("double_integrator_time", "double_integrator_fuel", "singular_regulator", "van_der_pol")
numbers = st.floats(-3.0, 3.0)
widths = st.floats(0.0, 2.0)


@pytest.fixture(scope="module")
def built() -> dict[str, Kernels]:
    return {name: generated(problem) for name, problem in PROBLEMS.items()}


def generated(problem: Problem) -> Kernels:
    """Kernels of a problem, verified."""
    derivation = derived(problem)
    found = kernels.from_text(module.render(derivation, "mine.py"), "task.py")
    verify.verify(derivation, found)
    return found


def places(model: Kernels, data: st.DataObject) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
    """States, costates and bounds; the box may lie on one side of zero."""
    n, m = len(model.spec.states), len(model.spec.controls)
    x, lam = (tuple(data.draw(numbers) for _ in range(n)) for _ in range(2))
    x = tuple(v if abs(v) > 0.1 else 1.0 for v in x)  # masses divide
    lower = tuple(data.draw(numbers) for _ in range(m))
    return x, lam, (*lower, *(low + data.draw(widths) for low in lower))


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_problems_say_that_they_switch(name: str) -> None:
    model = kernels.load(name)
    assert model.spec.switching
    assert not hasattr(model, "control_hessian")
    assert len(model.switching_function(0.0, *2 * [[1.0] * len(model.spec.states)], [0.0] * 1)) == 1


def test_a_regular_problem_does_not() -> None:
    model = kernels.load("double_integrator_energy")
    assert not model.spec.switching
    assert not hasattr(model, "switching_function")
    assert model.control_hessian(0.0, (1.0, 0.0), (0.5,), (1.0, 1.0), ()) == (1.0,)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROBLEMS)
@given(data=st.data())
def test_no_admissible_control_makes_h_smaller(built: dict[str, Kernels], name: str, data: st.DataObject) -> None:
    model, p = built[name], (0.8,)
    x, lam, box = places(model, data)
    m = len(model.spec.controls)
    u = model.control_law(0.0, x, lam, p, (*box, 1e-200, 1.0))
    assert all(low <= v <= high for v, low, high in zip(u, box[:m], box[m:], strict=True))
    best = model.hamiltonian(0.0, x, u, lam, p)
    levels = [
        [low, high, min(max(0.0, low), high), *np.linspace(low, high, 5)]
        for low, high in zip(box[:m], box[m:], strict=True)
    ]
    competitors = [model.hamiltonian(0.0, x, competitor, lam, p) for competitor in itertools.product(*levels)]
    assert min(competitors) >= best - 1e-12 * (1.0 + abs(best))


@pytest.mark.parametrize("name", PROBLEMS)
@settings(max_examples=40)
@given(data=st.data())
def test_both_forms_of_the_law_agree(built: dict[str, Kernels], name: str, data: st.DataObject) -> None:
    model, p = built[name], (0.8,)
    x, lam, box = places(model, data)
    bounds = (*box, 0.3, 0.5)
    for function in ("control_law", "canonical", "switching_function"):
        more = (bounds,) if function != "switching_function" else ()
        scalar = getattr(model, function)(0.0, x, lam, p, *more)
        batch = getattr(model, f"{function}_batch")(np.zeros(1), *(np.array(v)[:, None] for v in (x, lam)), p, *more)
        assert batch[:, 0] == pytest.approx(np.array(scalar), rel=1e-14, abs=1e-14)


@given(data=st.data())
def test_at_an_undecided_switch_the_law_is_the_midpoint_or_the_least_magnitude(
    built: dict[str, Kernels], data: st.DataObject
) -> None:
    low = data.draw(numbers)
    high = low + data.draw(widths)
    bounds = (low, high, 1e-200, 1.0)
    assert built["time"].control_law(0.0, (0.0, 0.0), (1.0, 0.0), (1.0,), bounds) == (0.5 * (low + high),)
    nearest = low if low > 0.0 else high if high < 0.0 else 0.0
    for threshold in (-1.0, 0.3, 1.0):
        assert built["fuel"].control_law(0.0, (0.0, 0.0), (1.0, threshold), (1.0,), bounds) == (nearest,)


@pytest.mark.parametrize("name", PROBLEMS)
@settings(max_examples=40)
@given(data=st.data())
def test_the_smoothed_law_minimises_the_companions_hamiltonian(
    built: dict[str, Kernels], name: str, data: st.DataObject
) -> None:
    """Read off the state rates: held against fine grids over the box, and against the exact law at no smoothing."""
    model, p, (smoothing, fraction) = built[name], (0.8,), (data.draw(st.floats(0.05, 2.0)), data.draw(st.floats(0, 1)))
    x, lam, box = places(model, data)
    m, n = len(model.spec.controls), len(model.spec.states)

    def companion(u: tuple[float, ...]) -> float:
        weights = np.array(model.magnitude_weight(0.0, x, lam, p))
        effort = 0.5 * smoothing * sum(v * v for v in u)
        return float(model.hamiltonian(0.0, x, u, lam, p) + effort - (1 - fraction) * weights @ np.abs(u))

    found = model.boundary(0.0, x, lam, (), p, (*box, smoothing, fraction), (0.0,) * 3 * n)[-1]
    grids = [np.linspace(low, high, 31) for low, high in zip(box[:m], box[m:], strict=True)]
    least = min(companion(u) for u in itertools.product(*grids))
    spacing = max((high - low) / 30 for low, high in zip(box[:m], box[m:], strict=True))
    assert least >= found - 1e-12 * (1 + abs(found))
    assert least <= found + m * (smoothing * spacing**2 + 2 * spacing * _steepest(model, x, lam, p)) + 1e-12

    exact = model.control_law(0.0, x, lam, p, (*box, 1e-200, 1.0))
    sigma, weight = (
        np.array(v) for v in (model.switching_function(0.0, x, lam, p), model.magnitude_weight(0.0, x, lam, p))
    )
    if _decided(sigma, weight, np.array(box[:m]), np.array(box[m:])):
        limit = model.canonical(0.0, x, lam, p, (*box, 1e-200, 1.0))
        rates = (*model.dynamics(0.0, x, exact, p), *model.costate_rate(0.0, x, exact, lam, p))
        assert np.array(limit) == pytest.approx(np.array(rates), rel=1e-12, abs=1e-12)


def _decided(sigma: np.ndarray, weight: np.ndarray, low: np.ndarray, high: np.ndarray) -> bool:
    """Whether of each control the best of three values is clearly better than those that differ from it."""
    levels = np.array([low, np.clip(0.0, low, high), high])
    values = sigma * levels + weight * np.abs(levels)
    best = levels[values.argmin(axis=0), range(len(sigma))]
    return bool(np.where(levels == best, np.inf, values - values.min(axis=0)).min() > 1e-9)


def _steepest(model: Kernels, x: tuple[float, ...], lam: tuple[float, ...], p: tuple[float, ...]) -> float:
    sigma, weight = model.switching_function(0.0, x, lam, p), model.magnitude_weight(0.0, x, lam, p)
    return float(np.max(np.abs(sigma) + np.abs(weight)) + 10.0)


@pytest.mark.parametrize("name", PROBLEMS)
def test_rates_and_jacobians_are_those_of_the_motion(built: dict[str, Kernels], name: str) -> None:
    """Against differences along, and across, extremals."""
    model, p, rng = built[name], (0.8,), np.random.default_rng(3)
    n, m = len(model.spec.states), len(model.spec.controls)
    for _ in range(10):
        z, u = rng.uniform(0.5, 1.5, 2 * n) * rng.choice([-1, 1], 2 * n), rng.uniform(-1, 1, m)

        def rates(z: np.ndarray, u: np.ndarray = u) -> np.ndarray:
            x, lam = z[:n], z[n:]
            return np.array([*model.dynamics(0.0, x, u, p), *model.costate_rate(0.0, x, u, lam, p)])

        def sigma(z: np.ndarray) -> np.ndarray:
            return np.array(model.switching_function(0.0, z[:n], z[n:], p))

        h = 1e-6
        along = (sigma(z + h * rates(z)) - sigma(z - h * rates(z))) / (2 * h)
        assert model.switching_rate(0.0, z[:n], u, z[n:], p) == pytest.approx(along, rel=1e-7, abs=1e-7)
        across = np.stack([(rates(z + h * e) - rates(z - h * e)) / (2 * h) for e in np.eye(2 * n)], axis=1)
        found = np.reshape(model.extremal_jacobian(0.0, z[:n], u, z[n:], p), (2 * n, 2 * n))
        assert found == pytest.approx(across, rel=1e-7, abs=1e-7)


def test_a_fault_in_generated_text_is_found() -> None:
    derivation = derived(OSCILLATOR)
    text = module.render(derivation, "mine.py")
    for function in ("switching_rate", "switching_rate_batch", "control_law", "extremal_jacobian_batch"):
        head, body = text.split(f"def {function}(", 1)
        change = ("u1_min if", "u1_max if") if function == "control_law" else ("x1*x1", "x1")
        wrong = f"{head}def {function}({body.replace(*change, 1)}"
        assert wrong != text
        with pytest.raises(DerivationError, match="deviates"):
            verify.verify(derivation, kernels.from_text(wrong, "task.py"))


def test_a_module_must_have_what_its_description_promises() -> None:
    text = module.render(derived(MINIMUM_TIME), "mine.py")
    spec, functions = check(text)
    assert spec.switching
    assert {"switching_function", "switching_rate_batch", "extremal_jacobian"} <= {f.name for f in functions}
    without = re.sub(r"def switching_rate\(.*?\n\n\n", "", text, flags=re.DOTALL)
    with pytest.raises(Unexpected, match="does not contain switching_rate"):
        check(without)
    with pytest.raises(Unexpected, match="does not belong there"):
        check(text.replace("    'switching': True,\n", ""))
    with pytest.raises(Unexpected, match="not in a box"):
        check(text.replace("'control_set': 'box'", "'control_set': 'free'"))


@pytest.mark.slow
def test_compiled_functions_give_the_same(built: dict[str, Kernels]) -> None:
    pytest.importorskip("numba")
    model = built["fuel"]
    fast = model.compiled()
    arguments = (0.0, (1.0, 0.5), (0.3, 1.4), (0.8,), (-1.0, 2.0, 0.1, 1.0))
    for name in ("control_law", "canonical"):
        assert getattr(fast, name)(*arguments) == getattr(model, name)(*arguments)
