"""The second-order condition: a field of extremals about the one that was found has no focal point.

The field starts from a symmetric matrix W(t0) of one's choice, Lambda = W X with X = 1. Where X stays regular on the
closed interval, with a determinant that keeps its sign where controls jump, the costates of the field are the gradient
of a solution of Hamilton-Jacobi's equation near the extremal. At the end of each segment W is replaced by an exact
matrix that is larger: solutions of Riccati's equation keep their order, for H is concave in the costates, so that what
is shown for the larger one holds for the field as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from flint import arb, arb_mat

from satsym.proof.balls.arithmetic import Ball, NotProved
from satsym.proof.balls.taylor import Matrix, Step, rates, unit
from satsym.proof.ends import positive
from satsym.proof.laws import AtLevels, Law, Throttled, gradient
from satsym.proof.shooting import Carried, Pass, Segment, Shooting

DEEPEST = 10
"""Largest number of times that a step is halved to show that X is regular on it; otherwise the proof fails."""


class _FormNotPositive(NotProved):
    """The field is regular, but its quadratic form at the final time could not be shown to be positive."""


@dataclass(frozen=True)
class Regularity:
    """A field of extremals that was shown to be regular.

    Attributes
    ----------
    start
        How W(t0) was chosen; W_k is that of all extremals from the initial state, after k steps.
    pieces
        Into how many the interval fell, on each of which X was shown to be regular.
    ratios
        Ratios of the determinants of X after and before each jump of the controls; all are positive.
    """

    start: str
    pieces: int
    ratios: tuple[Ball, ...]


def regular_field(shooting: Shooting, passed: Pass) -> Regularity:
    """Find a regular field of extremals with a positive form at the end.

    Raises
    ------
    NotProved
        If no choice of W(t0) gives one.
    """
    failure = NotProved()
    for called, w in _starts(shooting, passed):
        for i in shooting.statement.free:
            w[i, i] = arb(0)  # so that V(t0, x) is the same for all of these
        try:
            return _followed(shooting, passed, w, called)
        except NotProved as error:
            if not isinstance(failure, _FormNotPositive):  # the first of these says most
                failure = error
    raise NotProved(str(failure))


def _followed(shooting: Shooting, passed: Pass, w: Matrix, called: str) -> Regularity:
    pieces, ratios, time = 0, [], shooting.statement.t0
    for j, (arc, segments) in enumerate(zip(shooting.arcs, passed.segments, strict=True)):
        if j:
            w, ratio = _across(shooting.arcs[j - 1].law, arc.law, passed.segments[j - 1][-1], w, time)
            ratios += [ratio] if ratio is not None else []
        for segment in segments:
            w, taken = _along(arc.law.n, segment, w, shooting.sizes, time)
            pieces += taken
            time += sum((step.h for step in segment.steps), arb(0))
    form = passed.end.second_variation(w)
    if form.nrows() and not positive(form):
        raise _FormNotPositive(
            "the second variation at the final time could not be shown to be positive (a focal point of the final "
            "conditions?)"
        )
    return Regularity(called, pieces, tuple(ratios))


def _along(n: int, segment: Segment, w: Matrix, sizes: Sequence[float], time: Ball) -> tuple[Matrix, int]:
    """Return W, or an exact matrix above it, at the end of a segment, and the number of pieces used."""
    m = segment.derivative.nrows()
    first = arb_mat(m, n, [*unit(n).entries(), *w.entries(), *[arb(0)] * (n * (m - 2 * n))])
    x, lam, pieces, carried = unit(n), w, 0, Carried.of([arb(0)] * m)
    for step in segment.steps:
        start = _ratio(x, lam)
        taken = _regular(step, start, _widths(start, sizes[:n]), 0.0, 1.0, DEEPEST)
        if not taken:
            raise NotProved(
                f"X of the field could not be shown to be regular near t = {_about(time)} (a conjugate point?)"
            )
        pieces, time = pieces + taken, time + step.h
        carried = carried.after(step.derivative(), [arb(0)] * m)
        there = carried.frame * (carried.flow * first)
        x, lam = _block(there, 0, 0, n), _block(there, n, 0, n)
    return _above(_ratio(x, lam), sizes[:n]), pieces


def _widths(w: Matrix, sizes: Sequence[float]) -> list[float]:
    """Return, for each state, how far it is displaced for the value function of the field to change by about one.

    A displacement is at most a fixed multiple of the size of its state.
    """
    entries = [abs(float(w[i, i].mid())) for i in range(w.nrows())]
    largest = max((e * s * s for e, s in zip(entries, sizes, strict=True)), default=0.0)
    return [max(e, 1e-9 * largest / (s * s), 1e-300) ** -0.5 for e, s in zip(entries, sizes, strict=True)]


def _ratio(x: Matrix, lam: Matrix) -> Matrix:
    """Return W = Lambda X^-1, which is symmetric."""
    try:
        w = lam * x.inv()
    except ZeroDivisionError:
        raise NotProved("X of the field could not be shown to be regular (a conjugate point?)") from None
    return (w + w.transpose()) * (arb(1) / 2)


def _above(w: Matrix, sizes: Sequence[float]) -> Matrix:
    """Return an exact symmetric matrix that exceeds all of a ball matrix, by a diagonal that dominates its radii."""
    n = w.nrows()
    found = w.mid()
    for i in range(n):
        found[i, i] += sum((w[i, j].rad() * (sizes[j] / sizes[i]) for j in range(n)), arb(0)) * 1.01 + arb(2) ** -400
    return found.mid()


def _regular(step: Step, w: Matrix, sizes: Sequence[float], low: float, high: float, depth: int) -> int:
    """Count the pieces of a step on each of which V_xx + V_xl W is regular; 0 where that is not shown."""
    n = w.nrows()
    v = step.derivative(arb(low).union(arb(high)) * step.h)
    x = _block(v, 0, 0, n) + _block(v, 0, n, n) * w
    try:
        near = x.mid().inv().mid() * x
        off = unit(n) - near
        if all(sum((abs(off[i, j]) * sizes[j] for j in range(n)), arb(0)) < sizes[i] for i in range(n)):
            return 1
        if not near.det().contains(0):
            return 1
    except ZeroDivisionError:
        pass
    if depth == 0:
        return 0
    middle = (low + high) / 2
    left = _regular(step, w, sizes, low, middle, depth - 1)
    right = _regular(step, w, sizes, middle, high, depth - 1) if left else 0
    return left + right if right else 0


def _across(law: Law, following: Law, segment: Segment, w: Matrix, time: Ball) -> tuple[Matrix, Ball | None]:
    """Return W after the end of an arc; where the motion jumps, X jumps, and keeps the sign of its determinant."""
    if not isinstance(law, AtLevels | Throttled):
        return w, None
    n = law.n
    there = segment.steps[-1].reached(segment.steps[-1].h)
    before, after = rates(law, there), rates(following, there)
    jump = [b - a for a, b in zip(before, after, strict=True)]
    slopes = gradient(law, law.leaving(following), there)
    speed = sum((g * v for g, v in zip(slopes, before, strict=True)), arb(0))
    if not speed < 0:
        raise NotProved("a switching function vanishes with zero slope")
    along = [
        slopes[j] + sum((slopes[n + i] * w[i, j] for i in range(n)), arb(0)) for j in range(n)
    ]  # of the condition by the field's states
    ratio = 1 + sum((a * v for a, v in zip(along, jump[:n], strict=True)), arb(0)) / speed
    if not ratio > 0:
        raise NotProved(f"det X of the field changes sign at the switch at t = {_about(time)} (a conjugate point?)")
    x = arb_mat(n, n, [jump[i] * along[j] / speed + int(i == j) for i in range(n) for j in range(n)])
    lam = arb_mat(n, n, [jump[n + i] * along[j] / speed + w[i, j] for i in range(n) for j in range(n)])
    return _ratio(x, lam), ratio


def _about(time: Ball) -> str:
    return str(time.mid().str(6, radius=False))


def _block(a: Matrix, i: int, j: int, n: int) -> Matrix:
    return arb_mat(n, n, [a[i + r, j + c] for r in range(n) for c in range(n)])


def _starts(shooting: Shooting, passed: Pass) -> Iterator[tuple[str, Matrix]]:
    """Return matrices W(t0) to try: any symmetric one is valid. Negative ones are safe, small ones keep digits."""
    n, sizes = shooting.arcs[0].law.n, shooting.sizes
    scale = [b / a for a, b in zip(sizes[:n], sizes[n : 2 * n], strict=True)]
    least = max(scale) * 1e-6
    yield from _later(shooting, passed)
    for kappa in (1.0, 10.0, 100.0, 1e3, 1e4, 0.1, 0.0):
        yield f"-{kappa:g} diag(lambda / x)", _diagonal([-kappa * max(v, least) for v in scale])


def _later(shooting: Shooting, passed: Pass) -> Iterator[tuple[str, Matrix]]:
    """Return diagonals of W, at later times, of the field of all extremals from admitted initial states."""
    free = shooting.statement.free
    n, flow = shooting.arcs[0].law.n, unit(shooting.arcs[0].law.m)
    jumping = isinstance(shooting.arcs[0].law, AtLevels | Throttled)
    reach = passed.segments[:1] if jumping else passed.segments
    steps = [step for segments in reach for segment in segments for step in segment.steps]
    wanted = {max(1, len(steps) // part) for part in (2, 4, 8, 16)}
    for k, step in enumerate(steps, 1):
        flow = (step.derivative().mid() * flow).mid()
        if k not in wanted:
            continue
        try:
            of = [i if i in free else n + i for i in range(n)]  # what differs at the start of all these extremals
            x, lam = (arb_mat(n, n, [flow[r + i, c] for i in range(n) for c in of]) for r in (0, n))
            w = lam * x.inv()
        except ZeroDivisionError:
            continue
        for kappa in (1, 8, 64):
            yield (
                f"-{kappa} |diag W(t_{k})|",
                _diagonal([-kappa * abs(float(w[i, i].mid())) for i in range(n)]),
            )


def _diagonal(entries: Sequence[float]) -> Matrix:
    n = len(entries)
    return arb_mat(n, n, [arb(entries[i]) if i == j else arb(0) for i in range(n) for j in range(n)])
