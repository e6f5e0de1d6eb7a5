"""Pictures: what is written, that it can be read, and that the numbers in it are right."""

from __future__ import annotations

import dataclasses
import math
import struct
import subprocess
import sys
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from satsym import instance as instances
from satsym import units
from satsym.instance import Guess, Instance, SolverOptions
from satsym.kernels import Kernels, load
from satsym.report import display
from satsym.report.look import SIZES, Look
from satsym.report.plots import curves, pages, pictures, series, style
from satsym.report.plots.panels import _of_pi
from satsym.report.plots.powers import WithPowers
from satsym.report.plots.reading import Reading
from satsym.report.plots.reading import read as read_all
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import Series
from satsym.report.terminal.solution import solution_text
from satsym.solution import Iteration, Simulation, Solution
from satsym.solvers import simulate
from satsym.spec import ProblemSpec, Variable
from satsym.status import Status
from tests.support.solved import solve

SOLVED = ["overview", "orbit", "states", "controls", "costates", "invariants", "convergence"]
NODES = 61
MICRO = "\N{MICRO SIGN}"


def read(one: Series) -> Reading:
    """A quantity that is alone."""
    return read_all([one])[0]


@pytest.fixture(scope="module")
def soft_return() -> Solution:
    return solve(instances.load("soft-return"))


@pytest.fixture(scope="module")
def geostationary() -> Solution:
    return solve(instances.load("soft-return-geo"))


@pytest.fixture(scope="module")
def ball() -> Solution:
    return solution(case(model(6, 3, "ball", position=3, reference=True, invariant=True, unit="km"), 1.2))


def model(states: int, controls: int = 0, kind: str = "free", position: int = 0, **more: Any) -> Kernels:
    """A made-up model: each state decays, drawn by the next one and pushed by a control; position = first states."""

    def rates(t: Any, x: Any, u: Any, p: Any, out: Any = None) -> Any:
        push = [u[i % controls] if controls else 0.0 for i in range(states)]
        return np.array([x[(i + 1) % states] - 0.5 * x[i] + push[i] for i in range(states)])

    def forward(times: Any, x0: Any, u: Any, u_mid: Any, p: Any, x: Any, x_mid: Any) -> float:
        for i in range(states):
            x[i][:] = [x0[i] * math.exp(-0.3 * t) for t in times]
        return 0.0

    spec = ProblemSpec(
        name="made_up",
        title="Made up",
        source="made_up.py",
        states=tuple(Variable(f"x{i}", more.get("latex", f"x_{i}"), more.get("unit", "1")) for i in range(states)),
        controls=tuple(Variable(f"u{i}", f"u_{i}") for i in range(controls)),
        parameters=(),
        control_set=kind,  # type: ignore[arg-type]
        has_cost=True,
        has_terminal_cost=False,
        has_reference=more.get("reference", False),
        autonomous=True,
        invariants=(Variable("energy", "E"),) if more.get("invariant") else (),
        position=tuple(Variable(axis, axis) for axis in "xyz"[:position]),
    )
    functions: dict[str, Callable[..., Any]] = {
        "dynamics_batch": rates,
        "forward": forward,
        "hamiltonian_batch": lambda t, x, u, lam, p, out=None: (lam * rates(t, x, u, p)).sum(axis=0),
        "running_cost_batch": lambda t, x, u, p, out=None: (u**2).sum(axis=0),
        "position_batch": lambda t, x, p, out=None: np.array(x[:position]),
        "reference_batch": lambda t, p, out=None: np.array([np.cos(t + i) for i in range(states)]),
        "invariants_batch": lambda t, x, p, out=None: np.array([x[0] ** 2]),
    }
    return Kernels(spec, functions)


def case(kernels: Kernels, bound: float = math.inf, **more: Any) -> Instance:
    m, box = len(kernels.spec.controls), kernels.spec.control_set == "box"
    return Instance(
        name="made-up",
        path=Path("made-up.toml"),
        title=more.get("title", ""),
        model=kernels,
        parameters=(),
        initial=(1.0,) * len(kernels.spec.states),
        final=more.get("final", {}),
        t0=0.0,
        tf=5.0,
        tf_guess=None,
        lower=(-bound if box else -math.inf,) * m,
        upper=(bound if box else math.inf,) * m,
        max_norm=math.inf if box else bound,
        solver=SolverOptions(),
        lqr=None,
        guess=Guess(),
    )


