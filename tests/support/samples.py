"""Random returns to a circular orbit: the two populations on which cold starts are judged."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

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

    def case(self, number: int) -> Instance:
        """One of them, as an instance."""
        r, goal, v, theta, rotation, tf = (float(column[number]) for column in self._drawn)
        rate = goal**-1.5
        initial = (r, v, theta, rotation * r**-1.5)
        final = {"r": goal, "r_dot": 0.0, "theta": rate * tf, "theta_dot": rate}
        base = instance.load("return-to-orbit")
        return replace(base, name=f"{self.seed}-{number}", initial=initial, tf=tf, final=final)

    @cached_property
    def _drawn(self) -> tuple[np.ndarray, ...]:
        rng = np.random.default_rng(self.seed)
        limits = [self.radius, self.target]
        if self.logarithmic:
            radii = [np.exp(rng.uniform(*np.log(pair), self.size)) for pair in limits]
        else:
            radii = [rng.uniform(*pair, self.size) for pair in limits]
        others = [(-self.radial, self.radial), (-1.0, 1.0), (0.8, 1.2), self.duration]
        return (*radii, *(rng.uniform(*pair, self.size) for pair in others))


EASY = Population(1, 10_000, (0.6, 1.6), (1.0, 1.0), (1.0, 12.0), 0.2, False)
HARD = Population(2, 2_000, (0.4, 2.5), (0.5, 2.0), (2.0, 25.0), 0.3, True)
