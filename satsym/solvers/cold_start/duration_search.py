"""The cost at given durations: which ones are tried, how far up and down that goes, and where minima lie between."""

from __future__ import annotations

from itertools import count, pairwise

from satsym.solvers.cold_start.duration_trials import Minimum, Trials, Try

RATIO = 2.0**0.5
"""Of neighbouring durations."""

LONGER, SHORTER, SMALLEST = 2.0, 0.4, 1.002
"""Powers of the ratio after a step that succeeded and one that failed, and the ratio at which that is given up."""

AROUND_GUESS = (-2, 2)
AROUND_SCALE = (-2, 8)
"""Powers of the ratio that are tried at first: around a stated guess, and around the motion's own time scale."""

MOST_SCALES, SMALLEST_SCALES = 64.0, 1e-7
"""Durations, in units of the first one, at which a search gives up that has no reason of its own to end."""

LONG = 100.0
"""A cost that falls over durations of such a ratio, up to some that are long on the problem's own scale, falls for ever
where time costs nothing."""

MOST_INTERVALS = 300
"""Mesh beyond which no longer durations are tried: about fifty revolutions."""

FAR_ABOVE, RISES = 3.0, 3
"""No longer durations are tried either once the cost has risen that many times running, and so far."""

FAILURES = 3
"""Nor once that many durations running have given no extremal, after one that has."""

BISECTIONS = 12
SLACK = 1e-2
"""Share of a duration by which a minimum may lie beside its bracket: signs of slopes near zero are not sure, because
cold starts end before their extremals are accurate."""


