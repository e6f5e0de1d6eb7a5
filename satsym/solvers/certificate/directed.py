"""Competitors where vanishing costates say nothing: regularised or direct problems, other starts or durations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solution import Kind
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

if TYPE_CHECKING:
    from satsym.solvers.collocation.curve import Curve
    from satsym.solvers.collocation.problem import TwoPoint

Found = tuple["TwoPoint", "Curve"]

WIDE = 1.0
"""Amplitude of paths that are drawn where the final time is free, in sizes of the states: those that lead another way
round are far from the straight line."""

SHOWN, SAME = 21, 1e-2
"""Times at which minima without bounds are compared, and the largest difference of those that are one, scaled."""


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Extremals from drawn paths, where the final time is free; each minimum without bounds is followed once."""

    instance: Instance
    lasting: float
    rng: np.random.Generator
    followed: list[tuple[Array, object]] = field(default_factory=list)
    """States of such minima, and what they led to."""

    def __call__(self, limits: Limits) -> object:
        """What the next one leads to."""
        from satsym.solvers.cold_start.directions import bent, full_length

        at: Array | None = None

        def before(curve: Curve) -> Any:
            nonlocal at
            at = curve(np.linspace(0.0, 1.0, SHOWN))[: len(self.instance.initial)]
            same = (found for other, found in self.followed if np.abs(at - other).max() <= SAME)
            return next(same, None)

        found = bent(self.instance, self.rng, WIDE, limits, full_length, self.lasting, before)
        if at is not None:
            self.followed.append((at, found))
        return found


def led(
    instance: Instance,
    lasting: float,
    rng: np.random.Generator,
    amplitudes: tuple[float, ...],
    fractions: tuple[float, ...],
) -> Iterator[tuple[Kind, list[Callable[[Limits], Found | None]]]]:
    """Kinds, and what is tried of each: a problem with a rough extremal of it, if it leads to one.

    Parameters
    ----------
    lasting
        The duration of the solution.
    rng, amplitudes
        For starts that are drawn, where the final time is given.
    fractions
        Of the duration, from which others are looked for where it is free.
    """
    from satsym.solvers.cold_start.direct import direct
    from satsym.solvers.cold_start.directions import bent, directed, full_length

    plain, kind = replace(instance, guess=Guess()), Kind.STARTS
    starts: list[Callable[..., object]] = [
        partial(bent, plain, rng, amplitude, unsmoothed=full_length) for amplitude in amplitudes
    ]
    if not instance.model.spec.directional:
        starts = [partial(direct, plain, seed=int(rng.integers(2**31))) for _ in amplitudes]
    elif instance.tf is None:
        kind, beside = (
            Kind.DURATIONS,
            [replace(plain, tf_guess=instance.t0 + fraction * lasting) for fraction in fractions],
        )
        starts = [partial(directed, one, effort=False, unsmoothed=full_length) for one in beside]
    yield kind, [partial(_attempted, start) for start in starts]


def led_far_round(
    instance: Instance, lasting: float, rng: np.random.Generator, counts: Sequence[int]
) -> Iterator[list[Callable[[Limits], Found | None]]]:
    """The same from paths that are far from the straight line, in groups of so many, where the final time is free.

    Parameters
    ----------
    lasting
        The duration in which they are drawn, and minimised at first.
    """
    if not instance.model.spec.directional or instance.tf is not None:
        return
    drawn = _Drawn(replace(instance, guess=Guess()), lasting, rng)
    for count in counts:
        yield [partial(_attempted, drawn)] * count


def _attempted(start: Callable[..., object], limits: Limits) -> Found | None:
    from satsym.solvers.collocation.extremal import Extremal

    found = tried(partial(start, limits=limits))
    if not isinstance(found, tuple) or isinstance(found, Extremal):
        return None
    problem, begun = found
    return problem, begun.found.curve
