"""Claims about the maximum principle on the scaled pitch axis, held against its derived Hamiltonians."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 59
_TRIES = 60
_CONTROLS = np.linspace(-1.0, 1.0, 401)
_SAME = 1e-9
_COARSE = 1e-4
"""What a grid of controls may miss of the largest H."""


@cache
def _hamiltonian(problem: str) -> Callable[..., float]:
    """H of the maximum principle, of X1, X2, P1, P2, U, C_p: the derived one, its sign and its costates reversed."""
    from satsym.symbolic.lookup.library import derivation

    found = derivation(problem).equation("hamiltonian.H").rhs

    def value(x1: float, x2: float, p1: float, p2: float, u: Any, c_p: float = 0.0) -> Any:
        at = {"X1": x1, "X2": x2, "lambda_X1": -p1, "lambda_X2": -p2, "C_p": c_p}
        places = {s.name: s for s in found.free_symbols}
        whole = found.xreplace({places[n]: v for n, v in at.items() if n in places})
        by_u = [float(whole.diff(places["U"], k).xreplace({places["U"]: 0})) if k else
                float(whole.xreplace({places["U"]: 0})) for k in range(3)]  # fmt: skip
        return -(by_u[0] + by_u[1] * u + by_u[2] * u**2 / 2.0)

    return value


def _numbers(found: exact.Expression, **values: float) -> float:
    return exact.number(found, values)


@predicate
def law_maximises(row: Question, problem: str, costate: str) -> Finding:
    """Whether a printed control makes the derived H largest among the admissible ones, at random states and constants.

    Parameters
    ----------
    costate
        The row with the solution for P2, in C1, C2 and tau.
    """
    law, p2 = exact.expression(str(row.printed)), exact.expression(str(row.document[costate]))
    rng, worst = np.random.default_rng(_SEED), 0.0
    for _ in range(_TRIES):
        c1, c2, x1, x2 = (float(v) for v in rng.uniform(-2.0, 2.0, 4))
        tau = float(rng.uniform(0.0, 3.0))
        places = {"C1": c1, "C2": c2, "tau": tau, "X2": x2}
        at = (x1, x2, c1, _numbers(p2, **places))
        h = _hamiltonian(problem)
        worst = max(worst, float(np.max(h(*at, _CONTROLS))) - float(h(*at, _numbers(law, **places))))
    return Finding(
        worst < _SAME,
        f"no admissible control gives more, but for {max(worst, 0.0):.0e}",
        {"cases": _TRIES, "largest shortfall": worst},
    )


@predicate
def costate_solves(row: Question, rate: str, solution: str) -> Finding:
    """Whether a printed costate P2 has the printed rate where the control changes, P1 being C1.

    Parameters
    ----------
    rate, solution
        Rows with the rate of P2, in P1 and U, and with P2 itself, in tau, C1, C2 and U.
    """
    wanted, found = (exact.expression(str(row.document[key])) for key in (rate, solution))
    place = exact.letters(found, wanted, needed=("tau", "P1", "C1"))
    still = found.diff(place["tau"]) - wanted.xreplace({place["P1"]: place["C1"]})
    moving = found.diff(place["U"]) if "U" in place else 0 * found
    return Finding(
        exact.same(still, 0 * still) and exact.same(moving, 0 * moving),
        f"its rate differs from the printed one by {still.expand()}, and by {moving} times the rate of U",
        {"right for a constant control": exact.same(still, 0 * still)},
        remark="the control is what is sought, and was taken for a constant in integrating",
    )


@predicate
def limited_law_maximises(row: Question, costate: str) -> Finding:
    """Whether a printed control of least energy, its limits included, makes the derived H largest among all.

    The costate of the rate is the derived one, for a satellite that does not turn at first.

    Parameters
    ----------
    costate
        Address of the derived costate, in that of the problem without C_p, which is linear in time.
    """
    from satsym.auditing.predicates.pitch_axis import derived

    law, h = exact.expression(str(row.printed)), _hamiltonian("pitch_scaled_energy")
    rng, met, worst = np.random.default_rng(_SEED), 0, 0.0
    for _ in range(_TRIES):
        c1, c2, x2 = (float(v) for v in rng.uniform(-2.0, 2.0, 3))
        tau, c_p = float(rng.uniform(0.0, 3.0)), float(rng.uniform(0.1, 1.0))
        p2 = -derived(costate, {"reduced_lambda_X2": -(c2 - c1 * tau), "C_p": c_p, "X2": x2})
        said = float(np.clip(_numbers(law, C1=c1, C2=c2, tau=tau, X2=x2, C_p=c_p), -1.0, 1.0))
        value = np.asarray(h(0.0, x2, c1, p2, _CONTROLS, c_p))
        short = float(value.max() - h(0.0, x2, c1, p2, said, c_p))
        met += short < _COARSE
        worst = max(worst, short)
    return Finding(
        met == _TRIES,
        f"it does in {met} of {_TRIES} cases, and elsewhere falls short by up to {worst:.3g}",
        {"cases": _TRIES, "largest": met, "largest shortfall": worst},
        remark="" if met == _TRIES else "the control is half of C2 - C1 tau within its limits, whatever C_p",
    )


@predicate
def switches_at_most(row: Question, costate: str, printed: int) -> Finding:
    """Whether a printed costate changes its sign at most so often, over random constants."""
    p2 = exact.expression(str(row.document[costate]))
    rng, most, times = np.random.default_rng(_SEED), 0, np.linspace(0.0, 5.0, 41)
    for _ in range(_TRIES // 3):
        c1, c2 = (float(v) for v in rng.uniform(-2.0, 2.0, 2))
        signs = np.sign([_numbers(p2, C1=c1, C2=c2, tau=float(t)) for t in times])
        most = max(most, int((np.diff(signs[signs != 0.0]) != 0.0).sum()))
    return Finding(most == printed, f"{most} at most", {"most changes of sign": most})


@predicate
def largest_is_zero(final_time: str) -> Finding:
    """Whether the largest H is zero along optimal motions: with the final time ``free``, or ``given``.

    From rest at 1 to rest at 0: least time by one switch, least energy by the derived control.
    """
    if final_time == "free":
        # from rest at 1 to rest at 0: switching in the middle of time 2, P2 = C2 - C1 t vanishing there, H(0) = 0
        h, worst = _hamiltonian("pitch_scaled_time"), 0.0
        for t in np.linspace(0.0, 2.0, 41):
            x2 = -t if t <= 1.0 else t - 2.0
            worst = max(worst, abs(float(np.max(h(0.0, x2, -1.0, t - 1.0, _CONTROLS)))))
        return Finding(worst < _SAME, f"it is zero all along, but for {worst:.0e}", {"largest size of H": worst})
    if final_time == "given":
        from satsym.auditing.predicates.pitch_axis import derived

        start = {"X1_0": 1.0, "t_f": 2.0}
        u = [derived("pitch_scaled_energy:least_effort.from_rest", {**start, "t": t}) for t in (0.0, 1.0)]
        p1 = -2.0 * (u[1] - u[0])
        value = float(np.max(_hamiltonian("pitch_scaled_energy")(1.0, 0.0, p1, 2.0 * u[0], u[0])))
        return Finding(abs(value) < _SAME, f"it is {value:.3g}, as the final time is given", {"H": value})
    raise BadInput(f"largest_is_zero: no final time {shown(final_time)}; write free or given")


@predicate
def constants_follow(row: Question, hamiltonian: str, costate: str) -> Finding:
    """Whether H = 0 at the start and P2 = 0 when the control switches give both constants, from rest."""
    h, p2 = (exact.expression(str(row.document[key])) for key in (hamiltonian, costate))
    rng, worst = np.random.default_rng(_SEED), 0.0
    for _ in range(10):
        x1, middle = float(rng.uniform(0.1, 3.0)), 0.0
        middle = x1**0.5  # half of the least time
        # both are linear in C1 and C2
        rows, right = [], []
        for e, at in ((h, {"tau": 0.0, "X2": 0.0, "U": -1.0}), (p2, {"tau": middle})):
            base = _numbers(e, C1=0.0, C2=0.0, **at)
            rows.append([_numbers(e, C1=1.0, C2=0.0, **at) - base, _numbers(e, C1=0.0, C2=1.0, **at) - base])
            right.append(-base)
        c1, c2 = np.linalg.solve(np.array(rows), np.array(right))
        worst = max(worst, abs(float(c2) + 1.0), abs(float(c1) + 1.0 / middle))
    return Finding(worst < _SAME, "they do: C2 = -1 and C1 = C2 over the time of the switch", {"off by": worst})


@predicate
def continuous_suffices() -> Finding:
    """Whether the least time is reached by a continuous control: the steeper the switch, the less time, never least.

    From rest to rest over the distance 1 with |U| <= 1, the control going from 0 to 1, to -1 and to 0 within a share
    of the time each.
    """
    times = {}
    for share in (0.1, 0.01, 0.001):
        nodes = np.array([0.0, share, 0.5 - share, 0.5 + share, 1.0 - share, 1.0])
        u = np.array([0.0, 1.0, 1.0, -1.0, -1.0, 0.0])
        fine = np.linspace(0.0, 1.0, 40001)
        way = np.interp(fine, nodes, u)
        rate = np.concatenate([[0.0], np.cumsum((way[1:] + way[:-1]) * np.diff(fine) / 2.0)])
        distance = float(((rate[1:] + rate[:-1]) * np.diff(fine) / 2.0).sum())
        times[share] = distance**-0.5
    least = 2.0
    return Finding(
        min(times.values()) <= least,
        "continuous controls take "
        + ", ".join(f"{time:.5g}" for time in times.values())
        + f" with ever steeper switches, and none takes {least:g}, as the printed law does, which jumps",
        {f"time, switching within {share:g}": time for share, time in times.items()},
        remark="controls must be admitted that are only piecewise continuous, or measurable",
    )


@predicate
def nonlinear_switches_not(row: Question, hamiltonian: str) -> Finding:
    """Whether H that is not linear in the control is largest inside its limits; unsound if that is not why.

    The derived H is concave in U; with its square reversed H is as nonlinear, and largest at the limits always.
    """
    h = _hamiltonian("pitch_scaled_energy")
    rng, inside, convex_inside = np.random.default_rng(_SEED), 0, 0
    for _ in range(_TRIES):
        at = tuple(float(v) for v in rng.uniform(-1.0, 1.0, 4))
        values = h(*at, _CONTROLS)
        inside += 0 < int(np.argmax(values)) < len(_CONTROLS) - 1
        convex_inside += 0 < int(np.argmax(values + 2.0 * _CONTROLS**2)) < len(_CONTROLS) - 1
    found = exact.expression(str(row.document[hamiltonian]))
    place = exact.letters(found, needed=("U",))["U"]
    bend = found.diff(place, 2)
    turned = _numbers(bend, C_p=0.5, tau=4.0)
    return Finding(
        inside > 0,
        f"inside the limits for {inside} of {_TRIES} random costates, for H is concave in U; with U^2 added twice it "
        f"is as nonlinear, and inside for {convex_inside}",
        {"concave, inside": inside, "convex, inside": convex_inside, "printed H, second derivative": turned},
        sound=convex_inside > 0,
        remark=f"by the printed (28) it would not even be so: its second derivative is {bend}, and positive for "
        "tau > 1/C_p",
    )


@predicate
def setting_to_zero_maximises(row: Question, hamiltonian: str) -> Finding:
    """Whether dH/dU = 0 gives the largest of a printed H at all times."""
    found = exact.expression(str(row.document[hamiltonian]))
    place = exact.letters(found, needed=("U",))["U"]
    bend = found.diff(place, 2)
    signs = {tau: _numbers(bend, C_p=0.5, tau=tau) for tau in (0.0, 1.0, 2.0, 3.0)}
    return Finding(
        all(value < 0.0 for value in signs.values()),
        f"the second derivative of the printed H is {bend}: positive where tau exceeds 1/C_p, so that H is least there",
        {f"second derivative for C_p = 0.5, tau = {tau:g}": value for tau, value in signs.items()},
        remark="besides, the principle compares controls with the costates held, and P2 is made of U in the printed H",
    )


@predicate
def has_least_energy() -> Finding:
    """Whether some control makes the energy least from rest to rest, the final time being left open."""
    from satsym.auditing.predicates.pitch_axis import derived

    costs = {
        time: derived("pitch_scaled_energy:least_effort.cost_from_rest", {"X1_0": 1.0, "t_f": time})
        for time in (1.0, 10.0, 100.0, 1000.0)
    }
    falling = all(later < 0.9 * cost for cost, later in pairwise(costs.values()))
    return Finding(
        not (falling and min(costs.values()) > 0.0),
        "the least energy from rest at 1 is "
        + ", ".join(f"{cost:.3g} in {time:g}" for time, cost in costs.items())
        + ": it falls with the time and is 0 for none",
        {f"least energy in {time:g}": cost for time, cost in costs.items()},
        remark="the final time must be given, or weighed",
    )
