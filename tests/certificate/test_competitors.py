"""Competitors: cheaper extremals are found where the first one found is not the best, and that becomes the answer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from sympy import Float, Matrix, exp, eye

from satsym import instance
from satsym.instance import Guess, Instance
from satsym.solution import Certificate, Competitors, Kind, Progress, Solution
from satsym.solvers import solve
from satsym.solvers import two_point as two_point_method
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.competitors.comparing import none_conceivable
from satsym.solvers.certificate.competitors.comparison import UNCOMPARED, Compared, Comparison, unseen
from satsym.solvers.certificate.verdict import examined
from satsym.solvers.improving import improved, starting_from
from satsym.solvers.search import solving
from satsym.solvers.search.order import Tried
from satsym.solvers.search.starts.planning import Plan
from satsym.solvers.symmetry import symmetric
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import FirstOrder, Newton, Problem, Variable, symbols_of
from tests.support.models import build

PLACES = tuple(Variable(name, name) for name in ("x", "y", "v_x", "v_y"))
PUSHES = tuple(Variable(f"a_{q}", f"a_{q}") for q in "xy")
MU = Variable("mu", r"\mu", default=1.0, positive=True)
x, y, v_x, v_y = symbols_of(PLACES)
(mu,) = symbols_of((MU,))
position, push = Matrix([x, y]), Matrix(symbols_of(PUSHES))

cartesian = Problem(
    name="cartesian",
    title="Transfer between orbits, in Cartesian coordinates",
    model=Newton(
        name="plane",
        title="A body in a plane",
        states=PLACES,
        controls=PUSHES,
        parameters=(MU,),
        coordinates={x: v_x, y: v_y},
        directions={f"e_{q}": eye(2)[:, k] for k, q in enumerate("xy")},
        position=position,
        forces={"gravity": -mu * position / position.norm() ** 3, "thrust": push},
    ),
    running_cost=push.dot(push) / 2,
)

AXES = tuple(Variable(f"x{k}", f"x_{k}") for k in (1, 2))
RATES = tuple(Variable(f"u{k}", f"u_{k}") for k in (1, 2))
WEIGHT = Variable("k", "k", default=-1.0)
x1, x2 = symbols_of(AXES)
u1, u2 = symbols_of(RATES)
(k,) = symbols_of((WEIGHT,))
plane = FirstOrder(name="rates", title="Rates", states=AXES, controls=RATES, parameters=(), rates={x1: u1, x2: u2})
line = FirstOrder(
    name="rate", title="A rate", states=AXES[:1], controls=RATES[:1], parameters=(WEIGHT,), rates={x1: u1}
)
HILL = 3 * exp(-8 * x1**2)

bump = Problem(
    name="bump", title="A hill in the way", model=plane, running_cost=(u1**2 + u2**2) / 2 + HILL * exp(-8 * x2**2)
)
over = Problem(
    name="over", title="Straight over the hill", model=replace(line, parameters=()), running_cost=u1**2 / 2 + HILL
)
saddle = Problem(name="saddle", title="Two axes", model=plane, running_cost=(u1**2 + u2**2 - x1**2 - x2**2) / 2)
reward = Problem(
    name="reward",
    title="A distance that is rewarded",
    model=line,
    running_cost=u1**2 / 2,
    terminal_cost=k * x1**2 / 2,
    control_set="box",
)
tied = Problem(
    name="tied",
    title="An end on a line, at rest",
    model=FirstOrder(
        name="body", title="A body", states=AXES, controls=RATES[:1], parameters=(), rates={x1: x2, x2: u1}
    ),
    running_cost=u1**2 / 2,
    terminal_constraints=(x1 + x2 - 1, x2),
    control_set="box",
)


def certificate(solution: Solution) -> Certificate:
    assert solution.certificate is not None
    return solution.certificate


def compared(solution: Solution) -> set[Kind]:
    return {found.kind for found in certificate(solution).competitors}


@pytest.mark.study
def test_a_transfer_in_cartesian_coordinates_makes_the_revolutions_that_cost_least(tmp_path: Path) -> None:
    """Polar coordinates, where the final angle says how many they are, give the same cost."""
    case = build(
        tmp_path,
        cartesian,
        "[initial]\nx = 1.0\ny = 0.0\nv_x = 0.0\nv_y = 1.0\n[final]\nx = -1.2\ny = 0.0\nv_x = 0.0\nv_y = -0.9\n"
        "[time]\ntf = 10.0\n[solver]\nmax_seconds = 600.0\n",
    )
    found = solve(case)
    turns = []
    for angle in (1, 3, 5):
        end = {"r": 1.2, "r_dot": 0.0, "theta": angle * np.pi, "theta_dot": 0.75}
        polar = replace(
            instance.load("return-to-orbit"), initial=(1.0, 0.0, 0.0, 1.0), final=end, tf=10.0, lower=(-np.inf,) * 2
        )
        turns.append(solve(replace(polar, upper=(np.inf,) * 2)).objective)
    assert found.objective == pytest.approx(min(turns), rel=1e-8)
    assert int(np.argmin(turns)) == 1
    assert certificate(found).verdict == "certified"
    assert Kind.REVOLUTIONS in compared(found)


@pytest.mark.slow
def test_a_cheaper_competitor_becomes_the_answer(tmp_path: Path) -> None:
    """A solver that starts at the wrong corner at first, and then from whatever it is given."""
    numbers = 0.4, -8.0, (-1.6, 0.4), 2.0
    case = rewarded(tmp_path, *numbers)

    def solver(one: Instance, progress: Progress | None) -> Solution:
        start = one.guess or Guess(control={"u1": (0.4,)})
        return replace(two_point_method.solve(replace(one, guess=start), progress), instance=one)

    costs = dearest(*numbers)
    first = solver(case, None)
    assert first.objective == pytest.approx(costs[0.4], rel=1e-9)
    found = improved(solver, case, None)
    assert found.objective == pytest.approx(costs[-1.6], rel=1e-9)
    assert certificate(found).verdict == "certified"
    assert found.instance is case
    assert f"{costs[0.4]:.6g}" in found.message


@pytest.mark.parametrize("name", ["return-to-orbit", "lapan-minimum-energy"])
def test_models_without_a_rotation_in_their_coordinates_show_none(name: str) -> None:
    assert not symmetric(instance.load(name))


@pytest.mark.slow
def test_a_hill_exactly_in_the_way_is_passed_on_one_side(tmp_path: Path) -> None:
    ends = "[initial]\nx1 = -1.0\n{}[final]\nx1 = 1.0\n{}[time]\ntf = 2.0\n"
    beside = solve(build(tmp_path, bump, ends.format("x2 = 0.0\n", "x2 = 0.0\n")))
    straight = solve(build(tmp_path, over, ends.format("", "")))
    assert beside.objective < straight.objective
    assert np.abs(beside.x[1]).max() > 0.1
    assert certificate(beside).verdict == "certified"


@pytest.mark.slow
def test_of_two_ways_that_cost_nearly_the_same_the_cheaper_one_is_known(tmp_path: Path) -> None:
    """A hill is passed on either side; their costs differ by 9e-6 of themselves, which no coarse mesh tells."""
    ends = "[initial]\nx1 = -1.0\nx2 = 0.0\n[final]\nx1 = 1.0\nx2 = 0.0\n[time]\ntf = 2.0\n"

    def tilted(by: float) -> Instance:
        return build(tmp_path, replace(bump, name="tilted", running_cost=bump.running_cost + Float(by) * x2), ends)

    one, other = (solve(tilted(by)) for by in (1e-5, -1e-5))
    assert one.x[1].mean() * other.x[1].mean() < 0.0
    dearer = two_point_method.solve(replace(one.instance, guess=starting_from(other).guess))
    assert dearer.x[1].mean() * other.x[1].mean() > 0.0
    assert 1e-6 < dearer.objective / one.objective - 1.0 < 1e-4
    _, better = examined(replace(dearer, instance=one.instance), np.inf)
    assert better is not None
    assert better.objective == pytest.approx(one.objective, rel=1e-10)


def test_a_saddle_is_left_for_what_lies_below_it(tmp_path: Path) -> None:
    """From next to the long axis the far end of an ellipse is an extremal, too; the near one is the nearest point."""
    ends = Problem(
        name="ellipse",
        title="To an ellipse",
        model=plane,
        running_cost=(u1**2 + u2**2) / 2,
        terminal_constraints=(x1**2 / 4 + x2**2 - 1,),
    )
    start, tf = (0.3, 0.0), 1.5
    found = solve(build(tmp_path, ends, f"[initial]\nx1 = {start[0]}\nx2 = {start[1]}\n[time]\ntf = {tf}\n"))
    angles = np.linspace(0.0, 2.0 * np.pi, 200_001)
    nearest = np.hypot(2.0 * np.cos(angles) - start[0], np.sin(angles) - start[1]).min()
    assert found.objective == pytest.approx(nearest**2 / (2.0 * tf), rel=1e-8)
    assert certificate(found).verdict == "certified"


@pytest.mark.slow
@pytest.mark.parametrize(("tf", "bounded"), [(3.0, True), (4.0, False), (7.0, False)])
@pytest.mark.parametrize("method", ["auto", "linear", "shooting"])
def test_two_equal_axes_beyond_their_conjugate_time_have_no_minimiser(
    tf: float, bounded: bool, method: str, tmp_path: Path
) -> None:
    """Conjugate times are multiples of pi, each for both axes at once: its determinant touches zero only."""
    ends = "[initial]\nx1 = 0.5\nx2 = 0.3\n[final]\nx1 = 0.0\nx2 = 0.0\n"
    found = solve(build(tmp_path, saddle, f'{ends}[time]\ntf = {tf}\n[solver]\nmethod = "{method}"\n'))
    if bounded:
        assert certificate(found).verdict == "certified"
        assert found.objective == pytest.approx(0.5 * (0.25 + 0.09) / np.tan(tf), rel=1e-9)
    else:
        assert found.status is Status.NO_MINIMISER
        assert "unbounded below" in found.message


@pytest.mark.slow
def test_a_reward_of_the_distance_without_bounds_has_no_minimiser() -> None:
    polar = instance.load("soft-return")
    names = polar.model.spec.parameter_names
    weights = tuple(
        {"k1": -1.0, "k2": 0.0, "k3": 0.0, "k4": 0.0}.get(name, value)
        for name, value in zip(names, polar.parameters, strict=True)
    )
    still = replace(polar, parameters=weights, initial=(1.0, 0.0, 0.0, 1.0), tf=3.0)
    for method in ("auto", "sweep"):
        found = solve(replace(still, solver=msgspec.structs.replace(polar.solver, method=method)))
        assert found.status is Status.NO_MINIMISER, method
        assert "fix the final time" not in found.status.explain(found.message)


def rewarded(folder: Path, start: float, weight: float, bounds: tuple[float, float], tf: float) -> Instance:
    return build(
        folder,
        reward,
        f"[parameters]\nk = {weight}\n[initial]\nx1 = {start}\n[time]\ntf = {tf}\n[control]\nu1 = {list(bounds)}\n",
    )


def dearest(start: float, weight: float, bounds: tuple[float, float], tf: float) -> dict[float, float]:
    """Costs of a control held at either bound: where the reward outweighs the effort one of them is the least."""
    return {u: u * u * tf / 2 + weight * (start + u * tf) ** 2 / 2 for u in bounds}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_what_exists_only_within_bounds_is_found(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    start, weight, tf = rng.uniform(-1.0, 1.0), -rng.uniform(2.0, 9.0), rng.uniform(1.0, 3.0)
    bounds = (-rng.uniform(0.2, 2.0), rng.uniform(0.2, 2.0))
    found = solve(rewarded(tmp_path, start, weight, bounds, tf))
    assert found.objective == pytest.approx(min(dearest(start, weight, bounds, tf).values()), rel=1e-9)
    assert certificate(found).verdict == "certified"
    assert Kind.STARTS in compared(found)


@pytest.mark.slow
def test_a_guess_is_honoured_and_what_is_cheaper_is_said(tmp_path: Path) -> None:
    numbers = 0.4, -8.0, (-1.6, 0.4), 2.0
    costs = dearest(*numbers)
    assert costs[-1.6] < costs[0.4]
    case = rewarded(tmp_path, *numbers)
    found = solve(replace(case, guess=Guess(control={"u1": (0.4,)})))
    assert found.objective == pytest.approx(costs[0.4], rel=1e-9)
    assert certificate(found).verdict == "extremal only"
    assert f"{costs[-1.6]:.6g}" in found.message


@pytest.mark.slow
@pytest.mark.parametrize("method", ["auto", "sweep"])
def test_constraints_on_the_end_are_never_ignored(method: str, tmp_path: Path) -> None:
    """From rest x1 + x2 = 1 with x2 = 0 takes 0.9 s at the least with |u1| <= 5."""
    text = f'[initial]\nx1 = 0.0\nx2 = 0.0\n[control]\nu1 = [-5.0, 5.0]\n[solver]\nmethod = "{method}"\n[time]\ntf = '
    if method == "sweep":
        with pytest.raises(BadInput, match="terminal constraints"):
            solve(build(tmp_path, tied, text + "0.1\n"))
        return
    assert solve(build(tmp_path, tied, text + "0.1\n")).status is Status.INFEASIBLE
    reached = solve(build(tmp_path, tied, text + "1.0\n"))
    assert certificate(reached).verdict == "certified"
    assert reached.x[:, -1] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_time_that_is_up_before_the_comparison_never_certifies() -> None:
    found = solve(instance.load("return-to-orbit"))
    late = replace(found.instance, solver=msgspec.structs.replace(found.instance.solver, max_seconds=1e-9))
    hurried = certify(replace(found, instance=late))
    assert hurried is not None
    assert hurried.verdict == "extremal only"
    assert Kind.STARTS in hurried.not_checked
    assert all(check.passed for check in certificate(found).checks)


def test_no_control_is_the_best_only_where_nothing_depends_on_the_state() -> None:
    thesis = solve(instance.load("its-thesis"))
    assert none_conceivable(thesis)
    names = thesis.instance.model.spec.parameter_names
    weighed = tuple(
        -1e-6 if name == "k1" else value for name, value in zip(names, thesis.instance.parameters, strict=True)
    )
    assert not none_conceivable(replace(thesis, instance=replace(thesis.instance, parameters=weighed)))


@pytest.mark.slow
def test_starts_that_minimise_slowly_are_compared_with() -> None:
    """The state rests between both ends for a time of 10,000: Newton's method finishes what penalties leave undone."""
    found = solve(instance.load("hypersensitive-10000"))
    assert found.certificate is not None
    (starts,) = (one for one in found.certificate.competitors if one.kind is Kind.STARTS)
    assert starts.solved
    assert starts.cheapest == pytest.approx(found.objective, rel=1e-8)
    assert found.certificate.verdict is Verdict.CERTIFIED


