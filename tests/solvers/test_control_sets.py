"""Vectors in balls and rings, and products of sets, against integrals in closed form or by quadrature."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, root
from sympy import Expr, Float, Symbol, cos, sin, sqrt, sympify

from satsym.instance import Instance, load
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Angle, Annulus, Ball, Box, DerivationError, FirstOrder, Free, Problem, Variable, symbols_of
from satsym.symbolic.checks import numeric
from tests.support.derived import derived
from tests.support.models import build

PLACE = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
THRUST = tuple(Variable(name, name) for name in ("ux", "uy"))
x, y, vx, vy, ux, uy = symbols_of((*PLACE, *THRUST))
POINT = FirstOrder(
    name="point",
    title="A point",
    states=PLACE,
    controls=THRUST,
    parameters=(),
    rates={x: vx, y: vy, vx: ux, vy: uy},
)
EFFORT = (ux**2 + uy**2) / 2
QUICK = Problem(name="quick", title="Minimum time", model=POINT, running_cost=1, control_set="ball")
RING = Problem(
    name="ring", title="In a ring", model=POINT, running_cost=EFFORT, control_sets={"jet": Annulus("ux", "uy")}
)
SIMULATED = """
[initial]
x = 1.0
y = 0.0
vx = 0.0
vy = 1.0
[final]
x = 0.0
y = 0.0
vx = 0.0
vy = 0.0
[time]
tf = {tf}
[control]
{limits}
"""


def case(folder: Path, problem: Problem, tf: str, limits: str) -> Instance:
    return build(folder, problem, SIMULATED.format(tf=tf, limits=limits))


def certified(instance: Instance) -> Solution:
    found = solve(instance)
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    return found


def reached(slopes: np.ndarray, tf: float, least: float, largest: float) -> tuple[np.ndarray, float]:
    """Where a thrust against p = a + b t, its size |p| within limits, leads; and half its square, integrated."""
    a, b = slopes[:2], slopes[2:]
    corners = [0.0, tf]
    for limit in (least, largest):
        polynomial = np.array([b @ b, 2.0 * a @ b, a @ a - limit**2])
        corners += [t.real for t in np.roots(polynomial) if abs(t.imag) < 1e-12 and 0.0 < t.real < tf]
    corners.append(float(np.clip(-(a @ b) / (b @ b), 0.0, tf)))
    nodes, weights = np.polynomial.legendre.leggauss(80)
    end, effort = np.array([1.0, tf, 0.0, 1.0]), 0.0
    for low, high in zip(sorted(corners)[:-1], sorted(corners)[1:], strict=True):
        t, w = low + (high - low) * (nodes + 1.0) / 2.0, (high - low) / 2.0 * weights
        p = a[:, None] + b[:, None] * t
        norm = np.sqrt((p * p).sum(axis=0))
        u = -p / norm * np.clip(norm, least, largest)
        end += np.concatenate([u @ (w * (tf - t)), u @ w])
        effort += float(w @ (u * u).sum(axis=0)) / 2.0
    return end, effort


@pytest.mark.slow
def test_the_thrust_of_minimum_time_points_against_the_primer_vector(tmp_path: Path):
    def missed(unknown: np.ndarray) -> np.ndarray:
        slopes, tf = unknown[:4], unknown[4]
        at_end = slopes[:2] + slopes[2:] * tf
        return np.append(reached(slopes, tf, 1.0, 1.0)[0], at_end @ at_end - 1.0)

    expected = root(missed, [0.5, 1.5, -0.3, -1.0, 2.5], tol=1e-13)
    assert expected.success
    found = certified(case(tmp_path, QUICK, '"free"', "max_norm = 1.0"))
    assert found.objective == pytest.approx(expected.x[4], rel=1e-10)
    assert np.abs(np.hypot(*found.u) - 1.0).max() < 1e-12


@pytest.mark.slow
def test_the_same_thrust_in_a_ring_leaves_its_hole_alone(tmp_path: Path):
    ring = Problem(name="quick_ring", title="r", model=POINT, running_cost=1, control_sets={"jet": Annulus("ux", "uy")})
    found = certified(case(tmp_path, ring, '"free"', "max_norm = 1.0\nmin_norm = 0.5"))
    assert found.objective == pytest.approx(2.752748183, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("limits", "least", "largest"), [("", 0.0, 9.0), ("min_norm = 0.3\nmax_norm = 1.0", 0.3, 1.0)])
def test_a_thrust_in_a_ring_is_as_large_as_the_ring_allows(tmp_path: Path, limits: str, least: float, largest: float):
    expected = root(lambda slopes: reached(slopes, 4.0, least, largest)[0], [0.375, 0.99, -0.17, -0.4], tol=1e-13)
    assert expected.success
    found = certified(case(tmp_path, RING, "4.0", limits))
    assert found.objective == pytest.approx(reached(expected.x, 4.0, least, largest)[1], rel=1e-10)
    norm = np.hypot(*found.u)
    assert norm.min() >= least - 1e-12
    assert norm.max() <= largest + 1e-12
    a, b = expected.x[:2], expected.x[2:]
    roots = [np.roots([b @ b, 2.0 * a @ b, a @ a - limit**2]) for limit in ((least, largest) if limits else ())]
    met = sorted(t.real for pair in roots for t in pair if 0.0 < t.real < 4.0)
    assert list(found.switching_times[0]) == pytest.approx(met, abs=1e-9)


@cache
def product() -> Problem:
    """Four sets, and parts of H that do not see each other, so that what each costs is known by itself."""
    states = tuple(Variable(name, name) for name in ("q", "s", "x", "y", "vx", "vy", "h"))
    controls = tuple(Variable(name, name) for name in ("w", "z", "ux", "uy", "beta"))
    q, s, *_, h = symbols_of(states)
    w, z, _, _, beta = symbols_of(controls)
    model = FirstOrder(
        name="many",
        title="Many",
        states=states,
        controls=controls,
        parameters=(),
        rates={q: w, s: z, x: vx, y: vy, vx: ux - vx / 2, vy: uy, h: cos(beta) + 2 * s * sin(beta)},
    )
    return Problem(
        name="product",
        title="A product",
        model=model,
        running_cost=(q**2 + w**2 + z**2) / 2,
        terminal_cost=h - x - 2 * y,
        control_sets={"rate": Box("w"), "slow": Free("z"), "jet": Ball("ux", "uy"), "way": Angle("beta")},
    )


TASK = """
[initial]
q = 2.0
s = 0.0
x = 0.0
y = 0.0
vx = 0.0
vy = 0.0
h = 0.0
[final]
s = 1.0
[time]
tf = 2.0
[control]
w = [-1.0, 1.0]
"""


def of_the_bend() -> float:
    """Least integral of s'^2 / 2 - sqrt(1 + 4 s^2) from s = 0 to 1 in a time of 2, over all that are stationary."""

    def path(slope: float) -> np.ndarray:
        def rates(_: float, v: np.ndarray) -> list[float]:
            size = math.sqrt(1.0 + 4.0 * v[0] ** 2)
            return [v[1], -4.0 * v[0] / size, v[1] ** 2 / 2.0 - size]

        return solve_ivp(rates, (0.0, 2.0), [0.0, slope, 0.0], rtol=1e-12, atol=1e-13, method="DOP853").y[:, -1]

    starts = np.linspace(-8.0, 8.0, 81)
    ends = [path(k)[0] - 1.0 for k in starts]
    pairs = zip(starts[:-1], starts[1:], ends[:-1], ends[1:], strict=True)
    slopes = [brentq(lambda k: path(k)[0] - 1.0, a, b, xtol=1e-13) for a, b, u, v in pairs if u * v < 0.0]
    return min(float(path(k)[2]) for k in slopes)


