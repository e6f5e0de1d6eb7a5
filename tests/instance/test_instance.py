"""Instances: what a file says arrives in the model's units, and the shipped ones say what they should."""

from __future__ import annotations

import dataclasses
import math
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym import instance, kernels
from satsym.instance import Instance
from satsym.spec import ProblemSpec
from satsym.status import BadInput

EXAMPLE = """
model = "polar_orbit"
title = "Return to the reference orbit"
[parameters]
sigma = 1.0
omega = 1.0
c1 = 1.0
c2 = 1.0
[initial]
r = 1.1
r_dot = 0.0
theta = "0 deg"
theta_dot = 0.9
[final]
r = 1.0
r_dot = 0.0
theta = "reference"
theta_dot = 1.0
[time]
t0 = 0.0
tf = 6.283185307179586
[control]
u1 = [-0.2, 0.2]
[lqr]
Q = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
R = [1.0]
inputs = ["u2"]
[solver]
method = "auto"
tolerance = 1e-9
steps = 1000
max_seconds = 60.0
free_angles = ["theta"]
"""
SMALLEST = 'model = "polar_orbit"\ninitial = {r = 1, r_dot = 0, theta = 0, theta_dot = 1}\ntime.tf = 1\n'


@pytest.fixture
def load(tmp_path: Path) -> Callable[[str], Instance]:
    """Loads the text of an instance."""

    def load_text(text: str) -> Instance:
        file = tmp_path / "case.toml"
        file.write_text(text, encoding="utf-8")
        return instance.load(str(file))

    return load_text


