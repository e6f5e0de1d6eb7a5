"""What stands beside a motion and against what it is drawn: no control that is one, one unit, places and rates."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import sympy

import satsym
from satsym import instance as instances
from satsym import kernels
from satsym.analysis.orbits.elements import elements
from satsym.analysis.subject import analyse
from satsym.instance import Instance
from satsym.report.look import Look
from satsym.report.plots import curves, figures, pages, phase_planes, series, style
from satsym.report.plots import plane as eigenvalue_plane
from satsym.report.plots.reading import read
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import Series
from satsym.report.plots.space import attitudes
from satsym.report.plots.space.conics import _asymptotes, _open
from satsym.report.plots.studies import figures as of_study
from satsym.report.plots.studies import on_axis
from satsym.report.results.studies import Numbers, distinguishing
from satsym.solution import Iteration, Simulation, Solution
from satsym.spec import Variable
from satsym.status import Status

T = np.linspace(0.0, 1.0, 41)


def steered(name: str, u: float) -> Simulation:
    """A shipped instance with its controls held at a number."""
    case = instances.load(name)
    held = np.full((len(case.model.spec.controls), len(T)), u)
    x0 = [0.5 if isinstance(v, str) else float(v) for v in case.initial]
    x, _, _ = case.model.forward(T, x0, held, held[:, 1:], case.parameters)
    return Simulation(case, "none", Status.CONVERGED, "", T, x, held, {}, {})


@pytest.mark.parametrize(
    ("name", "drawn"),
    [("brachistochrone", False), ("zermelo", False), ("transfer-time", False), ("cart-pole", True)],
)
def test_an_angle_of_zero_is_a_control_and_no_motion_without_one(name: str, drawn: bool) -> None:
    assert (Scene.of(steered(name, 0.3)).free is not None) == drawn


def test_an_angle_without_a_unit_is_in_radians() -> None:
    (slope,) = series.controls(Scene.of(steered("brachistochrone", 0.3)))
    assert (slope.unit, slope.angle) == ("rad", True)


def test_a_motion_without_control_on_the_reference_is_not_drawn_over_it() -> None:
    on, off = Scene.of(steered("ends-1-given", 1e-3)), Scene.of(steered("return-to-orbit", 1e-3))
    assert on.free is None
    assert off.free is not None


def component(values: np.ndarray, unit: str = "km") -> Series:
    return Series("x", "x", unit, "", values)


def test_components_of_a_vector_are_drawn_in_one_unit() -> None:
    wide, slim, other = component(np.sin(T) * 3e-5), component(np.sin(T) * 4e-8), component(np.cos(T), "km/s")
    shown = read([wide, slim, other])
    assert [one.label for one in shown] == ["$x$ [mm]", "$x$ [mm]", "$x$ [km/s]"]
    assert shown[1].values == pytest.approx(slim.values * 1e6)
    assert read([slim])[0].label == "$x$ [µm]"
    # one of which all ticks would need powers of ten is no longer compared
    assert read([wide, component(np.sin(T) * 2e-9)])[1].label == "$x$ [µm]"


def test_a_hamiltonian_that_is_constant_but_for_a_billionth_is_flat() -> None:
    noisy = np.where(T > 0.5, 0.0, -3e-8)
    (steady,) = read([dataclasses.replace(component(noisy, "1"), size=1.0, steady=series.STEADY)])
    (shown,) = read([dataclasses.replace(component(noisy, "1"), size=1.0)])
    assert steady.high - steady.low > 1e6 * np.ptp(noisy)
    assert shown.high - shown.low < 10.0 * np.ptp(noisy)


def own(*states: tuple[str, str], rates: dict[str, str]) -> Instance:
    """A model as a user states it, without a position vector."""
    symbols = {name: sympy.Symbol(name, real=True) for name, _ in states} | {"u": sympy.Symbol("u", real=True)}
    motion = satsym.FirstOrder(
        name="own_motion",
        title="A motion",
        states=tuple(satsym.Variable(name, name, unit) for name, unit in states),
        controls=(satsym.Variable("u", "u", "1"),),
        parameters=(),
        rates={symbols[name]: sympy.sympify(rate, locals=symbols) for name, rate in rates.items()},
    )
    problem = satsym.Problem(name="own", title="A motion", model=motion, running_cost=symbols["u"] ** 2 / 2)
    return satsym.Instance.of(problem, initial=dict.fromkeys([symbols[n] for n, _ in states], 0.3), tf=1.0).case


@pytest.mark.slow
@pytest.mark.parametrize(
    ("states", "rates", "picture"),
    [
        ((("q", "1"), ("w", "1")), {"q": "w", "w": "u - q"}, "phase"),
        ((("a", "1"), ("b", "1")), {"a": "b**2 + a", "b": "u"}, "phase"),
        ((("x", "1"), ("y", "1"), ("h", "1")), {"x": "cos(h)", "y": "sin(h)", "h": "u"}, "path"),
        ((("f", "1"), ("g", "1"), ("v", "1"), ("w", "1")), {"f": "v", "g": "w", "v": "u", "w": "-g"}, "path"),
        ((("a", "1"), ("b", "1"), ("c", "1")), {"a": "b + c", "b": "u", "c": "a*b"}, ""),
    ],
    ids=["oscillator", "two states", "by name", "by rates", "neither"],
)
def test_an_own_motion_is_drawn_in_its_phase_plane_or_as_a_path(
    states: tuple[tuple[str, str], ...], rates: dict[str, str], picture: str
) -> None:
    case = own(*states, rates=rates)
    rng = np.random.default_rng(1)
    x = rng.normal(size=(len(states), 1)) + rng.normal(size=(len(states), 1)) * T
    found = figures(Simulation(case, "none", Status.CONVERGED, "", T, x, np.sin(T)[None], {}, {}))
    assert {"orbit", "path", "phase"} & found.keys() == ({picture} if picture else set())
    assert "states" in found


def turned() -> Simulation:
    """The rigid body, turned by a right angle about its third axis."""
    case, angle = instances.load("reorientation"), 0.5 * np.pi * T
    x = np.zeros((7, len(T)))
    x[2], x[3] = np.sin(angle / 2.0), np.cos(angle / 2.0)
    return Simulation(case, "none", Status.CONVERGED, "", T, x, np.full((3, len(T)), 0.1), {}, {})


def test_a_quaternion_is_drawn_by_the_axes_of_the_body_on_a_sphere() -> None:
    """The first axis ends where the second begins, and the third stays."""
    (axes,) = figures(turned())["attitude"].axes
    marks = {
        (line.get_color(), line.get_marker()): np.ravel(line.get_xydata())
        for line in axes.get_lines()
        if line.get_marker() in ("o", "s")
    }
    first, second, third = attitudes.AXES
    np.testing.assert_allclose(marks[first, "s"], marks[second, "o"], atol=1e-12)
    np.testing.assert_allclose(marks[third, "s"], marks[third, "o"], atol=1e-12)
    assert {text.get_text() for text in axes.texts} == {"1", "2", "3"}


def test_states_that_agree_on_the_trajectory_alone_are_no_rates() -> None:
    case = instances.load("rayleigh")  # x1' = x2; x2' = -x1 + (1.4 - 0.14 x2**2) x2 + 4 u
    x = np.vstack([np.zeros_like(T), np.zeros_like(T)])
    found = curves.pairs(case.model, T, x, np.zeros((1, len(T))), case.parameters)
    assert found == [(0, 1)]


def test_angles_and_states_of_two_units_are_no_place() -> None:
    metres, turns = Variable("x", "x", "m"), Variable("y", "y", "rad")
    assert curves.places((metres, Variable("y", "y", "m")), []) == (0, 1)
    assert curves.places((metres, turns), [(0, 2), (1, 3)]) == ()
    assert curves.places((turns, dataclasses.replace(turns, symbol="z")), []) == ()


def converging(costs: list[float], residuals: list[float], **changes: float) -> Solution:
    case, given = instances.load("double-integrator-fuel"), steered("double-integrator-fuel", 0.5)
    history = tuple(Iteration(k, *pair) for k, pair in enumerate(zip(costs, residuals, strict=True)))
    return Solution(
        case, "sweep", Status.CONVERGED, "", costs[-1], T, given.x, given.u, given.x, ((),), 3, history, 0.1, **changes
    )


def drawn(found: Solution) -> list[tuple[float, float]]:
    """The ends of the axes of the panels."""
    with style.applied():
        page = pages.convergence(Scene.of(found))
    return [] if page is None else [axes.get_ylim() for axes in page.axes]


def test_rounding_has_no_panel_and_fills_no_axis() -> None:
    residuals = [1.0, 1e-5, 1e-40]
    both = drawn(converging([1.5, 1.0 + 1e-9, 1.0], residuals))
    assert len(both) == 2
    assert both[1][0] == pytest.approx(1e-5 / 3.0)
    assert len(drawn(converging([1.0, 1.0, 1.0], residuals))) == 1
    # full thrust costs 3 here, so that what costs 1e-26 is free
    assert len(drawn(converging([1e-26, 1e-33, 0.0], residuals))) == 1
    assert len(drawn(converging([1e-6, 1e-9, 0.0], residuals))) == 2


@pytest.mark.parametrize("count", [3, 7, 14, 25])
def test_panels_on_a_slide_leave_room_for_each_other(count: int) -> None:
    with style.applied(Look(size="slide")):
        columns = style.columns(count, 2, 2.2)
        rows = -(-count // columns)
        page = style.figure(style.WIDTH, 1.2 + 2.2 * rows)
        assert page.get_figheight() <= style.sheet().highest + 1e-9
        assert style.points(10.0) * rows * 2.2 / 10.0 <= style.sheet().highest
        assert style.points(1.0) >= 0.5
    with style.applied():
        assert style.columns(count, 2, 2.2) == 2


@pytest.mark.parametrize(
    ("column", "shown"),
    [
        ("initial.r_dot [km/s]", r"$\dot{r}(t_0)$ [km/s]"),
        ("costate_initial.theta [km**2/s**3]", r"$\lambda_{\theta}(t_0)$ [km²/s³]"),
        ("parameters.c1", "$c_{1}$"),
        ("time.tf [s]", "$t_f$ [s]"),
        ("control.u1.upper [km/s**2]", "upper bound of $u_{1}$ [km/s²]"),
        ("parameters.drag_area [m**2]", "parameters.drag_area [m²]"),
        ("objective [J]", "$J$ [J]"),
        ("control.max_norm [m/s**2]", "largest norm of the control [m/s²]"),
    ],
)
def test_columns_of_a_study_are_formulas_on_axes(column: str, shown: str) -> None:
    assert on_axis(column) == shown


def test_cells_without_an_answer_are_filled_and_said() -> None:
    grid = {"a": np.repeat([1.0, 2.0, 3.0], 3), "b": np.tile([1.0, 2.0, 3.0], 3)}
    values = np.where(np.arange(9) < 7, np.arange(9.0), np.nan)
    status = ["converged"] * 7 + ["infeasible", "time limit"]
    page = of_study(Numbers("a study", grid, {"q": values}, status, (3, 3)))["overview"]
    (legend,) = page.legends
    assert [text.get_text() for text in legend.get_texts()] == ["infeasible: 1", "time limit: 1"]


def test_what_varies_is_not_drawn_once_more_over_itself() -> None:
    durations = np.array([1.0, 2.0, 3.0, 4.0])
    found = {"objective": durations**2, "t_final [s]": np.array([1.0, 2.0, np.nan, 4.0])}
    assert list(distinguishing(found, {"time.tf [s]": durations})) == ["objective"]


def test_phase_planes_show_where_the_motion_has_to_end() -> None:
    found = converging([1.0, 1.0, 1.0], [1.0, 0.1, 0.01])
    (plane,) = phase_planes.of(Scene.of(found))
    assert plane.target == (0.0, 0.0)
    with style.applied():
        page = pages.phase(Scene.of(found))
    assert page is not None


@pytest.mark.parametrize(("name", "scale"), [("roll_yaw", "symlog"), ("polar_orbit", "linear")])
def test_eigenvalues_that_lie_decades_apart_are_not_drawn_on_one_spot(name: str, scale: str) -> None:
    """Of a satellite whose wheel swings in sprung gimbals the furthest is millions of times the nearest."""
    found = analyse(kernels.load(name))
    (axes,) = eigenvalue_plane.of_analysis(found).axes
    assert (axes.get_xscale(), axes.get_yscale()) == (scale, scale)
    ends = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o"]
    assert len(ends) == len(found.eigenvalues)
    shown = axes.transAxes.inverted().transform(axes.transData.transform(ends))
    assert shown.min() >= 0.0
    assert shown.max() <= 1.0
    apart = np.linalg.norm(shown[:, None] - shown, axis=-1) + np.eye(len(ends))
    assert apart.min() > 3e-3


def test_asymptotes_are_where_the_branches_of_a_hyperbola_go() -> None:
    orbit = elements((2.0, 0.0, 0.0), (0.3, 1.6, 0.2), 1.0)
    assert orbit.eccentricity > 1.0
    last = _open(orbit, 1e6)[:, [0, -1]]
    for ray, far in zip(_asymptotes(orbit, 10.0), last.T, strict=True):
        way = ray[:, 1] - ray[:, 0]
        assert float(way @ way) == pytest.approx((10.0 + np.linalg.norm(ray[:, 0])) ** 2)
        np.testing.assert_allclose(way / np.linalg.norm(way), far / np.linalg.norm(far), atol=1e-5)
