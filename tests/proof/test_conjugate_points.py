"""Extremals behind a conjugate or a focal point are not proved, those before it are, with their closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import mpmath
import pytest

from satsym.proof.proving import prove
from satsym.proof.record import Enclosure, Outcome
from tests.proof.closed_forms import between, extremal


def holds(found: Enclosure, exact: mpmath.mpf) -> bool:
    return abs(mpmath.mpf(found.centre) - exact) <= mpmath.mpf(found.radius)


@pytest.mark.parametrize("tf", [1.0, 2.5, 3.0, 3.125])
def test_with_given_ends_all_is_proved_before_the_conjugate_time_pi(tf: float) -> None:
    case, found = between(0.5, tf)
    proof = prove(case, lambda: found)
    assert (proof.status, proof.reason) == (Outcome.PROVED, "")
    with mpmath.workdps(40):
        t = mpmath.mpf(tf)
        speed = (mpmath.mpf("0.5") - mpmath.cos(t)) / mpmath.sin(t)
        assert holds(proof.costate_initial["q"], -speed)
        last = -mpmath.sin(t) + speed * mpmath.cos(t)
        assert proof.objective is not None
        assert holds(proof.objective, (last / 2 - speed) / 2)  # the integral of (q'^2 - q^2)/2 is [q q']/2
        assert float(proof.objective.radius) < 1e-19 * max(1.0, abs(float(proof.objective.centre)))


@pytest.mark.parametrize("tf", [3.1875, 4.0, 6.0, 7.0])
def test_with_given_ends_nothing_is_proved_behind_it(tf: float) -> None:
    case, found = between(0.5, tf)
    proof = prove(case, lambda: found)
    assert proof.status is Outcome.NOT_PROVED
    assert "conjugate" in proof.reason
    assert proof.theorem is None
    assert proof.costate_initial  # the extremal exists nevertheless


def test_with_given_ends_nothing_is_proved_a_billionth_behind_it() -> None:
    case, found = between(0.5, math.pi + 1e-9)
    assert prove(case, lambda: found).status is Outcome.NOT_PROVED


@pytest.mark.parametrize(("tf", "wanted"), [(1.0, Outcome.PROVED), (1.5, Outcome.PROVED), (1.75, Outcome.NOT_PROVED)])
def test_with_a_free_end_the_focal_time_is_half_of_it(tf: float, wanted: Outcome) -> None:
    case, found = between(None, tf)
    proof = prove(case, lambda: found)
    assert proof.status is wanted
    assert ("focal" in proof.reason) is (wanted is Outcome.NOT_PROVED)


def test_costates_that_lead_elsewhere_are_not_proved() -> None:
    case, _ = between(0.5, 2.0)
    proof = prove(case, lambda: extremal(case, 2.0, 3.0))
    assert proof.status is Outcome.NOT_PROVED
    assert "not an extremal" in proof.reason


def test_numbers_of_python_are_the_binary_fractions_that_they_are() -> None:
    case, found = between(0.1, 1.0)
    proof = prove(case, lambda: found)
    assert "0x1.999999999999ap-4" in proof.numbers["final.q"]
    with mpmath.workdps(40):
        exact = Fraction(0.1)
        end = mpmath.mpf(exact.numerator) / exact.denominator
        assert holds(proof.costate_initial["q"], -(end - mpmath.cos(1)) / mpmath.sin(1))
        assert not holds(proof.costate_initial["q"], -(mpmath.mpf("0.1") - mpmath.cos(1)) / mpmath.sin(1))


def test_digits_are_those_asked_for_and_more_of_them_agree() -> None:
    case, found = between(0.5, 2.0)
    few, many = (prove(case, lambda: found, digits) for digits in (8, 40))
    assert few.status is many.status is Outcome.PROVED
    a, b = (mpmath.mpf(one.costate_initial["q"].centre) for one in (few, many))
    assert abs(a - b) <= mpmath.mpf(few.costate_initial["q"].radius) + mpmath.mpf(many.costate_initial["q"].radius)
    assert float(many.costate_initial["q"].radius) < 1e-38


def test_an_answer_without_costates_is_not_proved() -> None:
    case, found = between(0.5, 2.0)
    proof = prove(case, lambda: replace(found, lam=found.lam * math.nan))
    assert proof.status is Outcome.NOT_PROVED
    assert "no costates" in proof.reason
