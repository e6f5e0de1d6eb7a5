"""Derivations of the shipped linear models."""

from __future__ import annotations

from pathlib import Path

from satsym.symbolic import Derivation, Model, Problem, loader
from tests.support import derived as shared

FOLDER = Path(__file__).resolve().parents[2] / "derivations"


def stated(file: str, name: str) -> Problem | Model:
    """What a shipped derivation file states under a name."""
    return next(p for p in loader.load(FOLDER / f"{file}.py") if p.name == name)


def derived(file: str, name: str) -> Derivation:
    """Everything derived from it."""
    return shared.derived(stated(file, name))


def satellite() -> Derivation:
    """Deviations of a satellite from a circular orbit."""
    return derived("clohessy_wiltshire", "clohessy_wiltshire")


def small(name: str) -> Derivation:
    """A small system."""
    return derived("small_systems", name)