def solution(given: Instance, **changes: Any) -> Solution:
    n, m = len(given.model.spec.states), len(given.model.spec.controls)
    times = np.linspace(0.0, 5.0, NODES)
    x = np.array([np.exp(-0.3 * times) * np.cos(times + i) for i in range(n)])
    u = np.array([np.sin(times + i) for i in range(m)]).reshape(m, NODES)
    u = np.clip(u, np.reshape(given.lower, (m, 1)), np.reshape(given.upper, (m, 1)))
    made = Solution(
        instance=given,
        method="sweep",
        status=Status.CONVERGED,
        message="",
        objective=1.0,
        times=times,
        x=x,
        u=u,
        lam=np.array([np.sin(times * i) for i in range(n)]),
        switching_times=((1.0,),) * m,
        iterations=2,
        history=tuple(Iteration(k, 1.0 + 2.0**-k, 3.0**-k) for k in range(3)),
        wall_s=0.1,
    )
    return dataclasses.replace(made, **changes)


def fed_back(given: Instance) -> Simulation:
    made = solution(given)
    return Simulation(given, "lqr", Status.CONVERGED, "", made.times, made.x, made.u, {}, {})


def page_texts(page: Any) -> list[tuple[str, Any]]:
    """Every text of a figure that was rendered, with the rectangle it covers."""
    from matplotlib.axis import Axis
    from matplotlib.text import Text

    beyond = set()  # labels of ticks beyond the ends of their axis exist but are not drawn
    for axis in page.findobj(Axis):
        scaled = axis.get_transform().transform
        low, high = sorted(scaled(axis.get_view_interval()))
        room = 1e-9 * (high - low)
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            if not low - room <= scaled(tick.get_loc()) <= high + room:
                beyond |= {tick.label1, tick.label2}
    texts = [text for text in page.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return [(text.get_text(), text.get_window_extent()) for text in texts if text not in beyond]


def stems(written: Sequence[Path]) -> list[str]:
    return [path.stem for path in written]


def save(result: Solution | Simulation, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Its pictures as files."""
    drawn = pictures(result, Look(tuple(formats)))
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in drawn.items():
        with (folder / name).open("wb") as stream:
            content(stream)
    return [folder / name for name in drawn]


def png_size(path: Path) -> tuple[int, int]:
    content = path.read_bytes()
    assert content.startswith(b"\x89PNG\r\n\x1a\n")
    assert content.endswith(b"IEND\xaeB`\x82")
    width, height = struct.unpack(">II", content[16:24])
    return width, height


@pytest.mark.slow
@pytest.mark.usefixtures("full_resolution")
def test_a_solution_gives_all_pictures_as_png_of_sane_size(soft_return: Solution, tmp_path: Path) -> None:
    written = save(soft_return, tmp_path / "new" / "folder")
    assert stems(written) == SOLVED
    assert sorted(written) == sorted((tmp_path / "new" / "folder").iterdir())
    for path in written:
        width, height = png_size(path)
        assert 1100 <= width <= 1700
        assert 500 <= height <= 1700
        assert 10_000 < path.stat().st_size < 400_000


@pytest.mark.slow
def test_pictures_are_the_same_bytes_each_time_whatever_the_user_s_settings(tmp_path: Path) -> None:
    import matplotlib

    made, kinds = fed_back(case(model(2, 1, "box", position=2, reference=True), 0.7)), ("png", "pdf")
    first = save(made, tmp_path / "first", kinds)
    with matplotlib.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "axes.formatter.use_locale": True}):
        second = save(made, tmp_path / "second", kinds)
        assert matplotlib.rcParams["font.size"] == 30.0
    assert [path.suffix for path in first] == [".png", ".pdf"] * 4
    for one, other in zip(first, second, strict=True):
        assert one.name == other.name
        assert one.read_bytes() == other.read_bytes(), one.name


@pytest.mark.slow
def test_a_simulation_without_control_has_no_pictures_of_controls(tmp_path: Path) -> None:
    assert stems(save(simulate(instances.load("soft-return")), tmp_path)) == [
        "overview",
        "orbit",
        "states",
        "invariants",
    ]


def test_a_simulation_with_feedback_shows_its_controls(tmp_path: Path) -> None:
    assert stems(save(fed_back(case(model(2, 1))), tmp_path)) == ["overview", "phase", "states", "controls"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("given", "pictures"),
    [
        (case(model(1)), "overview states costates convergence"),
        (case(model(1, 1, "box"), 0.7, final={"x0": 0.0}), "overview states controls costates convergence"),
        (case(model(4, 3, "ball", position=3, reference=True, invariant=True), 1.2), " ".join(SOLVED)),
        (case(model(9, 1, latex=r"\nosuch{x}")), "overview states controls costates convergence"),
        (case(model(1, title="$5 für 日本語 $x_1_2$ " * 9)), "overview states costates convergence"),
    ],
    ids=["one state", "box", "ball in space", "many, with bad LaTeX", "any title"],
)
def test_any_model_can_be_drawn(given: Instance, pictures: str, tmp_path: Path) -> None:
    written = save(solution(given), tmp_path)
    assert " ".join(stems(written)) == pictures
    assert all(max(png_size(path)) * style.DPI / style._RC["figure.dpi"] < 3000 for path in written)


def broken(values: float, first: int) -> np.ndarray:
    x = np.ones((2, NODES))
    x[:, first:] = values
    return x


@pytest.mark.slow
@pytest.mark.parametrize(
    "x",
    [
        broken(math.nan, 30),
        broken(math.inf, 30),
        broken(1e300, 30),
        broken(1e99, 30),
        broken(1.0, 30),
        broken(1e-300, 2),
    ],
    ids=["nan", "inf", "1e300", "1e99", "constant", "tiny"],
)
def test_what_a_failed_run_left_behind_is_drawn_as_far_as_it_goes(x: np.ndarray) -> None:
    from satsym.report.plots import pages, style

    given = case(model(2, 1, position=2, reference=True))
    left = solution(given, x=x, status=Status.NON_FINITE, objective=math.nan, u=np.full((1, NODES), np.nan))
    with style.applied():
        page = pages.overview(Scene.of(left))
        assert page is not None
        assert "non-finite" in dict(page_texts(page))
        assert style.rendered(page, "png").startswith(b"\x89PNG")


@pytest.mark.parametrize("size", SIZES)
def test_title_and_facts_of_an_overview_are_whole_at_any_size(size: str) -> None:
    from satsym.report.plots import pages

    title = "Goddard rocket: maximum altitude with bounded dynamic pressure"
    found = solution(dataclasses.replace(case(model(2, 1)), title=title))
    with style.applied(Look(size=size)):
        page = pages.overview(Scene.of(found))
        assert page is not None
        written = [" ".join(text.split()) for text, _ in page_texts(page)]
    assert title in written
    (facts,) = (text for text in written if text.startswith("model "))
    assert all(fact in facts for fact in ("iteration", "$J$", "$t_f$"))


@pytest.mark.slow
def test_a_failed_run_gives_all_pictures_if_it_had_a_trajectory(tmp_path: Path) -> None:
    given = case(model(2, 1, position=2, reference=True, invariant=True))
    left = solution(given, x=broken(math.nan, 30), status=Status.NON_FINITE, objective=math.nan)
    assert stems(save(left, tmp_path)) == SOLVED


@pytest.mark.parametrize("nodes", [0, 1, NODES])
def test_without_a_trajectory_there_is_nothing_but_convergence(nodes: int, tmp_path: Path) -> None:
    nothing = np.full((2, nodes), np.nan)
    times = np.linspace(0.0, 5.0, nodes)
    failed = solution(case(model(2, 1)), times=times, x=nothing, u=nothing[:1], lam=nothing, status=Status.NON_FINITE)
    assert stems(save(failed, tmp_path)) == ["convergence"]
    unheard = dataclasses.replace(failed, history=failed.history[:1])
    assert pictures(unheard) == {}


@pytest.mark.parametrize("residual", [math.inf, math.nan, 0.0])
def test_iterations_without_a_number_that_can_be_drawn_have_no_picture(residual: float, tmp_path: Path) -> None:
    history = tuple(Iteration(k, math.nan, residual) for k in range(3))
    assert "convergence" not in stems(save(solution(case(model(1)), history=history), tmp_path))


@pytest.mark.slow
def test_pyplot_is_never_imported_and_matplotlib_only_to_draw(repository: Path) -> None:
    code = """
import sys
from satsym import instance, solvers
from satsym.report import plots
simulation = solvers.simulate(instance.load("soft-return"))
assert "matplotlib" not in sys.modules
assert plots.pictures(simulation)
assert "matplotlib" in sys.modules
assert not sys.modules.keys() & {"matplotlib.pyplot", "scipy", "sympy", "tkinter"}
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=repository, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("which", "name"),
    [("soft_return", name) for name in SOLVED]
    + [("geostationary", name) for name in ("overview", "orbit", "states", "costates")]
    + [("ball", name) for name in ("overview", "orbit", "controls")],
)
def test_no_text_leaves_the_page_or_covers_another(which: str, name: str, request: pytest.FixtureRequest) -> None:
    from satsym.report.plots import pages, style

    found = request.getfixturevalue(which)
    draw = pages.convergence if name == "convergence" else getattr(pages, name)
    with style.applied():
        page = draw(Scene.of(found))
        style.rendered(page, "png")
        texts = page_texts(page)
    assert texts
    for text, box in texts:
        assert box.x0 >= -1, text
        assert box.y0 >= -1, text
        assert box.x1 <= page.bbox.x1 + 1, text
        assert box.y1 <= page.bbox.y1 + 1, text
    for i, (text, box) in enumerate(texts):
        for other, another in texts[i + 1 :]:
            assert not box.overlaps(another), (text, other)


def test_thrust_in_space_is_what_the_polar_controls_mean(soft_return: Solution) -> None:
    kernels, (_, _, theta, _) = soft_return.instance.model, soft_return.x
    u1, u2 = soft_return.u
    expected = np.array([u1 * np.cos(theta) - u2 * np.sin(theta), u1 * np.sin(theta) + u2 * np.cos(theta)])
    found = curves.thrust(kernels, soft_return.times, soft_return.x, soft_return.u, soft_return.instance.parameters)
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())


