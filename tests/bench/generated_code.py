"""The generated loops: as they are, on lists or arrays, and through the array wrappers that solvers call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from orbit import COSTATE, PARAMETERS, START, Case
from peers import Missing, Runner

from satsym.kernels import Kernels, load
from satsym.status import BadInput


def kernels(backend: str) -> Kernels:
    """The polar orbit, interpreted or compiled."""
    found = load("polar_orbit")
    try:
        return found if backend == "python" else found.compiled()
    except BadInput:
        raise Missing("numba is not installed") from None


def trajectory(case: Case, backend: str) -> Runner:
    """``forward`` as it was generated."""
    loop, given, x, _, _ = _prepared(case, backend)

    def run() -> object:
        return loop["forward"](*given)

    def final() -> np.ndarray:
        run()
        return np.array([row[-1] for row in x])

    return Runner(run, final)


def wrapped_trajectory(case: Case, backend: str) -> Runner:
    """``Kernels.forward``: arrays in, new arrays out."""
    model = kernels(backend)

    def run() -> Any:
        return model.forward(case.times, START, case.u, case.u_mid, PARAMETERS)

    return Runner(run, lambda: run()[0][:, -1])


def sweep(case: Case, backend: str) -> Runner:
    """``forward`` and ``backward`` as they were generated; its final "state" is the costate at the start."""
    loop, given, x, x_mid, (lam, lam_mid) = _prepared(case, backend)
    times, _, u, u_mid, p = given[:5]

    def run() -> None:
        loop["forward"](*given)
        loop["backward"](times, COSTATE, x, x_mid, u, u_mid, p, lam, lam_mid)

    def final() -> np.ndarray:
        run()
        return np.array([row[0] for row in lam])

    return Runner(run, final)


def wrapped_sweep(case: Case, backend: str) -> Runner:
    """The same through the array wrappers."""
    model = kernels(backend)

    def run() -> Any:
        x, x_mid, _ = model.forward(case.times, START, case.u, case.u_mid, PARAMETERS)
        return model.backward(case.times, COSTATE, x, x_mid, case.u, case.u_mid, PARAMETERS)

    return Runner(run, lambda: run()[0][:, 0])


def _prepared(case: Case, backend: str) -> tuple[Any, tuple[Any, ...], Any, Any, Any]:
    """Loops, arguments of ``forward``, and where states and costates go: lists for Python, arrays for numba."""
    kind: Callable[[Any], Any] = np.array if backend == "numba" else list
    give = np.asarray if backend == "numba" else np.ndarray.tolist

    def rows(length: int) -> tuple[Any, ...]:
        return tuple(kind([0.0] * length) for _ in range(4))

    at_nodes, at_midpoints = rows(case.steps + 1), rows(case.steps)
    given = (give(case.times), START, tuple(map(give, case.u)), tuple(map(give, case.u_mid)), PARAMETERS)
    costates = rows(case.steps + 1), rows(case.steps)
    return kernels(backend).functions, (*given, at_nodes, at_midpoints), at_nodes, at_midpoints, costates
