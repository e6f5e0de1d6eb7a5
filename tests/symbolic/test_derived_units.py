"""Units of costs and of what is conserved are composed of the names that a model uses, or are not said."""

from __future__ import annotations

import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from satsym import kernels, units
from satsym.codegen.module import unit_of
from satsym.symbolic.dimensions import of_unit

POWERS = st.integers(-4, 4)


@given(POWERS, POWERS, POWERS)
def test_a_derived_unit_has_the_dimension_that_was_asked_for_and_uses_only_the_names_of_the_model(
    force: int, length: int, time: int
) -> None:
    wanted = {"[mass]": force, "[length]": force + length, "[time]": time - 2 * force}
    found = unit_of({base: sp.Integer(n) for base, n in wanted.items() if n}, ["N", "m", "s", "kg"])
    assert of_unit(found) == {base: n for base, n in wanted.items() if n}
    assert set(units.factors(found)) <= {"N", "m", "s", "kg"}


def test_names_of_several_sizes_give_no_unit() -> None:
    area = {"[length]": sp.Integer(2)}
    assert unit_of(area, ["km", "s"]) == "km**2"
    assert unit_of(area, ["km", "m", "s"]) == ""
    assert unit_of(area, ["s"]) == ""
    assert unit_of(None, ["s"]) == ""
    assert unit_of({}, ["s"]) == "1"


def test_an_expression_is_read_as_the_names_that_it_was_written_from() -> None:
    for factors in ({"km": 2, "s": -3, "rad": -1}, {"s": -1}, {}, {"N": 1, "m": 1}):
        assert units.factors(units.expression(factors)) == factors


def test_shipped_models_say_in_what_their_costs_are_and_what_they_conserve() -> None:
    costs = {"polar_orbit": "km**2/s**3", "pitch_minimum_time": "s", "pitch_minimum_energy": "W*s", "beam": "1"}
    assert {name: kernels.load(name).spec.objective_unit for name in costs} == costs
    energy, momentum, *_ = kernels.load("two_body").spec.invariants
    assert (energy.unit, momentum.unit) == ("km**2/s**2", "km**2/s")
