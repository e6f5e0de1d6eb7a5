"""The worked example of CONTRIBUTING: a step is a function in a list, with its sentences."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from typing import Any

import pytest
import sympy as sp

from satsym.report.latex import document
from satsym.report.texts import MissingText, load
from satsym.symbolic import (
    Derivation,
    DerivationError,
    Equation,
    FirstOrder,
    Step,
    Variable,
    derive,
    notation,
    pipeline,
    symbols_of,
)
from satsym.symbolic.algebra import tidy
from satsym.symbolic.checks import Point, compare, numeric, partial
from satsym.symbolic.lookup.addresses import resolve
from tests.support.contributing import example

StepFunction = Callable[[Derivation], Step | None]
NAMES: dict[str, Any] = {each.__name__: each for each in (Derivation, Equation, Step, compare, numeric, partial)}
NAMES |= {"Any": Any, "Point": Point, "sp": sp, "symbols_of": symbols_of, "tidy": tidy}


@pytest.fixture
def divergence(monkeypatch: pytest.MonkeyPatch) -> StepFunction:
    """The step as CONTRIBUTING prints it, in the list of those that follow from any motion."""
    scope = dict(NAMES)
    exec(example("A step of a derivation", "python"), scope)  # noqa: S102
    step: StepFunction = scope["divergence"]
    monkeypatch.setattr(pipeline, "OUTPUTS", (*pipeline.OUTPUTS, step))
    monkeypatch.setitem(notation.FIXED, sp.Symbol("divergence", real=True), r"\nabla \cdot f")
    return step


STATES = (Variable("x", "x", "m"), Variable("v", "v", "m/s"))
(x, v) = symbols_of(STATES)
DAMPED = FirstOrder(
    name="damped",
    title="A body that a fluid brakes",
    states=STATES,
    controls=(),
    parameters=(Variable("k", "k", "1/m", default=1.0, positive=True),),
    rates={x: v, v: -sp.Symbol("k", positive=True) * v**2},
)


def test_it_follows_for_every_model_and_has_an_address(divergence: StepFunction) -> None:
    trace = resolve(derive(DAMPED), "damped:divergence.trace").rhs
    assert trace == -2 * sp.Symbol("k", positive=True) * v


def test_its_check_can_fail(divergence: StepFunction) -> None:
    divergence.__globals__["tidy"] = lambda trace: 2 * trace
    with pytest.raises(DerivationError, match="damped:divergence failed its check 'numeric derivative'"):
        derive(DAMPED)


def test_without_a_check_of_its_own_it_is_refused(divergence: StepFunction) -> None:
    divergence.__globals__["Step"] = lambda *given: Step(*given[:-1], ())
    with pytest.raises(DerivationError, match="damped:divergence has no machine check"):
        derive(DAMPED)


def test_its_sentences_are_asked_for_and_typeset(divergence: StepFunction, monkeypatch: pytest.MonkeyPatch) -> None:
    found = derive(DAMPED)
    with pytest.raises(MissingText, match=r'en\.toml: there is no text for "divergence" in \[titles\]'):
        document.render(found)
    own = tomllib.loads(example("A step of a derivation", "toml"))
    monkeypatch.setattr(document, "load", lambda language: load(language).with_own(own))
    typeset = document.render(found)
    assert "Growth of volumes" in typeset
    assert r"\nabla \cdot f" in typeset