@pytest.mark.slow
def test_sets_are_minimised_over_side_by_side(tmp_path: Path):
    left = brentq(lambda s: s * math.tanh(s) - 1.0, 0.5, 2.0, xtol=1e-15)
    saturated = 2.0 - left
    box = ((8.0 - left**3) / 3.0 + saturated) / 2.0 + math.tanh(left) * left**2 / 2.0
    jet = -quad(lambda t: 1.5 * math.hypot(2.0 * (1.0 - math.exp(-t / 2.0)), 2.0 * t), 0.0, 2.0, epsabs=1e-13)[0]
    found = certified(build(tmp_path, product(), TASK + "[control.jet]\nmax_norm = 1.5\n"))
    assert found.objective == pytest.approx(box + jet + of_the_bend(), rel=1e-9)
    w_switches, *others = found.switching_times
    assert w_switches == pytest.approx([saturated], abs=1e-9)
    assert others == [(), (), (), ()]


def test_what_nothing_limits_is_refused(tmp_path: Path):
    complaint = r"\[control\.jet\]: ux, uy have no bounds, and the cost has no term in their squares;"
    with pytest.raises(BadInput, match=complaint):
        build(tmp_path, product(), TASK)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("[control.jet]\nmax_norm = -1.0\n", r"\[control\.jet\] max_norm: a bound of -1 admits no control"),
        ("[control.jet]\nmin_norm = 1.0\n", r"\[control\.jet\] min_norm"),
        ("[control.slow]\nmax_norm = 1.0\n", r"\[control\.slow\]: the model takes"),
        ("z = [0.0, 1.0]\n[control.jet]\nmax_norm = 1.5\n", r"\[control\] z: the model takes"),
        ("beta = [0.0, 1.0]\n[control.jet]\nmax_norm = 1.5\n", r"no bound of the angle beta"),
        ("nothing = 1.0\n[control.jet]\nmax_norm = 1.5\n", r"the model has no such control"),
        ("maxnorm = 1.5\n", r'\[control\] maxnorm: the model has no such control; did you mean "max_norm"\?'),
        ("jett = 1.5\n", r'\[control\] jett: the model has no such control; did you mean "jet"\?'),
        ("[control.jet]\nmaxnorm = 1.5\n", r'\[control\.jet\] maxnorm: did you mean "max_norm"\?'),
    ],
)
def test_a_set_takes_its_own_numbers_only(tmp_path: Path, text: str, complaint: str):
    with pytest.raises(BadInput, match=complaint):
        build(tmp_path, product(), TASK + text)


