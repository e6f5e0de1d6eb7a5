"""Competitors where vanishing costates say nothing: regularised or direct problems, other starts or durations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from satsym.instance import Guess, Instance
from satsym.solution import Kind
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

if TYPE_CHECKING:
    from satsym.solvers.collocation.curve import Curve
    from satsym.solvers.collocation.problem import TwoPoint

Found = tuple["TwoPoint", "Curve"]


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
    from satsym.solvers.collocation.extremal import Extremal

    plain = replace(instance, guess=Guess())
    starts: list[Callable[..., object]] = [
        partial(bent, plain, rng, amplitude, unsmoothed=full_length) for amplitude in amplitudes
    ]
    if not instance.model.spec.directional:
        starts = [partial(direct, plain, seed=int(rng.integers(2**31))) for _ in amplitudes]
    elif instance.tf is None:
        beside = [replace(plain, tf_guess=instance.t0 + fraction * lasting) for fraction in fractions]
        starts = [partial(directed, one, effort=False, unsmoothed=full_length) for one in beside]

    def attempt(start: Callable[..., object], limits: Limits) -> Found | None:
        found = tried(partial(start, limits=limits))
        if not isinstance(found, tuple) or isinstance(found, Extremal):
            return None
        problem, begun = found
        return problem, begun.found.curve

    directional = instance.model.spec.directional
    kind = Kind.DURATIONS if instance.tf is None and directional else Kind.STARTS
    yield kind, [partial(attempt, start) for start in starts]