def test_thrust_in_space_is_found_at_the_scale_of_kilometres_too(geostationary: Solution) -> None:
    size = np.linalg.norm(
        curves.thrust(
            geostationary.instance.model,
            geostationary.times,
            geostationary.x,
            geostationary.u,
            geostationary.instance.parameters,
        ),
        axis=0,
    )
    np.testing.assert_allclose(size, np.linalg.norm(geostationary.u, axis=0), rtol=1e-5)


def test_controls_that_push_the_position_itself_are_their_own_arrows() -> None:
    made = solution(case(model(2, 2, position=2)))
    np.testing.assert_allclose(curves.thrust(made.instance.model, made.times, made.x, made.u, ()), made.u, atol=1e-12)


@pytest.mark.parametrize("tilt", [None, 0.0, 0.7])
def test_a_path_seen_from_the_reference(tilt: float | None) -> None:
    times = np.linspace(0.0, 20.0, 400)
    ahead, above = 0.02 * np.sin(times) - 0.01 * times, 0.05 * np.cos(times)

    def place(radius: Any, angle: Any) -> np.ndarray:
        flat = np.array([radius * np.cos(angle), radius * np.sin(angle)])
        return flat if tilt is None else np.array([flat[0], flat[1] * np.cos(tilt), flat[1] * np.sin(tilt)])

    seen = curves.relative(place(7.0 + above, times + ahead), place(7.0, times))
    assert seen is not None
    np.testing.assert_allclose(seen.along, 7.0 * ahead, atol=1e-12)
    np.testing.assert_allclose(seen.radial, above, atol=1e-12)


