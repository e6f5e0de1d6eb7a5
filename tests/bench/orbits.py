"""Many orbits for a revolution each: closed form, RK4 on arrays, and what others offer, at equal error.

Every method gets the steps or the tolerance with which it comes as near to the closed form as WANTED, and hardly
nearer; the error that it then has is printed beside its time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from peers import Missing
from rows import Goal, Row, Table, missing
from timing import Samples, interleaved

from satsym.status import BadInput

COUNT = 4096
LOOPED = 32
"""Of them, for what takes them one after another: a loop gets no quicker by going on."""
WANTED = 1e-9
"""Largest distance from the closed form over the orbits, relative to that from the centre."""
CLOSED, NUMPY, NUMBA = "satsym, closed form", "satsym, RK4 on arrays, NumPy", "satsym, RK4 on arrays, numba"
KICKED = "satsym, symplectic on arrays, numba"
SCIPY, HEYOKA = "SciPy DOP853 in a loop", "heyoka, batch mode"


@dataclass(frozen=True, eq=False)
class Orbits:
    """Ellipses about a centre with mu = 1, in all attitudes.

    Attributes
    ----------
    start
        Shape (6, N).
    duration
        Of one revolution, the same for all: their energies are equal.
    exact
        Positions after a revolution and a third, shape (3, N).
    """

    start: np.ndarray
    duration: float
    exact: np.ndarray

    def part(self, count: int) -> Orbits:
        return replace(self, start=self.start[:, :count], exact=self.exact[:, :count])

    def error(self, found: np.ndarray) -> float:
        """Largest distance from the closed form, relative to that from the centre."""
        apart = np.linalg.norm(found[:3] - self.exact, axis=0) / np.linalg.norm(self.exact, axis=0)
        return float(apart.max())


Method = Callable[[Orbits, float], np.ndarray]
"""From orbits, and a number of steps or a tolerance, to the states at the end, shape (6, N)."""


def orbits(count: int = COUNT) -> Orbits:
    """Eccentricities up to 0.5, semi-major axes one."""
    from satsym.analysis.orbits import kepler

    rng = np.random.default_rng(7)
    e, anomaly = rng.uniform(0.0, 0.5, count), rng.uniform(-np.pi, np.pi, count)
    p = 1.0 - e**2
    radius, zero = p / (1.0 + e * np.cos(anomaly)), np.zeros(count)
    r = radius * np.array([np.cos(anomaly), np.sin(anomaly), zero])
    v = np.array([-np.sin(anomaly), e + np.cos(anomaly), zero]) / np.sqrt(p)
    attitude, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    r, v = (np.einsum("kij,jk->ik", attitude, vector) for vector in (r, v))
    duration = 4.0 / 3.0 * 2.0 * np.pi
    return Orbits(np.vstack([r, v]), duration, kepler.propagate(r, v, 1.0, duration)[0])


def many(rounds: int = 3) -> Table:
    """All of them by every means."""
    on = orbits()
    makers: dict[str, tuple[Callable[[], Method], Orbits]] = {
        CLOSED: (lambda: closed, on),
        NUMPY: (partial(_steps, "python", "RK4"), on),
        NUMBA: (partial(_steps, "numba", "RK4"), on),
        KICKED: (partial(_steps, "numba", "symplectic"), on),
        SCIPY: (lambda: _dop853, on.part(LOOPED)),
        HEYOKA: (_heyoka, on),
    }
    absent, runs, errors, effort, counts = {}, {}, {}, {}, {}
    for name, (make, of) in makers.items():
        try:
            method = make()
        except Missing as error:
            absent[name] = str(error)
            continue
        effort[name] = 0.0 if name == CLOSED else _enough(method, of, integer=name in (NUMPY, NUMBA, KICKED))
        errors[name], counts[name] = of.error(method(of, effort[name])), of.start.shape[1]
        runs[name] = partial(method, of, effort[name])
    samples = interleaved(runs, rounds, 0.0)
    each = {name: Samples(tuple(s / counts[name] for s in sample.seconds)) for name, sample in samples.items()}
    rows = [
        _row(name, each, errors[name], effort[name]) if name in each else missing(name, absent[name]) for name in makers
    ]
    title = f"8. {COUNT} orbits, eccentricities to 0.5, for 4/3 of a revolution, to an error of {WANTED:g}"
    return Table(title, "microseconds each", tuple(rows))


def _row(name: str, each: dict[str, Samples], error: float, effort: float) -> Row:
    goals: list[Goal] = []
    if name in (NUMBA, KICKED) and SCIPY in each:
        goals.append(Goal("at most 0.1 x SciPy", each[name].times(each[SCIPY]), 0.1))
    if name in (SCIPY, HEYOKA):
        goals.append(Goal("at least as long as the closed form", each[name].times(each[CLOSED]), 1.0, least=True))
    notes = {
        CLOSED: "every error is a distance from it",
        KICKED: f"error {error:.0e}, {effort:.0f} steps of twelve evaluations",
        SCIPY: f"error {error:.0e}, rtol {effort:.0e}; {LOOPED} of them timed",
        HEYOKA: f"error {error:.0e}, tolerance {effort:.0e}; without compiling",
    }
    note = notes.get(name, f"error {error:.0e}, {effort:.0f} steps")
    sample = each[name]
    return Row(name, sample.least * 1e6, sample.middle * 1e6, sample.times(each[CLOSED]), tuple(goals), note)


def _enough(method: Method, of: Orbits, integer: bool) -> float:
    """The fewest steps, to a twentieth, or the largest tolerance, to a quarter of a decade, that reaches WANTED."""
    few = of.part(LOOPED)
    given = 32.0 if integer else 1e-6
    for orbits in (few, of):  # the hardest may not be among the few
        while (error := orbits.error(method(orbits, given))) > WANTED:
            # of sixth order at most: this does not pass by the number looked for
            given = (
                float(np.ceil(given * max(1.05, (error / WANTED) ** (1.0 / 6.0)))) if integer else given * 10.0**-0.25
            )
    return given


def closed(of: Orbits, _: float) -> np.ndarray:
    """In closed form."""
    from satsym.analysis.orbits import kepler

    return np.vstack(kepler.propagate(of.start[:3], of.start[3:], 1.0, of.duration))


def _steps(backend: str, method: str) -> Method:
    from satsym.kernels import load
    from satsym.solvers.simulation import batch

    kernels = load("two_body")
    if backend == "numba":
        try:
            kernels = kernels.compiled()
        except BadInput:
            raise Missing("numba is not installed (the fast extra has it)") from None

    def end(of: Orbits, steps: float) -> np.ndarray:
        return batch.simulate(kernels, [0.0, of.duration], of.start, (1.0,), int(steps), method=method)[:, 1]

    return end


def _dop853(of: Orbits, tolerance: float) -> np.ndarray:
    from scipy.integrate import solve_ivp

    def rates(_: float, y: np.ndarray) -> list[float]:
        r_x, r_y, r_z, *pace = y.tolist()  # floats: arrays of three take longer
        pull = -((r_x * r_x + r_y * r_y + r_z * r_z) ** -1.5)
        return [*pace, pull * r_x, pull * r_y, pull * r_z]

    def end(start: np.ndarray) -> np.ndarray:
        return solve_ivp(rates, (0.0, of.duration), start, "DOP853", rtol=tolerance, atol=tolerance).y[:, -1]

    return np.array([end(start) for start in of.start.T]).T


def _heyoka() -> Method:
    try:
        import heyoka as hy
    except ImportError:
        raise Missing("heyoka is not installed (the bench extra has it)") from None
    place, pace = hy.make_vars("x", "y", "z"), hy.make_vars("v_x", "v_y", "v_z")
    pull = hy.sum([q**2 for q in place]) ** -1.5
    system = [*zip(place, pace, strict=True), *((v, -q * pull) for q, v in zip(place, pace, strict=True))]
    size = hy.recommended_simd_size()
    built: dict[float, object] = {}

    def method(of: Orbits, tolerance: float) -> np.ndarray:
        if tolerance not in built:
            built[tolerance] = hy.taylor_adaptive_batch(system, np.zeros((6, size)), tol=tolerance)
        integrator, found = built[tolerance], np.empty_like(of.start)
        for begin in range(0, of.start.shape[1], size):
            part = slice(begin, begin + size)
            integrator.set_time(0.0)
            integrator.state[:] = of.start[:, part]
            integrator.propagate_until(of.duration)
            found[:, part] = integrator.state
        return found

    return method