def test_a_ring_needs_a_hole_that_is_smaller(tmp_path: Path):
    with pytest.raises(BadInput, match="min_norm is above max_norm; swap them"):
        case(tmp_path, RING, "4.0", "min_norm = 2.0\nmax_norm = 1.0")


def test_products_of_controls_in_different_sets_are_refused():
    mixed = Problem(
        name="mixed",
        title="",
        model=POINT,
        running_cost=EFFORT + ux * uy,
        control_sets={"a": Free("ux"), "b": Box("uy")},
    )
    with pytest.raises(DerivationError, match="H contains products of ux and uy, which belong to different"):
        derived(mixed)
    assert derived(Problem(name="one", title="", model=POINT, running_cost=EFFORT + ux * uy / 2)).name == "one"


SATELLITE = tuple(Variable(name, name, positive=name in "rm") for name in "ruvm")
JETS = tuple(Variable(name, name) for name in ("jr", "jv"))
EXHAUST = Variable("c", "c", default=0.1405 / 0.07487, positive=True)


def thrusting(name: str, cost: int, final: Expr, **fields: object) -> Problem:
    """A satellite whose mass flows with the size of its thrust."""
    r, u, v, m = symbols_of(SATELLITE)
    jr, jv = symbols_of(JETS)
    model = FirstOrder(
        name=f"{name}_satellite",
        title="A satellite",
        states=SATELLITE,
        controls=JETS,
        parameters=(EXHAUST,),
        rates={
            r: u,
            u: v**2 / r - 1 / r**2 + jr / m,
            v: -u * v / r + jv / m,
            m: -sqrt(jr**2 + jv**2) / symbols_of((EXHAUST,))[0],
        },
    )
    sets = {"thrust": Ball("jr", "jv")}
    return Problem(
        name=name, title=name, model=model, running_cost=cost, terminal_cost=final, **{"control_sets": sets, **fields}
    )


