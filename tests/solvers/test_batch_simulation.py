"""Many motions at once: each as it is alone, whatever runs it."""

from __future__ import annotations

import ast

import numpy as np
import pytest
from sympy import sin

from satsym.analysis.orbits import kepler
from satsym.codegen import module
from satsym.kernels import Kernels, from_text, load
from satsym.kernels.batch.factored import INVERSE, UNIT, Arithmetic, Factored, Unsuited
from satsym.kernels.batch.runge_kutta import SMALLEST_BLOCK, OnTape, fewest
from satsym.kernels.batch.tape import Buffers, Tape, bound
from satsym.kernels.blocks import block_step
from satsym.solvers.simulation import batch
from satsym.status import BadInput
from satsym.symbolic import FirstOrder, Variable, symbols_of
from tests.support.derived import derived

q, v = symbols_of((Variable("q", "q"), Variable("v", "v")))

TIMES = np.array([0.0, 0.5, 2.0])
STEPS = 25


@pytest.fixture(scope="module")
def orbit() -> Kernels:
    return load("two_body")


def starts(count: int) -> np.ndarray:
    rng = np.random.default_rng(4)
    return np.vstack(
        [
            rng.uniform(0.8, 1.2, count),
            *rng.uniform(-0.2, 0.2, (3, count)),
            rng.uniform(0.8, 1.2, count),
            rng.uniform(-0.3, 0.3, count),
        ]
    )


def backends(kernels: Kernels) -> list[Kernels]:
    pytest.importorskip("numba")
    return [kernels, kernels.compiled()]


def test_each_is_what_the_generated_loop_makes_of_it_alone(orbit: Kernels):
    x0, mu = starts(7), np.linspace(0.9, 1.1, 7)
    u = np.linspace(-0.01, 0.01, 21).reshape(3, 7)
    for kernels in backends(orbit):
        x = batch.simulate(kernels, TIMES, x0, (mu,), STEPS, u)
        assert x.shape == (6, 3, 7)
        for k in range(7):
            here = tuple(x0[:, k])
            for begin, end, column in zip(TIMES, TIMES[1:], (1, 2), strict=False):
                nodes = np.linspace(begin, end, STEPS + 1)
                control = np.repeat(u[:, k : k + 1], STEPS + 1, axis=1)
                alone, _, _ = orbit.forward(nodes, here, control, control[:, 1:], (mu[k],))
                here = tuple(alone[:, -1])
                assert np.abs(x[:, column, k] - here).max() <= 1e-13


def test_the_error_falls_with_the_fourth_power(orbit: Kernels):
    x0 = starts(50)
    exact = np.vstack(kepler.propagate(x0[:3], x0[3:], 1.0, 2.0))
    for kernels in backends(orbit):
        coarse, fine = (
            np.abs(batch.simulate(kernels, [0.0, 2.0], x0, (1.0,), n)[:, 1] - exact).max() for n in (200, 400)
        )
        assert coarse <= 1e-4
        assert 12.0 <= coarse / fine <= 20.0


def test_the_symplectic_method_is_the_generated_loop_for_each_and_of_sixth_order(orbit: Kernels):
    x0, mu = starts(7), np.linspace(0.9, 1.1, 7)
    exact = np.vstack(kepler.propagate(x0[:3], x0[3:], mu, TIMES[-1]))
    for kernels in backends(orbit):
        x = batch.simulate(kernels, TIMES[[0, 2]], x0, (mu,), STEPS, method="symplectic")[:, 1]
        nodes = np.linspace(TIMES[0], TIMES[2], STEPS + 1)
        alone = [orbit.symplectic(nodes, tuple(x0[:, k]), (mu[k],))[:, -1] for k in range(7)]
        assert np.abs(x - np.transpose(alone)).max() <= 1e-13
        finer = batch.simulate(kernels, TIMES[[0, 2]], x0, (mu,), 2 * STEPS, method="symplectic")[:, 1]
        assert 45.0 <= np.abs(x - exact).max() / np.abs(finer - exact).max() <= 90.0


def test_models_with_explicit_time_see_it(orbit: Kernels):
    model = load("time_varying")
    n, p = len(model.spec.states), tuple(v.default or 1.0 for v in model.spec.parameters)
    u = np.full(len(model.spec.controls), 0.3)
    nodes = np.linspace(0.2, 1.4, STEPS + 1)
    table = np.repeat(u[:, None], STEPS + 1, axis=1)
    alone, _, _ = model.forward(nodes, (1.0,) * n, table, table[:, 1:], p)
    for kernels in backends(model):
        x = batch.simulate(kernels, nodes[[0, -1]], np.ones((n, 3)), p, STEPS, u)
        assert np.abs(x[:, 1] - alone[:, -1:]).max() <= 1e-12


