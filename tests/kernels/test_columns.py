"""Functions of many columns say what those of one point say, compiled or not, and machine code is kept."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym.kernels import load
from satsym.kernels.batch import compiling
from satsym.kernels.batch.pointwise import columns, text
from satsym.kernels.contract import GROUPS, pointwise, sizes
from satsym.kernels.core import Kernels

MODELS = ["polar_orbit", "polar_orbit_ball", "explicit_time", "pitch_minimum_energy", "return_above", "beam"]
COUNT = 21
"""Two blocks of columns and some."""


def drawn(kernels: Kernels, name: str) -> dict[str, np.ndarray]:
    """Arguments of a function, with a column each; some laws are undefined at some."""
    counts, rng, found = sizes(kernels.spec), np.random.default_rng(4), {}
    for each in pointwise(kernels.spec)[name].arguments:
        rows = int(np.prod([counts[letter] for letter in GROUPS.get(each, "")]))
        values = rng.uniform(0.3, 1.7, (rows, COUNT))
        if each == "bounds":
            values = np.where(np.arange(rows)[:, None] < rows // 2, -1.0, 1.0) * values
        found[each] = values[0] if each == "t" else values
    return found


def one_by_one(kernels: Kernels, name: str, given: dict[str, np.ndarray]) -> np.ndarray:
    def at(k: int) -> Any:
        try:
            row = [float(v[k]) if each == "t" else tuple(v[:, k].tolist()) for each, v in given.items()]
            return np.asarray(kernels.functions[name](*row), dtype=float).reshape(-1)
        except (ArithmeticError, ValueError, TypeError):
            return None

    rows = [at(k) for k in range(COUNT)]
    size = next(len(row) for row in rows if row is not None)
    return np.array([np.full(size, np.nan) if row is None else row for row in rows]).T


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("model", MODELS)
def test_columns_are_what_single_points_are(model: str, compiled: bool) -> None:
    kernels = load(model)
    if compiled:
        pytest.importorskip("numba")
    stated = ("dynamics", "canonical", "canonical_jacobian", "running_cost", "control_law")
    names = [name for name in stated if name in kernels.functions]
    for name in names[:: 2 if compiled else 1]:
        given = drawn(kernels, name)
        expected = one_by_one(kernels, name, given)
        found = columns(kernels, name, compiled)(*given.values()).reshape(expected.shape)
        there = np.isfinite(expected)
        scale = np.maximum(np.abs(expected[there]), 1.0)
        assert (np.abs(found[there] - expected[there]) <= 1e-12 * scale).all(), name


def test_numbers_stand_for_all_columns_and_results_go_where_they_are_wanted() -> None:
    kernels = load("polar_orbit")
    x, u = np.ones((4, COUNT)), np.zeros((2, COUNT))
    p = tuple(variable.default or 0.0 for variable in kernels.spec.parameters)
    out = np.empty((4, COUNT))
    found = columns(kernels, "dynamics", compiled=False)(0.0, x, u, p, out=out)
    assert found is out
    assert np.array_equal(found, np.asarray(kernels.dynamics_batch(0.0, x, u, p)))


def test_a_compiled_function_notices_what_is_not_finite() -> None:
    pytest.importorskip("numba")
    kernels = load("polar_orbit")
    x = np.ones((4, COUNT))
    x[0, 5], x[1, 7] = 0.0, np.nan
    p = tuple(variable.default or 1.0 for variable in kernels.spec.parameters)
    found = columns(kernels, "dynamics", compiled=True)(0.0, x, np.ones((2, COUNT)), p)
    assert [k for k in range(COUNT) if not np.isfinite(found[:, k]).all()] == [5, 7]


SECOND = """
import time, numpy as np
from satsym.kernels import load
from satsym.kernels.batch.pointwise import columns
kernels, began = load("polar_orbit"), time.process_time()
many = columns(kernels, "canonical_jacobian", compiled=True)
many(0.0, np.ones((4, 9)), np.ones((4, 9)), np.ones((8, 9)), np.ones((4, 9)))
print(time.process_time() - began)
"""


@pytest.mark.slow
def test_machine_code_is_kept_for_the_next_process(tmp_path: Path) -> None:
    pytest.importorskip("numba")

    def seconds() -> float:
        said = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
        done = subprocess.run([sys.executable, "-c", SECOND], env=said, capture_output=True, text=True, check=True)
        return float(done.stdout)

    first, second = seconds(), seconds()
    kept = list((tmp_path / "satsym/kernels").rglob("*.nbc"))
    assert kept
    assert second < first


def test_a_model_made_by_hand_is_not_compiled() -> None:
    orbit = load("polar_orbit")
    with pytest.raises(Exception, match="nothing to compile"):
        compiling.module_text(Kernels(orbit.spec, orbit.functions))


def test_bodies_stand_in_line_under_names_of_their_own() -> None:
    written = text(load("polar_orbit"), "dynamics")
    assert "def many(t, x, u, p, out):" in written
    assert "dynamics(" not in written
