"""The symplectic loop: its order, by conditions and by measurement; what it keeps; and which models have one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from sympy import sin

from satsym.analysis.orbits import kepler
from satsym.codegen import module
from satsym.kernels import Kernels, from_text, load
from satsym.kernels.plain import weights
from satsym.status import BadInput
from satsym.symbolic import FirstOrder, Variable, symbols_of, t
from tests.support.derived import derived

START = (1.0, 0.0, 0.0, 0.0, 1.0, 0.5)
ORDER = 6


@pytest.fixture(scope="module")
def orbit() -> Kernels:
    return load("two_body")


def motion(rates: dict, parameters: tuple[str, ...] = ("k",), controls: tuple[str, ...] = ()) -> str:
    """Text of a generated first-order model whose states are the keys, by name."""
    names = tuple(Variable(str(s), str(s)) for s in rates)
    model = FirstOrder(
        name="motion",
        title="A motion",
        states=names,
        controls=tuple(Variable(c, c) for c in controls),
        parameters=tuple(Variable(p, p, default=1.0) for p in parameters),
        rates=rates,
    )
    return module.render(derived(model), "a test")


q1, q2, v1, v2, k, force = symbols_of(Variable(name, name) for name in ("q1", "q2", "v1", "v2", "k", "force"))


def trees(size: int) -> Iterator[tuple[np.ndarray, float, int]]:
    """Of each tree of Nystrom's form with ``size`` powers of c: stage values, and the monomial a c^n they stand for.

    A vertex is a derivative of the acceleration, applied to velocities, each a factor c, and to branches, each another
    such tree integrated twice (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.14).
    """
    kicks, drifts = map(np.array, weights())
    c = np.concatenate([[0.0], np.cumsum(drifts)])
    twice = np.tril(kicks * (c[:, None] - c), -1)
    known = [(c**size, 1.0, size)]
    for branches in _partitions(size, 2):
        for choice in _chosen(branches):
            stage, factor = c ** (size - sum(branches)), 1.0
            for value, a, n in choice:
                stage, factor = stage * (twice @ value), factor * a / ((n + 1) * (n + 2))
            known.append((stage, factor, size))
    yield from known


def _partitions(size: int, least: int) -> Iterator[tuple[int, ...]]:
    """Sizes of one or more branches, each at least two (its own, and the double integral), in rising order."""
    for first in range(least, size + 1):
        yield (first,)
        yield from ((first, *rest) for rest in _partitions(size - first, first))


def _chosen(branches: tuple[int, ...]) -> Iterator[tuple]:
    if not branches:
        yield ()
        return
    for tree in trees(branches[0] - 2):
        yield from ((tree, *rest) for rest in _chosen(branches[1:]))


def defects(order: int) -> list[float]:
    """Of the order conditions of velocities and of coordinates, at exactly this order."""
    kicks, drifts = map(np.array, weights())
    c = np.concatenate([[0.0], np.cumsum(drifts)])
    found = [kicks @ value - a / (n + 1) for value, a, n in trees(order - 1)]
    if order >= 2:
        found += [(kicks * (1.0 - c)) @ value - a / ((n + 1) * (n + 2)) for value, a, n in trees(order - 2)]
    return [abs(float(d)) for d in found]


@pytest.mark.parametrize(("order", "count"), [(1, 1), (2, 2), (3, 3), (4, 5), (5, 9), (6, 16)])
def test_the_coefficients_satisfy_all_conditions_up_to_sixth_order(order: int, count: int):
    found = defects(order)
    assert len(found) == count
    assert max(found) <= 3e-15


def test_they_fail_those_of_seventh_order_so_the_conditions_can_fail():
    assert max(defects(ORDER + 1)) >= 1e-6


def test_the_weights_are_symmetric_and_make_up_a_whole_step():
    kicks, drifts = weights()
    assert (len(kicks), len(drifts)) == (12, 11)
    for fractions in (kicks, drifts):
        assert fractions == fractions[::-1]
        assert sum(fractions) == pytest.approx(1.0, abs=1e-15)


def test_on_an_orbit_the_error_falls_with_the_sixth_power(orbit: Kernels):
    exact = np.concatenate(kepler.propagate(START[:3], START[3:], 1.0, 6.0))
    errors = [
        np.abs(orbit.symplectic(np.linspace(0.0, 6.0, steps + 1), START, (1.0,))[:, -1] - exact).max()
        for steps in (20, 40, 80)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert ((orders > ORDER - 0.3) & (orders < ORDER + 0.7)).all(), (errors, orders)


def test_nodes_are_stored_each_at_its_own_time(orbit: Kernels):
    times = np.cumsum([0.3, 0.01, 0.02, 0.015, 0.03])
    x = orbit.symplectic(times, START, (1.0,))
    exact = np.vstack(kepler.propagate(START[:3], START[3:], 1.0, times - times[0]))
    assert np.array_equal(x[:, 0], START)
    assert np.abs(x - exact).max() <= 1e-14


def jacobian(orbit: Kernels, advance) -> np.ndarray:
    step = 2e-6
    columns = []
    for nudge in np.eye(6) * step:
        ahead, behind = (advance(tuple(np.array(START) + s * nudge)) for s in (1.0, -1.0))
        columns.append((ahead - behind) / (2.0 * step))
    return np.array(columns).T


def test_its_flow_is_symplectic_to_rounding_at_steps_at_which_that_of_rk4_is_not(orbit: Kernels):
    times = np.linspace(0.0, 6.0, 9)
    u = np.zeros((3, 9))
    canonical = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.eye(3), np.zeros((3, 3))]])

    def defect(advance) -> float:
        m = jacobian(orbit, advance)
        return float(np.abs(m.T @ canonical @ m - canonical).max())

    assert defect(lambda start: orbit.symplectic(times, start, (1.0,))[:, -1]) <= 1e-7
    assert defect(lambda start: orbit.forward(times, start, u, u[:, 1:], (1.0,))[0][:, -1]) >= 1e-2


def test_it_runs_back_the_way_it_came(orbit: Kernels):
    times = np.linspace(0.0, 20.0, 41)
    there = orbit.symplectic(times, START, (1.0,))
    back = orbit.symplectic(times[::-1], tuple(there[:, -1]), (1.0,))
    assert np.abs(back[:, ::-1] - there).max() <= 1e-12


def test_both_backends_agree(orbit: Kernels):
    pytest.importorskip("numba")
    times = np.linspace(0.0, 6.0, 61)
    plain, fast = (kernels.symplectic(times, START, (1.0,)) for kernels in (orbit, orbit.compiled()))
    assert np.abs(plain - fast).max() <= 1e-13


def test_beyond_a_singularity_there_is_nan_and_no_exception(orbit: Kernels):
    x = orbit.symplectic([0.0, 1.0], (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (1.0,))
    assert np.isnan(x[:, 1]).all()


@pytest.mark.parametrize(
    ("rates", "separable"),
    [
        pytest.param({q1: v1, v1: -k * sin(q1)}, True, id="pendulum"),
        pytest.param({v1: -k * q1, q1: v1}, True, id="velocity first"),
        pytest.param({q1: v1, v1: -k * sin(q1) + force}, True, id="with a control"),
        pytest.param({q1: v1, q2: v2, v1: k * q1 * q2**2, v2: k * q1**2 * q2}, True, id="coupled by a potential"),
        pytest.param({q1: v1, q2: v2, v1: k * q2**2, v2: k * q1}, False, id="coupled by none"),
        pytest.param({q1: v1, v1: -k * sin(q1) - v1}, False, id="damped"),
        pytest.param({q1: v1, v1: -k * sin(q1) * sin(t)}, False, id="explicit time"),
        pytest.param({q1: v1, v1: sin(force)}, False, id="nothing but a control"),
        pytest.param({q1: 2 * v1, v1: -k * sin(q1)}, False, id="another momentum"),
        pytest.param({q1: v1, q2: v1, v1: -k * sin(q1)}, False, id="a velocity of two"),
        pytest.param({q1: v1, v1: q1}, True, id="no parameter in it"),
        pytest.param({q1: v1, v1: v2, v2: sin(q1)}, False, id="third order"),
    ],
)
def test_which_models_have_a_symplectic_loop(rates: dict, separable: bool):
    controls = ("force",) if any(r.has(force) for r in rates.values()) else ()
    kernels = from_text(motion(rates, controls=controls), "motion")
    assert kernels.spec.separable == separable
    assert ("symplectic" in kernels.functions) == separable
    if not separable:
        with pytest.raises(BadInput, match=r"^motion: no symplectic integrator applies to this model: its acc"):
            kernels.symplectic([0.0, 1.0], (1.0,) * len(rates), (1.0,))


def test_an_oscillator_swings_as_it_should_in_whatever_order_its_states_are():
    kernels = from_text(motion({v1: -k * q1, q1: v1}), "motion")
    times = np.linspace(0.0, 10.0, 101)
    assert np.abs(kernels.symplectic(times, (0.0, 1.0), (4.0,))[1] - np.cos(2.0 * times)).max() <= 1e-9


def test_the_orbit_in_polar_coordinates_has_none_and_in_cartesian_ones_it_has():
    assert not load("polar_orbit").spec.separable
    assert load("two_body").spec.separable


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (
            "'coordinates': (\n        'q1',",
            "'coordinates': (\n        'v1',",
            "coordinates and velocities that are not",
        ),
        ("'coordinates': (\n        'q1',", "'coordinates': (\n        'q1',\n        'q1',", "coordinates and vel"),
        ("'coordinates': (\n        'q1',\n    ),\n", "", "coordinates and velocities that are not"),
        ("x0, p, x):", "x0, p, x_mid):", r"defines symplectic with other arguments than \(times, x0, p, x\)"),
        ("q1_at[i] =", "q1_at[i + 2] =", "has an index of an unsupported kind"),
    ],
)
def test_a_file_that_says_something_else_is_refused(old: str, new: str, reason: str):
    text = motion({q1: v1, v1: -k * sin(q1)})
    assert old in text
    head, loop = text.split("def symplectic") if "q1_at" in old or "x0" in old else (text, None)
    changed = head.replace(old, new) if loop is None else f"{head}def symplectic{loop.replace(old, new)}"
    with pytest.raises(BadInput, match=f"^.motion.: line [0-9]+ .*{reason}"):
        from_text(changed, "motion")