def test_a_single_competitor_that_was_solved_is_something_to_compare_with() -> None:
    def tried(kind: Kind, solved: int, interrupted: bool = False) -> Compared:
        return Compared(Competitors(kind, 4, solved, 2.0), 1.0 if solved else np.inf, interrupted)

    def failing(*kinds: Compared) -> list[str]:
        return [check.name for check in Comparison(kinds, ()).checks if not check.passed]

    assert failing() == []
    assert failing(tried(Kind.STARTS, 0), tried(Kind.DURATIONS, 0)) == [UNCOMPARED]
    assert failing(tried(Kind.STARTS, 0), tried(Kind.DURATIONS, 1)) == []
    assert failing(replace(tried(Kind.STARTS, 0), enough=True)) == []
    assert failing(tried(Kind.STARTS, 0, interrupted=True)) == ["not checked within the time limit: seeded starts"]


@pytest.mark.parametrize("guessed", [False, True])
def test_the_first_cheaper_extremal_ends_the_comparison_unless_a_guess_decides(
    monkeypatch: pytest.MonkeyPatch, guessed: bool
) -> None:
    """What is cheaper is compared with all starts itself; the answer to a guess stays, and the cheapest is told."""
    found = solve(instance.load("return-to-orbit"), examined=False)
    costs = [share * found.objective for share in (1.0, 0.9, 0.8)]
    tried = [Tried(Plan(), cost, replace(found, objective=cost) if cost < costs[0] else None) for cost in costs]
    monkeypatch.setattr(solving, "others", lambda *_: iter(tried))
    given = replace(found, instance=starting_from(found)) if guessed else found
    seen, better = examined(given, np.inf)
    assert seen is not None
    assert better is not None
    assert better.objective == costs[2 if guessed else 1]
    assert seen.verdict is Verdict.EXTREMAL_ONLY
    assert seen.competitors[0].tried == (3 if guessed else 2)


