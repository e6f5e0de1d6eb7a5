"""The second variation on singular arcs, by Goh's transformation: its variable is the integral of the control.

Where H is linear in the control, variations of the control have no cost of their own, and no quadratic form is positive
in them. Their integral y has one, the generalised Legendre-Clebsch expression, and y may jump, since pulses of the
control are limits of admissible variations: at the ends of a singular arc they also stand for shifts of its junctions.
If the form is positive in y, in its value at the end of each singular arc and in the times of the other switches, an
extremal with one control that is strictly within its bounds on singular arcs, jumps at their ends and has a strict sign
of its switching function elsewhere is a strict local minimum (Aronna, Bonnans, Dmitruk and Lotito, Quadratic order
conditions for bang-singular extremals, Numerical Algebra, Control and Optimization 2, 2012; beside boundary arcs of a
constraint of order one Aronna, Bonnans and Goh, Second order analysis of control-affine problems with scalar state
constraint, Mathematical Programming 160, 2016).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solvers.certificate.second_variation import Arc
from satsym.solvers.certificate.switching.integration import Integration, Span
from satsym.solvers.certificate.switching.replay import Replay
from satsym.solvers.switching.field import NUDGE, Field

FEWEST, STEPS = 6, 12
"""Minimum number of pieces of a singular arc on which variations of the control are constant, and number of classical
Runge-Kutta steps in each."""

SHIFT = 1e-4
"""Step of the finite difference of H_t with respect to time, as a fraction of the length of an arc."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SingularArc(Arc):
    """A singular arc. Its variations are the values of y at the ends of its pieces, and y beyond its end.

    Between them y is linear; at the start of the arc it jumps from zero, or from its value on the arc before if the
    same control is singular there, and at the end to the value beyond. The latter does not count if the same control is
    singular on the next arc, or if the motion ends and nothing depends on the states that a pulse moves then.
    """

    mixed: Array
    """Derivatives of H by the control and the states, shape (2 K + 1, n), in scaled units."""
    continues: bool
    """Whether the same control is singular on the arc before."""
    released: bool
    """Whether the value of y beyond the end of the arc counts, to which y jumps there."""

    @property
    def columns(self) -> int:
        """Return the number of control variations on the arc."""
        return self.pieces + (2 if self.released else 1)

    def added(self, form: Array, x: Array, length: Array, own: int, ties: list[Array]) -> Array:
        """Add the arc's contribution to a form, and return the variations of the states at its end."""
        (h, per), share, unit = self.widths, length / self.lasting, np.eye(len(form))

        def integrand(at: int, y: Array, w: Array) -> Array:
            outer = np.outer(share, self.slope[at] @ y) + np.outer(w, self.mixed[at] @ y)
            return np.asarray(y.T @ (self.restoring[at] @ y) / 2.0 + outer)

        x = self._pulsed(form, x, 0, unit[own] - (unit[own - 1] if self.continues else 0.0))
        for k in range(per * self.pieces):
            at = own + k // per
            w = (unit[at + 1] - unit[at]) / (h * per)
            middle, after = self.stepped(k, x, w[None], share)
            first, second, third = (integrand(2 * k + place, y, w) for place, y in enumerate((x, middle, after)))
            form += h / 6.0 * (first + 4.0 * second + third)
            x = after
        if not self.released:
            return x
        at = own + self.pieces
        return self._pulsed(form, x, -1, unit[at + 1] - unit[at])

    def _pulsed(self, form: Array, x: Array, place: int, pulse: Array) -> Array:
        """Add the contribution of a pulse of the control, and return the variations of the states after it."""
        jump = np.outer(self.push[place, :, 0], pulse)
        form += np.outer(pulse, self.mixed[place] @ (x + 0.5 * jump))
        return np.asarray(x + jump)


def groups(again: Replay) -> list[int]:
    """Return the index of the change of length in which each arc takes part.

    A junction with a singular arc moves by a pulse of the control, so that the arcs on both sides only share the change
    of their length as a whole.
    """
    kept = [piece.field.singular for piece in again.pieces]
    return np.cumsum([0, *(before == after for before, after in pairwise(kept))]).tolist()


def inside(again: Replay) -> float:
    """Return the minimum distance of controls on their singular arcs from their bounds, as a fraction of the range."""
    found = [np.inf]
    for piece in again.pieces:
        if (control := piece.field.singular) is not None:
            low, high = piece.field.instance.lower[control], piece.field.instance.upper[control]
            u = piece.field.along(*again.along(piece))[0][control]
            found.append(float(np.minimum(u - low, high - u).min() / (high - low)))
    return min(found)


def jumped(again: Replay) -> float:
    """Return the smallest jump of a control between a singular arc and the next or previous one, by its range."""
    found = [np.inf]
    for before, after in pairwise(again.pieces):
        if before.field.singular == after.field.singular:
            continue
        control = before.field.singular if before.field.singular is not None else after.field.singular
        assert control is not None
        u = [
            one.field.control(one.end if one is before else one.start, z.tolist())[control]
            for one, z in ((before, before.after), (after, after.before))
        ]
        instance = before.field.instance
        found.append(abs(u[1] - u[0]) / (instance.upper[control] - instance.lower[control]))
    return min(found)


def single(again: Replay) -> bool:
    """Return whether only one control has singular arcs, and no other control switches."""
    every = {piece.field.singular for piece in again.pieces} | {piece.switched for piece in again.pieces}
    return len(every - {None}) == 1


