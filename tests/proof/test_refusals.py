"""Features that no theorem here covers are refused by their names before anything is solved, whatever else is there."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
import sympy

import satsym
from satsym.instance.unknowns import Place, Unknown
from satsym.proof.proving import prove
from satsym.proof.record import Outcome
from satsym.symbolic import Ball, Box

q, v, u, w, k = sympy.symbols("q v u w k", real=True)
START, END = {"q": 1.0, "v": 0.0}, {"q": 0.0, "v": 0.0}


def body(*parameters: Any) -> Any:
    return satsym.FirstOrder(
        name="refused_motion",
        title="A body",
        states=(satsym.Variable("q", "q"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"), satsym.Variable("w", "w")),
        parameters=parameters,
        rates={q: v, v: u + w},
    )


EFFORT = (u**2 + w**2) / 2
STATED: dict[str, tuple[dict[str, Any], dict[str, Any], str]] = {
    "waypoints": ({"interior": {"p": (q - 2,)}}, {"final": END, "tf": 1.0}, "waypoints"),
    "sets of two kinds": (
        {"control_sets": {"one": Box("u"), "other": Ball("w")}},
        {"final": END, "tf": 1.0, "control": {"u": [-9.0, 9.0], "other": {"max_norm": 9.0}}},
        "a product of several control sets",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("feature", STATED)
def test_a_feature_is_named(feature: str) -> None:
    stated, given, named = STATED[feature]
    problem = satsym.Problem(name="refused", title="Refused", model=body(), running_cost=EFFORT + 1, **stated)
    case = satsym.Instance.of(problem, initial=START, **given)
    proof = prove(case.case, lambda: pytest.fail("nothing need be solved"))
    assert proof.status is Outcome.BEYOND
    assert named in proof.reason


@pytest.mark.slow
def test_a_free_parameter_beside_a_wall_is_refused() -> None:
    problem = satsym.Problem(
        name="refused",
        title="Refused",
        model=body(satsym.Variable("k", "k", default=1.0)),
        running_cost=EFFORT + (k - 2) ** 2,
        path_constraints={"wall": q - 9},
    )
    case = satsym.Instance.of(problem, initial=START, final=END, tf=1.0).case
    case = replace(case, free=(Unknown(Place.PARAMETER, "k", 0, positive=False),))
    proof = prove(case, lambda: pytest.fail("nothing need be solved"))
    assert proof.status is Outcome.BEYOND
    assert "together with free parameters" in proof.reason
