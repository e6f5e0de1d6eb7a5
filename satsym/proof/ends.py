"""The conditions at the final time, with second derivatives, from the terminal cost and the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, NotProved, constant, value
from satsym.proof.balls.jets import derivatives, variables
from satsym.proof.balls.taylor import Matrix, rates
from satsym.proof.laws import Law, hamiltonian
from satsym.proof.statement import Statement


@dataclass(frozen=True)
class End:
    """The final point of an extremal, over a ball.

    Attributes
    ----------
    law
        The law of the last arc.
    z, time
        The final components and the final time.
    nu
        The multipliers of the constraints at the end that hold with equality.
    terminal
        Value, gradient and Hessian by the states and time of the terminal cost, with the constraints times their
        multipliers.
    constraints
        Values and gradients of all constraints at the end.
    """

    statement: Statement
    law: Law
    z: Sequence[Ball]
    time: Ball
    nu: Sequence[Ball]
    terminal: tuple[Ball, list[Ball], list[list[Ball]]]
    constraints: list[tuple[Ball, list[Ball]]]

    @classmethod
    def at(cls, statement: Statement, law: Law, z: Sequence[Ball], time: Ball, nu: Sequence[Ball]) -> End:
        """Return the end of a chain of arcs from its last law, final components and multipliers."""
        n, kernel, p = law.n, statement.kernel, statement.p
        given = variables([*z[:n], time])
        psi = kernel.terminal_constraints(given[n], given[:n], p) if statement.spec.multipliers else ()

        def weighted() -> Any:
            total = kernel.terminal_cost(given[n], given[:n], p)
            for k, v in zip(statement.active, nu, strict=True):
                total = psi[k] * constant(v) + total
            return total

        constraints = [derivatives(lambda one=one: one, n + 1)[:2] for one in psi]
        return cls(statement, law, z, time, nu, derivatives(weighted, n + 1), constraints)

    @property
    def ties(self) -> list[tuple[Ball, list[Ball]]]:
        """Return values and gradients of the constraints that hold with equality."""
        return [self.constraints[k] for k in self.statement.active]

    def residuals(self) -> tuple[list[Ball], Matrix]:
        """Return the residuals at the end, with derivatives by components, final time and multipliers.

        There is a row for each state, for each constraint, and one for a free final time.
        """
        n, m, free, ties = self.law.n, self.law.m, self.statement.tf is None, self.ties
        found: list[Ball] = []
        jac = arb_mat(n + len(ties) + free, m + 1 + len(ties))
        (_, s, ss), lam = self.terminal, self.z[n : 2 * n]
        for i in range(n):
            target = self.statement.targets.get(i)
            if target is None:
                found.append(lam[i] - s[i])
                jac[i, n + i] = 1
                for j in range(n):
                    jac[i, j] = -ss[i][j]
                jac[i, m] = -ss[i][n]
                for k, (_, slopes) in enumerate(ties, m + 1):
                    jac[i, k] = -slopes[i]
            else:
                goal, speed, _ = self.goal(i)
                found.append(self.z[i] - goal)
                jac[i, i], jac[i, m] = 1, -speed
        for k, (level, slopes) in enumerate(ties, n):
            found.append(level)
            for j in range(n):
                jac[k, j] = slopes[j]
            jac[k, m] = slopes[n]
        if free:
            found.append(self._of_time(jac))
        return found, jac

    def goal(self, i: int) -> tuple[Ball, Ball, Ball]:
        """Return the target of a state that is not free, with its first and second rate by the final time."""
        target = self.statement.targets[i]
        if target.value is not None:
            return target.value + 2 * (target.turns or 0) * arb.pi(), arb(0), arb(0)
        (t,) = variables([self.time])
        place, (speed,), ((bend,),) = derivatives(lambda: self.statement.kernel.reference(t, self.statement.p)[i], 1)
        return place, speed, bend

    def _of_time(self, jac: Matrix) -> Ball:
        """Return H + S_t + (S_x - lambda)' c' over the states on the reference; store its derivatives in the last row.

        S includes the constraints, times their multipliers.
        """
        n, m, ties = self.law.n, self.law.m, self.ties
        (_, s, ss), lam = self.terminal, self.z[n : 2 * n]
        by_multiplier = [slopes[n] for _, slopes in ties]
        ctx.cap = 1
        here = [arb_series([v]) for v in self.z]
        t, x, costates = self.law.parts(here)
        total = value(hamiltonian(self.law.kernel, t, x, self.law.control(here), costates, self.law.p)) + s[n]
        moving = rates(self.law, self.z)
        row = [-v for v in moving[n : 2 * n]] + list(moving[:n]) + [arb(0)] * (m - 2 * n)  # dH = (-lambda', x')
        by_time = ss[n][n] + self.hamiltonian_by_time()
        for j in range(n):
            row[j] += ss[n][j]
        for i in self.statement.targets:
            _, speed, bend = self.goal(i)
            total += (s[i] - lam[i]) * speed
            for j in range(n):
                row[j] += ss[i][j] * speed
            row[n + i] -= speed
            by_time += ss[i][n] * speed + (s[i] - lam[i]) * bend
            by_multiplier = [v + slopes[i] * speed for v, (_, slopes) in zip(by_multiplier, ties, strict=True)]
        for j, v in enumerate([*row, by_time, *by_multiplier]):
            jac[n + len(ties), j] = v
        return total

    def hamiltonian_by_time(self) -> Ball:
        """Return the derivative of H by time, under the controls of the law."""
        law = self.law
        if not law.timed:
            return arb(0)
        t, x, lam = law.parts([constant(v) for v in self.z])
        ctx.cap = 1
        u = [constant(value(v)) for v in law.control([arb_series([v]) for v in self.z])]
        ctx.cap = 2
        return hamiltonian(law.kernel, arb_series([value(t), 1]), x, u, lam, law.p)[1]

    def second_variation(self, w: Matrix) -> Matrix:
        """Return the form on free final states and final time that must be positive.

        It is the Hessian of the terminal cost, with constraints times their multipliers, less the value function of the
        field, whose second derivatives by the states are W, over the tangents of the ends that the problem admits.

        Raises
        ------
        NotProved
            If the gradients of constraints are not shown to be independent on these.
        """
        n, free = self.law.n, self.statement.tf is None
        (_, s, ss), lam = self.terminal, self.z[n : 2 * n]
        open_states = [i for i in range(n) if i not in self.statement.targets]
        size = n + free
        full = arb_mat(size, size)
        for i in range(n):
            for j in range(n):
                full[i, j] = ss[i][j] - w[i, j]
        basis = [[arb(int(i == j)) for i in range(size)] for j in open_states]
        if free:
            moving = rates(self.law, self.z)
            f, h_x = moving[:n], [-v for v in moving[n : 2 * n]]
            wf = [sum((w[i, j] * f[j] for j in range(n)), arb(0)) for i in range(n)]
            for i in range(n):
                full[i, n] = full[n, i] = ss[i][n] + h_x[i] + wf[i]
            corner = ss[n][n] + self.hamiltonian_by_time()
            for i in range(n):
                corner -= f[i] * (h_x[i] + wf[i])
            along = [arb(0)] * n + [arb(1)]
            for i in self.statement.targets:
                _, along[i], bend = self.goal(i)
                corner += (s[i] - lam[i]) * bend
            full[n, n] = corner
            basis.append(along)
        rows = arb_mat(len(basis), size, [v for row in basis for v in row]) if basis else arb_mat(0, size)
        if self.ties:
            slopes = arb_mat(len(self.ties), size, [v for _, row in self.ties for v in row[:size]])
            rows = kernel_of(slopes * rows.transpose()) * rows
        return rows * full * rows.transpose()


def kernel_of(slopes: Matrix) -> Matrix:
    """Return rows that span the null space of a ball matrix, if its own rows are independent.

    Raises
    ------
    NotProved
        If that is not shown.
    """
    from scipy.linalg import qr

    count, size = slopes.nrows(), slopes.ncols()
    middle = np.array([[float(slopes[i, j].mid()) for j in range(size)] for i in range(count)]).reshape(count, size)
    middle /= np.maximum(np.abs(middle).max(axis=1, initial=0.0), 1e-300)[:, None]
    chosen = sorted(int(j) for j in qr(middle, mode="r", pivoting=True)[1][:count]) if count <= size else []
    others = [j for j in range(size) if j not in chosen]
    try:
        if not chosen:
            raise ZeroDivisionError
        block = arb_mat(count, count, [slopes[i, j] for i in range(count) for j in chosen])
        rest = arb_mat(count, len(others), [slopes[i, j] for i in range(count) for j in others])
        solved = block.inv() * rest
    except ZeroDivisionError:
        raise NotProved("the gradients of the terminal constraints could not be shown to be independent") from None
    found = arb_mat(len(others), size)
    for row, j in enumerate(others):
        found[row, j] = 1
        for k, i in enumerate(chosen):
            found[row, i] = -solved[k, row]
    return found


def positive(form: Matrix) -> bool:
    """Tell whether a symmetric ball matrix is positive definite, by the pivots of its elimination."""
    n = form.nrows()
    a: Any = [[form[i, j] for j in range(n)] for i in range(n)]
    for k in range(n):
        if not a[k][k] > 0:
            return False
        for i in range(k + 1, n):
            for j in range(k + 1, n):
                a[i][j] -= a[i][k] * a[k][j] / a[k][k]
    return True