def test_models_without_controls_and_parameters_fly_too():
    motion = FirstOrder(
        name="motion",
        title="A pendulum",
        states=(Variable("q", "q"), Variable("v", "v")),
        controls=(),
        parameters=(),
        rates={q: v, v: -sin(q)},
    )
    pendulum = from_text(module.render(derived(motion), "a test"), "motion")
    x0, times = np.array([[0.5, 1.0], [0.0, 0.1]]), [0.0, 3.0, 1.0]
    simulations = [batch.simulate(pendulum, times, x0, (), 60, method=m)[:, 2] for m in batch.METHODS]
    tail = pendulum.forward(np.linspace(0.0, 1.0, 201), (1.0, 0.1), np.zeros((0, 201)), np.zeros((0, 200)), ())[0][
        :, -1
    ]
    assert max(np.abs(simulated[:, 1] - tail).max() for simulated in simulations) <= 1e-6
    assert np.ptp(simulations, axis=0).max() <= 1e-6


def test_more_columns_than_a_block_holds_are_all_there_and_the_starts_untouched(orbit: Kernels):
    x0 = starts(2 * batch.BLOCK + 5)
    given = x0.copy()
    for kernels in backends(orbit):
        x = batch.simulate(kernels, [0.0, 0.1], x0, (1.0,), 2)
        assert np.array_equal(x0, given)
        assert np.array_equal(x[:, 0], x0)
        for k in (0, batch.BLOCK - 1, batch.BLOCK, 2 * batch.BLOCK + 4):
            alone = batch.simulate(kernels, [0.0, 0.1], x0[:, k : k + 1], (1.0,), 2)
            assert np.abs(x[:, 1, k] - alone[:, 1, 0]).max() <= 1e-14


def test_beyond_the_centre_is_nan_and_the_others_go_on(orbit: Kernels):
    x0 = starts(3)
    x0[:, 1] = 0.0
    for kernels in backends(orbit):
        x = batch.simulate(kernels, [0.0, 0.1], x0, (1.0,), 2)
        assert np.isnan(x[:, 1, 1]).any()
        assert np.isfinite(x[:, 1, [0, 2]]).all()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"times": 1.0}, r"times: has shape \(\)"),
        ({"times": [0.0, float("nan")]}, "times: not finite"),
        ({"x0": np.ones(6)}, r"x0: has shape \(6,\); give a row for each of the 6 states"),
        ({"x0": np.full((6, 2), np.inf)}, "x0: not finite"),
        ({"steps": 0}, "steps: 0; use at least one step"),
        ({"p": (1.0, 2.0)}, "p: 2 components; the model has 1"),
        ({"p": ([1.0, 2.0, 3.0],)}, "p: each component must be a number or an array of 2"),
        ({"u": (1.0, 0.0, 0.0), "method": "symplectic"}, "u: the symplectic method supports uncontrolled motions only"),
        ({"method": "simplectic"}, 'method: "simplectic"; did you mean "symplectic"'),
        ({"u": (1.0,)}, "u: 1 components; the model has 3"),
    ],
)
def test_bad_input_is_refused(orbit: Kernels, given: dict, message: str):
    sound = {"times": [0.0, 1.0], "x0": np.ones((6, 2)), "p": (1.0,), "steps": 3}
    with pytest.raises(BadInput, match=f"^{message}"):
        batch.simulate(orbit, **sound | given)


def test_a_model_that_is_not_separable_has_no_symplectic_method():
    with pytest.raises(BadInput, match=r"^polar_orbit: no symplectic integrator applies to this model"):
        batch.simulate(load("polar_orbit"), [0.0, 1.0], np.ones((4, 2)), (1.0,) * 8, 3, method="symplectic")


def test_one_not_compiled_has_no_compiled_step(orbit: Kernels):
    with pytest.raises(BadInput, match=r"^two_body: a block step requires compiled kernels: call compiled\(\)"):
        block_step(orbit)


SHIPPED = ("polar_orbit", "explicit_time", "beam", "two_body", "roll_yaw", "goddard", "three_modes", "reorientation")


@pytest.mark.parametrize("name", SHIPPED)
@pytest.mark.parametrize("h", [0.02, -0.01])
def test_operations_on_a_tape_are_the_steps_of_the_batch_form(name: str, h: float):
    """Also where time is explicit, with an odd number of steps, and beside columns that are not finite."""
    kernels, rng = load(name), np.random.default_rng(3)
    n, m, k = (len(rows) for rows in (kernels.spec.states, kernels.spec.controls, kernels.spec.parameters))
    start, u, p = (rng.uniform(0.5, 1.5, (rows, 7)) for rows in (n, m, k))
    start[0, 3] = np.nan
    tape, step = OnTape(kernels), batch._RungeKutta(kernels)
    for steps in (5, 2):
        found, expected = start.copy(), start.copy()
        with np.errstate(all="ignore"):
            tape.advance(0.3, h, steps, found, u, p)
            step.advance(0.3, h, steps, expected, u, p)
        others = [0, 1, 2, 4, 5, 6]
        np.testing.assert_allclose(found[:, others], expected[:, others], rtol=1e-13, atol=1e-14)
        assert np.isnan(found[0, 3])
    unmoved = start.copy()
    tape.advance(0.3, 0.0, 2, unmoved, u, p)
    np.testing.assert_array_equal(unmoved, start)


