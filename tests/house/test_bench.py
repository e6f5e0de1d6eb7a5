"""The benchmark compares like with like: everyone computes the same numbers. How fast anything is is not tested."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

STEPS = 40


@pytest.fixture(scope="module")
def bench(repository: Path) -> Iterator[dict[str, ModuleType]]:
    """The modules of tests/bench, which is no package: run.py is run as a script."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(repository / "tests/bench")
        yield {path.stem: importlib.import_module(path.stem) for path in sorted(repository.glob("tests/bench/*.py"))}


def made(bench: dict[str, ModuleType], subject: str, name: str):
    loops, orbit, peers = bench["loops"], bench["orbit"], bench["peers"]
    try:
        return getattr(loops, subject)[name](orbit.case(STEPS))
    except peers.Missing as error:
        pytest.skip(str(error))


@pytest.mark.parametrize(
    "name",
    [
        "  through Kernels.forward",
        "lambdify(math), RK4 on floats",
        "  states only",
        "lambdify(numpy), RK4 on arrays",
        "generated, numba",
        "  numba through Kernels.forward",
        "C by hand, -O3",
        "C by hand, -O3 -march=native",
        "CasADi, mapaccum",
    ],
)
def test_every_peer_arrives_where_the_generated_code_arrives(bench, name: str):
    ours, theirs = (made(bench, "TRAJECTORIES", n).final() for n in ("generated, plain Python", name))
    assert np.abs(ours - theirs).max() <= bench["loops"].SAME


@pytest.mark.parametrize("name", ["  through Kernels", "generated, numba", "  numba through Kernels"])
def test_every_sweep_arrives_at_the_same_costates(bench, name: str):
    ours, theirs = (made(bench, "SWEEPS", n).final() for n in ("generated, plain Python", name))
    assert np.abs(ours - theirs).max() <= bench["loops"].SAME


@pytest.mark.parametrize("name", ["SciPy solve_ivp, RK45", "SciPy solve_ivp, DOP853"])
def test_scipy_is_as_exact_as_the_grid_and_not_forced_to_be_much_more_so(bench, name: str):
    exact = bench["loops"].TRAJECTORIES["lambdify(numpy), RK4 on arrays"](bench["orbit"].case(20 * STEPS)).final()
    grid = np.abs(made(bench, "TRAJECTORIES", "generated, plain Python").final() - exact).max()
    error = np.abs(made(bench, "ADAPTIVE", name).final() - exact).max()
    assert 1e-3 * grid <= error <= 1.01 * grid


def test_c_integrates_the_cost_too(bench):
    case = bench["orbit"].case(STEPS)
    ours = made(bench, "TRAJECTORIES", "generated, plain Python").run()
    assert made(bench, "TRAJECTORIES", "C by hand, -O3").run() == pytest.approx(ours, rel=1e-13)
    assert made(bench, "TRAJECTORIES", "  through Kernels.forward").run()[2] == ours
    assert ours == pytest.approx(0.5 * np.trapezoid((case.u**2).sum(axis=0), case.times), rel=1e-2)


def test_c_leaves_the_midpoints_behind(bench):
    runner, wrapped = (made(bench, "TRAJECTORIES", n) for n in ("C by hand, -O3", "  through Kernels.forward"))
    runner.run()
    (x, x_mid), (ours, ours_mid, _) = runner.left, wrapped.run()
    assert np.abs(x - ours).max() <= 1e-12
    assert np.abs(x_mid - ours_mid).max() <= 1e-12


def test_variants_that_compute_something_else_are_refused(bench):
    case, runner = bench["orbit"].case(STEPS), bench["peers"].Runner
    makers = {
        "right": lambda case: runner(lambda: None, lambda: np.zeros(4)),
        "wrong": lambda case: runner(lambda: None, lambda: np.full(4, 1e-9)),
    }
    with pytest.raises(AssertionError, match=r"wrong arrives 1\.0e-09 away"):
        bench["loops"].prepare(makers, case, 1e-12)


def test_a_missing_peer_is_said_with_its_reason(bench):
    def absent(case):
        raise bench["peers"].Missing("it is not here")

    runner = bench["peers"].Runner(lambda: None, lambda: np.zeros(4))
    runners, reasons = bench["loops"].prepare({"a": lambda case: runner, "b": absent}, bench["orbit"].case(1), 0.0)
    assert (list(runners), reasons) == (["a"], {"b": "it is not here"})
    rows = bench["rows"]
    table = rows.Table("title", "seconds", (rows.missing("b", reasons["b"]),))
    assert "not timed: it is not here" in rows.text(table)


