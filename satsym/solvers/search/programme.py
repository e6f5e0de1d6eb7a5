"""The nonlinear programme of an instance with exact sparse derivatives, in the form that sparse solvers require."""

from __future__ import annotations

from functools import cached_property, partial

import numpy as np

from satsym.arrays import Array
from satsym.solvers.search.controls import Norm
from satsym.solvers.search.sizes import ranges
from satsym.solvers.search.transcription import DEGREE, SLOPES, Function, Places, Transcription


class Programme(Transcription):
    """A nonlinear programme: a transcription with first and second derivatives."""

    @cached_property
    def ranges(self) -> Array:
        """Largest ranges (n,) of states in the uncontrolled motions from both ends."""
        return ranges(self.instance, self.controls, self.sizes.duration)

    @cached_property
    def _into(self) -> tuple[Array, Array, Places]:
        """Derivatives of the local variables of each point with respect to its unknowns, a matrix (l, z, N).

        Also the derivatives of the steps (z, N), and the indices (z, N) of these unknowns.
        """
        n, k, points = self.points.states, self.controls.count, self.count
        inner, wide = self.points.local, len(self.globals)
        z = n + k + wide
        into, steps, places = np.zeros((inner, z, points)), np.zeros((z, points)), np.zeros((z, points), int)
        own = np.arange(points)
        for i in range(n):
            into[i, i], places[i] = self.sizes.states[i], (own + 1) * n + i
        for i in range(k):
            into[n + i, n + i], places[n + i] = self.sizes.variables[i], self.first_variable + own * k + i
        places[n + k :] = self.globals[:, None]
        unit = self.sizes.duration
        into[self._time, n + k : n + k + self.phases] = self.shares.T * unit
        steps[n + k : n + k + self.phases] = self.steps.T * unit
        for i in range(len(self.free)):
            into[self._time + 1 + i, n + k + self.phases + i] = self.sizes.free[i]
        if self.starts:
            into[self._time, -1] = unit
        return into, steps, places

    def _end_into(self, point: int) -> tuple[Array, Places]:
        """Return derivatives of the local variables of one point by its unknowns, (l, z), and their indices (z,).

        Controls of the point are left out.
        """
        n, wide = self.points.states, len(self.globals)
        into = np.zeros((self.points.local, n + wide))
        into[range(n), range(n)] = self.sizes.states
        shares = np.concatenate([np.zeros((1, self.phases)), self.shares])[point]
        into[self._time, n : n + self.phases] = shares * self.sizes.duration
        for i in range(len(self.free)):
            into[self._time + 1 + i, n + self.phases + i] = self.sizes.free[i]
        if self.starts:
            into[self._time, -1] = self.sizes.duration
        return into, np.concatenate([point * n + np.arange(n), self.globals])

    def _slopes(self, w: Array) -> Array:
        """Return derivatives (n + 1, l, N) of rates by local variables, cached for the last unknowns."""
        key = w.tobytes()
        if self._last_slopes is None or self._last_slopes[0] != key:
            self._last_slopes = key, self.points.slopes_of_rates(self._local(w)[0])
        return self._last_slopes[1]

    def gradient(self, w: Array) -> Array:
        """Return the derivatives of :meth:`objective` with respect to all unknowns."""
        _, steps, _ = self._local(w)
        into, grown, places = self._into
        slopes, cost = self._slopes(w)[-1], self._rates(w)[-1]
        each = self.weights * (np.einsum("lN,lzN->zN", slopes * steps, into) + cost * grown)
        found: Array = np.bincount(places.ravel(), each.ravel(), self.unknowns).astype(float)
        if self.instance.model.spec.has_terminal_cost:
            into_end, places_end = self._end_into(self.count)
            slope = self.points.slopes(self.points.cost, self._at(w, [self.count]))[0, :, 0]
            found[places_end] += slope @ into_end
        return found / self.sizes.cost

    def jacobian(self, w: Array) -> Array:
        """Return the entries of the constraint Jacobian, at the positions of :attr:`jacobian_places`."""
        y, steps, _ = self._local(w)
        n = self.points.states
        into, grown, _ = self._into
        slopes, values = self._slopes(w)[:n], self._rates(w)[:n]
        moved = np.einsum("ilN,lzN->izN", slopes * steps, into) + values[:, None] * grown[None]
        parts = [
            np.repeat(self._collocation[:, :, None], n, 2).ravel(),
            (-moved / self.sizes.states[:, None, None]).transpose(2, 0, 1).ravel(),
        ]
        if "path" in self.kinds:
            found = self.points.slopes(self.points.constraints, y)
            parts.append(np.einsum("clN,lzN->Ncz", found, into).ravel())
        for number, norm in enumerate(self.controls.norms):
            parts.append((2.0 * self._signed(number) * y[[n + k for k in self._spots(norm)]]).T.ravel())
        for function, point in self._single:
            into_end, _ = self._end_into(point)
            parts.append((self.points.slopes(function, self._at(w, [point]))[:, :, 0] @ into_end).ravel())
        if "time" in self.kinds:
            parts.append(self._end_into(self.count)[0][self._time] / self.sizes.duration)
        target, count = self._summed
        return np.bincount(target, np.concatenate(parts), count).astype(float)

    @cached_property
    def _collocation(self) -> Array:
        """Derivatives (N, degree + 1) of the interpolated slopes with respect to the states of their interval."""
        return np.tile(SLOPES.T, (self.intervals, 1))

    def _spots(self, norm: Norm) -> list[int]:
        return [*norm.places, *([norm.spot] if norm.spot is not None else [])]

    def _signed(self, number: int) -> Array:
        """Return the factors (k, 1) of the squares in the row of a norm, times the scales of its variables."""
        norm = self.controls.norms[number]
        signs = np.array([1.0] * len(norm.places) + [-1.0] * (norm.spot is not None))
        spots = self._spots(norm)
        return np.asarray((signs * self.sizes.variables[spots] / self._unit(number) ** 2)[:, None])

    @cached_property
    def _single(self) -> list[tuple[Function, int]]:
        """Functions of one point whose values are constraint rows, and the index of that point."""
        found: list[tuple[Function, int]] = []
        if "ends" in self.kinds:
            found.append((self.points.ends, self.count))
        if "way" in self.kinds:
            first = 0
            for one, place in zip(self.instance.model.spec.interior, self._places(), strict=True):
                found.append((partial(self._passed, slice(first, first + one.conditions)), place))
                first += one.conditions
        return found

    @cached_property
    def _summed(self) -> tuple[Places, int]:
        """Positions at which entries of the Jacobian are summed, and the number of positions."""
        rows, columns = self._entries
        unique, target = np.unique(rows * self.unknowns + columns, return_inverse=True)
        self._jacobian_keys = unique
        return target, len(unique)

    def _passed(self, rows: slice, y: Array) -> Array:
        """Return the values of some of the conditions at waypoints."""
        return self.points.on_the_way(y)[rows]

    @cached_property
    def jacobian_places(self) -> tuple[Places, Places]:
        """Rows and columns of the entries of :meth:`jacobian`."""
        _ = self._summed
        return self._jacobian_keys // self.unknowns, self._jacobian_keys % self.unknowns

    @cached_property
    def _entries(self) -> tuple[Places, Places]:
        n, points, d = self.points.states, self.count, DEGREE
        _, _, places = self._into
        own, z = np.arange(points), len(places)
        lines = own[:, None] * n + np.arange(n)
        nodes = (own // d)[:, None] * d + np.arange(d + 1)
        rows = [np.broadcast_to(lines[:, None], (points, d + 1, n)).ravel()]
        columns = [(nodes[:, :, None] * n + np.arange(n)).ravel()]
        rows.append(np.broadcast_to(lines[:, :, None], (points, n, z)).ravel())
        columns.append(np.broadcast_to(places.T[:, None], (points, n, z)).ravel())
        if "path" in self.kinds:
            count = len(self.points.kept)
            lines = self.kinds["path"].first + own[:, None] * count + np.arange(count)
            rows.append(np.broadcast_to(lines[:, :, None], (points, count, z)).ravel())
            columns.append(np.broadcast_to(places.T[:, None], (points, count, z)).ravel())
        for number, norm in enumerate(self.controls.norms):
            spots = self._spots(norm)
            lines = self.kinds[f"norm{number}"].first + own
            rows.append(np.repeat(lines, len(spots)))
            columns.append((self.first_variable + own[:, None] * self.controls.count + np.array(spots)).ravel())
        first = (
            self.kinds["ends"].first if "ends" in self.kinds else self.kinds["way"].first if "way" in self.kinds else 0
        )
        for function, point in self._single:
            count = len(function(self._at(np.ones(self.unknowns), [point])))
            _, columns_end = self._end_into(point)
            rows.append(np.repeat(first + np.arange(count), len(columns_end)))
            columns.append(np.tile(columns_end, count))
            first += count
        if "time" in self.kinds:
            _, columns_end = self._end_into(self.count)
            rows.append(np.full(len(columns_end), self.kinds["time"].first))
            columns.append(columns_end)
        return np.concatenate(rows), np.concatenate(columns)

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Return the lower triangle of the Hessian of factor * objective + multipliers * rows, as entries."""
        y, steps, _ = self._local(w)
        n = self.points.states
        into, grown, _ = self._into
        mu = -multipliers[self.kinds["defects"].places].reshape(self.count, n).T / self.sizes.states[:, None]
        weight = factor / self.sizes.cost * self.weights
        held = len(self.points.kept)
        eta = multipliers[self.kinds["path"].places].reshape(self.count, held).T if held else np.empty((0, self.count))
        second, of_path = self.points.hessian(y, mu, weight, eta)
        gradient = np.einsum("ilN,iN->lN", self._slopes(w), np.concatenate([mu, weight[None]]))
        each = np.ascontiguousarray(into.transpose(2, 0, 1))
        block = each.transpose(0, 2, 1) @ (second * steps + of_path).transpose(2, 0, 1) @ each
        block = block.transpose(1, 2, 0)
        along = np.einsum("lN,lzN->zN", gradient, into)
        block += along[:, None] * grown[None] + grown[:, None] * along[None]
        for number, norm in enumerate(self.controls.norms):
            spots = [n + place for place in self._spots(norm)]
            own = multipliers[self.kinds[f"norm{number}"].places]
            sizes = self.sizes.variables[self._spots(norm)][:, None]
            block[spots, spots] += 2.0 * self._signed(number) * sizes * own
        entries = [block.transpose(2, 0, 1).ravel()]
        end = self._at(w, [self.count])
        for function, point, weights in self._weighed(multipliers, factor):
            at = end if point == self.count else self._at(w, [point])
            into_end, _ = self._end_into(point)

            def added(z: Array, function: Function = function, weights: Array = weights) -> Array:
                return (weights @ function(z))[None]

            bent = self.points._differences(added, at, range(self.points.local))[:, :, 0]
            entries.append((into_end.T @ bent @ into_end).ravel())
        chosen, target, count = self._merged
        return np.bincount(target, np.concatenate(entries)[chosen], count).astype(float)

    def _weighed_at_end(self, factor: float) -> list[tuple[Function, int, Array]]:
        """Return the terminal cost as a function of one point, the index of the point, and its weight."""
        if not self.instance.model.spec.has_terminal_cost:
            return []
        return [(self.points.cost, self.count, np.array([factor / self.sizes.cost]))]

    def _weighed(self, multipliers: Array, factor: float) -> list[tuple[Function, int, Array]]:
        """Return functions of one point, the index of the point, and their weights in the Lagrangian."""
        found = self._weighed_at_end(factor)
        first = (
            self.kinds["ends"].first if "ends" in self.kinds else self.kinds["way"].first if "way" in self.kinds else 0
        )
        for function, point in self._single:
            count = len(function(self._at(np.ones(self.unknowns), [point])))
            found.append((function, point, multipliers[first : first + count]))
            first += count
        return found

    @cached_property
    def _merged(self) -> tuple[Places, Places, int]:
        """Indices of the block entries in the lower triangle, positions at which they are summed, and their number."""
        rows, columns = self._block_places
        chosen = np.flatnonzero(rows >= columns)
        key = rows[chosen] * self.unknowns + columns[chosen]
        unique, target = np.unique(key, return_inverse=True)
        self._hessian_keys = unique
        return chosen, target, len(unique)

    @cached_property
    def _block_places(self) -> tuple[Places, Places]:
        _, _, places = self._into
        z = len(places)
        rows = [np.broadcast_to(places.T[:, :, None], (self.count, z, z)).ravel()]
        columns = [np.broadcast_to(places.T[:, None, :], (self.count, z, z)).ravel()]
        for _, point, _ in self._weighed(np.zeros(self.rows), 0.0):
            _, own = self._end_into(point)
            rows.append(np.repeat(own, len(own)))
            columns.append(np.tile(own, len(own)))
        return np.concatenate(rows), np.concatenate(columns)

    @cached_property
    def hessian_places(self) -> tuple[Places, Places]:
        """Rows and columns of the entries of :meth:`hessian`."""
        _ = self._merged
        return self._hessian_keys // self.unknowns, self._hessian_keys % self.unknowns
