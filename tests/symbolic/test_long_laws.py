"""Laws that are long are named, so that what depends on them is not multiplied by their length."""

from __future__ import annotations

import pytest
import sympy as sp

from satsym.codegen.functions import chain_of
from satsym.codegen.naming import all_functions
from satsym.symbolic import Ball, FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.pipeline import derive


def transfer() -> Problem:
    """Minimum time with bounded thrust, in modified equinoctial elements (Walker, Ireland and Owens, 1985)."""
    elements = tuple(Variable(s, s, "1", positive=s == "p") for s in ("p", "f", "g", "h", "k", "longitude"))
    thrust = tuple(Variable(s, s, "1") for s in ("radial", "transverse", "normal"))
    p, f, g, h, k, longitude = symbols_of(elements)
    radial, transverse, normal = symbols_of(thrust)
    c, s, root = sp.cos(longitude), sp.sin(longitude), sp.sqrt(p)
    w, tilt, square = 1 + f * c + g * s, h * s - k * c, 1 + h**2 + k**2
    rates = {
        p: 2 * p * root / w * transverse,
        f: root * (s * radial + ((w + 1) * c + f) / w * transverse - tilt * g / w * normal),
        g: root * (-c * radial + ((w + 1) * s + g) / w * transverse + tilt * f / w * normal),
        h: root * square * c / (2 * w) * normal,
        k: root * square * s / (2 * w) * normal,
        longitude: w**2 / (p * root) + root * tilt / w * normal,
    }
    model = FirstOrder(name="elements", title="Elements", states=elements, controls=thrust, parameters=(), rates=rates)
    sets = {"thrust": Ball("radial", "transverse", "normal")}
    return Problem(name="transfer", title="Transfer", model=model, running_cost=1, control_sets=sets)


@pytest.mark.slow
def test_the_jacobian_of_thrust_on_equinoctial_elements_stays_short():
    derived = derive(transfer())
    jacobian = next(f for f in all_functions(derived) if f.name == "canonical_jacobian")
    parts = sum(sp.count_ops(value) for _, value in chain_of(derived))
    assert jacobian.value.has(*(s for s, _ in chain_of(derived)))
    assert sp.count_ops(jacobian.value) + parts < 100_000  # a million where each law is written out in it