def test_variants_take_turns_and_short_ones_are_repeated(bench):
    calls, now = [], [0.0]

    def action(name: str, seconds: float):
        def run() -> None:
            calls.append(name)
            now[0] += seconds

        return run

    samples = bench["timing"].interleaved(
        {"slow": action("slow", 4.0), "fast": action("fast", 1.0)}, rounds=2, least=3.0, clock=lambda: now[0]
    )
    assert "".join(name[0] for name in calls) == "ss" + "ff" + "sfff" * 2
    assert samples["slow"].seconds == (4.0, 4.0)
    assert samples["fast"].seconds == (1.0, 1.0)
    assert samples["slow"].times(samples["fast"]) == 4.0


def test_ratios_are_formed_pair_by_pair(bench):
    samples = bench["timing"].Samples
    assert samples((2.0, 20.0, 2.0)).times(samples((1.0, 10.0, 10.0))) == 2.0
    assert (samples((3.0, 1.0, 2.0)).least, samples((3.0, 1.0, 2.0)).middle) == (1.0, 2.0)


def test_lost_rows_are_printed_as_lost(bench):
    rows = bench["rows"]
    won, lost = rows.Goal("at least 3 x", 3.5, 3.0, least=True), rows.Goal("at most 1.2 x", 1.37, 1.2)
    table = rows.Table("1. A subject", "seconds", (rows.Row("ours", 1.0, 2.0, 1.0, (won, lost), "noted"),))
    assert "at least 3 x: reached (3.5); at most 1.2 x: NOT REACHED (1.37); noted" in rows.text(table)
    assert rows.summary([table, table]) == "2 of 4 goals reached"


def test_everyone_solves_the_same_riccati_equations(bench):
    from satsym.analysis.regulator import many

    regulators = bench["regulators"]
    A, Q, R = given = regulators.problems(5)
    _, ours, _ = many.solve(A, regulators.INPUT, Q, R)
    theirs = np.array([regulators._scipy(*each) for each in zip(A, Q, R, strict=True)])
    assert np.abs(ours / theirs - 1.0).max() < 1e-9
    assert max(regulators.largest_residual(P, given) for P in (ours, theirs)) < regulators.WITHIN


def test_the_machine_and_the_versions_are_named(bench):
    assert "numpy" in bench["machine"].described()


@pytest.mark.slow
@pytest.mark.parametrize("imports", [1, pytest.param(None, marks=pytest.mark.study)])
def test_paid_once_and_commands_are_timed_in_fresh_interpreters(bench, imports: int | None, monkeypatch):
    if imports is not None:  # compiling takes longest
        monkeypatch.setattr(bench["startup"], "IMPORTS", bench["startup"].IMPORTS[:imports])
        monkeypatch.setattr(bench["startup"], "COMPILED", ())
    startup, commands = bench["startup"].startup(rounds=1), bench["commands"].commands(rounds=1, long=False)
    for table in (startup, commands):
        assert all(row.least or row.note.startswith("not timed") for row in table.rows)


@pytest.mark.parametrize(
    ("maker", "effort"),
    [
        (lambda m: m._steps("python", "RK4"), 400),
        (lambda m: m._steps("numba", "RK4"), 400),
        (lambda m: m._steps("numba", "symplectic"), 60),
        (lambda m: m._dop853, 1e-8),
        (lambda m: m._heyoka(), 1e-8),
    ],
    ids=["RK4, NumPy", "RK4, numba", "symplectic", "SciPy", "heyoka"],
)
def test_every_means_of_flying_orbits_arrives_where_the_closed_form_does_and_nearer_with_more_effort(
    bench, maker, effort: float
):
    orbits = bench["orbits"]
    try:
        method = maker(orbits)
    except bench["peers"].Missing as error:
        pytest.skip(str(error))
    on = orbits.orbits(8)
    rough, fine = (on.error(method(on, e)) for e in (effort, 2 * effort if effort > 1.0 else effort / 100))
    assert 1e-13 < fine < 0.3 * rough < 1e-5


def test_the_effort_that_is_timed_is_just_enough(bench):
    orbits = bench["orbits"]
    on, method = orbits.orbits(8), orbits._steps("python", "RK4")
    steps = orbits._enough(method, on, integer=True)
    assert on.error(method(on, steps)) <= orbits.WANTED < on.error(method(on, int(steps / 1.1)))


def test_where_heyoka_is_missing_the_table_says_so(bench, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    with pytest.raises(bench["peers"].Missing, match="heyoka is not installed"):
        bench["orbits"]._heyoka()
