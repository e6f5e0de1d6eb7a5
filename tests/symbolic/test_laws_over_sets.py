"""The check of a law over a product of sets sees a slip in it, however close H is to its minimum there."""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable
from dataclasses import replace

import mpmath as mp
import pytest
import sympy as sp

from satsym.report.artefacts import generated
from satsym.symbolic import Angle, Annulus, Ball, Box, DerivationError, FirstOrder, Free, Problem, Variable, derive
from satsym.symbolic.functions.minimisers import Clip
from satsym.symbolic.functions.roots import minimum_between
from satsym.symbolic.principle import effort, parts, product

STATES = (Variable("x", "x"), Variable("y", "y"))
CONTROLS = (Variable("u", "u"), Variable("v", "v"), Variable("w", "w"))
x, y, u, v, w = sp.symbols("x y u v w", real=True)
SMALL = 1 + sp.Rational(1, 10**14)


def problem(sets: dict[str, Box | Ball | Free | Annulus], cost: sp.Expr) -> Problem:
    rates = {x: y + 3 * u, y: v - 7 * w - x}
    model = FirstOrder(name="m", title="M", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
    return Problem(name="task", title="Task", model=model, running_cost=cost, control_sets=sets)


CASES = [
    ({"a": Box("u"), "b": Ball("v", "w")}, u**2 / 500 + v**2 + w**2),
    ({"a": Free("u", "v"), "b": Box("w")}, u**2 / 500 + v**2 + 40 * w**2),
    ({"a": Ball("u", "v"), "b": Free("w")}, u**2 + v**2 + w**2 / 3),
    ({"a": Annulus("u", "v"), "b": Box("w")}, u**2 + v**2 + w**2 / 3),
    ({"a": Ball("u", "v"), "b": Box("w")}, w**2 / 3),
]


@pytest.mark.parametrize("stated", [problem(*case) for case in CASES])
def test_a_slip_in_the_law_over_a_set_is_refused(stated: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    before = replace(found := derive(stated), steps=found.steps[: [s.name for s in found.steps].index("control_law")])
    law_of: Callable[..., list[sp.Expr]] = product.law_of

    def wrong(of: Problem, one: object) -> list[sp.Expr]:
        first, *others = law_of(of, one)
        return [Clip(SMALL * first.args[0], *first.args[1:]) if isinstance(first, Clip) else SMALL * first, *others]

    assert before.extended(product.control_law(before))
    monkeypatch.setattr(product, "law_of", wrong)
    with pytest.raises(DerivationError, match="control_law failed its check"):
        before.extended(product.control_law(before))


def test_what_is_least_at_an_end_is_that_end_to_the_last_digit() -> None:
    with mp.workdps(30):
        end = mp.mpf("1.3e-9")
        for slope, expected in ((5, -end), (-5, end)):
            assert minimum_between(lambda z, s=slope: (s + z**3, 3 * z**2), -end, end) == expected
        assert minimum_between(lambda z: (1 / z - 10, -1 / z**2 + 10), 0, 1) <= 1


def turned(drive: sp.Expr, across: sp.Expr) -> Problem:
    """A thrust of either sign and its angle, which two pairs of them make alike."""
    controls = (Variable("F", "F"), Variable("b", "b", kind="angle"))
    thrust, angle = sp.symbols("F b", real=True)
    rates = {x: y + drive * thrust * sp.cos(angle), y: across * thrust * sp.sin(angle) - x}
    model = FirstOrder(name="m", title="M", states=STATES, controls=controls, parameters=(), rates=rates)
    sets = {"throttle": Box("F"), "course": Angle("b")}
    return Problem(
        name="task", title="Task", model=model, running_cost=sp.Rational(103984, 7) * thrust**2, control_sets=sets
    )


@pytest.mark.slow
def test_rounding_does_not_choose_between_opposite_vectors_at_opposite_angles() -> None:
    _, kernels = generated(derive(turned(sp.Integer(1), sp.atan(y) / 6)), "task.py")
    rng = random.Random(3)
    places = [[tuple(rng.uniform(-1.5, 1.5) for _ in range(2)) for _ in range(2)] for _ in range(200)]
    forces = [kernels.control_law(0.0, *place, (), (-1.0, 1.0, 1.0))[0] for place in places]
    assert all(force >= 0.0 for force in forces) or all(force <= 0.0 for force in forces)


@pytest.mark.slow
def test_a_law_that_has_the_magnitude_of_a_costate_is_generated() -> None:
    stated = turned(sp.Integer(1), sp.Integer(0))
    (thrust, angle) = sp.symbols("F b", real=True)
    drive = thrust * (sp.cos(angle) + 14 * sp.sqrt(1 + 2 * x**2) * sp.sin(angle))
    rates = {x: y + drive, y: -x}
    model = replace(stated.model, rates=rates)
    text, kernels = generated(derive(replace(stated, model=model)), "task.py")
    law = kernels.control_law(0.0, (0.3, 0.1), (-0.7, 0.4), (), (-1.0, 1.0, 1.0))
    assert "fabs(lambda_x)" in text
    assert law[0] * (math.cos(law[1]) + 14 * math.sqrt(1.18) * math.sin(law[1])) > 0.0


@pytest.mark.parametrize("least", [0.0, 0.5])
@pytest.mark.parametrize("costates", [(0.9, -0.4), (0.1, 0.2)])
def test_the_minimised_hamiltonian_of_a_norm_is_the_least_of_all_controls(
    least: float, costates: tuple[float, float]
) -> None:
    thrust = Annulus("u", "v") if least else Ball("u", "v")
    derivation = derive(problem({"a": thrust, "b": Free("w")}, sp.sqrt(u**2 + v**2) + w**2 / 3))
    found = derivation.step("minimised_hamiltonian").equations[0].rhs
    (a, b), (at_x, at_y) = costates, (0.3, 0.7)
    values = {"x": at_x, "y": at_y, "lambda_x": a, "lambda_y": b, "u_min": least, "u_max": 2.0}
    vectors = [cmath.rect(size, 0.001 * k) for size in (least, 1.0, 2.0) for k in range(6284)]
    of_vector = min(abs(z) + 3.0 * a * z.real + b * z.imag for z in vectors)
    of_other = min(0.01 * k * (0.01 * k / 3.0 - 7.0 * b) for k in range(-1000, 1001))
    expected = a * at_y - b * at_x + of_vector + of_other
    assert float(found.xreplace({s: values[s.name] for s in found.free_symbols})) == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize(("cost", "smoothed"), [(v**2 + w**2, True), (u**2 + v**2 + w**2, False)])
def test_what_smooths_a_switching_control_has_the_unit_of_the_cost_over_its_square(
    cost: sp.Expr, smoothed: bool
) -> None:
    length, rate = {"[length]": sp.Integer(1)}, {"[length]": sp.Integer(3), "[time]": sp.Integer(-1)}
    known: dict[str, dict[str, sp.Expr] | None] = {"u": length, "v": {}, "w": {}}
    effort.declare_product(known, problem({"a": Box("u"), "b": Free("v", "w")}, cost), rate)
    expected = {"[length]": sp.Integer(1), "[time]": sp.Integer(-1)} if smoothed else None
    assert known[parts.SMOOTHING.symbol] == expected
