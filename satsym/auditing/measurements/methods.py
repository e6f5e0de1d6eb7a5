"""Numerical integration methods, given as the lines of one step; their order is measured along a known motion.

Lines are assignments. The ending of a name says at which node the value is taken: ``x_n`` (or ``x_i``, ``x_j``) at the
current node, ``x_n1`` at the next one, ``x_n0`` at the previous one, ``x_nh`` and ``x_n0h`` half way to these. ``h`` is
the step.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from satsym import kernels
from satsym.arrays import Array, kept
from satsym.auditing.program import text as programs
from satsym.auditing.program.run import run
from satsym.auditing.propositions.values import Record, Undecided, undecided_if_refused
from satsym.formula.functions import classical_weights
from satsym.status import BadInput

_MARK = re.compile(r"(\w+)_([nij])(1|0h|0|h)?")
_OFFSETS = {"": 0.0, "1": 1.0, "0": -1.0, "h": 0.5, "0h": -0.5}
_NODES = np.linspace(0.25, 1.0, 7)
_STEPS = (1 / 16, 1 / 32)
_SLACK = 0.3
"""Largest distance of a measured order from an integer; otherwise the order is undecided."""
_SPAN = (0.0, 1.25)
_SEED = 3


def rk4() -> list[str]:
    """Return the classical Runge-Kutta method of order four for y' = f(x, y)."""
    weighted = " + ".join(f"{b}*k{s}" for s, b in enumerate(classical_weights(), start=1))
    stages = [f"k{s} = f(x_n + h*{c}, y_n + h*{c}*k{max(s - 1, 1)})" for s, c in ((2, 0.5), (3, 0.5), (4, 1))]
    return ["k1 = f(x_n, y_n)", *stages, f"y_n1 = y_n + h*({weighted})"]


def heun() -> list[str]:
    """Return Heun's method for y' = f(x, y)."""
    return ["k1 = f(x_n, y_n)", "k2 = f(x_n + h, y_n + h*k1)", "y_n1 = y_n + h/2*(k1 + k2)"]


def euler() -> list[str]:
    """Return Euler's method for y' = f(x, y)."""
    return ["y_n1 = y_n + h*f(x_n, y_n)"]


def runge_kutta(unknown: Sequence[str], others: Sequence[str] = (), previous: bool = False) -> list[str]:
    """Return the classical Runge-Kutta method for several unknowns, in stages ``k1_x = h*f1(...)``.

    `others` are further arguments of the time derivatives; `previous` integrates backwards to the previous node.
    """
    sign, there = ("-", "0") if previous else ("+", "1")
    lines = []
    for stage, share, at in ((1, 0, ""), (2, 0.5, "h"), (3, 0.5, "h"), (4, 1, there)):
        mark = f"_n{'0h' if previous and at == 'h' else at}"
        moved = [f"{x}_n {sign} {share}*k{stage - 1}_{x}" if share else f"{x}_n" for x in unknown]
        arguments = ", ".join([*moved, *(f"{name}{mark}" for name in others)])
        lines += [f"k{stage}_{x} = h*f{i}({arguments})" for i, x in enumerate(unknown, start=1)]
    for x in unknown:
        weighted = " + ".join(f"{b}*k{s}_{x}" for s, b in enumerate(classical_weights(), start=1))
        lines.append(f"{x}_n{there} = {x}_n {sign} ({weighted})")
    return lines


def with_line(lines: Sequence[str], line: str) -> list[str]:
    """Return a method in which one line replaces the line that assigns a value to the same name."""
    name = line.partition("=")[0].strip()
    if name not in (other.partition("=")[0].strip() for other in lines):
        raise BadInput(f"no line of the method assigns a value to {name}")
    return [line if other.partition("=")[0].strip() == name else other for other in lines]


