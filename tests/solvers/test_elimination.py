"""The linear systems of collocation beside dense ones, and LAPACK beside SciPy's own way to it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest
from scipy.linalg.lapack import dgbtrf

from satsym import lapack
from satsym.solvers.collocation.elimination import AT_ONCE, Blocks, Nodes


@pytest.fixture
def anew() -> Iterator[None]:
    """What was loaded is forgotten before and after."""
    lapack._wrapper.cache_clear()
    yield
    lapack._wrapper.cache_clear()


@pytest.mark.parametrize(("half", "count"), [(1, 1), (1, 7), (4, 3), (4, 40)])
def test_nodes_solve_the_whole_system(half: int, count: int) -> None:
    rng, n = np.random.default_rng(count), 2 * half
    transition = np.eye(n) + 0.1 * rng.standard_normal((count, n, n))
    final = rng.standard_normal((half, n))
    whole = np.zeros((n * (count + 1), n * (count + 1)))
    whole[:half, :half] = np.eye(half)
    for k, one in enumerate(transition):
        rows = slice(half + n * k, half + n * (k + 1))
        whole[rows, n * k : n * (k + 1)], whole[rows, n * (k + 1) : n * (k + 2)] = one, -np.eye(n)
    whole[-half:, -n:] = final
    right = rng.standard_normal((len(whole), 2))
    nodes = Nodes(transition, final)
    for _ in range(2):  # factors are kept
        assert whole @ nodes.solve(right) == pytest.approx(right, abs=1e-9)


def test_where_the_end_says_nothing_of_the_nodes_they_are_singular() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        Nodes(np.tile(np.eye(4), (3, 1, 1)), np.zeros((2, 4)))


def test_blocks_solve_alike_at_once_and_with_factors() -> None:
    rng = np.random.default_rng(1)
    matrices, right = rng.standard_normal((5, 6, 6)), rng.standard_normal((5, 2, 6))
    blocks = Blocks(matrices.copy())
    for _ in range(AT_ONCE + 2):
        assert np.einsum("kij,kcj->kci", matrices, blocks.solve(right)) == pytest.approx(right, abs=1e-11)


def test_lapack_alone_is_that_of_scipy_and_loads_nothing_else() -> None:
    code = (
        "import sys, numpy; before = set(sys.modules)\n"
        "from satsym.lapack import lapack; assert callable(lapack().dgbtrs)\n"
        "assert not any(name.startswith('scipy') for name in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    band = np.random.default_rng(2).standard_normal((4, 6))
    for ours, theirs in zip(lapack.lapack().dgbtrf(band, 1, 1), dgbtrf(band, 1, 1), strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.usefixtures("anew")
@pytest.mark.parametrize("name", ["_nowhere", "_flapack"])
def test_elsewhere_it_is_had_from_scipy(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Where the compiled module has another name, and where it cannot be loaded by itself."""

    def refused(_: object) -> None:
        raise ImportError

    monkeypatch.setitem(lapack.WRAPPERS, "lapack", name)
    monkeypatch.setattr(lapack, "module_from_spec", refused)
    assert lapack.lapack().dgbtrf is dgbtrf
