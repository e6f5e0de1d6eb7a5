"""The second variation on singular arcs: its form against differences of the cost, and conjugate times."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from sympy import Rational, cos, sin

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import certificate
from satsym.solvers.by_search import bang_bang, boundary_arcs
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import units
from satsym.solvers.certificate.switching import singular
from satsym.solvers.certificate.switching.integration import Integration
from satsym.solvers.certificate.switching.replay import replay
from satsym.solvers.certificate.switching.second_variation import form_of
from satsym.solvers.iteration import MOST_ITERATIONS, Limits
from satsym.status import Status, Verdict
from satsym.symbolic import Problem, t
from tests.support.models import build
from tests.switching.test_switching_models import case, problem, v, x, y

VAN_DER_POL = problem("van_der_pol", {x: y, y: -x + y * (1 - x**2) + v}, (x**2 + y**2) / 2, ("v",))
TIMED = problem("timed", {x: y * cos(t), y: v * (1 + sin(t) / 2) - x * t}, x**2 * (1 + t) + y**2, ("v",))
PUSHED = problem("pushed", {x: y, y: v}, (y**2 - x**2) / 2, ("v",))
FLOORED = replace(PUSHED, name="floored", path_constraints={"floor": -y - Rational(1, 2)})
CUBIC = problem("cubic", {x: y + x**3 / 5, y: v * (1 + x**2)}, (x**2 + y**2) / 2 + x**3 / 7, ("v",))

LIMITS = Limits(MOST_ITERATIONS, float("inf"))


def along_the_cosine(folder: Path, tf: float) -> Solution:
    """The motion x = cos t with u = -x, which is singular throughout: the costate of x is -y, that of y vanishes."""
    times = np.linspace(0.0, tf, 201)
    motion = np.array([np.cos(times), -np.sin(times)])
    costates = np.array([np.sin(times), np.zeros_like(times)])
    found = bang_bang(pushed(folder, 1.0))
    return replace(
        found,
        instance=pushed(folder, tf),
        times=times,
        x=motion,
        lam=costates,
        u=-motion[:1],
        objective=-math.sin(2.0 * tf) / 4.0,
        switching_times=((),),
        certificate=None,
    )


def pushed(folder: Path, tf: float) -> Instance:
    """An instance to the value of the cosine at the final time."""
    text = f"""
        [initial]
        x = 1.0
        y = 0.0
        [final]
        x = {math.cos(tf)!r}
        [time]
        tf = {tf}
        [control]
        v = [-2.0, 2.0]
        """
    return build(folder, PUSHED, text)


@pytest.mark.parametrize(("tf", "minimum"), [(1.0, True), (3.14, True), (3.143, False), (4.0, False)])
def test_a_singular_arc_has_its_conjugate_time_where_the_oscillator_has(
    tmp_path: Path, tf: float, minimum: bool
) -> None:
    # With y as the control, the integral of (y^2 - x^2) / 2 is least up to half a period, which is pi.
    found = certificate.certify(along_the_cosine(tmp_path, tf), compared=False)
    assert found is not None
    failed = [check.name for check in found.checks if not check.passed]
    assert failed == ([] if minimum else ["second variation along singular arcs"])
    assert found.verdict is (Verdict.LOCAL_MINIMUM if minimum else Verdict.EXTREMAL_ONLY)


def above_a_floor(folder: Path, last: float) -> Solution:
    """The same motion, held for a while on y = -1/2, where its rate is constant, and released for the time ``last``.

    It enters at t = pi / 6, and leaves where the integral of x since then vanishes, after 4 cos(pi / 6).
    """
    first, held = math.pi / 6.0, 4.0 * math.cos(math.pi / 6.0)
    edges = [0.0, first, first + held, first + held + last]

    def instance(last: float) -> Instance:
        text = f"""
            [initial]
            x = 1.0
            y = 0.0
            [final]
            x = {-math.cos(first - last)!r}
            [time]
            tf = {first + held + last!r}
            [control]
            v = [-2.0, 2.0]
            """
        return build(folder, FLOORED, text)

    times = np.concatenate([np.linspace(begin, end, 101) for begin, end in pairwise(edges)])
    t1, t2, t3 = times[:101], times[101:202] - first, times[202:] - first - held
    zero, half = np.zeros(101), np.full(101, 0.5)
    motion = [
        [np.cos(t1), math.cos(first) - t2 / 2.0, -np.cos(first - t3)],
        [-np.sin(t1), -half, -np.sin(first - t3)],
    ]
    costates = [np.sin(t1), 0.5 + math.cos(first) * t2 - t2**2 / 4.0, np.sin(first - t3)], [zero] * 3
    control = np.concatenate([-np.cos(t1), zero, np.cos(first - t3)])
    found = boundary_arcs(instance(0.5))
    entry, leaving = found.events
    return replace(
        found,
        instance=instance(last),
        times=times,
        x=np.array([np.concatenate(row) for row in motion]),
        lam=np.array([np.concatenate(row) for row in costates]),
        u=control[None],
        objective=_cost_above_a_floor(first, held, last),
        switching_times=((first, first + held),),
        events=(replace(entry, t=first), replace(leaving, t=first + held)),
        certificate=None,
    )


def _cost_above_a_floor(first: float, held: float, last: float) -> float:
    free = -math.sin(2.0 * first) / 4.0 + (math.sin(2.0 * (first - last)) - math.sin(2.0 * first)) / 4.0
    return free + held / 8.0 - (held**3 / 12.0 / 8.0)


@pytest.mark.parametrize(("last", "minimum"), [(0.5, True), (0.522, True), (0.525, False), (0.55, False)])
def test_singular_arcs_around_a_boundary_are_conjugate_where_the_closed_form_is(
    tmp_path: Path, last: float, minimum: bool
) -> None:
    # y is given on the boundary, so x varies by a constant h there: the form is h^2 (cot(pi / 6) + cot(last) - held).
    # It vanishes at last = pi / 6 = 0.5236.
    found = certificate.certify(above_a_floor(tmp_path, last), compared=False)
    assert found is not None
    failed = [check.name for check in found.checks if not check.passed]
    assert failed == ([] if minimum else ["second variation along singular and boundary arcs"])


def solved(folder: Path, one: Problem, start: tuple[float, float], tf: float) -> Solution:
    found = bang_bang(case(folder, one, start, None, str(tf)))
    assert found.status is Status.CONVERGED, found.message
    return found


def cost(held: Instance, edges: list[float], control: Callable[[float, float], float]) -> float:
    """Cost of a motion by another integrator; the control is that of a time in the interval with a given middle."""
    state = np.append(np.array(held.initial), 0.0)
    for begin, end in pairwise(edges):

        def rates(s: float, z: np.ndarray, begin: float = begin, end: float = end) -> list[float]:
            u = control(s, (begin + end) / 2.0)
            at = z[:-1].tolist()
            p = held.parameters
            return [*held.model.dynamics(s, at, (u,), p), held.model.running_cost(s, at, (u,), p)]

        state = solve_ivp(rates, (begin, end), state, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    return float(state[-1])


@pytest.mark.parametrize(
    ("one", "start", "tf"),
    [(VAN_DER_POL, (-1.0, 0.3), 3.0), (TIMED, (0.3, -0.4), 1.2), (CUBIC, (0.6, 0.5), 2.0)],
    ids=lambda one: getattr(one, "name", ""),
)
def test_the_form_is_the_second_difference_of_the_cost(
    tmp_path: Path, one: Problem, start: tuple[float, float], tf: float
) -> None:
    found = solved(tmp_path, one, start, tf)
    again = replay(found)
    assert again is not None
    pieces, by = again.pieces, Integration(np.concatenate(typical(found)), LIMITS)
    place = next(k for k, piece in enumerate(pieces) if piece.field.singular is not None)
    state, unit = units(found, typical(found)[0])
    second = form_of(found, again, by, 20)
    arc = singular.arc(again, place, state, unit, 20, by)
    first, count = second.lengths, arc.pieces
    nodes = np.linspace(arc_start := pieces[place].start, arc_end := pieces[place].end, count + 1)
    reach = tf * (found.instance.upper[0] - found.instance.lower[0])
    dense = solve_ivp(
        lambda s, z: pieces[place].field.rates(s, z.tolist()),
        (arc_start, arc_end),
        pieces[place].before,
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
        dense_output=True,
    ).sol

    def law(s: float) -> float:
        return pieces[place].field.control(s, dense(s).tolist())[0]

    def plain(s: float, middle: float) -> float:
        piece = next(piece for piece in pieces if piece.start < middle < piece.end)
        return law(s) if piece is pieces[place] else piece.field.saturated[0]

    edges = sorted({piece.start for piece in pieces} | {tf} | set(nodes.tolist()))
    rng = np.random.default_rng(1)
    y = np.concatenate([[0.0], rng.normal(size=count - 1), [0.0]])  # without pulses at the ends of the arc
    slopes = np.diff(y) / np.diff(nodes) * reach

    def varied(size: float) -> float:
        def control(s: float, middle: float) -> float:
            inside = arc_start < middle < arc_end
            own = slopes[int(np.searchsorted(nodes, middle)) - 1] if inside else 0.0
            return plain(s, middle) + size * own

        return cost(found.instance, edges, control)

    h = 1e-3 / max(abs(slopes).max(), 1.0)
    twice = (-varied(2 * h) + 16 * varied(h) - 30 * varied(0.0) + 16 * varied(-h) - varied(-2 * h)) / (12 * h * h)
    direction = np.zeros(len(second.form))
    direction[first : first + len(y)] = y
    assert 2.0 * unit * direction @ second.form @ direction == pytest.approx(twice, rel=1e-4)

    # The arc before lasts longer: a pulse at the junction, after which y keeps its value.
    before = pieces[place - 1].field.saturated[0]

    def later(shift: float) -> float:
        moved = sorted({*edges, arc_start + shift})

        def control(s: float, middle: float) -> float:
            return before if arc_start < middle < arc_start + shift else plain(s, middle)

        return (cost(found.instance, moved, control) - nothing) / shift**2

    nothing = cost(found.instance, edges, plain)
    direction[first : first + len(y)] = (before - law(arc_start)) / reach
    assert place == len(pieces) - 1
    extrapolated = 2.0 * later(h := 1e-3) - later(2.0 * h)
    assert unit * direction @ second.form @ direction == pytest.approx(extrapolated, rel=1e-4)