ORBITS = """
[initial]
r = 1.0
u = 0.0
v = 1.0
m = 1.0
[final]
r = 1.525
u = 0.0
v = 0.809776330178916
[time]
tf = {}
[control.thrust]
max_norm = 0.1405
"""


@pytest.mark.study
def test_thrust_in_a_ball_whose_size_burns_mass_is_full_in_minimum_time(tmp_path: Path):
    """The same as with a mass that is known in time, of which a shipped example is held against shooting."""
    found = certified(build(tmp_path, thrusting("hurry", 1, sympify(0)), ORBITS.format('"free"')))
    known = solve(load("transfer-time"))
    assert found.objective == pytest.approx(known.objective, rel=1e-10)
    assert found.x[3, -1] == pytest.approx(1.0 - 0.07487 * found.objective, rel=1e-9)
    assert np.hypot(*found.u) == pytest.approx(0.1405, rel=1e-12)


def test_the_throttle_of_a_thrust_has_a_switching_function():
    derivation = derived(thrusting("spare", 0, -symbols_of(SATELLITE)[3]))
    stated = {e.name: e.rhs for step in ("control_parts", "control_law") for e in derivation.step(step).equations}
    numbers = {
        "lambda_u": 0.3,
        "lambda_v": -0.4,
        "m": 0.5,
        "c": 2.0,
        "u_max": 7.0,
        "smoothing": 1e-20,
        "norm_factor": 1.0,
    }

    def law(mass: float) -> tuple[float, float]:
        at = {**numbers, "lambda_m": mass}
        slopes = {name: value.xreplace(given(value, at)) for name, value in stated.items() if name[0] in "pn"}
        at |= {name: float(value) for name, value in slopes.items()}
        both = [numeric([stated[u]])(given(stated[u], at))[0] for u in ("jr", "jv")]
        return float(both[0]), float(both[1])

    assert law(0.0) == pytest.approx((-0.6 * 7.0, 0.8 * 7.0))  # the primer vector is (0.6, -0.8)
    assert law(-1.99) == pytest.approx((-0.6 * 7.0, 0.8 * 7.0))
    assert law(2.01) == pytest.approx((-0.6 * 7.0, 0.8 * 7.0))
    assert law(-2.01) == (0.0, 0.0)


def given(expression: Expr, at: dict[str, float]) -> dict[Symbol, Float]:
    return {s: Float(at[s.name], 30) for s in expression.free_symbols}


@pytest.mark.slow
def test_coasting_is_found(tmp_path: Path):
    found = solve(build(tmp_path, thrusting("spare", 0, -symbols_of(SATELLITE)[3]), ORBITS.format("4.0")))
    assert found.status is Status.CONVERGED
    assert (np.hypot(*found.u) == 0.0).any()


@pytest.mark.slow
def test_geodesics_are_minima_up_to_the_antipode_only(tmp_path: Path):
    """On a sphere neighbouring geodesics meet half way round: a conjugate point, where minimum time ends."""
    latitude, longitude = (Variable(name, name) for name in ("phi", "l"))
    phi, _ = symbols_of((latitude, longitude))
    (way,) = symbols_of((Variable("b", "b"),))
    model = FirstOrder(
        name="globe",
        title="A globe",
        states=(latitude, longitude),
        controls=(Variable("b", "b"),),
        parameters=(),
        rates={phi: sin(way), symbols_of((longitude,))[0]: cos(way) / cos(phi)},
    )
    sphere = Problem(name="sphere", title="", model=model, running_cost=1, control_sets={"way": Angle("b")})
    text = '[initial]\nphi = 0.0\nl = 0.0\n[final]\nphi = 0.0\nl = {}\n[time]\ntf = "free"\n'
    assert certified(build(tmp_path, sphere, text.format(3.0))).objective == pytest.approx(3.0, rel=1e-10)
    beyond = solve(build(tmp_path, sphere, text.format(3.5)))
    assert beyond.certificate is None or beyond.certificate.verdict is not Verdict.CERTIFIED
