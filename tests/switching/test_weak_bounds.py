"""Least times of weak controls that have to swing, against the front of all extremals that end where they are to.

A buckled beam is snapped through: x'' = x - x^3 - x'/20 + u from one rest to the other. Backwards from the end an
extremal is known by the direction of its costates there, so that all of them are one curve that moves on; the least
time is when it first sweeps over the start.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sympy import Integer

from satsym import solvers
from satsym.arrays import Array
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = (Variable("x", "x"), Variable("v", "v"))
x, v = symbols_of(STATES)
(u,) = symbols_of((Variable("u", "u"),))
BEAM = Problem(
    name="beam_snapped",
    title="Quickest snap",
    model=FirstOrder(
        name="buckled_beam",
        title="A buckled beam",
        states=STATES,
        controls=(Variable("u", "u"),),
        parameters=(),
        rates={x: v, v: x - x**3 - v / 20 + u},
    ),
    running_cost=Integer(1),
    control_set="box",
)


def rates(y: Array, bound: float) -> Array:
    """Of states and costates, backwards in time."""
    position, velocity, p, q = y
    force = -bound * np.sign(q)
    slopes = velocity, position - position**3 - velocity / 20.0 + force, -(1.0 - 3.0 * position**2) * q, q / 20.0 - p
    return -np.array(slopes)


def first_swept(bound: float, width: float, directions: int = 4000, longest: float = 40.0) -> float:
    """When the front first passes the start (-1, 0), up to one step of that width before."""
    angle = np.linspace(0.0, 2.0 * np.pi, directions, endpoint=False)
    y = np.array([np.ones(directions), np.zeros(directions), np.cos(angle), np.sin(angle)])
    for step in range(1, int(longest / width)):
        f1 = rates(y, bound)
        f2 = rates(y + width / 2.0 * f1, bound)
        f3 = rates(y + width / 2.0 * f2, bound)
        after = y + width / 6.0 * (f1 + 2.0 * (f2 + f3) + rates(y + width * f3, bound))
        here, beside, there, onward = y[:2], np.roll(y, -1, 1)[:2], after[:2], np.roll(after, -1, 1)[:2]
        near = np.abs(here - beside).max(axis=0) < 0.2
        if (near & (_inside(here, beside, onward) | _inside(here, onward, there))).any():
            return step * width
        y = after
    return float("inf")


def _inside(a: Array, b: Array, c: Array) -> Array:
    """Whether the start lies in these triangles."""

    def side(m: Array, n: Array) -> Array:
        return np.asarray(np.sign((n[0] - m[0]) * (0.0 - m[1]) - (n[1] - m[1]) * (-1.0 - m[0])))

    return np.abs(side(a, b) + side(b, c) + side(c, a)) == 3.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bound", "structure"),
    [
        (0.25, "-+-+"),
        (0.2, "+-+-+-"),
        pytest.param(0.15, "-+-+-+-", marks=pytest.mark.study),
    ],
)
def test_a_weak_force_snaps_a_beam_through_as_soon_as_any_does(tmp_path: Path, bound: float, structure: str) -> None:
    numbers = f"x = -1.0\nv = 0.0\n[final]\nx = 1.0\nv = 0.0\n[time]\ntf = 'free'\n[control]\nu = [-{bound}, {bound}]\n"
    found = solvers.solve(build(tmp_path, BEAM, f"[initial]\n{numbers}"))
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert f"structure {structure}," in found.message
    width = 0.004
    assert first_swept(bound, width) == pytest.approx(found.objective, abs=2.0 * width)
