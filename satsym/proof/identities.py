"""Check of a generated kernel: its laws and derivatives against its own motion and costs.

The problem is what ``dynamics``, ``running_cost`` and ``terminal_cost`` state. From these alone first and second
derivatives of H are computed (:mod:`satsym.proof.balls.jets`), at random points near the extremal, and compared with
the other functions of the kernel that the proof uses. Both sides are analytic functions, with the comparisons of the
arc answered as they are along it: two that differ anywhere differ at almost every point.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Answers, Ball, BeyondProof, NotProved, constant, value
from satsym.proof.balls.jets import OPAQUE, derivatives, variables
from satsym.proof.laws import AtLevels, Law, Regular, Throttled, hamiltonian, norms
from satsym.proof.laws import derivatives as partials
from satsym.proof.statement import Statement
from satsym.proof.walls import OnBoundary, OnMixed, Pushed

POINTS = 3
SEED = 20260
SPREAD = 0.03
"""Distance of the random test points from the extremal, relative to the magnitudes of the components."""
KEPT = 0.6
"""Fraction of the working precision, in bits, to which equal numbers must agree, relative to their magnitudes."""


def verify(statement: Statement, law: Law, nodes: Sequence[Sequence[Ball]], sizes: Sequence[float]) -> None:
    """Check all functions of a kernel that are used along an arc against its motion and costs.

    Raises
    ------
    NotProved
        If something differs.
    BeyondProof
        If H depends on the controls in a way that is not recognised.
    """
    drawn = random.Random(SEED)
    for _ in range(POINTS):
        node = drawn.choice(list(nodes))
        z = [arb(float(v.mid()) + SPREAD * s * drawn.uniform(-1, 1)) for v, s in zip(node, sizes, strict=False)]
        ctx.cap = 1
        point = _Point(statement, law, z, drawn)
        point.motion()
        point.jacobian()
        if isinstance(law, OnBoundary):
            point.boundary()
        elif isinstance(law, OnMixed):
            point.mixed()
        elif isinstance(law, AtLevels):
            point.switching()
        elif isinstance(law, Throttled):
            point.throttle()
        else:
            assert isinstance(law, Regular)
            _SETS[law.kernel.spec.control_set or ""](point)


class _Point:
    """A random point at which a kernel is checked."""

    def __init__(self, statement: Statement, law: Law, z: list[Ball], drawn: random.Random) -> None:
        self.statement, self.law, self.z, self.drawn = statement, law, z, drawn
        self.n, self.p, self.kernel = law.n, law.p, law.kernel
        self.series = [constant(v) for v in z]
        self.t, self.x, self.lam = law.parts(self.series)
        self.u = [constant(value(v)) for v in law.control(self.series)]

    def by_controls(self, u: Sequence[Any]) -> tuple[Ball, list[Ball], list[list[Ball]]]:
        """Return H, H_u and H_uu at other controls."""
        given = variables([value(v) for v in u])
        return self.elsewhere(
            lambda: derivatives(lambda: hamiltonian(self.kernel, self.t, self.x, given, self.lam, self.p), len(given))
        )

    def elsewhere(self, evaluate: Callable[[], Any]) -> Any:
        """Evaluate at another point, with comparisons answered as they come out there."""
        before, self.kernel.answers = self.kernel.answers, Answers()
        try:
            return evaluate()
        finally:
            self.kernel.answers = before

    def at(self, *u: Ball) -> Ball:
        """Return H at other controls."""
        return self.by_controls([constant(v) for v in u])[0]

    def random_controls(self) -> list[Any]:
        return [constant(arb(self.drawn.uniform(-2, 2))) for _ in self.u]

    def equal(self, a: Sequence[Any], b: Sequence[Any], what: str) -> None:
        a, b = [value(v) for v in a], [value(v) for v in b]
        size = max((float(abs(v).mid()) for v in (*a, *b)), default=1.0)
        if not all(abs(v - w) <= _agreed() * max(size, 1e-30) for v, w in zip(a, b, strict=True)):
            raise NotProved(f"the generated module contradicts its own motion and costs: {what}")

    def motion(self) -> None:
        """Check that rates are (f, -H_x) under the law's controls."""
        states = variables([value(v) for v in self.x])
        answers = self.kernel.answers

        def along() -> Any:
            return derivatives(lambda: hamiltonian(self.kernel, self.t, states, self.u, self.lam, self.p), self.n)

        _, h_x, _ = self.elsewhere(along)
        self.kernel.answers = answers
        found = self.law.rates(self.series)
        self.equal(found[: self.n], self.kernel.dynamics(self.t, self.x, self.u, self.p), "rates of the states")
        wanted = [-v for v in h_x]
        if isinstance(self.law, Pushed):
            push, slope = value(self.law.multiplier(self.series)), self.law.gradient(self.series)
            wanted = [v - push * value(s) for v, s in zip(wanted, slope, strict=True)]
        self.equal(found[self.n : 2 * self.n], wanted, "rates of the costates")

    def jacobian(self) -> None:
        """Check the derivatives of the rates."""
        m = self.law.m
        found = self.law.jacobian(self.series)
        rates = partials(self.law.rates, self.z)
        ctx.cap = 1
        for i, row in enumerate(rates):
            self.equal(found[i * m : i * m + m], row, "derivatives of the rates")

    def boundary(self) -> None:
        """Check that motions on the boundary, with H_u = 0 along it, stay there; the point is moved there."""
        law = self.law
        assert isinstance(law, OnBoundary)
        n, none = self.n, [constant(0) for _ in self.u]
        states = variables([value(v) for v in self.x])
        level = derivatives(
            lambda: self.kernel.path_constraints(self.t, states, none, self.p, ())[law.which] + constant(0), n
        )
        self.equal(level[1], law.slope, "the gradient of a path constraint")
        rows = partials(
            law.vanishing, self.z
        )  # what vanishes is linear, or the point is not there and all of this fails
        d = arb_mat(len(rows), len(self.z), [v for row in rows for v in row])
        ctx.cap = 1
        off = arb_mat(len(rows), 1, [value(v) for v in law.vanishing(self.series)])
        moved = (d.transpose() * (d * d.transpose()).inv() * off).entries()
        there = _Point(self.statement, law, [a - b for a, b in zip(self.z, moved, strict=True)], self.drawn)
        there.motion()
        rates = [value(v) for v in law.rates(there.series)]
        ctx.cap = 2
        along = law.vanishing([arb_series([v, rate]) for v, rate in zip(there.z, rates, strict=True)])
        ctx.cap = 1
        for v in along:
            there.equal([v[0] + 1, v[1] + 1], [arb(1), arb(1)], "a boundary arc stays on its boundary")
        slopes, _ = there.quadratic()
        there.vanishing(slopes)

    def mixed(self) -> None:
        """Check that the control is on the boundary, which limits it by the states, and that H falls across it."""
        law = self.law
        assert isinstance(law, OnMixed)
        k, n = law.which, self.n

        def level(x: Sequence[Any], u: Sequence[Any]) -> Any:
            return self.kernel.path_constraints(self.t, x, u, self.p, ())[k] + constant(0)

        states, controls = variables([value(v) for v in self.x]), variables([value(v) for v in self.u])
        at, slope, _ = derivatives(lambda: level(states, self.u), n)
        self.equal([at + 1], [arb(1)], "a boundary arc is on its boundary")
        self.equal(law.gradient(self.series), slope, "the gradient of a path constraint")
        _, (effect,), _ = derivatives(lambda: level(self.x, controls), 1)
        try:
            (stated,) = (value(v) for v in self.kernel.path_effect(self.t, self.x, [OPAQUE], self.p)[k : k + 1])
        except TypeError:
            raise BeyondProof("a path constraint that is not linear in the control") from None
        self.equal([stated], [effect], "how a path constraint depends on the control")
        (push,), _ = self.quadratic()
        self.equal([push + value(law.multiplier(self.series)) * effect + 1], [arb(1)], "the multiplier of a boundary")

    def switching(self) -> None:
        """Check that H is linear in controls and magnitudes, by switching functions and weights."""
        slopes = self.kernel.switching_function(self.t, self.x, self.lam, self.p)
        weights = self.kernel.magnitude_weight(self.t, self.x, self.lam, self.p)
        zero = self.by_controls([constant(arb("1e-60")) for _ in self.u])[0]
        for _ in range(2):
            u = self.random_controls()
            total = zero
            for v, slope, weight in zip(u, slopes, weights, strict=True):
                total += value(slope) * value(v) + value(weight) * abs(value(v))
            self.equal([self.by_controls(u)[0]], [total], "H by the controls")

    def throttle(self) -> None:
        """Check that H is linear in a vector and its norm, and that the law is its best direction at a norm limit."""
        m, none = len(self.u), arb("1e-60")
        zero = self.at(*[none] * m)
        ways = [[arb(int(i == j)) if i == j else none for j in range(m)] for i in range(m)]
        pairs = [(self.at(*way), self.at(*(-v if v == 1 else v for v in way))) for way in ways]
        a = [(v - w) / 2 for v, w in pairs]
        q = (pairs[0][0] + pairs[0][1]) / 2 - zero
        for _ in range(2):
            u = [value(v) for v in self.random_controls()]
            norm = sum((v * v for v in u), arb(0)).sqrt()
            self.equal(
                [self.at(*u)], [sum((v * w for v, w in zip(a, u, strict=True)), zero + q * norm)], "H by the controls"
            )
        size = sum((v * v for v in a), arb(0)).sqrt()
        law = self.law
        assert isinstance(law, Throttled)
        slope = self.kernel.throttle_slope(self.t, self.x, self.lam, self.p, law.bounds)
        self.equal(slope, [q - size], "the slope of the throttle")
        least, largest = map(value, norms(law))
        best = [-(least if law.off else largest) * v / size for v in a]
        self.equal([value(v) + 1 for v in self.u], [v + 1 for v in best], "the controls")

    def quadratic(self) -> tuple[list[Ball], list[list[Ball]]]:
        """Return H_u under the law, and H_uu, which must not depend on the controls."""
        m, hessian = len(self.u), self.kernel.control_hessian
        try:
            stated = [value(v) for v in hessian(self.t, self.x, [OPAQUE] * m, self.lam, self.p)]
        except TypeError:
            raise BeyondProof("a Hamiltonian that is not quadratic in the controls") from None
        for u in (self.u, self.random_controls()):
            _, slopes, found = self.by_controls(u)
            self.equal([v for row in found for v in row], stated, "H_uu")
        _, slopes, found = self.by_controls(self.u)
        return slopes, found

    def conditions(self) -> list[Ball]:
        """Return the quantities that are positive along the arc, at this point."""
        return [value(v) for _, v in self.law.conditions(self.series)]

    def among(self, wanted: Ball, found: Sequence[Ball], what: str) -> None:
        """Check that a number that must be positive is among those that are shown to be."""
        size = max(abs(float(wanted.mid())), 1e-30)
        if not any(abs(wanted - v) <= _agreed() * size * 1e3 for v in found):
            raise NotProved(f"the kernel's law does not keep to {what}")

    def free(self) -> None:
        """Check that H_u vanishes at free controls."""
        slopes, _ = self.quadratic()
        self.vanishing(slopes)

    def vanishing(self, slopes: Sequence[Ball]) -> None:
        """Check that H_u vanishes, relative to its size elsewhere."""
        scale = [abs(v) + 1e-30 for v in self.by_controls(self.random_controls())[1]]
        self.equal([s / v + 1 for s, v in zip(slopes, scale, strict=True)], [arb(1)] * len(slopes), "H_u under the law")

    def box(self) -> None:
        """Check that H_u vanishes within bounds, or that H falls towards the active bound."""
        slopes, hessian = self.quadratic()
        m, shown = len(slopes), self.conditions()
        if any(hessian[i][j] != 0 for i in range(m) for j in range(m) if i != j):
            raise BeyondProof("bounded controls that H couples")
        lower, upper = self.statement.lower, self.statement.upper
        for i, u in enumerate(self.u):
            if not isinstance(lower[i], float) and value(u).overlaps(lower[i]):
                self.among(slopes[i] / hessian[i][i], shown, "the lower bound of a control")
            elif not isinstance(upper[i], float) and value(u).overlaps(upper[i]):
                self.among(-slopes[i] / hessian[i][i], shown, "the upper bound of a control")
            else:
                self.vanishing([slopes[i] if j == i else arb(0) for j in range(m)])
                if not isinstance(lower[i], float):
                    self.among(value(u) - lower[i], shown, "the lower bound of a control")
                if not isinstance(upper[i], float):
                    self.among(upper[i] - value(u), shown, "the upper bound of a control")

    def ball(self) -> None:
        """Check that H_u vanishes within the ball, or that H falls outwards on its sphere."""
        slopes, hessian = self.quadratic()
        m, c = len(slopes), hessian[0][0]
        for i in range(m):
            for j in range(m):
                if not (hessian[i][j] - (c if i == j else 0)).contains(0):
                    raise BeyondProof("controls within a ball whose weights differ")
        assert isinstance(self.law, Regular)
        (radius,) = self.law.bounds
        if isinstance(radius, float):
            return self.vanishing(slopes)
        r, shown = value(radius), self.conditions()
        norm = sum((value(v) * value(v) for v in self.u), arb(0))
        if (norm - r * r).contains(0):
            pull = -sum((s * value(v) for s, v in zip(slopes, self.u, strict=True)), arb(0)) / (r * r)
            self.equal(
                [s + pull * value(v) + c for s, v in zip(slopes, self.u, strict=True)], [c] * m, "H_u on the ball"
            )
            farther = r * (pull / c + 1)  # the norm without the bound
            return self.among(farther * farther - r * r, shown, "the ball of the controls")
        self.vanishing(slopes)
        return self.among(r * r - norm, shown, "the ball of the controls")

    def directed(self) -> None:
        """Check that the controls are a direction, by its angle or as a vector."""
        (part,) = self.kernel.spec.control_parts
        if part.kind == "angle":
            self.angle()
        else:
            self.steered()

    def steered(self) -> None:
        """Check that H is linear in a vector of bounded norm, and that the law is the largest against its slope."""
        m = len(self.u)
        middle, slopes, bends = self.by_controls([constant(0)] * m)
        for row in bends:
            self.equal([v + 1 for v in row], [arb(1)] * m, "H by the controls")
        for _ in range(2):
            u = [value(v) for v in self.random_controls()]
            total = sum((a * v for a, v in zip(slopes, u, strict=True)), middle)
            self.equal([self.at(*u)], [total], "H by the controls")
        size = sum((a * a for a in slopes), arb(0))
        assert isinstance(self.law, Regular)
        largest = value(norms(self.law)[1])
        best = [-largest * a / size.sqrt() for a in slopes]
        self.equal([value(v) + largest for v in self.u], [v + largest for v in best], "the controls")
        self.among(size, self.conditions(), "a direction that is determined")

    def angle(self) -> None:
        """Check that H is a multiple of the cosine of a direction, and that the law minimises it."""
        pi = arb.pi()
        ahead, behind = self.at(arb(0)), self.at(pi)
        mean, a = (ahead + behind) / 2, (ahead - behind) / 2
        b = (self.at(pi / 2) - self.at(-pi / 2)) / 2
        for _ in range(3):
            (v,) = (value(v) for v in self.random_controls())
            self.equal([self.at(v)], [mean + a * v.cos() + b * v.sin()], "H by the direction")
        self.equal([self.at(value(self.u[0]))], [mean - (a * a + b * b).sqrt()], "H under the law")
        self.among(a * a + b * b, self.conditions(), "a direction that is determined")


def _agreed() -> Ball:
    return arb(2) ** -int(KEPT * ctx.prec)


_SETS: dict[str, Callable[[_Point], None]] = {
    "free": _Point.free,
    "box": _Point.box,
    "ball": _Point.ball,
    "product": _Point.directed,
}