def test_starts_are_not_checked_where_a_cheaper_motion_is_unsettled(monkeypatch: pytest.MonkeyPatch) -> None:
    found = solve(instance.load("return-to-orbit"), examined=False)
    tried = [Tried(Plan(), found.objective), Tried(Plan(), np.nan, unsettled=True)]
    monkeypatch.setattr(solving, "others", lambda *_: iter(tried))
    seen, _ = examined(found, np.inf)
    assert seen is not None
    assert seen.verdict is Verdict.CERTIFIED
    assert Kind.STARTS in seen.not_checked


@pytest.mark.parametrize(
    ("costs", "share"),
    [
        ([1.0] * 12, 0.0),
        ([1.0] * 10 + [2.0, 3.0], 2 / 12),
        ([1.0, 1.0 + 5e-5] * 5 + [2.0, 3.0], 2 / 12),  # on a coarse mesh these are one motion
        ([float(k) for k in range(1, 11)] + [float("nan")] * 5, 1.0),
        ([float(k) for k in range(1, 10)], 0.0),  # too few to tell
        ([-1.0, -1.0, -2.0] * 4 + [-3.0], 1 / 13),
    ],
)
def test_the_share_of_motions_that_one_start_led_to_estimates_what_is_unseen(costs: list[float], share: float) -> None:
    assert unseen(costs) == pytest.approx(share)


def test_draws_from_a_known_distribution_are_estimated_without_bias() -> None:
    """Of motions with known probabilities, the probability of those unseen after 40 starts is estimated on average."""
    rng, chances = np.random.default_rng(3), np.array([0.5, 0.2, *[0.3 / 30] * 30])
    missed, estimated = [], []
    for _ in range(400):
        drawn = rng.choice(len(chances), 40, p=chances)
        missed.append(chances[np.setdiff1d(np.arange(len(chances)), drawn)].sum())
        estimated.append(unseen((1.0 + drawn).tolist()))
    assert np.mean(estimated) == pytest.approx(np.mean(missed), abs=0.01)
