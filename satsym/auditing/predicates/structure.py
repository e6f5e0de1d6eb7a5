"""Claims about what inputs can do: controllability, steering, and placing eigenvalues."""

from __future__ import annotations

from math import factorial

import numpy as np

from satsym.analysis.linear import polynomials
from satsym.analysis.linear import system as systems
from satsym.analysis.linear.ranks import controllability
from satsym.analysis.linear.system import LinearSystem
from satsym.arrays import Array
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.flows import expm
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_SEED = 13
_TRIES = 6
_NODES = 30
_EQUAL = 1e-6


def with_numbers(model: str, controls: tuple[str, ...] = (), omega: float = 1.0) -> LinearSystem:
    """A linear model with numbers for its parameters and some of its controls, all by default."""
    found = analysis(model).system
    values = {"omega": float(omega), "sigma": 1.0}
    for name in controls:
        if name not in found.inputs:
            raise BadInput(f"{model} has no control {shown(name)}; {suggestion(name, found.inputs)}")
    whole = systems.system(
        numeric(found.a, values), numeric(found.b, values), states=found.states, inputs=found.inputs, name=model
    )
    return whole.with_inputs(controls or found.inputs)


@predicate
def controllable_alone(model: str, control: str, printed: bool) -> Finding:
    """Whether one control alone makes the system controllable, as is printed or denied."""
    found = analysis(model)
    if control not in found.by_input:
        raise BadInput(f"controllable_alone: no control {shown(control)}; {suggestion(control, found.by_input)}")
    rank, n = found.by_input[control].rank, len(found.system.states)
    return Finding(
        (rank == n) == printed, f"rank {rank} of {n}", {"rank": rank, "states": n}, f"satsym analyse {model}"
    )


@predicate
def can_be_stabilised(model: str, control: str) -> Finding:
    """Whether one control alone can make all real parts negative."""
    lost = [e for e in controllability(with_numbers(model, (control,))).lost if e.value.real >= 0.0]
    return Finding(
        not lost,
        f"{control} moves every mode that does not decay"
        if not lost
        else f"{control} does not move the mode {lost[0].value:.3g}",
        {"modes out of reach that do not decay": len(lost)},
        f"satsym analyse {model}",
    )


@predicate
def sizes(model: str, controls: tuple[str, ...], states: int, inputs: int) -> Finding:
    """Whether a model with these controls has so many states and inputs."""
    found = with_numbers(model, controls)
    n, m = found.B.shape
    return Finding((n, m) == (states, inputs), f"A is {n} by {n}, B {n} by {m}", {"states": n, "inputs": m})


def _nodes(end: float) -> tuple[Array, Array]:
    """Nodes and weights of Gauss-Legendre quadrature over [0, end]."""
    places, weights = np.polynomial.legendre.leggauss(_NODES)
    return 0.5 * end * (places + 1.0), 0.5 * end * weights


def _gramian(a: Array, b: Array, end: float) -> Array:
    """K, the integral of e^(-As) B B' e^(-A's) over [0, end]."""
    total = np.zeros_like(a)
    for s, weight in zip(*_nodes(end), strict=True):
        column = expm(-s * a) @ b
        total += weight * column @ column.T
    return total


@predicate
def steers(law: str, start: str) -> Finding:
    """Whether the state reached is what is printed, on random systems with three states and two inputs.

    ``minimum energy``: u(t) = B' e^(-A't) K^-1 e^(-A t1) d, aimed at d = x1 from ``zero``, and at
    d = x1 - e^(A t1) x0 from ``any`` state x0, against the integration of x' = Ax + Bu. ``series``: for an arbitrary
    input from zero, the integral of e^(A(t1-s)) B u(s), and the sum of A^k B times that of (t1-s)^k/k! u(s).
    """
    if law not in ("minimum energy", "series") or start not in ("zero", "any"):
        raise BadInput("steers: write law='minimum energy' or 'series', start='zero' or 'any'")
    from scipy.integrate import solve_ivp

    rng, worst, end = np.random.default_rng(_SEED), 0.0, 1.2
    for _ in range(_TRIES):
        a, b = rng.uniform(-1.0, 1.0, (3, 3)), rng.uniform(-1.0, 1.0, (3, 2))
        aim, x0 = rng.uniform(-1.0, 1.0, 3), rng.uniform(-1.0, 1.0, 3) * (start == "any")
        effort = np.linalg.solve(_gramian(a, b, end), expm(-end * a) @ (aim - expm(end * a) @ x0))

        def control(s: float, a: Array = a, b: Array = b, effort: Array = effort) -> Array:
            wave = np.array([np.cos(3.0 * s), s])
            return np.asarray(b.T @ expm(-s * a.T) @ effort if law == "minimum energy" else wave)

        moved = solve_ivp(lambda s, x, a=a, b=b, u=control: a @ x + b @ u(s), (0.0, end), x0, rtol=1e-10, atol=1e-10).y[
            :, -1
        ]
        if law == "minimum energy":
            worst = max(worst, float(np.abs(moved - aim).max()))
            continue
        nodes = list(zip(*_nodes(end), strict=True))
        whole = sum(w * expm((end - s) * a) @ b @ control(s) for s, w in nodes)
        series = sum(
            np.linalg.matrix_power(a, k) @ b @ sum(w * (end - s) ** k / factorial(k) * control(s) for s, w in nodes)
            for k in range(20)
        )
        worst = max(worst, float(np.abs(whole - moved).max()), float(np.abs(series - moved).max()))
    return Finding(worst < _EQUAL, f"the state reached is off by {worst:.0e} at most", {"largest difference": worst})