def test_steps_are_written_with_few_operations():
    """As they are generated they are 86 and 112; where rates are sums of states alone, they need none but those."""
    assert fewest(load("polar_orbit")).operations == 49
    assert fewest(load("two_body")).operations == 85
    assert fewest(load("double_integrator_energy")).operations == 0


def expressions(text: str, late: bool, scales: tuple[float, ...]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """What a tape makes of assignments of `a` and `b`, which change, and of `p` and `q`, and what they come to."""
    tape, rng = Tape(), np.random.default_rng(1)
    arithmetic = Arithmetic(tape, scales, late)
    given = {name: rng.uniform(0.5, 1.5, 3) for name in "abpq"} | {UNIT: np.array(0.1), INVERSE: np.array(10.0)}
    names = {name: Factored(tape.given(name, name in "ab")) for name in "abpq"}
    names["a"] = names["a"].times(1.0, -1)  # what is on the tape is a tenth of it
    known = arithmetic.lines(ast.parse(text).body, names)
    outs = {name: np.empty(3) for name in known if name not in names}
    results = {tape.apply(np.positive, arithmetic.plain(known[name])): out for name, out in outs.items()}
    made = bound(tape, given, results, Buffers(3))
    made.begin()
    made.run()
    own = {"a": 10.0 * given["a"], **{name: given[name] for name in "bpq"}, "math": np}
    exec(text, own)  # noqa: S102 - the lines of the test below
    return {name: (out, own[name]) for name, out in outs.items()}


@pytest.mark.parametrize("late", [True, False])
@pytest.mark.parametrize("scales", [(), (2.0, -0.5)])
def test_what_numbers_are_multiplied_with_late_is_the_same(late: bool, scales: tuple[float, ...]):
    text = """c = p - 2.0*a*b
d = -a*b/p - (q - b)*3.0
e = p/a + q/(2.0*b*p)
f = a/b/q - b/a
g = (a*p)*(b*q) + a*a*p*q
h = 1.0 - a*p + (2.0 + p*q)
i = math.sin(2.0*a)*p + math.sqrt(a*p)
j = -a - b
k = a**2.0 - 0.0*b
l = p*q - 2.0/p
m = -2.0*b*p + b*q"""
    for name, (value, expected) in expressions(text, late, scales).items():
        np.testing.assert_allclose(value, np.broadcast_to(expected, 3), rtol=1e-14, err_msg=name)


def test_a_tape_makes_equal_operations_once_and_refuses_what_is_no_line_of_them():
    tape = Tape()
    a, b = tape.given("a", True), tape.given("b", False)
    twice = tape.apply(np.multiply, b, tape.constant(2.0))
    c = tape.apply(np.add, tape.apply(np.multiply, a, b), twice)
    assert c == tape.apply(np.add, tape.apply(np.multiply, tape.constant(2.0), b), tape.apply(np.multiply, b, a))
    assert tape.apply(np.multiply, b, b) not in tape.changing
    out = np.zeros(3)
    made = bound(tape, {"a": np.arange(3.0), "b": np.full(3, 2.0)}, {c: out}, Buffers(3))
    made.begin()
    made.run()
    assert out.tolist() == [4.0, 6.0, 8.0]
    assert len(made.first) == 1
    with pytest.raises(Unsuited):
        Arithmetic(tape).lines(ast.parse("for i in range(3):\n    a = b").body, {})


@pytest.mark.slow
def test_of_models_with_many_states_fewer_columns_are_taken_at_a_time() -> None:
    blocks = [OnTape(load(name)).block for name in ("polar_orbit", "reorientation", "roll_yaw")]
    assert blocks == sorted(blocks, reverse=True)
    assert blocks[0] == batch.BLOCK > blocks[-1] >= SMALLEST_BLOCK
    kernels = load("roll_yaw")
    x0 = np.random.default_rng(2).uniform(-0.1, 0.1, (len(kernels.spec.states), blocks[-1] + 3))
    p = [1.0 if one.default is None else one.default for one in kernels.spec.parameters]
    x = batch.simulate(kernels, [0.0, 0.1], x0, p, 2)
    alone = batch.simulate(kernels, [0.0, 0.1], x0[:, -2:], p, 2)
    np.testing.assert_allclose(x[:, :, -2:], alone, rtol=1e-13, atol=1e-15)
