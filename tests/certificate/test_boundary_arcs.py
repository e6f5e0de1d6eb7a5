"""What the certificate says of extremals with boundary arcs that are put together by hand, round a disc in a plane.

With x' = a, y' = b and (a^2 + b^2) / 2 as cost the least effort goes straight and round the disc at one speed w: the
costates are minus the velocity, and on the rim eta = w^2 / (2 R^2).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import msgspec
import numpy as np
import pytest
from sympy import sympify

import satsym
from satsym.solution import Event, Solution
from satsym.solvers import by_search
from satsym.solvers.by_search import boundary_arcs
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.constrained.conditions import _defect
from satsym.solvers.certificate.constrained.replay import replay
from satsym.solvers.certificate.constrained.second_variation import curvature
from satsym.solvers.certificate.second_variation import Quadratic
from satsym.solvers.constrained.structure import stated_arcs
from satsym.solvers.improving import bottomless, fall
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES, CONTROLS = (Variable("x", "x"), Variable("y", "y")), (Variable("a", "a"), Variable("b", "b"))
PARAMETERS = tuple(Variable(name, name, default=0.0) for name in ("c", "k", "q"))
(x, y), (a, b), (c, k, q) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)
PLANE = FirstOrder(
    name="plane", title="plane", states=STATES, controls=CONTROLS, parameters=PARAMETERS, rates={x: a, y: b}
)
DISC = Problem(
    name="disc",
    title="disc",
    model=PLANE,
    running_cost=(a**2 + b**2 - q * x**2) / 2,
    terminal_cost=c * x + k * (x**2 + y**2) / 2,
    path_constraints={"disc": 1 - x**2 - y**2},
)


@cache
def in_the_plane() -> satsym.Instance:
    """One case, whose beginning and end the motions below replace."""
    return satsym.Instance.of(DISC, initial={"x": -2.0, "y": 0.0}, tf=1.0)


def at(angle: Any) -> np.ndarray:
    """On the rim."""
    return np.array([np.cos(angle), np.sin(angle)])


def along(angle: Any) -> np.ndarray:
    """Clockwise on the rim."""
    return np.array([np.sin(angle), -np.cos(angle)])


def motion(instance: satsym.Instance, *arcs: tuple[float, bool], first: float, speed: float) -> Solution:
    """Arcs one after the other, clockwise, each so long and on the rim or straight; the rim is met at an angle."""
    case = instance.case
    begins, parts, angle = 0.0, list[Any](), first
    events = [Event("entry", "disc", 0.0)] if arcs[0][1] else []
    for number, (lasting, on_rim) in enumerate(arcs):
        times = np.linspace(begins, begins + lasting, 201)
        since = times - begins
        if on_rim:
            turned = angle - speed * since
            place, way = at(turned), along(turned)
            angle = float(turned[-1])
        else:
            since = since - lasting if number == 0 else since
            place = at(angle)[:, None] + speed * along(angle)[:, None] * since
            way = np.repeat(along(angle)[:, None], len(times), axis=1)
        parts.append((times, place, speed * way))
        begins += lasting
        if number < len(arcs) - 1:
            events.append(Event("exit" if on_rim else "entry", "disc", begins))
    times, places, ways = (np.concatenate(rows, axis=-1) for rows in zip(*parts, strict=True))
    end = places[:, -1]
    values = dict(zip(case.model.spec.parameter_names, case.parameters, strict=True))
    cost = speed**2 * begins / 2 + values["c"] * end[0] + values["k"] * end @ end / 2
    return Solution(
        instance=replace(case, initial=tuple(places[:, 0].tolist())),
        method="boundary-arcs",
        status=Status.CONVERGED,
        message="by hand",
        objective=float(cost),
        times=times,
        x=places,
        u=ways,
        lam=-ways,
        switching_times=((), ()),
        iterations=0,
        history=(),
        wall_s=0.0,
        events=tuple(events),
    )


LEADING, RIM, AWAY = (0.3, False), (0.4, True), (0.3, False)


@pytest.fixture(scope="module")
def round_the_disc() -> Solution:
    """From one side to the other, both ends given."""
    free = motion(in_the_plane(), LEADING, RIM, AWAY, first=2.0, speed=3.0)
    end = dict(zip("xy", free.x[:, -1].tolist(), strict=True))
    return replace(free, instance=replace(free.instance, final=end))


def limited(solution: Solution, seconds: float) -> Solution:
    options = msgspec.structs.replace(solution.instance.solver, max_seconds=seconds)
    return replace(solution, instance=replace(solution.instance, solver=options))


LATE = {f"not checked within the time limit: {kind}" for kind in ("seeded starts", "structure of boundary arcs")}
"""Checks that fail where nobody had the time to compare."""


def judged(solution: Solution, **how: Any) -> tuple[Verdict, set[str]]:
    """The verdict, and the names of checks that failed."""
    found = certify(solution, **how)
    assert found is not None
    return found.verdict, {check.name for check in found.checks if not check.passed}


def test_nothing_is_certified_that_nobody_had_the_time_to_compare(round_the_disc: Solution):
    verdict, failed = judged(limited(round_the_disc, 1e-9))
    assert verdict is Verdict.EXTREMAL_ONLY
    assert failed == LATE
    assert judged(round_the_disc, compared=False) == (Verdict.LOCAL_MINIMUM, set())


def to_the_rim(c: float) -> Solution:
    """Straight, then on the rim until an angle of 0.2, where c x is stationary along it: w = c sin(0.2)."""
    speed = c * np.sin(0.2)
    given = in_the_plane().with_(parameters={"c": c, "k": 4.0})
    return motion(given, (0.25, False), (0.75, True), first=0.2 - 0.75 * speed, speed=-speed)


@pytest.mark.parametrize(("c", "minimum"), [(1.0, True), (1.05, False)])
def test_a_boundary_on_which_the_motion_ends_curves_the_form_there(c: float, minimum: bool):
    """J = w^2 / 2 + c cos(angle) along paths that end elsewhere on the rim, the second derivative 1 - c cos(0.2)."""
    found = to_the_rim(c)
    assert (1 - c * np.cos(0.2) > 0) == minimum
    again = replay(found)
    assert again is not None
    assert (curvature(found, again) > 0.0) == minimum
    verdict, failed = judged(limited(found, 1e-9))
    assert verdict is Verdict.EXTREMAL_ONLY
    assert ("second variation with fixed active arcs" in failed) == (not minimum)


@pytest.mark.slow
def test_where_states_are_kept_within_bounds_no_cost_is_said_to_fall_without_end():
    """x'' = -q x with three conjugate points: without the constraint the cost is unbounded below."""
    given = in_the_plane().with_(parameters={"q": 100.0}, initial={"x": 0.3, "y": 5.0}, final={"x": 0.3, "y": 5.0})
    stationary = by_search.collocation(given.case)
    assert stationary.status is Status.CONVERGED
    assert fall(stationary) is not None
    assert bottomless(stationary) is None


def test_what_pushes_at_the_end_is_kept_apart_from_multipliers_of_terminal_constraints(round_the_disc: Solution):
    """Straight to (0.8, 0.6) on the rim, where y is asked for: zeta and nu together make up the costates' jump."""
    tied = replace(DISC, name="tied", terminal_constraints=(y - sympify("3/5"),))
    case = satsym.Instance.of(tied, initial={"x": 1.5, "y": 0.0}, parameters={"k": 4.0}, tf=1.0).case
    start, way, times = np.array([[1.5], [0.0]]), np.array([[-0.7], [0.6]]), np.linspace(0.0, 1.0, 401)
    along_it = np.repeat(way, 401, axis=1)
    found = replace(
        round_the_disc,
        instance=case,
        times=times,
        x=start + way * times,
        u=along_it,
        lam=-along_it,
        objective=0.85 / 2 + 2.0,
        events=(Event("touch", "disc", 1.0),),
    )
    again = replay(found)
    assert again is not None
    assert again.pressed == {0: pytest.approx((4 * 0.8 - 0.7) / 1.6)}  # lambda_x - S_x = zeta g_x
    assert judged(limited(found, 1e-9)) == (Verdict.EXTREMAL_ONLY, LATE)
    given = replace(found, instance=replace(case, final={"x": 0.8}))
    free = replay(given)
    assert free is not None
    assert not free.pressed  # what is given pushes by itself