def _half_reached() -> tuple[Array, Array]:
    """A system of which the input reaches one direction only."""
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    return turn @ np.diag([-0.4, -1.0]) @ turn.T, turn @ np.array([[1.0], [0.0]])


@predicate
def singular_for(vectors: str) -> Finding:
    """Whether a Gramian without an inverse sends ``all`` vectors to zero."""
    if vectors != "all":
        raise BadInput(f"singular_for: no {shown(vectors)}; write all")
    size = np.abs(np.linalg.eigvalsh(_gramian(*_half_reached(), 1.0)))
    kernel = int((size < _EQUAL).sum())
    return Finding(
        kernel == len(size),
        f"a singular K sends some a to zero, not all: here the kernel has dimension {kernel} of {len(size)}",
        {"dimension of the kernel": kernel, "largest eigenvalue of K": float(size.max())},
    )


@predicate
def gramian_kernel(part: str) -> Finding:
    """Whether K a = 0 makes a' e^(-As) B vanish all along (``2.53``), and with it a' A^k B (``derivatives``)."""
    if part not in ("2.53", "derivatives"):
        raise BadInput(f"gramian_kernel: no part {shown(part)}; write 2.53 or derivatives")
    a, b = _half_reached()
    values, vectors = np.linalg.eigh(_gramian(a, b, 1.0))
    left, other = vectors[:, 0], vectors[:, 1]
    found = {}
    for name, vector in (("in the kernel", left), ("not in it", other)):
        along = [vector @ expm(-s * a) @ b for s in np.linspace(0.0, 1.0, 11)]
        powers = [vector @ np.linalg.matrix_power(a, k) @ b for k in range(2)]
        found[name] = float(np.abs(along if part == "2.53" else powers).max())
    return Finding(
        values[0] < _EQUAL and found["in the kernel"] < _EQUAL < found["not in it"],
        f"it vanishes but for {found['in the kernel']:.0e}; for other vectors it is {found['not in it']:.2g}",
        {f"largest value, a {name}": value for name, value in found.items()},
    )


@predicate
def poles_go_anywhere(sign: str) -> Finding:
    """Whether some K gives A + B K (``plus``) any characteristic polynomial, on random controllable systems."""
    if sign != "plus":
        raise BadInput(f"poles_go_anywhere: no sign {shown(sign)}; write plus")
    rng, worst = np.random.default_rng(_SEED), 0.0
    for _ in range(_TRIES):
        given = systems.system(rng.uniform(-1.0, 1.0, (3, 3)), rng.uniform(0.5, 1.5, (3, 1)))
        wanted = np.array([1.0, *rng.uniform(0.5, 4.0, 3)])
        gain = -polynomials.place(given, np.roots(wanted).tolist())
        worst = max(worst, float(np.abs(polynomials.characteristic(given.A + given.B @ gain) - wanted).max()))
    return Finding(worst < _EQUAL, f"the coefficients are met but for {worst:.0e}", {"largest difference": worst})


@predicate
def companion_of(row: Question, coefficients: tuple[str, ...]) -> Finding:
    """Whether a printed matrix is the companion of the monic polynomial with these further coefficients."""
    from satsym.symbolic.analysis.companion_form import companion_matrix as companion

    found = companion([exact.expression(text) for text in ("1", *coefficients)])
    rows = [[found[i, j] for j in range(found.cols)] for i in range(found.rows)]
    return Finding(exact.same_entries(exact.matrix(row.printed), rows), exact.written(rows))


@predicate
def input_of_companion(row: Question, size: int) -> Finding:
    """Whether a printed column is that by which the input enters a system in companion form."""
    rng = np.random.default_rng(_SEED)
    given = systems.system(rng.uniform(-1.0, 1.0, (size, size)), rng.uniform(0.5, 1.5, (size, 1)))
    basis, form = polynomials.companion_form(given)
    column = np.linalg.solve(basis, given.B)[:, 0]
    printed = [float(entry) for (entry,) in exact.matrix(row.printed)]
    gap = float(np.abs(column - printed).max()) if len(printed) == size else float("inf")
    return Finding(
        gap < 1e-6 and bool(np.allclose(np.linalg.solve(basis, given.A @ basis), form.A)),
        f"({', '.join(f'{entry:.0f}' for entry in column)})'",
        {"largest difference": gap},
    )


@predicate
def placing_gain(row: Question, given: tuple[str, ...], wanted: tuple[str, ...]) -> Finding:
    """Whether a printed gain K carries one companion matrix into another, A + B K with B the last unit vector."""
    from satsym.symbolic.analysis.companion_form import companion_matrix as companion

    first, last = (companion([exact.expression(t) for t in ("1", *names)]) for names in (given, wanted))
    needed = [[last[last.rows - 1, j] - first[first.rows - 1, j] for j in range(last.cols)]]
    return Finding(exact.same_entries(exact.matrix(row.printed), needed), exact.written(needed))
