"""Subjects 1 and 2: a trajectory, and an iteration of the sweep, per step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from compiled_c import handwritten
from generated_code import sweep, trajectory, wrapped_sweep, wrapped_trajectory
from orbit import Case, case
from peers import Missing, Runner, casadi, on_arrays, on_floats, on_floats_states_only, solve_ivp
from rows import Goal, Row, Table, missing
from timing import Samples, interleaved

SAME = 1e-12
"""How far apart final states may be."""

PYTHON, NUMBA = "generated, plain Python", "generated, numba"
LAMBDIFY, NUMPY = "lambdify(math), RK4 on floats", "lambdify(numpy), RK4 on arrays"
C, C_NATIVE = "C by hand, -O3", "C by hand, -O3 -march=native"

TRAJECTORIES: Mapping[str, Callable[[Case], Runner]] = {
    PYTHON: partial(trajectory, backend="python"),
    "  through Kernels.forward": partial(wrapped_trajectory, backend="python"),
    LAMBDIFY: on_floats,
    "  states only": on_floats_states_only,
    NUMPY: on_arrays,
    NUMBA: partial(trajectory, backend="numba"),
    "  numba through Kernels.forward": partial(wrapped_trajectory, backend="numba"),
    C: partial(handwritten, flags=("-O3",)),
    C_NATIVE: partial(handwritten, flags=("-O3", "-march=native")),
    "CasADi, mapaccum": casadi,
}
ADAPTIVE: Mapping[str, Callable[[Case], Runner]] = {
    "SciPy solve_ivp, RK45": partial(solve_ivp, method="RK45"),
    "SciPy solve_ivp, DOP853": partial(solve_ivp, method="DOP853"),
}
SWEEPS: Mapping[str, Callable[[Case], Runner]] = {
    PYTHON: partial(sweep, backend="python"),
    "  through Kernels": partial(wrapped_sweep, backend="python"),
    NUMBA: partial(sweep, backend="numba"),
    "  numba through Kernels": partial(wrapped_sweep, backend="numba"),
}


def prepare(
    makers: Mapping[str, Callable[[Case], Runner]], on: Case, within: float
) -> tuple[dict[str, Runner], dict[str, str]]:
    """The runners that there are, and why the others are missing.

    Raises
    ------
    AssertionError
        If two arrive further apart than ``within``: then they are not the same computation.
    """
    runners: dict[str, Runner] = {}
    absent: dict[str, str] = {}
    for name, make in makers.items():
        try:
            runners[name] = make(on)
        except Missing as error:
            absent[name] = str(error)
    first = next(iter(runners.values())).final()
    for name, runner in runners.items():
        apart = np.abs(runner.final() - first).max()
        if not apart <= within:
            raise AssertionError(f"{name} arrives {apart:.1e} away from the others")
    return runners, absent


def trajectories(rounds: int = 30) -> Table:
    """One trajectory with the same tabulated control."""
    on = case()
    runners, absent = prepare(TRAJECTORIES, on, SAME)
    adaptive, _ = prepare(ADAPTIVE, on, 1e-6)
    runners |= adaptive
    samples = interleaved({name: runner.run for name, runner in runners.items()}, rounds)
    ours = samples[PYTHON]
    goals = {
        LAMBDIFY: _goals("at least 3 x generated", LAMBDIFY, PYTHON, 3.0, samples, least=True),
        NUMPY: _goals("at least 10 x generated", NUMPY, PYTHON, 10.0, samples, least=True),
        NUMBA: _goals("at most 1.2 x C -O3", NUMBA, C, 1.2, samples),
    }
    rows = [
        _row(name, samples[name], ours, on.steps, goals.get(name, ()), runners[name].note)
        if name in samples
        else missing(name, absent[name])
        for name in (*TRAJECTORIES, *ADAPTIVE)
    ]
    title = f"1. One trajectory of the polar orbit, {on.steps} RK4 steps, same control; final states agree to {SAME:g}"
    return Table(title, "microseconds a step", tuple(rows))


def sweeps(rounds: int = 30) -> Table:
    """One forward and one backward pass."""
    on = case()
    runners, absent = prepare(SWEEPS, on, SAME)
    samples = interleaved({name: runner.run for name, runner in runners.items()}, rounds)
    rows = [
        _row(name, samples[name], samples[PYTHON], on.steps) if name in samples else missing(name, absent[name])
        for name in SWEEPS
    ]
    return Table("2. One iteration of the sweep: states forward, costates backward", "microseconds a step", tuple(rows))


def _row(name: str, samples: Samples, ours: Samples, steps: int, goals: tuple[Goal, ...] = (), note: str = "") -> Row:
    return Row(name, samples.least * 1e6 / steps, samples.middle * 1e6 / steps, samples.times(ours), goals, note)


def _goals(
    text: str, name: str, other: str, limit: float, samples: Mapping[str, Samples], least: bool = False
) -> tuple[Goal, ...]:
    if not {name, other} <= set(samples):
        return ()
    return (Goal(text, samples[name].times(samples[other]), limit, least),)
