"""The units of shown results: those of the model, or none where its gravitational parameter is 1."""

from __future__ import annotations

from dataclasses import replace

from satsym import units
from satsym.instance.types import Instance
from satsym.spec import ProblemSpec, Variable

ROUNDING = 1e-12
"""Largest relative error of a gravitational parameter that is computed from other parameters."""
LENGTH, RATE = {"km": 1}, {"rad": 1, "s": -1}
"""Units of the radius and of the angular velocity of a reference orbit."""


def spec_of(instance: Instance) -> ProblemSpec:
    """Return the specification of an instance's model, without units where its gravitational parameter is 1.

    By convention the numbers of such an instance are multiples of those of a circular orbit, so that units would
    mislead. It is known by its gravitational parameter, or else by a length and an angular velocity that the model
    takes to be 1 by default; a body whose parameter is exactly 1 in the units of its model loses them as well.
    Files and JSON keep the units of the model.
    """
    model = instance.model
    if "inertial_state" in model.functions:
        mu = float(model.inertial_state(instance.t0, instance.initial, instance.parameters)[6])
        multiples = abs(mu - 1.0) <= ROUNDING
    else:
        ones = zip(model.spec.parameters, instance.parameters, strict=True)
        kept = [units.factors(v.unit) for v, value in ones if v.positive and v.default == value == 1.0]
        multiples = LENGTH in kept and RATE in kept
    return _without_units(model.spec) if multiples else model.spec


def _without_units(spec: ProblemSpec) -> ProblemSpec:
    def plain(variables: tuple[Variable, ...]) -> tuple[Variable, ...]:
        return tuple(replace(v, unit="1") for v in variables)

    return replace(
        spec,
        states=plain(spec.states),
        controls=plain(spec.controls),
        parameters=plain(spec.parameters),
        invariants=plain(spec.invariants),
        position=plain(spec.position),
        multipliers=plain(spec.multipliers),
        outputs=plain(spec.outputs),
        quantities=plain(spec.quantities),
        objective_unit="1" if spec.objective_unit else "",
    )