def test_curved_terminal_constraints_count_by_their_multipliers_after_the_jump_at_the_end(round_the_disc: Solution):
    """The motion above with room to a side, z, where y = 0.6 - q z^2 is asked for: 1 + k - 2 zeta + 2 q nu is left."""
    side, push = Variable("z", "z"), Variable("d", "d")
    (z,), (d,) = symbols_of((side,)), symbols_of((push,))
    space = replace(PLANE, states=(*STATES, side), controls=(*CONTROLS, push), rates={x: a, y: b, z: d})
    asked = Problem(
        name="sphere",
        title="sphere",
        model=space,
        running_cost=(a**2 + b**2 + d**2) / 2,
        terminal_cost=k * (x**2 + y**2 + z**2) / 2,
        terminal_constraints=(y - sympify("3/5") + q * z**2,),
        path_constraints={"disc": 1 - x**2 - y**2 - z**2},
    )
    start = {"x": 1.5, "y": 0.0, "z": 0.0}
    case = satsym.Instance.of(asked, initial=start, parameters={"k": 4.0, "q": 0.6}, tf=1.0).case
    way, times = np.array([[-0.7], [0.6], [0.0]]), np.linspace(0.0, 1.0, 401)
    found = replace(
        round_the_disc,
        instance=case,
        times=times,
        x=np.array([[1.5], [0.0], [0.0]]) + way * times,
        u=np.repeat(way, 401, axis=1),
        lam=-np.repeat(way, 401, axis=1),
        objective=0.85 / 2 + 2.0,
        events=(Event("touch", "disc", 1.0),),
    )
    again = replay(found)
    assert again is not None
    zeta = (4 * 0.8 - 0.7) / 1.6
    nu = -0.6 - 4 * 0.6 + 1.2 * zeta  # lambda_y = k y + nu - 2 y zeta
    assert curvature(found, again) == pytest.approx(1 + 4 - 2 * zeta + 2 * 0.6 * nu, abs=1e-9)


