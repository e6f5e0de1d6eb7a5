"""The units of shown results: those of the model, or none where its gravitational parameter is 1."""

from __future__ import annotations

from dataclasses import replace

from satsym.instance import Instance
from satsym.spec import ProblemSpec, Variable

ROUNDING = 1e-12
"""Largest relative error of a gravitational parameter that is computed from other parameters."""


def spec_of(instance: Instance) -> ProblemSpec:
    """Return the specification of an instance's model, without units where its gravitational parameter is 1.

    By convention the numbers of such an instance are multiples of those of a circular orbit, so that units would
    mislead; a body whose parameter is exactly 1 in the units of its model loses them as well. Files and JSON keep the
    units of the model.
    """
    model = instance.model
    if "inertial_state" not in model.functions:
        return model.spec
    mu = float(model.inertial_state(instance.t0, instance.initial, instance.parameters)[6])
    return _without_units(model.spec) if abs(mu - 1.0) <= ROUNDING else model.spec


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
