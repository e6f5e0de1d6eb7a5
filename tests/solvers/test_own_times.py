"""Free final times far from one, where the motion's own modes do not tell how long it lasts."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from sympy import sqrt

from satsym import instance
from satsym.instance import Instance
from satsym.instance.numbers import changed
from satsym.report.said import message, spoken
from satsym.solvers import solve
from satsym.solvers.cold_start.own_time import own_time, time_scale
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Annulus, FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = (Variable("x", "x"), Variable("v", "v"), Variable("y", "y"))
PULLED, DECAY, THRUST = Variable("g", "g", default=0.0), Variable("k", "k", default=0.0), Variable("w", "w")
x, v, y = symbols_of(STATES)
g, k, w = symbols_of((PULLED, DECAY, THRUST))


HOP = Problem(
    name="hop",
    title="A hop against a pull, beside a state that decays at a rate of its own",
    model=FirstOrder(
        name="hopping",
        title="M",
        states=STATES,
        controls=(THRUST,),
        parameters=(PULLED, DECAY),
        rates={x: v, v: w - g, y: -k * y},
    ),
    running_cost=w**2 / 2,
)


def hop(folder: Path, height: float, pull: float, decay: float) -> Instance:
    ends = f"[initial]\nx = 0.0\nv = 0.0\ny = 0.0\n[final]\nx = {height}\nv = 0.0\n"
    return build(folder, HOP, f'{ends}[parameters]\ng = {pull}\nk = {decay}\n[time]\ntf = "free"\n')


@pytest.mark.slow
@pytest.mark.parametrize("decay", [0.0, 10.0])
@pytest.mark.parametrize(("height", "pull"), [(1000.0, 1e-3), (6.0, 6e4)])
def test_the_least_effort_of_a_hop_is_found_however_long_it_lasts(
    tmp_path: Path, height: float, pull: float, decay: float
) -> None:
    """In a time T over a height h it is g^2 T / 2 + 6 h^2 / T^3, which is least at T = sqrt(6 h / g)."""
    own = math.sqrt(height / pull)
    case = hop(tmp_path, height, pull, decay / own)
    assert own_time(case) == pytest.approx(own, rel=1e-6)
    found = solve(case)
    lasting = math.sqrt(6.0) * own
    assert found.status is Status.CONVERGED, found.message
    assert found.times[-1] == pytest.approx(lasting, rel=1e-7)
    assert found.objective == pytest.approx(pull**2 * lasting / 2.0 + 6.0 * height**2 / lasting**3, rel=1e-9)


def test_that_longer_is_always_cheaper_is_said_over_decades(tmp_path: Path) -> None:
    """Without a pull nothing ends the fall of 6 h^2 / T^3."""
    found = solve(hop(tmp_path, 2.0, 0.0, 1.0))
    assert found.status is Status.NO_MINIMISER
    costs, durations = (
        [float(one) for one in part.split(", ")]
        for part in re.findall(r"cost (.*) at durations ([^;]*);", found.message)[0]
    )
    assert durations[-1] >= 50.0
    assert costs == pytest.approx([24.0 / duration**3 for duration in durations], rel=1e-3)
    with spoken("id"):
        assert message(found.message).startswith("durasi yang lebih lama selalu lebih murah:")


def test_the_scale_of_bounded_thrust_is_that_of_its_distance() -> None:
    case = instance.load("double-integrator-time")
    twice = replace(case, initial=tuple(4.0 * value for value in case.initial))
    assert time_scale(twice) == pytest.approx(2.0 * time_scale(case), rel=1e-6)


def test_a_guess_of_a_free_final_time_may_be_set_where_there_is_none() -> None:
    case = instance.load("ends-4-rendezvous")
    assert case.tf_guess is None
    assert changed(case, {"time.tf_guess": 4.0}).tf_guess == 4.0
    with pytest.raises(BadInput, match=r"^time\.tf_guess: -1 is not after t0 = 0; give a later time$"):
        changed(case, {"time.tf_guess": -1.0})
    with pytest.raises(BadInput, match=r"^time\.tf_guess: ends-1-given gives the final time; set time\.tf, or"):
        changed(instance.load("ends-1-given"), {"time.tf_guess": 4.0})


LANDER = tuple(Variable(name, name) for name in ("x", "z", "vx", "vz"))
THRUSTS = (Variable("Tx", "T_x"), Variable("Tz", "T_z"))
MASS, GRAVITY = Variable("m", "m", positive=True), Variable("g", "g", default=3.7114, positive=True)
FLOW = Variable("a", "a", default=5.09e-4, positive=True)


@pytest.mark.slow
def test_a_powered_descent_is_found_without_a_guess(tmp_path: Path) -> None:
    """Pinned: Acikmese and Ploen's first case without the glide slope; CasADi with Ipopt, 72.19 s and 388.145 kg."""
    h, z, vh, vz = symbols_of(LANDER)
    (m,), (tx, tz), (pull, flow) = symbols_of((MASS,)), symbols_of(THRUSTS), symbols_of((GRAVITY, FLOW))
    norm = sqrt(tx**2 + tz**2)
    landing = FirstOrder(
        name="landing",
        title="L",
        states=(*LANDER, MASS),
        controls=THRUSTS,
        parameters=(GRAVITY, FLOW),
        rates={h: vh, z: vz, vh: tx / m - pull, vz: tz / m, m: -flow * norm},
    )
    engine = {"engine": Annulus("Tx", "Tz")}
    problem = Problem(name="descent", title="D", model=landing, running_cost=flow * norm, control_sets=engine)
    text = "[initial]\nx = 1500.0\nz = 2000.0\nvx = -75.0\nvz = 100.0\nm = 1905.0\n[final]\nx = 0.0\nz = 0.0\n"
    text += 'vx = 0.0\nvz = 0.0\n[time]\ntf = "free"\n[control.engine]\nmax_norm = 13258.0\nmin_norm = 4972.0\n'
    found = solve(build(tmp_path, problem, text))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(388.145, abs=2e-3)
    assert found.times[-1] == pytest.approx(72.19, abs=1e-2)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
