"""A switching extremal, integrated again from its initial costates: the exact law, with its own switches.

Where the law switches is found from the signs of the switching functions, not taken from the solver; SciPy's DOP853
integrates, which the solver does not use. Only where singular arcs begin and end, which no sign shows, is the solver's.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solve.certificate.flow import typical
from satsym.solve.certificate.stated_arcs import Stated, arcs, undecided
from satsym.solve.switching.field import Field
from satsym.solve.switching.newton import switching
from satsym.solve.switching.recognition import levels as best_levels
from satsym.solve.switching.structure import REST, SINGULAR

Array = NDArray[np.floating[Any]]

TOLERANCE = 5e-14
MOST_SWITCHES = 200
POLISHED = 6
"""Newton steps to the time of a switch."""

TOUCHING = 1e-4
"""A change of sign so shortly before a singular arc, as a share of the arc before it, is where its zero is touched."""


@dataclass(frozen=True, eq=False)
class Piece:
    """An arc of the replay.

    Attributes
    ----------
    field
        Its equations, with the levels of the controls.
    start, end
        Times.
    before, after
        States and costates there, shape (2n,).
    switched
        The control whose switch ends it; ``None`` at the final time.
    transition
        Derivatives of ``after`` by ``before``, shape (2n, 2n).
    """

    field: Field
    start: float
    end: float
    before: Array
    after: Array
    switched: int | None
    transition: Array


@dataclass(frozen=True, eq=False)
class Replay:
    """The extremal again.

    Attributes
    ----------
    pieces
        Its arcs.
    times, z, u
        The solver's nodes, and the ends of the arcs: shapes (K,), (2n, K), (m, K).
    cost
        Of the motion, the terminal cost included.
    """

    pieces: list[Piece]
    times: Array
    z: Array
    u: Array
    cost: float

    def switching_times(self, control: int) -> list[float]:
        """Of one control."""
        return [piece.end for piece in self.pieces if piece.switched == control]


def replay(solution: Solution) -> Replay | None:
    """Integrate again; ``None`` where the motion is not finite or switches without end."""
    instance = solution.instance
    sizes = np.concatenate(typical(solution))
    z, t, end = np.concatenate([instance.initial, solution.lam[:, 0]]), instance.t0, float(solution.times[-1])
    stated = [arcs(solution, control) for control in range(len(instance.lower))]
    # the controls whose switches no sign shows: the solver's stand
    settled = [all(k != SINGULAR for *_, k in stated[i]) and undecided(solution, i) for i in range(len(stated))]
    levels = _first_levels(instance, stated, settled, z, t, end)
    stations = np.unique(solution.times)
    pieces: list[Piece] = []
    rows: list[tuple[Array, Array, Array]] = []
    cost = 0.0
    try:
        while len(pieces) <= MOST_SWITCHES:
            field = Field(instance, levels)
            piece, levels = _piece(stated, settled, field, t, end, z, sizes)
            pieces.append(piece)
            row, added = _stations(piece, stations, sizes)
            rows.append(row)
            t, z, cost = piece.end, piece.after, cost + added
            if piece.switched is None:
                times, values, controls = (np.concatenate(part, axis=-1) for part in zip(*rows, strict=True))
                cost += float(instance.model.terminal_cost(t, z[: len(instance.initial)].tolist(), instance.parameters))
                return Replay(pieces, times, values, controls, cost)
    except (ArithmeticError, ValueError):
        return None
    return None


def _first_levels(
    instance: Instance, stated: Stated, settled: list[bool], z: Array, t: float, end: float
) -> tuple[int, ...]:
    """Levels at the start: where a switching function vanishes, its rate decides."""
    n, m = len(instance.initial), len(instance.lower)
    resting = Field(instance, (REST,) * m)
    found = []
    for i in range(m):
        if settled[i] or stated[i][0][2] == SINGULAR:
            found.append(stated[i][0][2])
            continue
        sigma, rate = switching(resting, t, z.tolist(), i)
        weight = float(instance.model.magnitude_weight(t, tuple(z[:n]), instance.parameters)[i])
        size = max(abs(sigma), weight, abs(rate) * (end - t))
        if min(abs(abs(sigma) - weight), abs(sigma)) <= 1e-10 * size:
            sigma += rate * 1e-6 * (end - t)
        found.append(int(best_levels(instance, i, np.array([sigma]), np.array([weight]))[0]))
    return tuple(found)


def _piece(
    stated: Stated, settled: list[bool], field: Field, start: float, end: float, z: Array, sizes: Array
) -> tuple[Piece, tuple[int, ...]]:
    """The arc from a time to the next switch, and the levels after it."""
    known = [
        (now[1], i, after[2])
        for i, row in enumerate(stated)
        for now, after in pairwise(row)
        if (settled[i] or SINGULAR in (now[2], after[2])) and now[1] > start + 1e-12 * (end - start)
    ]
    until, switched, level = min(known, default=(end, None, None))
    met = _first_switch(field, settled, start, until, z, sizes)
    touching = met is not None and met[1] == switched and until - met[0] < TOUCHING * (until - start)
    if met is not None and not touching:
        until, switched = met
        level = None
    after, transition = _integrated(field, start, until, z, sizes)
    piece = Piece(field, start, until, z, after, switched, transition)
    if switched is None:
        return piece, field.levels
    if level is None:
        sigma, rate = switching(field, until, after.tolist(), switched)
        ahead = sigma + rate * 1e-6 * (end - start)
        weight = field.weight(until, after.tolist(), switched)
        level = int(best_levels(field.instance, switched, np.array([ahead]), np.array([weight]))[0])
    return piece, (*field.levels[:switched], level, *field.levels[switched + 1 :])


def _first_switch(
    field: Field, settled: list[bool], start: float, end: float, z: Array, sizes: Array
) -> tuple[float, int] | None:
    """When, and of which control, the next change of sign is."""
    from scipy.integrate import solve_ivp

    span, n = end - start, field.n
    marks: list[tuple[int, float]] = []
    for i, level in enumerate(field.levels):
        if settled[i] or level == SINGULAR or field.instance.lower[i] == field.instance.upper[i]:
            continue
        weighs = field.weight(start, z.tolist(), i) > 0.0
        marks += [(i, side) for side in ((-1.0, 1.0) if weighs else (0.0,))]

    def gone(i: int, side: float, t: float, y: list[float]) -> tuple[float, float]:
        """How far a switching function is from a value at which it switches, and the rate of that."""
        sigma, rate = switching(field, t, y, i)
        if side == 0.0:
            return sigma, rate
        return sigma - side * field.weight(t, y, i), rate - side * field.weight_gradient(t, y, i)[1]

    def event(i: int, side: float) -> Any:
        now, rate = gone(i, side, start, z.tolist())
        size = max(float(np.abs(field.gradient(start, z.tolist(), i)) @ sizes), 1e-300)
        sign = np.sign(now) if abs(now) > 1e-9 * size else np.sign(rate)

        def value(t: float, y: Array) -> float:
            if t - start < 1e-9 * span:  # leaving the switch that began this arc
                return float(sign)
            sigma = field.model.switching_function(t, y[:n].tolist(), y[n:].tolist(), field.p)[i]
            return float(sigma - side * field.weight(t, y.tolist(), i) if side else sigma)

        value.terminal = True  # type: ignore[attr-defined]
        return value

    if not marks or span <= 0.0:
        return None
    found = solve_ivp(
        lambda t, y: field.rates(t, y.tolist()),
        (start, end),
        z,
        method="DOP853",
        rtol=TOLERANCE,
        atol=TOLERANCE * sizes,
        events=[event(i, side) for i, side in marks],
        max_step=span / 16.0,
    )
    if found.status != 1:
        if found.status < 0:
            raise ArithmeticError(found.message)
        return None
    which = next(k for k, times in enumerate(found.t_events) if len(times))
    (control, side), time = marks[which], float(found.t_events[which][0])
    for _ in range(POLISHED):  # SciPy finds events on an interpolant that is less accurate than its steps
        y, _ = _integrated(field, start, time, z, sizes, transition=False)
        value, rate = gone(control, side, time, y.tolist())
        if rate == 0.0 or abs(value) > abs(rate) * 1e-3 * span:
            break
        correction = value / rate
        time -= correction
        if abs(correction) <= 1e-15 * max(abs(time), span):
            break
    return (time, control) if time < end else None


def _integrated(
    field: Field, start: float, end: float, z: Array, sizes: Array, transition: bool = True
) -> tuple[Array, Array]:
    """States and costates at the end of a piece, and their derivatives by those at its start."""
    from scipy.integrate import solve_ivp

    rows = len(z)

    def rates(t: float, y: Array) -> Array:
        here = y[:rows].tolist()
        if not transition:
            return np.array(field.rates(t, here))
        matrix = field.jacobian(t, here) @ y[rows:].reshape(rows, rows)
        return np.concatenate([field.rates(t, here), matrix.ravel()])

    y, scale = z, sizes
    if transition:
        y = np.concatenate([z, np.eye(rows).ravel()])
        scale = np.concatenate([sizes, np.outer(sizes, 1.0 / sizes).ravel()])
    if end <= start:
        return z, np.eye(rows)
    found = solve_ivp(rates, (start, end), y, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * scale)
    if found.status != 0:
        raise ArithmeticError(found.message)
    last = found.y[:, -1]
    return last[:rows], last[rows:].reshape(rows, rows) if transition else np.zeros(0)


def _stations(piece: Piece, nodes: Array, sizes: Array) -> tuple[tuple[Array, Array, Array], float]:
    """The arc at its ends and at the nodes between, as SciPy interpolates its steps; and its running cost."""
    from scipy.integrate import solve_ivp

    field, rows = piece.field, len(piece.before)
    times = np.concatenate([[piece.start], nodes[(nodes > piece.start) & (nodes < piece.end)], [piece.end]])

    def rates(t: float, y: Array) -> list[float]:
        z = y[:rows].tolist()
        return [*field.rates(t, z), field.model.running_cost(t, z[: field.n], field.control(t, z), field.p)]

    z, cost = np.stack([piece.before, piece.after], axis=1)[:, [0] * (len(times) - 1) + [1]], 0.0
    if piece.end > piece.start:
        start, scale = np.append(piece.before, 0.0), np.append(sizes, sizes[: field.n] @ sizes[field.n :])
        ends = (piece.start, piece.end)
        found = solve_ivp(rates, ends, start, method="DOP853", t_eval=times, rtol=TOLERANCE, atol=TOLERANCE * scale)
        if found.status != 0:
            raise ArithmeticError(found.message)
        z[:, 1:-1], cost = found.y[:rows, 1:-1], float(found.y[rows, -1])
    return (times, z, field.along(times, z)[0]), cost
