"""Random returns to a circular orbit: the two populations on which cold starts are judged."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from satsym import instance
from satsym.instance import Instance


@dataclass(frozen=True)
class Population:
    """Ranges from which starts, targets and durations are drawn; the gravity parameter is one.

    Attributes
    ----------
    seed, size
        Of the generator, and how many there are.
    radius, target, duration
        Ranges of the initial radius, of the target's, and of t_f.
    radial, logarithmic
        Largest radial velocity, and whether radii are drawn by their logarithms.
    """

    seed: int
    size: int
    radius: tuple[float, float]
    target: tuple[float, float]
    duration: tuple[float, float]
    radial: float
    logarithmic: bool

    def cases(self, count: int | None = None) -> Iterator[Instance]:
        """The first ones, as instances."""
        rng, base = np.random.default_rng(self.seed), instance.load("return-to-orbit")
        for number in range(self.size if count is None else count):
            r, goal = (self._radius(rng, limits) for limits in (self.radius, self.target))
            v, theta = rng.uniform(-self.radial, self.radial), rng.uniform(-1.0, 1.0)
            w, tf = r**-1.5 * rng.uniform(0.8, 1.2), rng.uniform(*self.duration)
            rate = goal**-1.5
            final = {"r": goal, "r_dot": 0.0, "theta": float(rate * tf), "theta_dot": rate}
            initial = (r, float(v), float(theta), float(w))
            yield replace(base, name=f"{self.seed}-{number}", initial=initial, tf=float(tf), final=final)

    def _radius(self, rng: np.random.Generator, limits: tuple[float, float]) -> float:
        if self.logarithmic:
            return float(np.exp(rng.uniform(*np.log(limits))))
        return float(rng.uniform(*limits))


EASY = Population(1, 10_000, (0.6, 1.6), (1.0, 1.0), (1.0, 12.0), 0.2, False)
HARD = Population(2, 2_000, (0.4, 2.5), (0.5, 2.0), (2.0, 25.0), 0.3, True)
