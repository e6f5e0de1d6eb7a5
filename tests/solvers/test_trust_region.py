"""Steps within a trust region are the least of their quadratic model, wherever that lies."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.solvers.unknowns.solving import _step, _updated

MODELS = {
    "inside": ([[2.0, 0.3], [0.3, 0.5]], [0.2, -0.1]),
    "beyond the radius": ([[2.0, 0.3], [0.3, 0.5]], [4.0, -3.0]),
    "a saddle": ([[1.0, 0.0], [0.0, -2.0]], [0.5, 0.1]),
    "falling both ways": ([[-3.0, 0.4], [0.4, -1.0]], [0.1, 0.7]),
}


@pytest.mark.parametrize("name", MODELS)
def test_no_step_in_the_region_makes_the_model_smaller(name: str) -> None:
    form, slopes = map(np.array, MODELS[name])
    radius = 1.0
    angle, length = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 721), np.linspace(0.0, radius, 101))
    tried = length * np.array([np.cos(angle), np.sin(angle)])

    def model(step: np.ndarray) -> np.ndarray:
        return np.einsum("i,i...->...", slopes, step) + np.einsum("i...,ij,j...->...", step, form, step) / 2.0

    step = _step(form, slopes, radius)
    assert np.linalg.norm(step) <= radius * (1.0 + 1e-12)
    assert model(step) <= model(tried).min() + 1e-12


def test_the_second_derivatives_of_a_quadratic_are_learnt_from_as_many_steps_as_it_has_axes() -> None:
    form, known = np.array([[2.0, 0.3, 0.0], [0.3, -0.5, 1.0], [0.0, 1.0, 4.0]]), np.eye(3)
    for step in np.random.default_rng(0).normal(size=(3, 3)):
        known = _updated(known, step, form @ step)
    assert known == pytest.approx(form, abs=1e-9)