def test_nothing_is_seen_from_a_reference_that_stands_still() -> None:
    still = np.ones((2, 9))
    assert curves.relative(still, still) is None
    assert curves.relative(still, np.zeros((2, 9))) is None


def test_motion_after_a_state_has_left_its_domain_is_not_drawn() -> None:
    kernels = instances.load("soft-return").model
    x = np.ones((4, 5))
    x[0] = [1.0, 0.5, -0.1, 0.4, 0.5]
    assert np.isfinite(curves.states(kernels, x)).all(axis=0).tolist() == [True, True, False, False, False]


def test_the_motion_without_control_is_accurate_on_a_coarse_grid() -> None:
    given = instances.load("soft-return")
    coarse, fine = np.linspace(0.0, 6.0, 7), np.linspace(0.0, 6.0, 6001)
    at = [curves.uncontrolled(given.model, times, given.initial, given.parameters) for times in (coarse, fine)]
    np.testing.assert_allclose(at[0], at[1][:, ::1000], rtol=1e-10, atol=1e-10)


def quantity(values: Any, **more: Any) -> Series:
    return Series("x", "x", more.pop("unit", "1"), "", np.asarray(values, dtype=float), **more)


def test_a_deviation_that_the_value_would_hide_is_shown_itself(geostationary: Solution) -> None:
    r, r_dot, theta, theta_dot = map(read, series.states(Scene.of(geostationary)))
    assert [shown.deviation for shown in (r, r_dot, theta, theta_dot)] == [True, False, True, True]
    assert r.label == r"$\Delta$$r$ [km]"
    assert theta.label == r"$\Delta$$\theta$ [deg]"
    assert r.values[0] == pytest.approx(5.0)
    assert theta.values[0] == pytest.approx(0.02)
    assert theta_dot.label.endswith("[nrad/s]")