def arc(again: Replay, place: int, state: Array, cost: float, pieces: int, by: Integration) -> SingularArc:
    """Return the accessory problem of a singular arc, with all controls but for its variations as they are.

    Parameters
    ----------
    place
        Index of the arc.
    state, cost
        Units of states and time, shape (n + 1,), and of the cost.
    pieces
        Number of pieces over all arcs on which variations of singular controls are constant.
    by
        Integration of the arcs.
    """
    piece = again.pieces[place]
    field, n, lasting = piece.field, piece.field.n, piece.end - piece.start
    control = field.singular
    assert control is not None
    count = max(FEWEST, int(np.ceil(pieces * lasting / state[-1])))
    times = np.linspace(piece.start, piece.end, 2 * STEPS * count + 1)
    span = Span(field, piece.start, piece.end, piece.before)
    z = by.solved(lambda t, y: field.rates(t, y.tolist()), span, piece.before, by.sizes, t_eval=times).y
    u, rates = field.along(times, z)
    slopes: Array = np.zeros((len(times), 2 * n, 2 * n + 1))
    slopes[:, :, : 2 * n] = field.model.extremal_jacobian_batch(times, z[:n], u, z[n:], field.p).transpose(2, 0, 1)
    by_time: Array = np.zeros(len(times))
    twice, drifting = by_time, by_time
    if not field.model.spec.autonomous:
        slopes[:, :, 2 * n], by_time, drifting = _explicit(field, times, z, u)
        before, after = (_explicit(field, times + k * SHIFT * lasting, z, u)[1] for k in (-1.0, 1.0))
        twice = (after - before) / (2.0 * SHIFT * lasting)
    plain = Arc.of(times, slopes, rates, (by_time, twice), state, cost, 0)
    by_control, mixed = _of_control(field, times, z, u)
    reach = state[-1] * (field.instance.upper[control] - field.instance.lower[control])
    mixed = np.column_stack([mixed.T, drifting]) * state * reach / cost
    push = np.column_stack([by_control.T, np.zeros(len(times))]) / state * reach
    given = {one.name: getattr(plain, one.name) for one in fields(plain)} | {"pieces": count, "push": push[:, :, None]}
    kept = [None, *(one.field.singular for one in again.pieces), None]
    previous, following = kept[place], kept[place + 2]
    released = following != control and not (
        place + 1 == len(again.pieces) and _costs_nothing_at_end(field, times, z, u)
    )
    return SingularArc(**given, mixed=mixed, continues=previous == control, released=released)


def _costs_nothing_at_end(field: Field, times: Array, z: Array, u: Array) -> bool:
    """Return whether neither final conditions nor the terminal cost depend on the states that the control moves.

    The control's effect and the gradient of the terminal cost are looked at along a singular arc and at random states.
    """
    instance, model, n = field.instance, field.model, field.n
    if model.spec.multipliers or instance.end_limits:
        return False
    rng = np.random.default_rng(0)
    x = z[:n] + np.abs(z[:n]).max(axis=1, keepdims=True) * rng.uniform(-1.0, 1.0, z[:n].shape)
    columns = [_of_control(field, times, np.concatenate([at, z[n:]]), u)[0] for at in (z[:n], x)]
    moved = np.abs(columns).max(axis=(0, 2)) > 0.0
    if any(name in instance.final for name, one in zip(model.spec.state_names, moved, strict=True) if one):
        return False
    each = [*z[:n].T.tolist(), *x.T.tolist()]
    return not any(np.array(model.terminal_gradient(float(times[-1]), tuple(at), field.p))[moved].any() for at in each)


def _of_control(field: Field, times: Array, z: Array, u: Array) -> tuple[Array, Array]:
    """Return derivatives, by the singular control, of the rates of the states and of H_x, each of shape (n, N).

    The latter are averaged over both signs of the control, so that a weight of its magnitude cancels.
    """
    n, x, lam = field.n, z[: field.n], z[field.n :]
    columns = np.broadcast_to(field.model.jacobian_u_batch(times, x, u, field.p), (n, len(u), len(times)))
    unit = np.zeros_like(u)
    unit[field.singular] = 1.0
    there, back = (field.model.costate_rate_batch(times, x, side * unit, lam, field.p) for side in (1.0, -1.0))
    return np.array(columns[:, field.singular]), np.broadcast_to((back - there) / 2.0, x.shape)


def _explicit(field: Field, times: Array, z: Array, u: Array) -> tuple[Array, Array, Array]:
    """Return derivatives by explicit time, with given controls, of all rates, of H and of the switching function.

    Returns
    -------
    Arrays of shapes (N, 2n), (N,) and (N,).
    """
    ahead, shape = times + 1j * NUDGE, (len(times),)
    x, lam, v = z[: field.n].astype(complex), z[field.n :].astype(complex), u.astype(complex)
    f = np.broadcast_to(field.model.dynamics_batch(ahead, x, v, field.p), x.shape)
    g = np.broadcast_to(field.model.costate_rate_batch(ahead, x, v, lam, field.p), x.shape)
    h = np.broadcast_to(field.model.hamiltonian_batch(ahead, x, v, lam, field.p), shape)
    sigma = np.broadcast_to(field.model.switching_function_batch(ahead, x, lam, field.p)[field.singular], shape)
    return np.concatenate([f, g]).imag.T / NUDGE, h.imag / NUDGE, sigma.imag / NUDGE