def test_a_motion_on_the_rim_from_start_to_end_is_an_extremal():
    """With w = c sin(angle) at the end, where the form is positive: 1 - c cos(angle) there."""
    c, end = 1.5, 2.0
    speed = c * np.sin(end)
    given = in_the_plane().with_(parameters={"c": c, "k": 4.0})
    found = motion(given, (1.0, True), first=end - speed, speed=-speed)
    assert stated_arcs(found) == [(0,)]
    assert judged(limited(found, 1e-9)) == (Verdict.EXTREMAL_ONLY, LATE)
    beside = replace(found, x=found.x * 0.999, instance=replace(found.instance, initial=tuple(found.x[:, 0] * 0.999)))
    assert judged(beside)[0] is Verdict.FAILED


@pytest.mark.parametrize(
    ("form", "ties", "least"),
    [
        (np.eye(3), np.zeros((0, 3)), 1.0),
        (np.eye(3), np.eye(3), np.inf),
        (np.full((3, 3), -np.inf), np.zeros((0, 3)), np.nan),
    ],
)
def test_a_form_without_numbers_is_not_positive(form: np.ndarray, ties: np.ndarray, least: float):
    assert Quadratic((), form, 1, ties, free_time=False).steepest()[0] == pytest.approx(least, nan_ok=True)


@pytest.mark.slow
def test_where_rounding_grows_along_the_flow_it_is_followed_part_by_part():
    """A return that stays above a floor for long: one flow misses the end by twice what it may, its parts do not."""
    given = satsym.Instance.of(
        "return_above",
        initial={"r": 1.08120458266, "r_dot": 0.01077883814, "theta": 0.0327927717, "theta_dot": 0.90093427772},
        final=dict.fromkeys(("r", "r_dot", "theta", "theta_dot"), "reference"),
        parameters={"r_min": 0.9907505085883487},
        tf=8.877432264346659,
    )
    found = boundary_arcs(given.case)
    verdict, failing = judged(limited(found, 1e-9))
    parts = replay(found, in_segments=True)
    assert parts is not None
    assert parts.gap < 1e-9
    assert verdict is not Verdict.FAILED, failing
    middle = len(found.times) // 2
    beside = found.lam * np.where(np.arange(len(found.times)) < middle, 1.0, 1.0 + 1e-7)
    assert judged(limited(replace(found, lam=beside), 1e-9))[0] is Verdict.FAILED
    moved = replay(replace(found, lam=beside), in_segments=True)
    assert moved is not None
    assert moved.gap > 1e-8


def test_the_distance_from_the_flow_is_relative_to_the_size_of_each_state_and_costate() -> None:
    found = satsym.solve("bryson-denham").found
    again = replay(found)
    assert again is not None
    for row, share in ((0, 1e-3), (1, 1e-4)):
        size = float(np.abs(found.lam[row]).max())
        moved = found.lam.copy()
        moved[row, 5] += share * size
        assert _defect(replace(found, lam=moved), again) == pytest.approx(share, rel=0.05)
