"""The worked example of CONTRIBUTING: a kind of model with a step of its own, all of it stated in this one place.

Unit masses in a potential: x'' = -V_x + u.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import pytest
import sympy as sp

from satsym.codegen import module
from satsym.kernels.loading import from_text
from satsym.report.latex.document import render
from satsym.report.texts import MissingText
from satsym.symbolic import (
    Derivation,
    DerivationError,
    Equation,
    Linearised,
    Model,
    Problem,
    Step,
    Variable,
    derive,
    symbols_of,
)
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import constants_of, gradient, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric, partial
from satsym.symbolic.dimension_algebra import Dimension, over, product
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.lookup.addresses import resolve
from satsym.symbolic.model import Line, MaybeStep, Paragraph, Requirement
from satsym.symbolic.motion import steps as motion

# The kind. Nothing outside this part knows of it.


@dataclass(frozen=True, kw_only=True)
class InPotential(Model):
    """Unit masses in a potential, each pushed by one control.

    Parameters
    ----------
    coordinates
        Each coordinate with the state that is its rate of change.
    potential
        V, a function of the coordinates and of time.
    """

    coordinates: Mapping[sp.Symbol, sp.Symbol]
    potential: sp.Expr

    def steps(self) -> tuple[MaybeStep, ...]:
        """Steps of its own, then what holds for any motion."""
        return (*self.motion_steps(), motion.reference, motion.linearisation)

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """The force and the first-order form."""
        return (force, first_order)

    def misfits(self) -> Iterator[str]:
        """What does not fit together."""
        if {*self.coordinates, *self.coordinates.values()} != set(symbols_of(self.states)):
            yield "the states must be the coordinates and their rates, no more, no less"
        if len(self.controls) != len(self.coordinates):
            yield "give one control for each coordinate"

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """The potential may not depend on the rates."""
        yield "the potential", [self.potential], constants_of(self) | set(self.coordinates)

    def names(self, problem: Problem | None) -> dict[str, str]:
        """The forces."""
        return {
            force_on(x).name: rf"F_{{{v.latex}}}" for x, v in zip(symbols_of(self.states), self.states, strict=True)
        }

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """A force per unit mass is an acceleration, a potential a velocity squared."""
        for x, rate in self.coordinates.items():
            require(f"{rate.name}, the rate of {x.name},", rate, known[n.rate_of(x).name])
            require("the potential", self.potential, product((known[rate.name], known[rate.name])))
            known[force_on(x).name] = over(known[rate.name], known[n.TIME.name])

    def statement(self) -> tuple[Paragraph, ...]:
        """What a report starts from."""
        return (Paragraph("in potential", lines=(Line("potential", "V", self.potential, address="V"),)),)

    def declared(self) -> dict[str, sp.Expr | sp.Matrix]:
        """The address ``model:declared.V``."""
        return {"V": self.potential}

    def sentences(self) -> Mapping[str, Mapping[str, Mapping[str, str]]]:
        """What reports say of its steps."""
        return {
            "en": {
                "statement": {"in potential": "Unit masses move in the potential"},
                "declared": {"potential": "the potential"},
                "titles": {"force": "Forces", "first_order": "Masses under force and control"},
                "rules": {"fall": "A potential pulls against its gradient, by <sources>.", "push": "By <sources>."},
                "claims": {"work of the controls": "The masses gain the work of the controls"},
            }
        }


def force_on(x: sp.Symbol) -> sp.Symbol:
    """The symbol for the force of the potential along a coordinate."""
    return sp.Symbol(f"force_{x.name}", real=True)


def force(so_far: Derivation) -> Step:
    """A derivation step: equations by one route, a check by another."""
    model = stated_as(InPotential, so_far)
    pulls = [-slope for slope in gradient(model.potential, model.coordinates)]
    equations = tuple(Equation(x.name, force_on(x), pull) for x, pull in zip(model.coordinates, pulls, strict=True))
    height, found = numeric([model.potential]), numeric(pulls)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return found(point), [-partial(height, point, x)[0] for x in model.coordinates]

    check = compare("numeric derivative", {*model.coordinates, *model.potential.free_symbols}, sides)
    return Step("force", "fall", equations, ("potential",), (check,))


def first_order(so_far: Derivation) -> Step:
    """Forces and controls move the masses; what they gain in energy is the work of the controls."""
    model = stated_as(InPotential, so_far)
    speeds, controls = list(model.coordinates.values()), symbols_of(model.controls)
    pushes = [pull + u for pull, u in zip(so_far.rhs("force"), controls, strict=True)]
    rates = {**model.coordinates, **dict(zip(speeds, pushes, strict=True))}
    equations = tuple(Equation(s.name, n.rate_of(s), rates[s]) for s in symbols_of(model.states))
    energy = model.potential + sum(speed**2 / 2 for speed in speeds)
    power = sum(u * speed for u, speed in zip(controls, speeds, strict=True)) + sp.diff(model.potential, n.TIME)
    proof = identity("work of the controls", [total_derivative(energy, rates) - power])
    return Step("first_order", "push", equations, ("force",), (proof,))


# A model of this kind: a mass between two springs that harden.

STATES = (Variable("x", "x", "m", "deflection"), Variable("v", "v", "m/s", "its rate"))
CONTROLS = (Variable("u", "u", "m/s**2", "push"),)
PARAMETERS = (
    Variable("k", "k", "1/s**2", "stiffness", 2.0, positive=True),
    Variable("h", "h", "1/m**2/s**2", "hardening", 0.5, positive=True),
)
(x, v), (u,), (k, h) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)
SPRING = InPotential(
    name="hardening_spring",
    title="A mass on a spring that hardens",
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    coordinates={x: v},
    potential=k * x**2 / 2 + h * x**4 / 4,
)


@pytest.fixture(scope="module")
def spring() -> Derivation:
    return derive(SPRING)


def test_its_steps_are_taken_and_those_of_every_motion(spring: Derivation) -> None:
    assert [step.name for step in spring.steps] == ["force", "first_order", "linearisation"]
    assert list(spring.rhs("first_order")) == [v, -k * x - h * x**3 + u]
    assert spring.equation("linearisation.A_v_x").rhs.equals(-k - 3 * h * x**2)


def test_its_step_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(globals(), "gradient", lambda *_: [k * x])
    with pytest.raises(DerivationError, match="hardening_spring:force failed its check 'numeric derivative'"):
        derive(SPRING)


def test_a_cost_brings_the_conditions_of_pontryagin() -> None:
    found = derive(Problem(name="calm", title="", model=SPRING, running_cost=u**2 / 2))
    assert found.equation("costate_equations.v").rhs == -sp.Symbol("lambda_x", real=True)


def test_it_can_be_linearised() -> None:
    states = (Variable("dx", "x_1", "m"), Variable("dv", "x_2", "m/s"))
    model = Linearised(
        name="soft_spring",
        title="",
        of=SPRING,
        states=states,
        controls=CONTROLS,
        parameters=PARAMETERS,
        about={x: sp.Integer(0), v: sp.Integer(0)},
        deviations=dict(zip(symbols_of(states), (x, v), strict=True)),
    )
    assert derive(model).equation("first_order.dv").rhs == -k * symbols_of(states)[0] + u


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"coordinates": {x: u}}, "the states must be the coordinates and their rates, no more, no less"),
        ({"controls": ()}, "give one control for each coordinate"),
        ({"potential": k * v**2}, "the potential cannot depend on v"),
        ({"potential": k * x}, "the potential has the dimension"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(change: dict[str, Any], complaint: str) -> None:
    with pytest.raises(DerivationError, match=complaint) as refused:
        derive(replace(SPRING, **change))
    assert "\n" not in str(refused.value)


def test_its_document_states_it_and_shows_its_step(spring: Derivation) -> None:
    document = render(spring)
    assert "Unit masses move in the potential" in document
    assert r"\label{hardening_spring:declared.V}" in document
    assert "A potential pulls against its gradient, by the potential" in document
    assert "F_{x}" in document
    assert "Masses under force and control" in document, "its own texts come before those of all reports"


def test_a_language_in_which_it_says_nothing_is_refused(spring: Derivation) -> None:
    with pytest.raises(MissingText, match='no text for "in potential"'):
        render(spring, "id")


def test_what_it_declares_has_an_address(spring: Derivation) -> None:
    assert resolve(spring, "hardening_spring:declared.V") == SPRING.potential


def test_its_kernels_compute_the_rates(spring: Derivation) -> None:
    kernels = from_text(module.render(spring, "a test"), "hardening_spring")
    assert list(kernels.dynamics(0.0, (2.0, 3.0), (1.0,), (2.0, 0.5))) == pytest.approx([3.0, -7.0])
