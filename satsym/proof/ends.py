"""The conditions at the final time and the second derivatives there, from the terminal cost and the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, constant, value
from satsym.proof.balls.jets import derivatives, variables
from satsym.proof.balls.taylor import Matrix, rates
from satsym.proof.laws import Law
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
    terminal
        Value, gradient and Hessian of the terminal cost by the states and time.
    """

    statement: Statement
    law: Law
    z: Sequence[Ball]
    time: Ball
    terminal: tuple[Ball, list[Ball], list[list[Ball]]]

    @classmethod
    def at(cls, statement: Statement, law: Law, z: Sequence[Ball], time: Ball) -> End:
        """The end of a chain of arcs whose last law and final components are these."""
        n, kernel = law.n, statement.kernel
        given = variables([*z[:n], time])
        terminal = derivatives(lambda: kernel.terminal_cost(given[n], given[:n], statement.p), n + 1)
        return cls(statement, law, z, time, terminal)

    def residuals(self) -> tuple[list[Ball], Matrix]:
        """What vanishes at the end, and its derivatives by the components and by the final time.

        There is a row for each state, and where the final time is free one for it.
        """
        n, m, free = self.law.n, self.law.m, self.statement.tf is None
        rows, found = n + free, []
        jac = arb_mat(rows, m + 1)
        (_, s, ss), lam = self.terminal, self.z[n : 2 * n]
        for i in range(n):
            target = self.statement.targets.get(i)
            if target is None:
                found.append(lam[i] - s[i])
                jac[i, n + i] = 1
                for j in range(n):
                    jac[i, j] = -ss[i][j]
                jac[i, m] = -ss[i][n]
            else:
                goal, speed, _ = self.goal(i)
                found.append(self.z[i] - goal)
                jac[i, i], jac[i, m] = 1, -speed
        if free:
            found.append(self._of_time(jac))
        return found, jac

    def goal(self, i: int) -> tuple[Ball, Ball, Ball]:
        """Where a state that is not free must be, with its rate and its second rate by the final time."""
        target = self.statement.targets[i]
        if target.value is not None:
            return target.value + 2 * (target.turns or 0) * arb.pi(), arb(0), arb(0)
        (t,) = variables([self.time])
        place, (speed,), ((bend,),) = derivatives(lambda: self.statement.kernel.reference(t, self.statement.p)[i], 1)
        return place, speed, bend

    def _of_time(self, jac: Matrix) -> Ball:
        """H + S_t + (S_x - lambda)' c' over the states on the reference; its derivatives into the last row."""
        n, m = self.law.n, self.law.m
        (_, s, ss), lam = self.terminal, self.z[n : 2 * n]
        ctx.cap = 1
        total = value(self.law.hamiltonian([arb_series([v]) for v in self.z])) + s[n]
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
        for j, v in enumerate([*row, by_time]):
            jac[n, j] = v
        return total

    def hamiltonian_by_time(self) -> Ball:
        """The derivative of H by time, with the controls of the law."""
        law = self.law
        if not law.timed:
            return arb(0)
        t, x, lam = law.parts([constant(v) for v in self.z])
        ctx.cap = 1
        u = [constant(value(v)) for v in law.control([arb_series([v]) for v in self.z])]
        ctx.cap = 2
        moving = arb_series([value(t), 1])
        total = law.kernel.running_cost(moving, x, u, law.p) + constant(0)
        for a, b in zip(lam, law.kernel.dynamics(moving, x, u, law.p), strict=True):
            total = a * b + total
        return total[1]

    def second_variation(self, w: Matrix) -> Matrix:
        """The form that must be positive on what the end leaves free: final states, then the final time.

        It is the Hessian of the terminal cost less the value function of the field, whose second derivatives by the
        states are W, over the ends that the problem admits.
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
        return rows * full * rows.transpose()


def positive(form: Matrix) -> bool:
    """Whether a symmetric ball matrix is positive definite, by the pivots of its elimination."""
    n = form.nrows()
    a: Any = [[form[i, j] for j in range(n)] for i in range(n)]
    for k in range(n):
        if not a[k][k] > 0:
            return False
        for i in range(k + 1, n):
            for j in range(k + 1, n):
                a[i][j] -= a[i][k] * a[k][j] / a[k][k]
    return True
