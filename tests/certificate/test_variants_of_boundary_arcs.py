"""Competitors near the structure of an answer: all are solved, and what is no extremal is none."""

from __future__ import annotations

import time

import pytest

import satsym
from satsym import instance
from satsym.solution import Kind
from satsym.solvers import solve
from satsym.solvers.certificate.constrained.variants import contacts, near
from satsym.solvers.constrained.structure import ordered


@pytest.mark.parametrize(("wall", "count"), [(1 / 9, 3), (0.2, 2)])
def test_a_convex_problem_has_no_other_extremal(wall: float, count: int):
    """Without the wall the effort is 2, and a touch in place of an arc violates it: neither is admissible."""
    ends = {"initial": {"x": 0.0, "v": 1.0}, "final": {"x": 0.0, "v": -1.0}, "tf": 1.0, "parameters": {"l": wall}}
    found = satsym.solve(satsym.Instance.of("bryson_denham", **ends)).found
    assert near(found, time.thread_time() + 60.0) == (count, [], False)


def test_variants_are_not_tried_when_time_is_up():
    found = solve(instance.load("bryson-denham"))
    assert near(found, 0.0) == (0, [], True)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["bryson-denham", "obstacle", "return-above"])
def test_contacts_are_those_that_the_answer_states(name: str):
    found = solve(instance.load(name))
    structure = ordered(contacts(found)).name(found.instance)
    assert found.message.removeprefix("structure ").startswith(structure)


@pytest.mark.slow
def test_structures_near_the_answer_are_among_the_competitors():
    found = solve(instance.load("return-above"))
    assert found.certificate is not None
    (compared,) = (one for one in found.certificate.competitors if one.kind is Kind.ARCS)
    assert compared.tried > 4
    assert Kind.ARCS not in found.certificate.not_checked
