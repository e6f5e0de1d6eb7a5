"""Kernels: found by name and by path, the same numbers from both backends, nan instead of exceptions."""

from __future__ import annotations

import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from satsym.grid import Grid
from satsym.kernels import Kernels, load, shipped
from satsym.kernels.digest import sealed
from satsym.status import BadInput
from tests.support.derived import derived

GRID = Grid.uniform(0.0, 6.0, 300)
X0 = (1.1, 0.02, -0.1, 0.9)
LAM_F = (0.1, -0.2, 0.3, 0.4)
NAN = float("nan")


@pytest.fixture(scope="module")
def orbit() -> Kernels:
    return load("polar_orbit")


@pytest.fixture(scope="module")
def compiled(orbit: Kernels) -> Kernels:
    pytest.importorskip("numba")
    return orbit.compiled()


def defaults(kernels: Kernels) -> tuple[float, ...]:
    return tuple(0.7 if v.default is None else v.default for v in kernels.spec.parameters)


def thrust(times: np.ndarray) -> np.ndarray:
    return np.vstack([0.1 * np.sin(3 * times), 0.05 * np.cos(times)])


def sweep(kernels: Kernels, grid: Grid = GRID) -> tuple[np.ndarray, ...]:
    u, u_mid, p = thrust(grid.nodes), thrust(grid.midpoints), defaults(kernels)
    x, x_mid, cost = kernels.forward(grid.nodes, X0, u, u_mid, p)
    lam, lam_mid = kernels.backward(grid.nodes, LAM_F, x, x_mid, u, u_mid, p)
    return x, x_mid, np.array(cost), lam, lam_mid


def test_the_shipped_models_are_the_generated_files(repository: Path):
    assert shipped() == sorted(path.stem for path in repository.glob("generated/[!_]*.py"))
    assert "polar_orbit" in shipped()