@kept
def moving(
    model: str,
    states: Sequence[str],
    controls: Sequence[str] = (),
    costates: Sequence[str] = (),
    coupled: bool = False,
) -> Record:
    """Return a motion of a model under varying controls, with the given names of states, controls and costates.

    ``f1``, ``f2``, ... are the time derivatives of the states, or of the costates if these are named, for use in lines
    of a method. `coupled` adds to each a term in all these states or costates, so that every argument has an effect.
    """
    from scipy.integrate import solve_ivp

    system, rng = kernels.load(model), np.random.default_rng(_SEED)
    n, m = len(states), len(system.spec.controls)
    if n != len(system.spec.states) or len(controls) not in (0, m) or len(costates) not in (0, n):
        raise BadInput(
            f"{model} has {len(system.spec.states)} states and {m} controls; name either all states and all "
            "controls, or none of them"
        )
    letters = {v.symbol: 1.0 for v in system.spec.parameters if v.default}
    p = tuple(letters.get(v.symbol, 0.0) for v in system.spec.parameters)
    phases, still = np.arange(m), (0.0,) * m

    def u(t: Any) -> Array:
        return 0.05 * np.cos(3.0 * np.asarray(t)[..., None] + phases) * bool(controls)

    def states_rate(x: Array, v: Array) -> Array:
        return np.array(system.dynamics(0.0, tuple(x), tuple(v) or still, p)) + np.sin(mixing @ x) * (not costates)

    def costates_rate(lam: Array, x: Array, v: Array) -> Array:
        return np.array(system.costate_rate(0.0, tuple(x), tuple(v) or still, tuple(lam), p)) + np.sin(mixing @ lam)

    def both(t: float, y: Array) -> Array:
        rate = states_rate(y[:n], u(t))
        return np.concatenate([rate, costates_rate(y[n:], y[:n], u(t))]) if costates else rate

    start = rng.uniform(0.8, 1.2, n + len(costates))
    mixing = rng.uniform(0.2, 0.5, (n, n)) * coupled
    found = solve_ivp(both, _SPAN, start, method="DOP853", rtol=1e-13, atol=1e-14, max_step=1 / 64, dense_output=True)

    def component(of: Callable[[Array], Array], k: int) -> Callable[[Array], Array]:
        return lambda t: of(t)[k]

    curves = {name: component(found.sol, k) for k, name in enumerate((*states, *costates))}
    curves |= {name: component(lambda t: u(t).T, k) for k, name in enumerate(controls)}
    rates = _components(
        costates_rate if costates else states_rate, (n, n, len(controls)) if costates else (n, len(controls))
    )
    return Record(f"a motion of {model}", {"curves": curves, **letters, **rates})


def order(lines: Sequence[str], along: Record | None = None) -> int:
    """Return the order of a method, from the errors of single steps along a known motion, by default of y' = cos(x) y.

    The error of a step of order p is proportional to the power p + 1 of the step.
    """
    known = along or _growth()
    errors = [_error(lines, known, step) for step in _STEPS]
    if not all(np.isfinite(errors)) or min(errors) <= 0.0:
        raise Undecided("the steps have no error that could be measured")
    found = float(np.log(errors[0] / errors[1]) / np.log(_STEPS[0] / _STEPS[1])) - 1.0
    if abs(found - round(found)) > _SLACK:
        raise Undecided(f"the measured order is {found:.2f}, which is not close to a whole number")
    return round(found)


def error(lines: Sequence[str], steps: int) -> float:
    """Return the error of a method for y' = cos(x) y after a number of steps from x = 0 to x = 1."""
    known, h = _growth(), 1.0 / steps
    curves = known.part("curves")
    y = curves["y"](np.array(0.0))
    for k in range(steps):
        world = {"x_n": k * h, "y_n": y, "h": h, "f": known.part("f")}
        y = run(programs.read(lines), world=world).values["y_n1"]
    return float(abs(y - curves["y"](np.array(1.0))))


def _error(lines: Sequence[str], along: Record, h: float) -> float:
    """Return the largest error of one step, taken from several nodes at once."""
    program, curves = programs.read(lines), along.part("curves")
    given = [name for statement in program.statements for name in programs.given_names(statement)]
    used = {name for statement in program.statements for name in programs.names_in(statement)}
    world: dict[str, Any] = {name: part for name, part in along.parts.items() if name != "curves"} | {"h": h}
    errors = []
    for name in {*used, *given}:
        marked = _MARK.fullmatch(name)
        if marked and marked[1] in curves:
            exact = curves[marked[1]](_NODES + h * _OFFSETS[marked[3] or ""])
            if name in given:
                errors.append((name, exact))
            else:
                world[name] = exact
    if not errors:
        raise BadInput("no line of the method computes the value at the next node")
    with undecided_if_refused():
        values = run(program, world=world).values
    return float(max(np.abs(values[name] - exact).max() for name, exact in errors))


@cache
def _growth() -> Record:
    """Return the known motion of y' = cos(x) y."""
    curves = {"x": lambda t: t, "y": lambda t: np.exp(np.sin(t))}
    return Record("y' = cos(x) y", {"curves": curves, "f": lambda x, y: np.cos(x) * y})


def _components(rate: Callable[..., Array], sizes: Sequence[int]) -> Mapping[str, Callable[..., Array]]:
    """Return the components of ``rate`` as functions ``f1``, ``f2``, ... of numbers or of arrays along a curve.

    `sizes` are the numbers of components of the arguments of ``rate``.
    """

    def component(k: int) -> Callable[..., Array]:
        def f(*arguments: Any) -> Array:
            columns = np.broadcast_arrays(*arguments)
            if len(columns) != sum(sizes):
                raise BadInput(f"f{k + 1} takes {sum(sizes)} arguments, but {len(columns)} are given")
            points = np.stack(columns, axis=-1)
            flat = [rate(*np.split(point, np.cumsum(sizes)[:-1]))[k] for point in points.reshape(-1, sum(sizes))]
            return np.array(flat).reshape(points.shape[:-1])

        return f

    return {f"f{k + 1}": component(k) for k in range(sizes[0])}
