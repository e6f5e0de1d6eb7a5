"""Ephemerides: a motion about a central body in kilometres and seconds, in a frame of the sky, with its burns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from satsym import units
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.orbit import OrbitOptions
from satsym.report.display import length_unit
from satsym.report.plots import curves
from satsym.solution import Simulation, Solution
from satsym.status import BadInput

MU_TOLERANCE = 0.01
"""Largest relative difference between the gravitational parameters of the model and of the named body.

A larger difference is refused.
"""
FINEST = 2.0 * np.pi / 90.0
"""Largest central angle between two exported points, in rad, as readers such as STK require."""
COARSEST = 0.2
"""Largest central angle between two nodes for interpolation, in rad; the error is then 1e-9 of the distance."""
LATEST = 1e10
"""Largest time from the epoch in seconds, about three hundred years."""
IDLE = 1e-6
"""Fraction of the largest thrust below which thrust counts as zero."""


@dataclass(frozen=True)
class Burn:
    """A time interval with thrust.

    Attributes
    ----------
    start, end
        In seconds from the epoch.
    delta_v
        Integral of the thrust per unit mass, in km/s.
    largest
        Thrust per unit mass at most, in km/s**2.
    """

    start: float
    end: float
    delta_v: float
    largest: float


@dataclass(frozen=True, eq=False)
class Arc:
    """Points of a motion between two jumps of the thrust.

    Attributes
    ----------
    times
        Seconds from the epoch, rising, shape (N,).
    position, velocity, thrust
        In the frame: km, km/s and km/s**2, shape (3, N).
    """

    times: Array
    position: Array
    velocity: Array
    thrust: Array


@dataclass(frozen=True, eq=False)
class Ephemeris:
    """A motion in the sky, ready for export.

    Attributes
    ----------
    name, title
        Of the instance.
    orbit
        Where in the sky and when it takes place.
    arcs
        One after the other; each begins when and where the one before it ends.
    burns
        In order of time.
    reference
        Where the reference of the model is at the times of all arcs, in km, shape (3, M); ``None`` without one.
    """

    name: str
    title: str
    orbit: OrbitOptions
    arcs: tuple[Arc, ...]
    burns: tuple[Burn, ...]
    reference: Array | None

    @classmethod
    def of(cls, result: Solution | Simulation) -> Ephemeris:
        """Place a motion in the sky.

        Raises
        ------
        BadInput
            If that cannot be done; see :func:`~satsym.report.exchange.exported`.
        """
        instance = result.instance
        orbit = placed(instance)
        model, p, spec = instance.model, instance.parameters, instance.model.spec
        known = np.isfinite(result.x).all(axis=0) & np.isfinite(result.u).all(axis=0)
        times = np.asarray(result.times, dtype=float)[known]
        if len(times) < 2:
            raise BadInput(f"{instance.called}: there is no motion to export ({result.message or result.status.value})")
        x, u = result.x[:, known], result.u[:, known]
        length = units.in_base_units(_length_unit(instance)) / 1000.0
        second = units.in_base_units(units.time_unit(v.unit for v in (*spec.states, *spec.controls)))
        if np.abs(times).max() * second > LATEST:
            raise BadInput(
                f"{instance.called}: [time] tf: the time is too far from the epoch to be written as a date; export "
                "a shorter motion"
            )
        turn = _turn(orbit)
        state = np.asarray(model.inertial_state_batch(times, x, p), dtype=float)
        thrust = np.zeros((3, len(times)))
        if spec.controls:
            added = curves.thrust(model, times, x, u, p)
            thrust[: len(added)] = np.nan_to_num(added)
        whole = Arc(
            times * second,
            turn @ state[:3] * length,
            turn @ state[3:6] * length / second,
            turn @ thrust * length / second**2,
        )
        mu = np.broadcast_to(state[6], times.shape) * length**3 / second**2
        arcs = tuple(_filled(part, mu[where], instance) for part, where in _parts(whole))
        return cls(
            name=instance.name,
            title=instance.title or spec.title or instance.name,
            orbit=orbit,
            arcs=arcs,
            burns=tuple(_burns(whole)),
            reference=_reference(instance, arcs, turn, length, second),
        )

    @property
    def times(self) -> Array:
        """Return the times of all arcs, shape (M,); a time that separates two arcs occurs once."""
        return self._joined([arc.times for arc in self.arcs])

    @property
    def position(self) -> Array:
        """Return the positions at :attr:`times`, shape (3, M)."""
        return self._joined([arc.position for arc in self.arcs])

    @property
    def velocity(self) -> Array:
        """Return the velocities at :attr:`times`, shape (3, M)."""
        return self._joined([arc.velocity for arc in self.arcs])

    @property
    def thrust(self) -> Array:
        """Return the thrust at :attr:`times`, shape (3, M); where it jumps, the value before the jump."""
        return self._joined([arc.thrust for arc in self.arcs])

    @staticmethod
    def _joined(parts: list[Array]) -> Array:
        return np.concatenate([parts[0], *(part[..., 1:] for part in parts[1:])], axis=-1)

    def moment(self, seconds: float) -> datetime:
        """Convert a time of the motion to UTC, to the microsecond."""
        return self.orbit.epoch + timedelta(seconds=seconds)

    def utc(self, seconds: float) -> str:
        """Write a time of the motion in UTC as CCSDS does, to the nanosecond: 2026-03-20T12:00:00.000000000."""
        whole, nanoseconds = divmod(round(seconds * 1e9), 10**9)
        epoch = self.orbit.epoch
        nanoseconds += epoch.microsecond * 1000
        moment = epoch.replace(microsecond=0, tzinfo=None) + timedelta(seconds=whole + nanoseconds // 10**9)
        return f"{moment.isoformat()}.{nanoseconds % 10**9:09d}"


def placed(instance: Instance) -> OrbitOptions:
    """Return the [orbit] table of an instance after checks that its motion can be placed in the sky.

    Raises
    ------
    BadInput
        If it states none, its model has no central body or no unit of length, or its gravitational parameter is not
        that of the body that it names.
    """
    spec, orbit = instance.model.spec, instance.orbit
    if not spec.keplerian:
        raise BadInput(
            f"{instance.called}: the motion of the model {spec.name} is not an orbit about a central body; "
            "export an instance of such a model, such as return-to-geo"
        )
    if orbit is None:
        raise BadInput(
            f"{instance.called}: [orbit] epoch: missing; add a table [orbit] with epoch = 2026-03-20T12:00:00Z, the "
            "frame and the centre"
        )
    length, time = _length_unit(instance), units.time_unit(v.unit for v in spec.states)
    mu = float(instance.model.inertial_state(instance.t0, instance.initial, instance.parameters)[6])
    factor = units.in_base_units(length) ** 3 / units.in_base_units(time) ** 2 / 1e9
    if abs(mu * factor - orbit.body.mu) > MU_TOLERANCE * orbit.body.mu:
        raise BadInput(
            f"{instance.called}: [orbit] centre: the model has mu = {mu * factor:.7g} km**3/s**2, but the body "
            f"{orbit.centre} has mu = {orbit.body.mu:.7g} km**3/s**2; correct the centre, or write "
            "[parameters] in physical units"
        )
    return orbit


def _length_unit(instance: Instance) -> str:
    """Return the unit of the position.

    Raises
    ------
    BadInput
        If the model has no unit of length.
    """
    spec = instance.model.spec
    stated = spec.position[0].unit
    found = stated if stated != "1" else length_unit(v.unit for v in spec.states)
    if found == "1" or dict(units.dimension(found)) != {"[length]": 1}:
        raise BadInput(f"{instance.called}: the model {spec.name} has no unit of length; give the unit of its position")
    return found


def _turn(orbit: OrbitOptions) -> Array:
    """Return the rotation from the model's axes to the frame: about axis three, one and three in turn.

    The angles are zero for a motion in space.
    """

    def about(axis: int, angle: float) -> Array:
        i, j = [k for k in range(3) if k != axis]
        found = np.eye(3)
        found[i, i] = found[j, j] = np.cos(angle)
        found[j, i], found[i, j] = np.sin(angle), -np.sin(angle)
        return found

    return about(2, orbit.node) @ about(0, orbit.inclination) @ about(2, orbit.argument)


def _parts(whole: Arc) -> Iterator[tuple[Arc, NDArray[np.intp]]]:
    """Split a motion where a time occurs twice, at a jump of the thrust; also return the places of each part."""
    jumps = np.flatnonzero(np.diff(whole.times) <= 0.0) + 1
    for where in np.split(np.arange(len(whole.times)), jumps):
        if len(where) > 1:
            rows = (whole.position[:, where], whole.velocity[:, where], whole.thrust[:, where])
            yield Arc(whole.times[where], *rows), where


def _filled(arc: Arc, mu: Array, instance: Instance) -> Arc:
    """Return an arc with additional points, as close to each other as readers need.

    Between two nodes the motion is the polynomial of fifth degree with their positions, velocities and accelerations.

    Raises
    ------
    BadInput
        If nodes are too far apart for that.
    """
    distance = np.linalg.norm(arc.position, axis=0)
    pulled = -mu * arc.position / distance**3
    pace = np.maximum(np.linalg.norm(arc.velocity, axis=0) / distance, np.sqrt(mu / distance**3))
    angle = np.diff(arc.times) * np.maximum(pace[1:], pace[:-1])
    if angle.max() > COARSEST:
        enough = int(np.ceil(1.1 * len(arc.times) * angle.max() / COARSEST))
        raise BadInput(
            f"{instance.called}: neighbouring nodes are up to {np.degrees(angle.max()):.0f} degrees of the "
            f"orbit apart, which is too far for an ephemeris; set [solver] steps to {enough} or more"
        )
    times, position, velocity, thrust = (
        [arc.times[:1]],
        [arc.position[:, :1]],
        [arc.velocity[:, :1]],
        [arc.thrust[:, :1]],
    )
    for k, parts in enumerate(np.ceil(angle / FINEST).astype(int)):
        share = np.arange(1, parts + 1) / parts
        span = arc.times[k + 1] - arc.times[k]
        place, pace_ = _between(
            span,
            share,
            *((row[:, k : k + 1], row[:, k + 1 : k + 2]) for row in (arc.position, arc.velocity, pulled + arc.thrust)),
        )
        times.append(arc.times[k] + share * span)
        position.append(place)
        velocity.append(pace_)
        thrust.append(arc.thrust[:, k : k + 1] + share * (arc.thrust[:, k + 1 : k + 2] - arc.thrust[:, k : k + 1]))
    return Arc(np.concatenate(times), *(np.hstack(rows) for rows in (position, velocity, thrust)))


def _between(
    span: float, share: Array, place: tuple[Array, Array], pace: tuple[Array, Array], rate: tuple[Array, Array]
) -> tuple[Array, Array]:
    """Interpolate position and velocity at fractions of a span, from the values and accelerations at both ends."""
    a, b, c = place[0], pace[0] * span, 0.5 * rate[0] * span**2
    # the rest of the polynomial, share**3 (d + e share + f share**2), meets what is given at the end
    p, v, w = place[1] - a - b - c, pace[1] * span - b - 2.0 * c, rate[1] * span**2 - 2.0 * c
    d, e, f = 10.0 * p - 4.0 * v + 0.5 * w, -15.0 * p + 7.0 * v - w, 6.0 * p - 3.0 * v + 0.5 * w
    s = share
    position = a + s * (b + s * (c + s * (d + s * (e + s * f))))
    velocity = (b + s * (2.0 * c + s * (3.0 * d + s * (4.0 * e + s * 5.0 * f)))) / span
    # the end itself is as it was given, to the last digit
    return np.where(s == 1.0, place[1], position), np.where(s == 1.0, pace[1], velocity)


def _burns(whole: Arc) -> Iterator[Burn]:
    """Return the burns: runs of intervals with thrust."""
    size = np.linalg.norm(whole.thrust, axis=0)
    if not size.max() > 0.0:
        return
    steps = np.diff(whole.times)
    burning = (np.maximum(size[1:], size[:-1]) > IDLE * size.max()) | (steps == 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], burning.astype(int), [0]])))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield from _within(whole.times[first : last + 1], size[first : last + 1], size.max())


def _within(times: Array, size: Array, largest: float) -> Iterator[Burn]:
    """Return the burn in a run of intervals; none if it has no length.

    At its ends thrust may be zero at a time that occurs twice.
    """
    used = np.flatnonzero(size > IDLE * largest)
    if not used.size:
        return
    first, last = used[0], used[-1]
    first -= first > 0 and times[first - 1] < times[first]
    last += last + 1 < len(times) and times[last + 1] > times[last]
    times, size = times[first : last + 1], size[first : last + 1]
    if times[-1] > times[0]:
        total = float((0.5 * (size[1:] + size[:-1]) * np.diff(times)).sum())
        yield Burn(float(times[0]), float(times[-1]), total, float(size.max()))


def _reference(instance: Instance, arcs: tuple[Arc, ...], turn: Array, length: float, second: float) -> Array | None:
    """Return the positions of the model's reference at the times of all arcs."""
    if not instance.model.spec.has_reference:
        return None
    times = Ephemeris._joined([arc.times for arc in arcs]) / second
    states = curves.reference(instance.model, times, instance.parameters)
    state = np.asarray(instance.model.inertial_state_batch(times, states, instance.parameters), dtype=float)
    return np.asarray(turn @ state[:3] * length)
