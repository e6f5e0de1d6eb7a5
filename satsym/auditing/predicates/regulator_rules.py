"""What documents say of weights, of Riccati's equation and of definite matrices, tried on examples."""

from __future__ import annotations

import numpy as np

from satsym.analysis.linear import system as systems
from satsym.analysis.regulator.lqr import lqr
from satsym.auditing.predicates import Finding, predicate
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 23
_TRIES = 20
_EXAMPLE = systems.system([[0.0, 1.0], [-0.5, 0.2]], [[0.0], [1.0]])


@predicate
def weights_are_free() -> Finding:
    """Whether there are weights that minimise the cost: half the weights give half the cost, and the same control."""
    start, shares = np.array([1.0, -0.5]), (1.0, 0.5, 0.25)
    designs = [lqr(_EXAMPLE, share * np.eye(2), share * np.eye(1)) for share in shares]
    costs = [design.cost(start) for design in designs]
    falls = costs[0] > costs[1] > costs[2] > 0.0
    same = all(np.allclose(design.K, designs[0].K) for design in designs)
    return Finding(
        not (falls and same),
        f"with weights 1, 1/2 and 1/4 the least cost is {', '.join(f'{cost:.3g}' for cost in costs)}, and so on down",
        {"same gain": same},
        remark="weights are chosen by what is wanted; it is the control that minimises J",
    )


@predicate
def weights_allowed(Q: tuple[float, ...], R: tuple[float, ...]) -> Finding:
    """Whether weights are such that the regulator's theory holds: Q positive semidefinite, R positive definite."""
    low = min(Q), min(R)
    return Finding(low[0] >= 0.0 and low[1] > 0.0, f"the smallest weights are {low[0]:g} and {low[1]:g}", {})


@predicate
def smaller_weights() -> Finding:
    """Whether smaller weights give a smaller least cost; with the control, that is another matter."""
    rng, smaller, same = np.random.default_rng(_SEED), 0, 0
    for _ in range(_TRIES):
        Q, R, start = rng.uniform(0.5, 2.0, 2), rng.uniform(0.5, 2.0, 1), rng.normal(size=2)
        less = Q * rng.uniform(0.2, 1.0, 2), R * rng.uniform(0.2, 1.0, 1)
        one, other, half = (lqr(_EXAMPLE, np.diag(q), np.diag(r)) for q, r in ((Q, R), less, (Q / 2.0, R / 2.0)))
        smaller += other.cost(start) < one.cost(start)
        same += bool(np.allclose(half.K, one.K))
    return Finding(
        smaller == _TRIES,
        f"the number J falls in {smaller} of {_TRIES} cases; where all weights are halved the motion is the same",
        {"cases": _TRIES, "same gain after halving": same},
    )


@predicate
def symmetric_suffices() -> Finding:
    """Whether a symmetric Q always leaves the cost a minimum: x' = u with Q = [-1], R = [1], u = -k x, from x = 1."""
    from scipy.linalg import solve_continuous_lyapunov

    gains = (0.1, 0.01, 0.001)
    costs = [float(solve_continuous_lyapunov([[-k]], [[1.0 - k**2]])[0, 0]) for k in gains]
    falls = costs[2] < 5.0 * costs[1] < 25.0 * costs[0] < 0.0
    return Finding(
        not falls,
        f"Q = [-1] is symmetric, but for x' = u, u = -k x with k = {', '.join(f'{k:g}' for k in gains)} the cost is "
        f"{', '.join(f'{cost:.3g}' for cost in costs)}: it has no minimum",
        {f"cost with k = {k:g}": cost for k, cost in zip(gains, costs, strict=True)},
        remark="Q must be positive semidefinite, too",
    )


@predicate
def riccati_kind(claim: str) -> Finding:
    """Whether -P' = A'P + PA + Q - P B R^-1 B'P is ``algebraic``, or ``linear`` in P."""
    rng = np.random.default_rng(_SEED)
    a, b, zero = _EXAMPLE.A, _EXAMPLE.B, np.zeros((2, 2))

    def rate(p: np.ndarray) -> np.ndarray:
        return np.asarray(a.T @ p + p @ a + np.eye(2) - p @ b @ b.T @ p)

    if claim == "linear":
        one, other = (m + m.T for m in (rng.normal(size=(2, 2)), rng.normal(size=(2, 2))))
        gap = float(np.abs(rate(one + other) - rate(one) - rate(other) + rate(zero)).max())
        return Finding(
            gap < 1e-9,
            f"for two matrices the values do not add up, by {gap:.2g}: the last term is quadratic in P",
            {"gap": gap},
        )
    if claim == "algebraic":
        first, second = (lqr(_EXAMPLE, np.eye(2), np.eye(1), horizon=span).P for span in (0.5, 1.0))
        change = float(np.abs(second - first).max())
        return Finding(
            change < 1e-9,
            f"with P' it is the differential equation: its solution differs by {change:.2g} between 0.5 and 1 before "
            "the end",
            {"change": change},
            remark="algebraic it is for a constant P, where the left-hand side is zero",
        )
    raise BadInput(f"riccati_kind: no claim {shown(claim)}; write algebraic or linear")


@predicate
def definite(word: str, except_zero: bool) -> Finding:
    """Whether a definition by x'Ax for every x, zero excepted or not, sorts matrices as their eigenvalues do."""
    if word not in ("definite", "semidefinite"):
        raise BadInput(f"definite: no word {shown(word)}; write definite or semidefinite")
    rng, agree = np.random.default_rng(_SEED), 0
    kinds = ([1.0, 2.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, -2.0])
    for eigenvalues in kinds:
        basis = np.linalg.qr(rng.normal(size=(2, 2)))[0]
        a = basis @ np.diag(eigenvalues) @ basis.T
        vectors = [*rng.normal(size=(200, 2)), *basis.T, *([] if except_zero else [np.zeros(2)])]
        values = [float(x @ a @ x) for x in vectors]
        met = min(values) > 1e-12 if word == "definite" else min(values) >= -1e-12
        agree += met == (min(eigenvalues) > 0.0 if word == "definite" else min(eigenvalues) >= 0.0)
    return Finding(
        agree == len(kinds),
        "for x = 0, x'Ax is 0, so that no matrix at all would be positive definite"
        if agree < len(kinds)
        else "as the eigenvalues say",
        {"kinds of matrices": len(kinds), "agree": agree},
        remark="it must say: for every x other than 0" if agree < len(kinds) else "",
    )
