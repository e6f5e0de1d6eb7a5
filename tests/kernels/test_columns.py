"""Machine code that was made for columns is kept for the next process, and stands for generated bodies in line."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from satsym.kernels import load
from satsym.kernels.batch import compiling
from satsym.kernels.batch.canonical import CLASSICAL, Tableau
from satsym.kernels.batch.workspace import inlined
from satsym.kernels.core import Kernels
from satsym.solvers.shooting.runge_kutta import tableau

SECOND = """
import time, numpy as np
from satsym.kernels import load
from satsym.kernels.blocks import block_step
kernels = load("polar_orbit").compiled()
began = time.process_time()
block_step(kernels)(0.0, 0.1, 3, np.ones((4, 9)), np.ones((2, 9)), np.ones((8, 9)))
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
    text = compiling.module_text(load("polar_orbit"))
    loads = {name: (lambda k, name=name: f"{name}_{k}") for name in ("x", "u", "p")} | {"t": lambda _: "t"}
    written = inlined(text, "dynamics", loads, "a_")
    assert len(written.results) == 4
    assert "dynamics(" not in "\n".join([*written.lines, *written.results])
    assert any(line.startswith("a_") for line in written.lines)


@pytest.mark.parametrize("method", [CLASSICAL, tableau()], ids=["classical", "of order eight"])
def test_methods_meet_the_conditions_of_order_four(method: Tableau) -> None:
    a, b, c = map(np.array, method)
    np.testing.assert_allclose(a.sum(axis=1), c, atol=1e-14)
    sums = (b, b * c, b * c**2, b @ a * c, b * c**3, b * c * (a @ c), b @ a * c**2, b @ a @ a * c)
    exact = (1.0, 1 / 2, 1 / 3, 1 / 6, 1 / 4, 1 / 8, 1 / 12, 1 / 24)
    np.testing.assert_allclose([one.sum() for one in sums], exact, atol=1e-14)