def test_without_a_reference_a_small_variation_is_counted_from_the_start() -> None:
    shown = read(quantity(1e6 + np.linspace(0.0, 3.0, 9)))
    assert shown.label == r"$x$$\,-\,$$x$$(t_0)$"
    assert shown.values.tolist() == pytest.approx(np.linspace(0.0, 3.0, 9).tolist())


def test_rounding_errors_are_drawn_as_a_flat_line() -> None:
    shown = read(quantity(2.0 + 1e-14 * np.sin(np.arange(50.0))))
    assert shown.high - shown.low > 0.1
    zero = read(quantity(1e-20 * np.sin(np.arange(50.0)), size=1.0))
    assert zero.high - zero.low > 0.1


def test_what_is_beside_a_curve_never_squashes_it() -> None:
    values, far, near = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 50.0, 9), np.linspace(0.0, 3.0, 9)
    assert read(quantity(values, free=far)).high < 2.5
    assert read(quantity(values, free=near)).high > 3.0
    assert read(quantity(values, reference=far)).high < 2.5


def test_all_values_and_the_required_end_are_on_the_axis() -> None:
    shown = read(quantity([-4.0, 2.0, math.nan], target=9.0))
    assert shown.low < -4.0
    assert shown.high > 9.0
    assert shown.target == 9.0


@pytest.mark.parametrize(("bound", "seen"), [(1.5, True), (100.0, False)])
def test_a_bound_is_in_sight_if_it_is_not_far_off(bound: float, seen: bool) -> None:
    shown = read(quantity([0.0, 1.0], upper=bound, from_zero=True))
    assert (shown.high > bound) is seen


def test_the_norm_of_a_set_of_controls_is_drawn_and_listed_with_its_bounds_and_unit() -> None:
    model = load("transfer_fuel")
    norms = {model.spec.control_parts[0].name: (0.0, 0.7)}
    given = dataclasses.replace(
        case(model), norms=norms, max_norm=math.inf, parameters=(1.0,) * len(model.spec.parameters)
    )
    whole = solution(given)
    *_, norm = series.controls(Scene.of(whole))
    np.testing.assert_allclose(norm.values, np.hypot(*whole.u), rtol=1e-12)
    assert (norm.symbol, norm.upper, norm.lower) == (r"$\sqrt{T_r^2 + T_\theta^2}$", 0.7, -math.inf)
    assert norm.switching == (1.0,)
    assert "sqrt(T_r^2 + T_t^2)" in solution_text(whole)


