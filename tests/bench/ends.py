"""Given ends: the return to the orbit from a cold start, by satsym and by what a good user would take instead.

Everyone must find the initial costates to 1e-9; nobody is given more than the straight line between the ends. What
is paid once beforehand (building, compiling) is noted beside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec
from math import pi
from time import perf_counter
from typing import Any

import numpy as np
from msgspec import structs
from peers import Missing
from rows import Goal, Row, Table, missing
from timing import interleaved

START, END, T_FINAL = np.array([1.1, 0.0, 0.0, 0.9]), np.array([1.0, 0.0, 2 * pi, 1.0]), 2 * pi
COSTATES = np.array([0.13817547355, 0.02984866111, -0.00567694889, 0.08773937141])
"""Pinned: computed by other programs, to the digits given."""

DEGREE, INTERVALS = 5, 10
"""Of CasADi's collocation."""

WITHIN = 1e-9
OURS = "satsym, collocation"
BUILT = "satsym, collocation, built once"
COMPILED = "satsym, shooting with numba, built once"
Solver = Callable[[], np.ndarray]


def satsym() -> Solver:
    """The shipped instance, without its certificate, at as many points of time as CasADi's program has."""
    from satsym.instance import load
    from satsym.solvers import two_point

    case = load("return-to-orbit")
    case = replace(case, solver=structs.replace(case.solver, steps=DEGREE * INTERVALS))
    return lambda: two_point.solve(case).lam[:, 0]


def built() -> Solver:
    """The same instance solved again and again, scales and mesh kept, each time from the straight line."""
    return _repeated(compiled=False)


def compiled() -> Solver:
    """The same by compiled shooting."""
    if find_spec("numba") is None:
        raise Missing("numba is not installed (the fast extra has it)")
    return _repeated(compiled=True)


def _repeated(compiled: bool) -> Solver:
    from satsym.instance import load
    from satsym.solvers.repeated import Repeated

    repeated = Repeated(load("return-to-orbit"), compiled)
    return lambda: repeated.solve(cold=True).lam[:, 0]


def solve_bvp() -> Solver:
    """SciPy's collocation on the canonical equations, written out by hand, with a vectorised right-hand side."""
    from scipy.integrate import solve_bvp

    def rates(t: Any, z: Any) -> Any:
        r, v, _, w, a, b, c, d = z
        u1, u2 = -b, -d / r
        return np.array(
            [
                v,
                r * w * w - 1 / r**2 + u1,
                w,
                (u2 - 2 * v * w) / r,
                -b * (w * w + 2 / r**3) - d * (2 * v * w - u2) / r**2,
                -a + 2 * d * w / r,
                0 * c,
                -2 * b * r * w - c + 2 * d * v / r,
            ]
        )

    def ends(a: Any, b: Any) -> Any:
        return np.concatenate([a[:4] - START, b[:4] - END])

    def run() -> np.ndarray:
        t = np.linspace(0, T_FINAL, 20)
        line = START[:, None] + (END - START)[:, None] * t / T_FINAL
        return solve_bvp(rates, ends, t, np.vstack([line, np.zeros((4, 20))]), tol=1e-9, max_nodes=20000).y[4:, 0]

    return run


def casadi() -> Solver:
    """CasADi, built beforehand, solved warm each time."""
    solve = program()
    return lambda: solve(START)


def program() -> Callable[[np.ndarray], np.ndarray]:
    """From initial states to costates: Legendre collocation of degree 5 on 10 intervals, Ipopt."""
    try:
        import casadi as ca
    except ImportError:
        raise Missing("casadi is not installed (the bench extra has it)") from None
    degree, intervals = DEGREE, INTERVALS
    h = T_FINAL / intervals
    x, u = ca.SX.sym("x", 4), ca.SX.sym("u", 2)
    rhs = ca.vertcat(x[1], x[0] * x[3] ** 2 - 1 / x[0] ** 2 + u[0], x[3], (u[1] - 2 * x[1] * x[3]) / x[0])
    f = ca.Function("f", [x, u], [rhs, ca.dot(u, u) / 2])
    c, d, b = ca.collocation_coeff(ca.collocation_points(degree, "legendre"))
    nodes = [ca.SX.sym(f"x{k}", 4) for k in range(intervals + 1)]
    stages = [ca.SX.sym(f"s{k}", 4, degree) for k in range(intervals)]
    controls = [ca.SX.sym(f"u{k}", 2, degree) for k in range(intervals)]
    begin, equations, cost = ca.SX.sym("begin", 4), [], 0
    for k in range(intervals):
        rates, running = f.map(degree)(stages[k], controls[k])
        known = ca.horzcat(nodes[k], stages[k])
        equations += [ca.vec(known @ c - h * rates), known @ d - nodes[k + 1]]
        cost += h * ca.mtimes(running, b)
    w = ca.vertcat(*nodes, *(ca.vec(s) for s in stages), *(ca.vec(v) for v in controls))
    met = ca.vertcat(nodes[0] - begin, nodes[-1] - END, *equations)
    nlp = {"x": w, "f": cost, "g": met, "p": begin}
    quiet = {"ipopt.print_level": 0, "print_time": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10}
    solver = ca.nlpsol("solver", "ipopt", nlp, quiet)
    fraction = np.linspace(0, 1, intervals + 1)
    inner = np.array([(k + t) / intervals for k in range(intervals) for t in ca.collocation_points(degree, "legendre")])

    def run(start: np.ndarray) -> np.ndarray:
        line = [start + (END - start) * at[:, None] for at in (fraction, inner)]
        guess = np.concatenate([line[0].ravel(), line[1].ravel(), np.zeros(2 * degree * intervals)])
        return -np.array(solver(x0=guess, lbg=0, ubg=0, p=start)["lam_g"]).ravel()[:4]

    return run


def ends(rounds: int = 10) -> Table:
    """The table."""
    makers = {
        OURS: satsym,
        BUILT: built,
        COMPILED: compiled,
        "SciPy solve_bvp": solve_bvp,
        "CasADi collocation, Ipopt, warm": casadi,
    }
    runs: dict[str, Solver] = {}
    absent: dict[str, str] = {}
    once: dict[str, float] = {}
    for name, make in makers.items():
        begun = perf_counter()
        try:
            runs[name] = make()
        except Missing as error:
            absent[name] = str(error)
        once[name] = perf_counter() - begun
    off = {name: float(np.abs(run() - COSTATES).max()) for name, run in runs.items()}
    samples = interleaved(runs, rounds)
    rows = []
    for name in makers:
        if name in absent:
            rows.append(missing(name, absent[name]))
            continue
        goals: tuple[Goal, ...] = ()
        if name.startswith("SciPy"):
            goals = (Goal("at least 5 x satsym", samples[name].times(samples[OURS]), 5.0, True),)
        elif name.startswith("CasADi"):
            ahead = [(kind, samples[name].times(samples[kind])) for kind in (OURS, BUILT, COMPILED) if kind in samples]
            goals = tuple(Goal(f"more than {kind}", ratio, 1.0, True) for kind, ratio in ahead)
        note = f"costates off by {off[name]:.0e}" + ("" if off[name] <= WITHIN else f", more than {WITHIN:g}")
        note += f"; {once[name]:.2g} s once" if once[name] > 0.01 else ""
        rows.append(
            Row(
                name,
                samples[name].least * 1e3,
                samples[name].middle * 1e3,
                samples[name].times(samples[OURS]),
                goals,
                note,
            )
        )
    return Table("5. The return to the orbit, final state given, from a straight line", "milliseconds", tuple(rows))
