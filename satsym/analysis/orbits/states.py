"""States of many orbits, read from a caller's arrays, and scaled to numbers of size one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array
from satsym.status import BadInput


@dataclass(frozen=True, eq=False)
class States:
    """Initial states and durations of N motions, as flat arrays."""

    position: Array
    velocity: Array
    """Positions and velocities, shape (3, N)."""
    mu: Array
    duration: Array
    """Gravitational parameters and durations, shape (N,)."""
    shape: tuple[int, ...]
    """Shape of the caller's broadcast arrays without their first axis."""

    def part(self, chosen: Any) -> States:
        """Return the states of some of the columns."""
        arrays = (self.position[:, chosen], self.velocity[:, chosen], self.mu[chosen], self.duration[chosen])
        return States(*arrays, self.shape)

    def scaled(self) -> tuple[States, Array, Array]:
        """Return the states in units of length and speed that are powers of two, which is exact, and those units.

        Positions are then of size one, and so is mu, up to a factor of four.
        """
        _, length = np.frexp(np.abs(self.position).max(axis=0))
        _, gravity = np.frexp(self.mu)
        speed = (gravity - length) // 2
        with np.errstate(over="ignore", invalid="ignore"):  # the result then says so
            states = States(
                self.position * np.ldexp(1.0, -length),
                self.velocity * np.ldexp(1.0, -speed),
                self.mu * np.ldexp(1.0, -length - 2 * speed),
                self.duration * np.ldexp(1.0, speed - length),
                self.shape,
            )
            return states, np.ldexp(1.0, length), np.ldexp(1.0, speed)


def checked(position: ArrayLike, velocity: ArrayLike, mu: ArrayLike, duration: ArrayLike) -> States:
    """Return a caller's states as flat arrays of equal size.

    Raises
    ------
    BadInput
        Where it cannot be the start of a motion; see :func:`satsym.analysis.orbits.kepler.propagate`.
    """
    given = {"position": position, "velocity": velocity, "mu": mu, "duration": duration}
    arrays = {name: _numbers(name, value) for name, value in given.items()}
    for name in ("position", "velocity"):
        if arrays[name].shape[:1] != (3,):
            raise BadInput(
                f"{name}: has shape {arrays[name].shape}; give an array whose first axis has length 3, one entry "
                "for each component"
            )
    vectors = [arrays[name] for name in ("position", "velocity")]
    scalars = [arrays[name] for name in ("mu", "duration")]
    try:
        shape = np.broadcast_shapes(*(a.shape[1:] for a in vectors), *(a.shape for a in scalars))
    except ValueError:
        raise BadInput(
            f"position, velocity, mu, duration: the shapes {', '.join(str(a.shape) for a in arrays.values())}, "
            "without the axis of the three components, cannot be broadcast together; give equally many of each, "
            "or a single one for all orbits"
        ) from None
    r, v = (_stretched(a, shape) for a in vectors)
    m, dt = (np.broadcast_to(a, shape).reshape(-1) for a in scalars)
    for name, values in (("position", r), ("velocity", v), ("mu", m), ("duration", dt)):
        bad = ~np.isfinite(values)
        refuse_first(bad.any(axis=0) if bad.ndim > 1 else bad, shape, f"{name} is not finite; give numbers")
    refuse_first(m <= 0.0, shape, "mu is not positive; give the gravitational parameter of the centre")
    refuse_first((r == 0.0).all(axis=0), shape, "the position is the centre itself; start elsewhere")
    return States(r, v, m, dt, shape)


def refuse_first(bad: Any, shape: tuple[int, ...], fault: str) -> None:
    """Raise BadInput for the first column that is bad, naming its index in the caller's shape; ``bad`` is (N,)."""
    if not bad.any():
        return
    index = tuple(int(i) for i in np.unravel_index(int(np.argmax(bad)), shape)) if shape else ()
    where = f"index {index[0] if len(index) == 1 else index}: " if index else ""
    raise BadInput(f"{where}{fault}")


def _numbers(name: str, value: ArrayLike) -> Array:
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
    except (TypeError, ValueError):
        raise BadInput(f"{name}: the value is not an array of real numbers; give real numbers") from None
    return array.astype(np.float64)


def _stretched(vector: Array, shape: tuple[int, ...]) -> Array:
    """Broadcast three components with fewer axes than ``shape`` to the shape (3, N)."""
    lead = vector.shape[1:]
    filled = vector.reshape(3, *(1,) * (len(shape) - len(lead)), *lead)
    return np.ascontiguousarray(np.broadcast_to(filled, (3, *shape)).reshape(3, -1))