@pytest.mark.parametrize(("seconds", "written"), [(0.0123, "0.012 s"), (9.96, "10 s"), (162.3, "162 s")])
def test_seconds_are_written_whole_where_they_are_many(seconds: float, written: str) -> None:
    assert f", {written})" in solution_text(solution(case(model(2, 1)), wall_s=seconds)).splitlines()[0]


def test_bounds_of_a_control_that_rests_are_in_sight() -> None:
    shown = read(quantity(np.zeros(5), lower=0.0, upper=700.0, from_zero=True))
    assert shown.low < 0.0
    assert shown.high > 700.0


def test_final_values_have_the_units_of_their_axes() -> None:
    scene = Scene.of(simulate(instances.load("return-to-geo")))
    with style.applied():
        page = pages.states(scene)
    assert page is not None
    for axes in page.axes:
        unit = axes.get_ylabel().partition("[")[2].removesuffix("]")
        assert unit
        assert axes.get_title("right").endswith(f" {unit}")


def test_an_angle_that_turns_is_marked_in_multiples_of_pi() -> None:
    assert read(quantity([0.0, 6.28], unit="rad", angle=True)).turns
    assert not read(quantity([0.0, 0.5], unit="rad", angle=True)).turns
    assert not read(quantity([0.0, 360.0], unit="deg", angle=True)).turns
    assert [_of_pi(k / 4) for k in (-8, -4, -1, 0, 1, 2, 3, 4, 10)] == [
        r"$-2\pi$", r"$-\pi$", r"$-\pi/4$", "0", r"$\pi/4$", r"$\pi/2$", r"$3\pi/4$", r"$\pi$", r"$5\pi/2$"
    ]  # fmt: skip


def test_the_required_end_of_an_angle_is_the_nearest_turn() -> None:
    given = case(model(1, unit="rad"), final={"x0": 0.5})
    given = dataclasses.replace(given, solver=SolverOptions(free_angles=("x0",)))
    made = solution(given, x=np.linspace(0.0, 13.0, NODES)[None])
    assert series.states(Scene.of(made))[0].target == pytest.approx(0.5 + 4.0 * math.pi)


def test_nodes_on_a_bound_are_known() -> None:
    made = solution(case(model(1, 1, "box"), 0.5))
    (control,) = series.controls(Scene.of(made))
    assert control.active is not None
    np.testing.assert_array_equal(control.active, np.abs(made.u[0]) == 0.5)
    assert 0 < control.active.sum() < NODES


def test_the_hamiltonian_of_an_optimum_is_a_flat_line(soft_return: Solution) -> None:
    *_, hamiltonian = series.costates(Scene.of(soft_return))
    assert np.ptp(hamiltonian.values) < 1e-6 * hamiltonian.size
    shown = read(hamiltonian)
    assert np.ptp(shown.values) < 0.01 * (shown.high - shown.low)


@pytest.mark.parametrize(
    ("units", "span", "expected"),
    [
        (["km", "km/s"], 6.28, (1.0, "s")),
        (["rad/s", "km/s**2"], 3600.0, (60.0, "min")),
        (["rad/s"], 86400.0, (3600.0, "h")),
        (["1/s"], 30 * 86400.0, (86400.0, "day")),
        (["km/day"], 0.5, (1.0 / 24.0, "h")),
        (["m/second"], 6.0, (1.0, "second")),
        (["km"], 6.28, (1.0, "1")),
        (["km/s", "1/day"], 6.28, (1.0, "1")),
        (["1"], 0.0, (1.0, "1")),
    ],
)
def test_times_are_in_a_unit_that_reads_well(units: list[str], span: float, expected: tuple[float, str]) -> None:
    factor, unit = display.time_scale(units, span)
    assert (factor, unit) == (pytest.approx(expected[0]), expected[1])


