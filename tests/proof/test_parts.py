"""The parts of a proof: exact numbers, derivatives, enclosures of motions."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
from flint import arb, ctx

from satsym import instance
from satsym.proof.balls.arithmetic import mathematics
from satsym.proof.balls.exact import Source, _factor
from satsym.proof.balls.jets import derivatives, variables
from satsym.proof.balls.taylor import Order, column, step, unit
from satsym.proof.record import Enclosure

PARAMETRIC = """
model = "polar_orbit"
[parameters]
sigma = 1.25
[initial]
r = "1100 m"
r_dot = 0.1
theta = "30 deg"
theta_dot = 1
[time]
tf = 2.5
"""


@pytest.fixture(autouse=True)
def precision() -> None:
    ctx.prec, ctx.cap = 150, 10


def test_numbers_of_a_file_are_read_exactly(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(PARAMETRIC)
    case = instance.load(file)
    source = Source(case)
    read = [
        source.number(value, v.unit, "initial", v.symbol)
        for v, value in zip(case.model.spec.states, case.initial, strict=True)
    ]
    exact = (arb("1.1"), arb("0.1"), arb.pi() / 6, arb(1))
    assert all(a.overlaps(b) for a, b in zip(read, exact, strict=True))
    assert all(ball.rad() < 1e-40 for ball in read)
    assert source.stated["initial.theta"] == "30 deg"
    assert not source.number(0.1 + 1e-16, "1", "initial", "r_dot").overlaps(arb("0.1"))
    assert "binary" in source.stated["initial.r_dot"]


def test_units_are_rational_or_parts_of_pi() -> None:
    assert _factor("deg/day", "rad/s") == (Fraction(1, 180 * 86400), 1)
    assert _factor("km/day", "m/s") == (Fraction(1000, 86400), 0)
    assert _factor("turn", "deg") == (Fraction(360), 0)


def test_jets_agree_with_differences_of_forty_digits() -> None:
    m = mathematics()

    def f(x, y, m):  # type: ignore[no-untyped-def]
        return m.sin(x * y) / (y + x * x) + m.sqrt(x + y) * m.log(y) - m.atan2(x, y * y) + m.exp(-x) * m.tan(y / 4)

    at = (arb("0.7"), arb("1.3"))
    given = variables(at)
    value, first, second = derivatives(lambda: f(*given, m), 2)
    with mpmath.workdps(40):
        point = [mpmath.mpf(v) for v in ("0.7", "1.3")]

        def exact(*orders: int) -> mpmath.mpf:
            return mpmath.diff(lambda x, y: f(x, y, mpmath), point, orders)

        wanted = [exact(0, 0), exact(1, 0), exact(0, 1), exact(2, 0), exact(1, 1), exact(0, 2)]
        found = [value, *first, second[0][0], second[0][1], second[1][1]]
        for a, b in zip(found, wanted, strict=True):
            assert abs(mpmath.mpf(a.mid().str(35, radius=False)) - b) < mpmath.mpf(10) ** -12


class Pendulum:
    """z'' = -sin z with the cost z: a field as laws are."""

    def rates(self, z):  # type: ignore[no-untyped-def]
        return [z[1], -z[0].sin()]

    def jacobian(self, z):  # type: ignore[no-untyped-def]
        zero = z[0] - z[0]
        return [zero, zero + 1, -z[0].cos(), zero]

    def cost(self, z):  # type: ignore[no-untyped-def]
        return z[0]


def test_a_step_encloses_motion_and_derivatives_from_all_of_a_ball() -> None:
    radius = arb(0, 1e-3)
    start = [arb(1), arb("0.2")]
    ball = [v + radius for v in start]
    found, _ = step(Pendulum(), start, ball, arb(0.4), Order(20, 1e-16), [1.0, 1.0, 1.0])
    h = float(found.h)
    with mpmath.workdps(30):
        for offset in ((0.0, 0.0), (1e-3, -1e-3), (-5e-4, 1e-3)):
            begin = [mpmath.mpf(1) + offset[0], mpmath.mpf("0.2") + offset[1], mpmath.mpf(1), mpmath.mpf(0)]

            def rates(_, y):  # type: ignore[no-untyped-def]
                return [y[1], -mpmath.sin(y[0]), y[3], -mpmath.cos(y[0]) * y[2]]

            end = mpmath.odefun(rates, 0, begin, tol=mpmath.mpf(10) ** -24)(mpmath.mpf(h))
            inside = zip(found.reached(found.h), end[:2], strict=True)
            assert all(abs(mpmath.mpf(b.mid().str(30, radius=False)) - v) <= float(b.rad()) + 1e-20 for b, v in inside)
            v = found.derivative()
            assert abs(float(v[0, 0].mid()) - end[2]) <= float(v[0, 0].rad()) + 1e-20
            assert abs(float(v[1, 0].mid()) - end[3]) <= float(v[1, 0].rad()) + 1e-20


def test_derivatives_of_a_hamiltonian_flow_have_determinant_one() -> None:
    start = [arb(1), arb("0.2")]
    found, _ = step(Pendulum(), start, start, arb(0.4), Order(20, 1e-16), [1.0, 1.0, 1.0])
    assert found.derivative().det().contains(1)
    assert (unit(2) * column(start)).entries()[0] == 1


def test_an_enclosure_holds_its_ball_whatever_its_digits() -> None:
    ball = arb("2.718281828459045235360287471352662498", 1e-30)
    for digits in (6, 12, 30):
        found = Enclosure.of(ball, digits)
        assert abs(ball - arb(found.centre)) <= arb(found.radius) * (1 + arb(2) ** -60)
    assert Enclosure.of(arb(0, 1e-40), 20).centre == "0"
