"""Whether the claim of a certificate is local or global, and which theorem it names."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Check
from satsym.solvers import solve
from satsym.solvers.certificate.scope import CONVEX, NOTHING_COSTS, SOONEST, THEOREMS, with_scope
from satsym.status import Scope, Verdict
from satsym.symbolic import Box, FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

X, V, W = Variable("x", "x"), Variable("v", "v"), Variable("w", "w")
x, v, w = symbols_of((X, V, W))


def moved(folder: Path, rates: dict, ends: str) -> Instance:
    model = FirstOrder(name="moving", title="M", states=(X, V), controls=(W,), parameters=(), rates=rates)
    folder.mkdir(exist_ok=True)
    problem = Problem(name="soon", title="S", model=model, running_cost=1, control_sets={"push": Box("w")})
    return build(folder, problem, f'{ends}[time]\ntf = "free"\n[control]\nw = [-1.0, 1.0]\n')


def scope_of(case: Instance) -> tuple[Verdict, Scope, str]:
    certificate = solve(case).certificate
    assert certificate is not None
    return certificate.verdict, certificate.scope, certificate.because


def test_least_time_to_a_point_of_rest_is_global():
    assert scope_of(instance.load("double-integrator-time")) == (Verdict.CERTIFIED, Scope.GLOBAL, SOONEST)


@pytest.mark.slow
def test_least_time_to_a_point_that_cannot_be_held_is_local(tmp_path: Path):
    """From x = 1 at rest to x = 0 with v = 1: the motion passes the end, and nothing keeps it there."""
    verdict, scope, because = scope_of(
        moved(tmp_path, {x: v, v: w}, "[initial]\nx = 1.0\nv = 0.0\n[final]\nx = 0.0\nv = 1.0\n")
    )
    assert (verdict, scope) == (Verdict.CERTIFIED, Scope.LOCAL)
    assert because == THEOREMS["second variation with respect to the switching times"]


def test_an_end_that_only_a_bound_holds_is_no_reason(tmp_path: Path):
    """At x = 1 only w = 1 balances x' = w - x, so the end lies on the boundary of all that is ever reached."""
    case = moved(tmp_path, {x: v, v: w - x}, "[initial]\nx = 0.0\nv = 0.0\n[final]\nx = 1.0\nv = 0.0\n")
    inside = moved(tmp_path / "in", {x: v, v: w - x}, "[initial]\nx = 0.0\nv = 0.0\n[final]\nx = 0.9\nv = 0.0\n")
    assert scope_of(case)[1] is Scope.LOCAL
    assert scope_of(inside)[1] is Scope.GLOBAL


def test_a_motion_that_is_not_linear_is_local(tmp_path: Path):
    found = scope_of(moved(tmp_path, {x: v, v: w - x**3}, "[initial]\nx = 0.5\nv = 0.0\n[final]\nx = 0.0\nv = 0.0\n"))
    assert found[:2] == (Verdict.CERTIFIED, Scope.LOCAL)


def test_convex_problems_are_global_and_others_local():
    assert scope_of(instance.load("bryson-denham"))[1:] == (Scope.GLOBAL, CONVEX)
    assert scope_of(instance.load("soft-return"))[1:] == (Scope.LOCAL, THEOREMS["conjugate points: none"])


def test_a_start_that_is_free_is_not_covered_by_what_holds_of_a_given_one(tmp_path: Path):
    """The quickest of all starts at rest is the one at the end, whatever the extremal from another one says."""
    found, ends = (
        solve(instance.load("double-integrator-time")),
        '[initial]\nx = "free"\nv = 0.0\n[final]\nx = 1.0\nv = 0.0\n',
    )
    free = moved(tmp_path, {x: v, v: w}, ends).free
    assert found.certificate is not None
    assert free
    assert with_scope(found.certificate, found).scope is Scope.GLOBAL
    loose = replace(found, instance=replace(found.instance, free=free))
    assert with_scope(found.certificate, loose).scope is Scope.LOCAL


def test_where_nothing_costs_anything_no_control_can_cost_less(tmp_path: Path):
    model = FirstOrder(name="idle", title="I", states=(X,), controls=(W,), parameters=(), rates={x: w})
    problem = Problem(name="idle", title="I", model=model, running_cost=w**2)
    case = build(tmp_path, problem, "[initial]\nx = 1.0\n[time]\ntf = 2.0\n")
    assert scope_of(case)[1:] in ((Scope.GLOBAL, NOTHING_COSTS), (Scope.GLOBAL, CONVEX))


@pytest.mark.parametrize("name", ["soft-return", "double-integrator-time"])
def test_what_failed_names_the_condition(name: str):
    found = solve(instance.load(name))
    assert found.certificate is not None
    failed = replace(found.certificate, verdict=Verdict.FAILED)
    check = replace(failed.checks[0], value=1.0)
    told = with_scope(replace(failed, checks=(check, *failed.checks[1:])), found)
    assert (told.scope, told.because) == (Scope.LOCAL, check.name)


def test_turns_of_angles_are_not_covered():
    """Another turn may be quicker."""
    found = solve(instance.load("double-integrator-time"))
    assert found.certificate is not None
    case = found.instance
    turning = replace(case, solver=structs.replace(case.solver, free_angles=(case.model.spec.state_names[0],)))
    assert with_scope(found.certificate, replace(found, instance=turning)).scope is Scope.LOCAL


@pytest.mark.slow
def test_path_constraints_that_are_not_convex_are_not_covered():
    """What is kept from some states need not be convex."""
    constrained = solve(instance.load("return-above")).certificate
    assert constrained is not None
    assert constrained.scope is Scope.LOCAL


def test_beside_something_cheaper_no_minimum_is_claimed():
    """Such an extremal is none of the least cost of all, whatever theorem would apply to it."""
    found = solve(instance.load("double-integrator-time"))
    assert found.certificate is not None
    cheaper = Check("cheaper by: seeded starts", 1e-3, 1e-9)
    beaten = replace(found.certificate, verdict=Verdict.EXTREMAL_ONLY, checks=(*found.certificate.checks, cheaper))
    told = with_scope(beaten, found)
    assert (told.scope, told.because) == (Scope.LOCAL, cheaper.name)