class Search:
    """Durations tried so far, in order.

    Attributes
    ----------
    trials
        Solve for given durations.
    tries
        Those that were solved for, the shortest first.
    long
        A duration that is long on the problem's own scale.
    """

    def __init__(self, trials: Trials, long: float) -> None:
        self.trials, self.limits, self.long = trials, trials.limits, long
        self.tries: list[Try] = []

    @property
    def cheapest(self) -> Try:
        """Of all durations tried."""
        return min(self.tries, key=lambda t: t.cost)

    @property
    def falls_to_the_shortest(self) -> bool:
        """Whether the shortest duration is the cheapest, and shorter ones would be cheaper still."""
        return self.tries[0] is self.cheapest and self.tries[0].slope > 0.0

    @property
    def falls_to_the_longest(self) -> bool:
        """Whether the longest duration is the cheapest, and longer ones would be cheaper still."""
        return self.tries[-1] is self.cheapest and self.tries[-1].slope <= 0.0

    @property
    def ends_at_nothing(self) -> bool:
        """Whether the cost was followed down to where durations are next to nothing, and that is the cheapest."""
        return self.falls_to_the_shortest and self._least(self.tries[0])

    @property
    def ends_in_a_fall(self) -> bool:
        """Whether long durations are the cheapest, and nothing ever makes longer ones cost more."""
        longest = self.tries[-1]
        return self.falls_to_the_longest and longest.floor <= 0.0 and self._far(longest.duration)

    def _far(self, duration: float) -> bool:
        """Whether so long a duration would have shown a minimum."""
        return duration >= max(LONG * self.tries[0].duration, self.long) * (1.0 - 1e-9)

    def flat(self, least: float) -> bool:
        """Whether costs at all durations differ by no more than this."""
        costs = [t.cost for t in self.tries]
        return len(costs) >= 3 and max(costs) - min(costs) <= least

    @property
    def brackets(self) -> list[tuple[Try, Try]]:
        """Neighbours between which the cost has a minimum, the cheapest first."""
        found = [(a, b) for a, b in pairwise(self.tries) if _minimum_between(a, b)]
        return sorted(found, key=lambda pair: min(t.cost for t in pair))

    def scan(self, around: float, powers: tuple[int, int]) -> None:
        """Solve for durations upwards, then downwards, as far as that may pay.

        Parameters
        ----------
        around, powers
            A duration, and powers of the ratio that are tried at first.
        """
        self._upwards(around, *powers)
        if self.tries:
            self._walk(down=False)
            self._walk(down=True)

    def minimum(self, a: Try, b: Try) -> Minimum | None:
        """The minimum between two durations; one that costs more than either of these if no other is found."""
        costlier: Minimum | None = None
        for _ in range(BISECTIONS):
            near, least = a if abs(a.slope) <= abs(b.slope) else b, min(a.cost, b.cost)
            found = self.trials.freed(near)
            if found and a.duration * (1.0 - SLACK) <= found.duration <= b.duration * (1.0 + SLACK):
                if found.cost <= least + SLACK * abs(least):
                    return found
                costlier = found
            middle = None if self.limits.expired else self._solved((a.duration * b.duration) ** 0.5, near)
            halves = [] if middle is None else [pair for pair in ((a, middle), (middle, b)) if _minimum_between(*pair)]
            if not halves:
                return costlier
            a, b = min(halves, key=lambda pair: min(t.cost for t in pair))
        return costlier

    def is_cheapest(self, best: Minimum, least: float) -> bool:
        """Whether none of the durations tried costs less than a minimum, but for this much."""

        def above(than: Try) -> bool:
            return best.cost > than.cost + 1e-9 * abs(than.cost) + least

        return not any(above(t) and above(self.trials.accurate(t)) for t in self.tries)

    def _upwards(self, around: float, low: int, high: int) -> None:
        """Solve for durations of a fixed ratio, from the shortest on."""
        failures = 0
        for power in count(low):
            duration = around * RATIO**power
            if self.limits.expired or failures >= FAILURES or not self._longer_may_pay(duration, power <= high):
                return
            found = self.trials.cold(duration)
            self._keep(found)
            failures = 0 if found or not self.tries else failures + 1

    def _longer_may_pay(self, duration: float, planned: bool) -> bool:
        """Whether the next longer duration may be the cheapest so far."""
        if not self.tries:
            return planned
        last, costs = self.tries[-1], [t.cost for t in self.tries]
        if len(last.start.found.curve.mesh) > MOST_INTERVALS:
            return False
        rising = len(costs) > RISES and all(a < b for a, b in pairwise(costs[-RISES - 1 :]))
        if rising and last.cost - min(costs) > (FAR_ABOVE - 1.0) * abs(min(costs)):
            return False
        if self._timed:
            return duration < self._dearest()
        falls = last.cost <= min(costs) and self._far(last.duration)
        most = RATIO * max(MOST_SCALES * self.trials.first, self.long)
        return planned or (not falls and duration <= most)

    def _walk(self, down: bool) -> None:
        """Go on from the shortest or the longest duration while the cost falls that way."""
        growth = RATIO
        while not self.limits.expired:
            edge = self.tries[0 if down else -1]
            if not (self._shorter_may_pay(edge) if down else self._still_longer_may_pay(edge)):
                return
            found = self._solved(self._next(edge, growth, down), edge)
            if found is None and growth**SHORTER <= SMALLEST:
                return
            self._keep(found)
            growth **= LONGER if found else SHORTER

    def _next(self, edge: Try, growth: float, down: bool) -> float:
        return edge.duration / growth if down else min(edge.duration * growth, self._dearest())

    def _least(self, edge: Try) -> bool:
        return edge.duration <= SMALLEST_SCALES * self.trials.first

    def _shorter_may_pay(self, edge: Try) -> bool:
        """Whether the cost would become the least so far, if it went on to fall as steeply, or is so at no time at all.

        Next to the latter there may be a minimum: ending at once costs more than that where the cost falls at first.
        """
        least = edge.cost - edge.slope * edge.duration if edge.slope > 0.0 else self.trials.at_once
        return min(least, self.trials.at_once) < self.cheapest.cost and not self._least(edge)

    def _still_longer_may_pay(self, edge: Try) -> bool:
        """Whether the cost still falls at the longest duration, before time alone would cost more."""
        fine = len(edge.start.found.curve.mesh) > MOST_INTERVALS
        return edge.slope <= 0.0 and edge.duration < self._dearest() * (1.0 - 1e-9) and not fine

    def _dearest(self) -> float:
        """From which duration on time alone costs more than the cheapest motion; the longest tried where it is free."""
        longest, spent = self.tries[-1], self.cheapest.cost + self.trials.credit
        return spent / longest.floor if self._timed else longest.duration

    @property
    def _timed(self) -> bool:
        """Whether time costs something along the longest motion, and that can be more than the cheapest one costs."""
        return self.tries[-1].floor > 0.0 and self.cheapest.cost + self.trials.credit > 0.0

    def _solved(self, duration: float, near: Try) -> Try | None:
        """The problem of a duration near another one: from a cold start where that is easy, else from that extremal."""
        found = None if near.start.found.hard else self.trials.cold(duration)
        return found or self.trials.beside(near, duration)

    def _keep(self, found: Try | None) -> None:
        if found:
            self.tries = sorted([*self.tries, found], key=lambda t: t.duration)


def _minimum_between(a: Try, b: Try) -> bool:
    """Whether the cost, if smooth, has a minimum between a duration and a longer one."""
    falls, rises = a.slope <= 0.0, b.slope > 0.0
    return (falls and rises) or (falls and b.cost > a.cost) or (rises and a.cost > b.cost)
