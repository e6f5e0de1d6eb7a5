"""Any problem by direct collocation, CasADi and Ipopt, built from what a derivation file states and from nothing else.

Legendre collocation on equal intervals from the straight line between the ends, with controls in the middle of their
bounds. The mesh is doubled until the optimum is met that is known beforehand: no user has it so easy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np
import sympy as sp
from peers import Missing

from satsym.instance import Instance
from satsym.symbolic import Angle, Annulus, Ball, Problem, derive, loader, symbols_of, t

DEGREE, FEWEST, MOST = 5, 10, 640
"""Of the collocation polynomials; and how many intervals there are."""

FIRST = 1.0
"""The duration to begin with, where it is free and the instance says nothing: that of satsym, too."""


@dataclass(frozen=True)
class Direct:
    """What came of it: the objective and mesh of the last try, whether that is good enough, and how to do it again."""

    objective: float
    intervals: int
    reached: bool
    again: Callable[[], float]


@dataclass(frozen=True)
class Stated:
    """A problem as functions of CasADi."""

    rates: Any
    """(t, x, u, p) -> rates of change and running cost."""
    end: Any
    """(t_f, x, p) -> terminal cost and constraints."""
    within: Any
    """u -> squared norms of the controls in each ball."""
    norms: tuple[tuple[float, float], ...]
    """Their least and largest, squared."""
    path: Any
    """(t, x, p) -> path constraints on the states alone."""
    mixed: Any
    """(t, x, u, p) -> those that hold controls, which are to keep to them where controls are: at the stages."""


def stated(problem: Problem, case: Instance) -> Stated:
    """The functions of a problem, by ``sympy.lambdify``."""
    try:
        import casadi as ca
    except ImportError:
        raise Missing("casadi is not installed (the bench extra has it)") from None
    if problem.interior:
        raise Missing("waypoints need phases")
    names = {"Abs": ca.fabs, "abs": ca.fabs, "acos": ca.acos, "asin": ca.asin, "atan": ca.atan, "Max": ca.fmax}
    names |= {name: getattr(ca, name) for name in ("sin", "cos", "tan", "exp", "log", "sqrt", "atan2", "tanh")}
    model = problem.model
    states, controls, parameters = (symbols_of(v) for v in (model.states, model.controls, model.parameters))
    constants = {symbols_of((d.variable,))[0]: d.value for d in model.definitions}
    if hasattr(model, "rates"):
        rates = [model.rates[x] for x in states]
    else:
        derivation = derive(problem)
        rates = [derivation.equation(f"first_order.{x}").rhs for x in states]

    def function(arguments: list[Any], expressions: list[Any]) -> Any:
        plain = [sp.sympify(e).subs(constants) for e in expressions]
        own = [ca.SX.sym(f"a{k}", 1 if isinstance(a, sp.Symbol) else len(a)) for k, a in enumerate(arguments)]
        given = [a if isinstance(s, sp.Symbol) else ca.vertsplit(a) for a, s in zip(own, arguments, strict=True)]
        values = sp.lambdify(arguments, plain, modules=[names], cse=True)(*given)
        return ca.Function("f", own, [ca.vertcat(*values) if values else ca.SX(0, 1)])

    kept = [sp.sympify(g) for g in problem.path_constraints.values()]
    balls = [(n, s) for n, s in problem.control_sets.items() if isinstance(s, Ball | Annulus)]
    if problem.control_set == "ball":
        within, norms = [sum(u**2 for u in controls)], ((0.0, case.max_norm**2),)
    else:
        within = [sum(sp.Symbol(u, real=True) ** 2 for u in s.controls) for _, s in balls]
        norms = tuple((case.norms[n][0] ** 2, case.norms[n][1] ** 2) for n, _ in balls)
    sense = -1 if problem.maximise else 1
    return Stated(
        function([t, states, controls, parameters], [*rates, sense * problem.running_cost]),
        function([t, states, parameters], [sense * problem.terminal_cost, *problem.terminal_constraints]),
        function([controls], within),
        norms,
        function([t, states, parameters], [g for g in kept if not g.free_symbols & set(controls)]),
        function([t, states, controls, parameters], [g for g in kept if g.free_symbols & set(controls)]),
    )


def solve(case: Instance, optimum: float, within: float, patience: float) -> Direct:
    """Refine until the optimum is met, the mesh is the finest or a try takes too long.

    Parameters
    ----------
    within
        Relative error that is allowed.
    patience
        Seconds; no try begins after these.
    """
    (problem, _), begun = loader.problem(case.model.spec.name), perf_counter()
    functions, intervals = stated(problem, case), FEWEST
    while True:
        again = partial(tried, problem, functions, case, intervals)
        objective = again()
        reached = abs(objective - optimum) <= within * abs(optimum)
        if reached or 2 * intervals > MOST or perf_counter() - begun > patience:
            return Direct(objective, intervals, reached, again)
        intervals *= 2


def tried(problem: Problem, functions: Stated, case: Instance, intervals: int) -> float:
    """The objective on one mesh; NaN where Ipopt finds none."""
    import casadi as ca

    n, m, stages = len(case.initial), len(case.lower), DEGREE * intervals
    p, free = ca.DM(list(case.parameters)), case.tf is None
    c, d, b = ca.collocation_coeff(ca.collocation_points(DEGREE, "legendre"))
    x, s, u = ca.MX.sym("x", n, intervals + 1), ca.MX.sym("s", n, stages), ca.MX.sym("u", m, stages)
    lasting = ca.MX.sym("T")
    tau = (np.arange(intervals)[:, None] + np.array(ca.collocation_points(DEGREE, "legendre"))).ravel() / intervals
    inside = (case.t0 + lasting * ca.DM(tau).T, s, u, ca.repmat(p, 1, stages))
    f, mixed = functions.rates.map(stages)(*inside), functions.mixed.map(stages)(*inside)
    h = lasting / intervals
    known = ca.horzcat(*(ca.horzcat(x[:, k], s[:, DEGREE * k : DEGREE * (k + 1)]) for k in range(intervals)))
    slopes = known @ ca.kron(ca.DM.eye(intervals), c)
    ends = known @ ca.kron(ca.DM.eye(intervals), d)
    end = functions.end(case.t0 + lasting, x[:, -1], p)
    cost = h * ca.sum2(f[n, :] @ ca.repmat(b, intervals, 1)) + end[0]
    norms = functions.within.map(stages)(u) if functions.norms else ca.MX(0, stages)
    inner = ca.DM(np.linspace(0.0, 1.0, intervals + 1)[1:-1]).T
    path = functions.path.map(intervals - 1)(case.t0 + lasting * inner, x[:, 1:-1], ca.repmat(p, 1, intervals - 1))
    g = list(map(ca.vec, (slopes - h * f[:n, :], ends - x[:, 1:], end[1:], norms, path, mixed)))
    zeros, kept = np.zeros(sum(one.numel() for one in g[:3])), np.zeros(path.numel() + mixed.numel())
    rows = [np.tile([row[k] for row in functions.norms], stages) for k in (0, 1)]
    low, high = np.concatenate([zeros, rows[0], kept - math.inf]), np.concatenate([zeros, rows[1], kept])
    lengths = ((case.tf_guess - case.t0) if case.tf_guess else FIRST) if free else case.tf - case.t0
    start, lower, upper = _begun(problem, case, intervals, tau, lengths)
    options = {"ipopt.print_level": 0, "print_time": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10, "ipopt.max_iter": 1000}
    options |= {"ipopt.bound_relax_factor": 0.0, "ipopt.max_wall_time": 60.0}
    w = ca.vertcat(ca.vec(x), ca.vec(s), ca.vec(u), lasting)
    solver = ca.nlpsol("solver", "ipopt", {"x": w, "f": cost, "g": ca.vertcat(*g)}, options)
    found = solver(x0=start, lbx=lower, ubx=upper, lbg=low, ubg=high)
    return float(found["f"]) if solver.stats()["success"] else math.nan


def _begun(problem: Problem, case: Instance, intervals: int, tau: Any, lasting: float) -> tuple[Any, Any, Any]:
    """Where to start, and the bounds of all variables: nodes, stages, controls, the duration."""
    names, stages = case.model.spec.state_names, len(tau)
    referred = "reference" in case.final.values()
    known = case.model.reference(case.t0 + lasting, case.parameters) if referred else case.initial
    wanted = [known[k] if case.final.get(x) == "reference" else case.final.get(x) for k, x in enumerate(names)]
    ends = np.array([case.initial[k] if value is None else value for k, value in enumerate(wanted)], dtype=float)
    initial = np.array(case.initial)
    line = [np.outer(initial, 1.0 - at) + np.outer(ends, at) for at in (np.linspace(0.0, 1.0, intervals + 1), tau)]
    low, high = np.array(case.lower), np.array(case.upper)
    angles = [c for s in problem.control_sets.values() if isinstance(s, Angle) for c in s.controls]
    middle = [(a + b) / 2.0 if math.isfinite(b - a) else 0.0 for a, b in zip(low, high, strict=True)]
    start = np.concatenate([*(part.T.ravel() for part in line), np.tile(middle, stages), [lasting]])
    domain = np.array([0.0 if v.positive else -math.inf for v in problem.model.states])
    lower, upper = (np.tile(v[:, None], intervals + 1) for v in (domain, np.full(len(ends), math.inf)))
    given = [k for k, x in enumerate(names) if x in case.final]
    for bound in (lower, upper):
        bound[:, 0], bound[given, -1] = initial, ends[given]
    free = [np.full(len(ends), math.inf), np.where([c in angles for c in case.model.spec.control_names], math.inf, 0.0)]
    lowest = np.concatenate([lower.T.ravel(), np.tile(domain, stages), np.tile(low - free[1], stages)])
    highest = np.concatenate([upper.T.ravel(), np.tile(free[0], stages), np.tile(high + free[1], stages)])
    times = (0.0, math.inf) if case.tf is None else (lasting, lasting)
    return start, np.append(lowest, times[0]), np.append(highest, times[1])