def test_the_example_of_the_manual_arrives_as_written(load: Callable[[str], Instance]) -> None:
    case = load(EXAMPLE)
    assert (case.name, case.title) == ("case", "Return to the reference orbit")
    assert case.model.spec.name == "polar_orbit"
    assert case.parameters == (1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    assert case.initial == (1.1, 0.0, 0.0, 0.9)
    assert case.final == {"r": 1.0, "r_dot": 0.0, "theta": "reference", "theta_dot": 1.0}
    assert (case.t0, case.tf, case.tf_guess) == (0.0, 2 * math.pi, None)
    assert (case.lower, case.upper, case.max_norm) == ((-0.2, -math.inf), (0.2, math.inf), math.inf)
    assert case.control_set.arguments == (-0.2, -math.inf, 0.2, math.inf)
    assert case.lqr is not None
    assert case.lqr.Q == ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    assert (case.lqr.R, case.lqr.inputs, case.lqr.horizon) == (((1.0,),), ("u2",), None)
    assert case.solver == instance.SolverOptions(free_angles=("theta",))
    assert not case.guess


def test_model_initial_state_and_final_time_are_enough(load: Callable[[str], Instance]) -> None:
    case = load(SMALLEST)
    assert case.parameters[:4] == (1.0, 1.0, 1.0, 1.0)
    assert case.final == {}
    assert case.control_set.arguments == (-math.inf, -math.inf, math.inf, math.inf)
    assert (case.solver, case.lqr, case.title) == (instance.SolverOptions(), None, "")
    assert all(type(number) is float for number in case.parameters + case.initial + (case.t0, case.tf))


def test_a_final_state_that_is_called_free_is_as_if_left_out(load: Callable[[str], Instance]) -> None:
    assert load(SMALLEST + "final = {r = 'free', r_dot = 0.5}\n").final == {"r_dot": 0.5}
    with pytest.raises(BadInput, match=r"\[final\] s"):
        load(SMALLEST + "final = {s = 'free'}\n")


def test_an_instance_cannot_be_changed_but_can_be_sent_to_another_process(load: Callable[[str], Instance]) -> None:
    case = load(EXAMPLE)
    with pytest.raises(dataclasses.FrozenInstanceError):
        case.tf = 1.0  # type: ignore[misc]
    with pytest.raises(AttributeError):
        case.solver.steps = 2  # type: ignore[misc]
    copy = pickle.loads(pickle.dumps(case))
    assert dataclasses.replace(copy, model=case.model) == case
    assert copy.model.spec == case.model.spec


def test_options_arrive_in_the_units_of_the_model(load: Callable[[str], Instance]) -> None:
    case = load(
        SMALLEST.replace("tf = 1", 'tf = "free"')
        + 'time.t0 = "1 minute"\ntime.tf_guess = "1 hour"\ncontrol.u2 = ["-1 m/s^2", 0]\n'
        + 'lqr = {Q = [1, 0, 2, 0], R = [[2, 1], [1, 2]], horizon = "2 hours"}\n'
        + 'guess = {state.r = [1, "2000 m"], state.theta = "180 deg", costate.r = 0.5, control.u1 = [0, 1, 0]}\n'
        + 'solver = {method = "sweep", relaxation = 1, backend = "numba", max_iterations = 7, steps = 2}\n'
    )
    assert (case.t0, case.tf, case.tf_guess) == (60.0, None, 3600.0)
    assert (case.lower, case.upper) == ((-math.inf, -0.001), (math.inf, 0.0))
    assert case.lqr is not None
    assert (case.lqr.Q[2], case.lqr.R, case.lqr.inputs) == ((0, 0, 2, 0), ((2, 1), (1, 2)), ("u1", "u2"))
    assert case.lqr.horizon == 7200.0
    assert case.guess.state == {"r": (1.0, 2.0), "theta": (math.pi,)}
    assert (case.guess.costate, case.guess.control) == ({"r": (0.5,)}, {"u1": (0.0, 1.0, 0.0)})
    assert (case.solver.relaxation, case.solver.backend, case.solver.max_iterations) == (1.0, "numba", 7)


def test_equal_bounds_fix_a_control(load: Callable[[str], Instance]) -> None:
    assert load(SMALLEST + "control.u1 = [0, 0]").control_set.arguments == (0.0, -math.inf, 0.0, math.inf)


def test_a_file_may_start_with_a_byte_order_mark_and_end_lines_like_windows(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(b"\xef\xbb\xbf" + EXAMPLE.replace("\n", "\r\n").encode())
    assert instance.load(tmp_path / "case.toml").tf == 2 * math.pi


def test_a_ball_takes_a_radius(load: Callable[[str], Instance], change_model: Callable[..., None]) -> None:
    change_model(control_set="ball")
    assert load(SMALLEST).control_set.arguments == (math.inf,)
    assert load(SMALLEST + 'control.max_norm = "1 m/s^2"').control_set.arguments == (0.001,)


def test_a_model_path_starts_at_the_instance_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def refuse(model: str, folder: Path | None = None) -> kernels.Kernels:
        asked.append((model, folder))
        raise BadInput("not\nhere")

    monkeypatch.setattr(kernels, "load", refuse)
    (tmp_path / "case.toml").write_text(SMALLEST.replace("polar_orbit", "mine/orbit"))
    with pytest.raises(BadInput, match=r"case\.toml: model: not\\nhere"):
        instance.load(tmp_path / "case.toml")
    assert asked == [("mine/orbit", tmp_path)]


@pytest.fixture
def change_model(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Lets instances see the shipped model with another description."""
    real = kernels.load

    def change(**changes: object) -> None:
        def changed(model: str, folder: Path | None = None) -> kernels.Kernels:
            loaded = real(model, folder)
            spec: ProblemSpec = dataclasses.replace(loaded.spec, **changes)  # type: ignore[arg-type]
            return dataclasses.replace(loaded, spec=spec)

        monkeypatch.setattr(kernels, "load", changed)

    return change


number = st.floats(allow_nan=False, allow_infinity=False)
positive = st.floats(min_value=1e-300, allow_infinity=False)


@given(r=positive, others=st.tuples(number, number, number), k3=number, length=positive, bound=number)
def test_every_double_comes_back_bit_for_bit(
    tmp_path_factory: pytest.TempPathFactory,
    r: float,
    others: tuple[float, float, float],
    k3: float,
    length: float,
    bound: float,
) -> None:
    file = tmp_path_factory.mktemp("cases") / "case.toml"
    r_dot, theta, theta_dot = others
    file.write_text(
        f'model = "polar_orbit"\nparameters.k3 = {k3!r}\ntime.tf = {length!r}\ncontrol.u2 = [{bound!r}, {bound!r}]\n'
        f'[initial]\nr = "{r!r} km"\nr_dot = {r_dot!r}\ntheta = {theta!r}\ntheta_dot = "{theta_dot!r} rad/s"\n'
    )
    case = instance.load(file)
    assert case.initial == (r, r_dot, theta, theta_dot)
    assert (case.parameters[6], case.tf, case.lower[1], case.upper[1]) == (k3, length, bound, bound)


def test_every_shipped_instance_loads_and_has_a_title() -> None:
    titles = instance.titles()
    assert list(titles) == instance.shipped() == sorted(titles)
    for name, title in titles.items():
        case = instance.load(name)
        assert (case.name, case.title) == (name, title)
        assert title


@pytest.mark.parametrize(
    ("name", "weights"),
    [
        ("its-thesis", (10.0, 10.0)),
        ("its-thesis-10-50", (10.0, 50.0)),
        ("its-thesis-50-10", (50.0, 10.0)),
        ("its-thesis-50-50", (50.0, 50.0)),
    ],
)
def test_the_thesis_is_as_printed(name: str, weights: tuple[float, float]) -> None:
    case = instance.load(name)
    assert case.parameters == (1.0, 1.0, *weights, 0.0, 0.0, 0.0, 0.0)
    assert (case.initial, case.final) == ((1.0, 1.0, 1.0, 1.0), {})
    assert (case.t0, case.tf, case.control_set.arguments) == (0.0, 60.0, (0.0, 0.0, 1.0, 1.0))


def test_the_geostationary_return_is_given_in_kilometres_and_seconds() -> None:
    case = instance.load("soft-return-geo")
    sigma, omega = case.parameters[:2]
    assert (sigma, omega, case.tf) == (42164.17, 7.2921159e-5, 86400.0)
    assert case.initial == pytest.approx((sigma + 5, 0.0, math.radians(0.02), omega), rel=1e-15, abs=0)
    assert case.control_set.arguments == (-math.inf, -math.inf, math.inf, math.inf)


def test_plain_numbers_load_neither_pint_nor_sympy() -> None:
    code = (
        "import sys; from satsym import instance; instance.shipped(); instance.titles(); "
        "assert 'numpy' not in sys.modules, 'listing loads numpy'; "
        "instance.load('soft-return'); "
        "assert not {'pint', 'sympy', 'scipy', 'matplotlib', 'numba'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