def test_units_and_numbers_are_written_as_people_write_them() -> None:
    assert display.unit_text("km/s**2") == "km/s²"
    assert display.unit_text("N**2*m/s^3/rad") == "N²·m/(s³·rad)"
    assert display.unit_text("1") == ""
    assert display.with_raised_units("It is 0.2 m/s^2, not 3 kg*m/s^2") == "It is 0.2 m/s², not 3 kg·m/s²"
    assert display.with_raised_units("2 r^2 and x = 3 sigma^2") == "2 r^2 and x = 3 sigma^2"
    assert display.number(-1.59e-11, 3) == "\N{MINUS SIGN}1.59 × 10⁻¹¹"
    assert display.number(42164.17, 7) == "42164.17"


@pytest.mark.parametrize("unit", ["km/s**2", "m", "km**2/s**3", "rad/s", "N*m", "kg", "W*s", "1", "1/s", "cost/km"])
@pytest.mark.parametrize("size", [0.0, 3e-14, 5e-9, 2e-5, 0.02, 9999.0, 42164.0, 7e8, math.inf])
def test_a_prefix_changes_numbers_by_as_much_as_the_unit(unit: str, size: float) -> None:
    told = display.engineering(unit, size)
    if told.unit == unit:
        assert told.exponent == 0
    else:
        assert units.parse_quantity(f"1 {told.unit.replace(MICRO, 'u')}", unit) == pytest.approx(told.divisor)
        assert abs(math.log10(size / told.divisor) - 1.0) < abs(math.log10(size) - 1.0)


def test_prefixes_are_those_that_engineers_use() -> None:
    told = {
        unit: display.engineering(unit, size).unit
        for unit, size in (("km/s**2", 5e-8), ("km", 42164.0), ("m", 42164.0), ("km**2/s**2", 4e-4), ("rad/s", 5e-9))
    }
    assert told == {"km/s**2": f"{MICRO}m/s**2", "km": "km", "m": "km", "km**2/s**2": "m**2/s**2", "rad/s": "nrad/s"}


def test_an_axis_that_has_no_prefix_says_its_power_of_ten_at_each_tick() -> None:
    with style.applied():
        page = style.figure(4.0, 3.0)
        axes = page.subplots()
        axes.plot([0.0, 1.0], [0.0, 4e-12])
        style.finished(page)
        page.draw_without_rendering()
    told = [tick.get_text() for tick in axes.get_yticklabels()]
    assert "2.0 × 10⁻¹²" in told or "2 × 10⁻¹²" in told
    assert axes.yaxis.get_offset_text().get_text() == ""


def test_a_formula_that_cannot_be_set_is_replaced_by_the_name() -> None:
    assert display.formula(r"\dot\theta", "theta_dot") == r"$\dot\theta$"
    assert display.formula(r"\nosuch{x}", "x_1") == "x_1"
    assert display.formula("x$y", "x") == "x"


def test_long_texts_are_broken_at_words_and_cut_only_after_the_last_line() -> None:
    text = "distance from the centre of force, along the reference orbit"
    wide = style.length("distance from the centre", style.TITLE)
    assert style.broken(text, 9.0) == text
    assert style.broken(text, wide).replace("\n", " ") == text
    lines = style.broken(text, wide, most=2).splitlines()
    assert len(lines) == 2
    assert lines[1].endswith("\N{HORIZONTAL ELLIPSIS}")
    assert max(style.length(line, style.TITLE) for line in lines) <= 1.25 * wide


def test_times_go_on_through_the_nodes(soft_return: Solution) -> None:
    scene = Scene.of(soft_return)
    assert all(a < b for a, b in pairwise(scene.times))
    assert scene.time_unit == "1"


@pytest.mark.parametrize(
    ("largest", "power"), [(0.0005, "5 × 10⁻⁴"), (0.001, ""), (500000.0, ""), (1000000.0, "1 × 10⁶"), (0.0, "")]
)
def test_ticks_have_a_power_of_ten_where_the_largest_is_outside_the_plain_range(largest: float, power: str) -> None:
    axis = Figure().subplots().yaxis
    axis.set_major_formatter(WithPowers())
    text = axis.get_major_formatter().format_ticks([0.0, largest])[-1]
    assert text == power if power else float(text) == largest