def test_listing_and_loading_import_only_what_they_need():
    code = (
        "import sys; from satsym.kernels import load, shipped; names = shipped();"
        "assert not any(m.startswith('satsym.generated.') for m in sys.modules);"
        "load('polar_orbit');"
        "assert [m for m in sys.modules if m.startswith('satsym.generated.')] == ['satsym.generated.polar_orbit'];"
        "assert not {'numba', 'scipy', 'sympy', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_shipped_model_is_loaded_once():
    assert load("polar_orbit") is load("polar_orbit")


@pytest.mark.slow
def test_every_shipped_model_passes_the_check_of_files_loaded_by_path(repository: Path):
    for name in shipped():
        by_path, by_name = load(f"generated/{name}", repository), load(name)
        assert by_path.spec == by_name.spec
        assert set(by_path.functions) == set(by_name.functions)


@pytest.mark.parametrize("model", ["models/mine", "./models/mine", "models/../models/mine"])
def test_a_copy_loaded_by_path_computes_the_same(orbit: Kernels, repository: Path, tmp_path: Path, model: str):
    (tmp_path / "models").mkdir()
    shutil.copy(repository / "generated/polar_orbit.py", tmp_path / "models/mine.py")
    mine = load(model, tmp_path)
    assert mine is not orbit
    for ours, theirs in zip(sweep(mine), sweep(orbit), strict=True):
        assert (ours == theirs).all()


def test_a_file_beside_the_instance_needs_no_slash_and_the_shipped_name_goes_first(
    orbit: Kernels, repository: Path, tmp_path: Path
):
    for name in ("mine", "polar_orbit"):
        shutil.copy(repository / "generated/polar_orbit.py", tmp_path / f"{name}.py")
    assert load("mine", tmp_path).origin == ("./mine", tmp_path.resolve())
    assert load("polar_orbit", tmp_path) is orbit
    assert load("./polar_orbit", tmp_path) is not orbit


def test_the_working_folder_is_where_paths_start_by_default(repository: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(repository)
    assert load("generated/polar_orbit").spec.name == "polar_orbit"


def test_an_unknown_name_is_refused_with_the_nearest_one():
    with pytest.raises(
        BadInput, match=r'"polar_orbt" is not a shipped model; did you mean "polar_orbit".*`satsym models`'
    ):
        load("polar_orbt")


@pytest.mark.slow
@pytest.mark.parametrize("control_set", ["free", "box", "ball", None])
def test_what_the_generator_writes_for_other_models_passes_the_check(control_set: str | None, tmp_path: Path):
    from sympy import Rational, atan2, cos, exp, pi, sqrt, tanh

    from satsym.codegen.module import render
    from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of, t

    states = (Variable("y", "y", positive=True), Variable("v", "v"))
    controls, parameters = (Variable("a", "a"),), (Variable("k", "k", default=2.0, positive=True),)
    (y, v), (a,), (k,) = symbols_of(states), symbols_of(controls), symbols_of(parameters)
    force = cos(k * y) + atan2(v, y) + tanh(v) * sqrt(k) + exp(-t) / (1 + y**2) ** Rational(3, 2) + y ** Rational(1, 3)
    model = FirstOrder(
        name="bare",
        title="A model",
        states=states,
        controls=controls,
        parameters=parameters,
        rates={y: v, v: a - force / pi},
    )
    subject = (
        Problem(name="whole", title="A problem", model=model, running_cost=a**2 / 2, control_set=control_set)
        if control_set
        else model
    )
    (tmp_path / "mine.py").write_text(render(derived(subject), "mine.py"), encoding="utf-8")
    mine = load("mine", tmp_path)
    x, _, cost = mine.forward([0.0, 0.1, 0.2], (1.0, 0.0), np.ones((1, 3)), np.ones((1, 2)), (2.0,))
    assert cost == pytest.approx(0.1 if control_set else 0.0)
    assert np.isfinite(x).all()
    # below zero the root is complex in Python, and a function of it raises TypeError
    x, x_mid, cost = mine.forward([0.0, 0.1, 0.2], (-1.0, 0.0), np.ones((1, 3)), np.ones((1, 2)), (2.0,))
    assert (x.dtype, x_mid.dtype) == (float, float)
    assert not np.isfinite(x[:, -1]).all()
    assert np.isnan(cost)


def test_an_edited_file_is_loaded_anew(repository: Path, tmp_path: Path):
    text = (repository / "generated/polar_orbit.py").read_text(encoding="utf-8")
    (tmp_path / "mine.py").write_text(text, encoding="utf-8")
    before = load("mine", tmp_path)
    assert load("mine", tmp_path) is before
    (tmp_path / "mine.py").write_text(sealed(text.replace("Rates of change", "Derivatives")), encoding="utf-8")
    assert load("mine", tmp_path).dynamics.__doc__ != before.dynamics.__doc__


def test_every_generated_function_is_an_attribute(orbit: Kernels):
    for name, function in orbit.functions.items():
        if name not in ("forward", "backward"):
            assert getattr(orbit, name) is function
    with pytest.raises(AttributeError, match="polar_orbit has no function no_such_function"):
        orbit.no_such_function  # noqa: B018


def test_both_backends_agree_on_trajectories(orbit: Kernels, compiled: Kernels):
    assert (orbit.backend, compiled.backend) == ("python", "numba")
    for plain, fast in zip(sweep(orbit), sweep(compiled), strict=True):
        assert np.isfinite(plain).all()
        assert np.abs(plain - fast).max() <= 1e-12


def test_both_backends_agree_on_a_grid_with_corners(orbit: Kernels, compiled: Kernels):
    grid = GRID.with_corners([0.0333, 2.7071, 5.99])
    for plain, fast in zip(sweep(orbit, grid), sweep(compiled, grid), strict=True):
        assert np.abs(plain - fast).max() <= 1e-12


def test_both_backends_agree_on_pointwise_functions(orbit: Kernels, compiled: Kernels):
    p = defaults(orbit)
    u, lam, bounds = (0.01, -0.02), (0.3, 0.2, -0.1, 0.4), (-0.1, -0.1, 0.1, 0.1)
    for plain, fast in zip(
        [orbit.dynamics(0.3, X0, u, p), orbit.control_law(0.3, X0, lam, p, bounds)],
        [compiled.dynamics(0.3, X0, u, p), compiled.control_law(0.3, X0, lam, p, bounds)],
        strict=True,
    ):
        assert np.abs(np.array(plain) - fast).max() <= 1e-15


def test_trajectories_are_fourth_order_at_nodes_and_midpoints(orbit: Kernels):
    finest = sweep(orbit, Grid.uniform(0.0, 6.0, 3200))
    x, _, cost, lam, _ = finest

    def errors(steps: int) -> np.ndarray:
        x_, x_mid, cost_, lam_, lam_mid = sweep(orbit, Grid.uniform(0.0, 6.0, steps))
        middle = 1600 + 1600 // steps  # of the step after the half time, a node of the finest grid
        differences = (
            x_[:, -1] - x[:, -1],
            x_mid[:, steps // 2] - x[:, middle],
            cost_ - cost,
            lam_[:, 0] - lam[:, 0],
            lam_mid[:, steps // 2] - lam[:, middle],
        )
        return np.array([np.abs(d).max() for d in differences])

    order = np.log2(errors(100) / errors(200))
    assert (order > 3.7).all(), order


@pytest.mark.parametrize("backend", ["python", "numba"])
@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0, 1.0), (1e200, 0.0, 0.0, 1e200), (NAN, 0.0, 0.0, 1.0)])
def test_a_division_by_zero_or_overflow_gives_nan(orbit: Kernels, request: pytest.FixtureRequest, backend: str, start):
    kernels = orbit if backend == "python" else request.getfixturevalue("compiled")
    u, u_mid, p = thrust(GRID.nodes), thrust(GRID.midpoints), defaults(orbit)
    x, x_mid, cost = kernels.forward(GRID.nodes, start, u, u_mid, p)
    assert np.isnan(cost)
    assert (x.shape, x_mid.shape) == ((4, 301), (4, 300))
    assert not np.isfinite(x[:, -1]).all()
    lam, lam_mid = kernels.backward(GRID.nodes, LAM_F, np.zeros_like(x), np.zeros_like(x_mid), u, u_mid, p)
    assert not np.isfinite(lam[:, 0]).all()
    assert not np.isfinite(lam_mid[:, 0]).all()


def test_what_was_computed_before_a_failure_is_kept(orbit: Kernels):
    p = (*defaults(orbit)[:2], 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    times = np.array([0.0, 0.5, 1.0, 1.5])
    u = np.zeros((2, 4))
    u[0, 2] = NAN
    x, _, cost = orbit.forward(times, X0, u, np.zeros((2, 3)), p)
    assert np.isfinite(x[:, :2]).all()
    assert np.isnan(x[:, 2:]).any(axis=0).all()
    assert np.isnan(cost)


@pytest.mark.parametrize("raised", [ZeroDivisionError, OverflowError, ValueError("math domain error"), TypeError])
def test_whatever_arithmetic_raises_becomes_nan(orbit: Kernels, raised):
    def forward(times, x0, u, u_mid, p, x, x_mid):
        x[0][0] = 5.0
        raise raised

    broken = Kernels(orbit.spec, {"forward": forward})
    x, x_mid, cost = broken.forward([0.0, 1.0], X0, np.zeros((2, 2)), np.zeros((2, 1)), defaults(orbit))
    assert x[0, 0] == 5.0
    assert np.isnan(x.ravel()[1:]).all()
    assert np.isnan(x_mid).all()
    assert np.isnan(cost)


def test_complex_numbers_become_nan(orbit: Kernels):
    def forward(times, x0, u, u_mid, p, x, x_mid):
        x[0][1] = (-8.0) ** (1.0 / 3.0)
        return x[0][1]

    strange = Kernels(orbit.spec, {"forward": forward})
    x, _, cost = strange.forward([0.0, 1.0], X0, np.zeros((2, 2)), np.zeros((2, 1)), defaults(orbit))
    assert np.isnan(x[0, 1])
    assert np.isnan(cost)


def test_arguments_of_the_wrong_shape_are_refused_before_anything_runs(orbit: Kernels):
    u, u_mid, p = thrust(GRID.nodes), thrust(GRID.midpoints), defaults(orbit)
    with pytest.raises(ValueError, match="x0 must hold 4 numbers"):
        orbit.forward(GRID.nodes, X0[:3], u, u_mid, p)
    with pytest.raises(ValueError, match=r"u_mid must have shape \(2, 300\)"):
        orbit.forward(GRID.nodes, X0, u, u, p)
    with pytest.raises(ValueError, match="p must hold 8 numbers"):
        orbit.forward(GRID.nodes, X0, u, u_mid, (*p, 1.0))
    with pytest.raises(ValueError, match="times must be"):
        orbit.forward([], X0, u, u_mid, p)


def test_the_domain_is_that_of_the_positive_states(orbit: Kernels):
    inside = np.array([[1.0, 0.1], [-3.0, 0.0], [-1.0, 0.0], [-1.0, 0.0]])
    assert orbit.in_domain(X0)
    assert orbit.in_domain(inside)
    for distance in (0.0, -1e-9, NAN):
        assert not orbit.in_domain(np.vstack([[1.0, distance], inside[1:]]))


def test_compiling_happens_once_and_leaves_the_batch_form_alone(orbit: Kernels, compiled: Kernels):
    assert orbit.compiled() is compiled
    assert compiled.compiled() is compiled
    assert compiled.dynamics_batch is orbit.dynamics_batch


@pytest.mark.slow
def test_a_model_loaded_by_path_compiles_and_leaves_nothing_on_disk(repository: Path, tmp_path: Path, orbit: Kernels):
    pytest.importorskip("numba")
    shutil.copy(repository / "generated/polar_orbit.py", tmp_path / "mine.py")
    fast = load("mine", tmp_path).compiled()
    for ours, theirs in zip(sweep(fast), sweep(orbit), strict=True):
        assert np.abs(ours - theirs).max() <= 1e-12
    # numba reads its cache with pickle: one beside a foreign file would run foreign code
    assert [path.name for path in tmp_path.iterdir()] == ["mine.py"]


def test_without_numba_the_message_says_what_to_install(orbit: Kernels, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    with pytest.raises(BadInput, match=r"numba is not installed.*satsym\[fast\]"):
        Kernels(orbit.spec, orbit.functions).compiled()


def test_kernels_survive_pickling(orbit: Kernels, compiled: Kernels, repository: Path, tmp_path: Path):
    assert pickle.loads(pickle.dumps(orbit)) is orbit
    assert pickle.loads(pickle.dumps(compiled)) is compiled
    (tmp_path / "models").mkdir()
    shutil.copy(repository / "generated/polar_orbit.py", tmp_path / "models/mine.py")
    mine = load("models/mine", tmp_path)
    assert pickle.loads(pickle.dumps(mine)).spec == mine.spec
