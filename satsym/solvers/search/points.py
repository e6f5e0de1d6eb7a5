"""Values and exact derivatives of rates, costs and constraints at many points, from generated functions.

First derivatives are complex steps through these functions. Second derivatives are complex steps through
``costate_rate`` and ``stationarity``, which are the derivatives of the Hamiltonian with respect to states and controls,
and differences of complex steps for the few others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.kernels.active import stated
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.search.controls import Controls, rates

STEP = 1e-30
"""Step of complex differences."""

DIFFERENCE = 1e-5
"""Step of real differences, relative to the scale of the variable."""


@dataclass(frozen=True)
class Points:
    """A problem at many points at once; local variables are states x, variables v, time t and free parameters q.

    Parameters
    ----------
    free
        Indices of the free parameters.
    sizes
        Scales of the local variables.
    """

    instance: Instance
    controls: Controls
    free: tuple[int, ...]
    sizes: Array

    @property
    def states(self) -> int:
        """Return the number of states."""
        return len(self.instance.initial)

    @property
    def local(self) -> int:
        """Return the number of local variables."""
        return self.states + self.controls.count + 1 + len(self.free)

    @cached_property
    def kept(self) -> list[int]:
        """Return the indices of the path constraints that are not bounds of controls."""
        return list(stated_constraints(self.instance.model.spec).values())

    def _parted(self, y: Array) -> tuple[Array, Array, Array, tuple[Any, ...]]:
        n, k = self.states, self.states + self.controls.count
        p = list[Any](self.instance.parameters)
        for row, place in enumerate(self.free):
            p[place] = y[k + 1 + row]
        return y[:n], y[n:k], y[k], tuple(p)

    def rates(self, y: Array) -> Array:
        """Return rates of states and cost, shape (n + 1, M), at local variables (l, M), real or complex."""
        x, v, t, p = self._parted(y)
        return sum(weight * rates(self.instance, t, x, u, p) for u, weight in self.controls.nodes(v))  # type: ignore[return-value]

    def constraints(self, y: Array) -> Array:
        """Return the path constraints, nonpositive where they hold, shape (c, M)."""
        if not self.kept:
            return np.empty((0, y.shape[1]), y.dtype)
        x, v, t, p = self._parted(y)
        u, spec = v[: self.controls.given], self.instance.model.spec
        found = self.instance.model.path_constraints_batch(t, x, u, p, self.instance.control_set.arguments)
        return np.asarray(np.broadcast_to(found, (len(spec.path_constraints), len(t)))[self.kept])

    def slopes(self, function: Callable[[Array], Array], y: Array) -> Array:
        """Return derivatives (rows, l, M) of a function with respect to all local variables."""
        return self._complex(function, y, range(self.local))

    @cached_property
    def _moving(self) -> list[int]:
        """Return the local variables that rates may depend on; time is left out if rates do not contain it."""
        still = {self.states + self.controls.count} if self.instance.model.spec.autonomous else set()
        still |= {self.states + place for place in self.controls.angles}
        return [place for place in range(self.local) if place not in still]

    @cached_property
    def _curved(self) -> list[int]:
        """Return the local variables, except states, in which rates need not be linear."""
        linear = {self.states + place for place in self.controls.linear}
        return [place for place in self._moving if place >= self.states and place not in linear]

    def _spread(self, found: Array) -> Array:
        """Return derivatives (rows, l, M) by all local variables from those by the variables that rates depend on."""
        whole = np.zeros((len(found), self.local, found.shape[2]))
        whole[:, self._moving] = found
        return whole

    def slopes_of_rates(self, y: Array) -> Array:
        """Return derivatives (n + 1, l, M) of :meth:`rates` with respect to all local variables."""
        return self._spread(self._complex(self.rates, y, self._moving))

    def _complex(self, function: Callable[[Array], Array], y: Array, by: Sequence[int]) -> Array:
        many = np.repeat(y.astype(complex)[:, None], len(by), 1)
        for k, place in enumerate(by):
            many[place, k] += 1j * STEP
        found = function(many.reshape(len(y), -1))
        return np.imag(found).reshape(len(found), len(by), y.shape[1]) / STEP

    def _slopes_of_hamiltonian(
        self, slopes: Callable[..., Array], rows: Sequence[int], y: Array, mu: Array, weight: Array
    ) -> Array:
        """Return derivatives (len(rows), M) of mu f + weight L from those of the Hamiltonian L + lam f.

        Parameters
        ----------
        slopes
            Function of t, x, u, lam and p that returns derivatives of the Hamiltonian, of which ``rows`` are used.
        mu, weight
            Weights of the rates and of the running cost. Weights for fewer than M points are repeated.
        """
        x, v, t, p = self._parted(y)
        times = y.shape[1] // mu.shape[1]
        lam, weight = np.tile(mu, (1, times)), np.tile(weight, times)
        plain = bool((weight > 0.0).all())
        if plain:
            lam = lam / weight
        total = np.zeros((len(rows), y.shape[1]), y.dtype)
        for u, share in self.controls.nodes(v):

            def found(lam: Array, u: Array = u) -> Array:
                every = slopes(t, x, u, lam, p)
                return np.array([np.broadcast_to(every[row], t.shape) for row in rows])

            if plain:
                total += weight * share * found(lam)
            else:
                total += share * (found(lam) + (weight - 1.0) * found(np.zeros_like(lam)))
        return total

    def hessian(self, y: Array, mu: Array, weight: Array, eta: Array) -> tuple[Array, Array]:
        """Return Hessians (l, l, M) of mu f + weight L, and those of eta g.

        Parameters
        ----------
        mu, weight, eta
            Weights of the rates, the running cost and the constraints, shapes (n, M), (M,) and (c, M).
        """
        n, count = self.states, self.local
        weights = np.concatenate([mu, weight[None]])

        def added(z: Array) -> Array:
            return np.sum(self.rates(z) * np.tile(weights, z.shape[1] // mu.shape[1]), axis=0)[None]

        def held(z: Array) -> Array:
            return np.sum(self.constraints(z) * np.tile(eta, z.shape[1] // mu.shape[1]), axis=0)[None]

        model, controls = self.instance.model, range(n, n + self.controls.given)
        found = np.zeros((count, count, y.shape[1]))

        def by_states(z: Array) -> Array:
            return -self._slopes_of_hamiltonian(model.costate_rate_batch, range(n), z, mu, weight)

        found[:n] = self._spread(self._complex(by_states, y, self._moving))
        found[n:, :n] = found[:n, n:].transpose(1, 0, 2)
        others = [place for place in self._moving if place >= n]
        steered = [place for place in self._curved if place in controls]
        if steered:
            rows = [place - n for place in steered]

            def by_controls(z: Array) -> Array:
                return self._slopes_of_hamiltonian(model.stationarity_batch, rows, z, mu, weight)

            bent = self._complex(by_controls, y, others)
            found[np.ix_(steered, others)] = bent
            found[np.ix_(others, steered)] = bent.transpose(1, 0, 2)
        if rest := [place for place in self._curved if place not in controls]:
            kept = [place for place in others if place not in steered]
            bent = self._differences(added, y, rest, kept)
            found[np.ix_(kept, rest)] = bent
            found[np.ix_(rest, kept)] = bent.transpose(1, 0, 2)
        other = self._differences(held, y, range(count)) if len(eta) else np.zeros_like(found)
        return found, other

    def _differences(
        self, function: Callable[[Array], Array], y: Array, by: Sequence[int], slopes: Sequence[int] | None = None
    ) -> Array:
        """Return second derivatives (s, k, M) of one row: by the variables ``by``, of the derivatives by ``slopes``."""
        whole = by if slopes is None else slopes
        moved = np.repeat(y[:, None], 2 * len(by), 1)
        for k, place in enumerate(by):
            moved[place, 2 * k] += DIFFERENCE * self.sizes[place]
            moved[place, 2 * k + 1] -= DIFFERENCE * self.sizes[place]
        found = self._complex(function, moved.reshape(len(y), -1), whole)[0]
        found = found.reshape(len(whole), len(by), 2, y.shape[1])
        steps = 2.0 * DIFFERENCE * self.sizes[list(by)]
        found = (found[:, :, 0] - found[:, :, 1]) / steps[None, :, None]
        rows = [list(whole).index(place) for place in by]
        found[rows] = 0.5 * (found[rows] + found[rows].transpose(1, 0, 2))
        return np.asarray(found)

    def cost(self, y: Array) -> Array:
        """Return the terminal cost, shape (1, M)."""
        x, _, t, p = self._parted(y)
        if not self.instance.model.spec.has_terminal_cost:
            return np.zeros((1, y.shape[1]), y.dtype)
        return np.asarray(np.broadcast_to(self.instance.model.terminal_cost_batch(t, x, p), (1, y.shape[1])))

    def ends(self, y: Array) -> Array:
        """Return the terminal conditions besides given states, equalities before inequalities (nonpositive), (e, M)."""
        x, _, t, p = self._parted(y)
        rows, spec = [], self.instance.model.spec
        places = [k for k, name in enumerate(spec.state_names) if self.instance.final.get(name) == "reference"]
        if places:
            curve = np.broadcast_to(self.instance.model.reference_batch(t, p), x.shape)
            rows.append((x - curve)[places])
        whole = stated(self.instance.model)
        if count := len(whole.spec.multipliers):
            lam, nu = np.ones_like(x), (0.0,) * count
            arguments = self.instance.control_set.arguments, final_argument(self.instance)
            # only the rows of constraints are used, which no costate is in
            found = np.asarray(whole.boundary_batch(t, x, lam, nu, p, *arguments))
            n = len(x)
            rows.append(np.broadcast_to(found[n : n + count].reshape(count, -1), (count, y.shape[1])))
        return np.concatenate(rows) if rows else np.empty((0, y.shape[1]), y.dtype)

    def misses(self, y: Array) -> Array:
        """Return the deviations from all final conditions, shape (k, M); terminal inequalities that hold have none.

        The rows are those of given states, of :meth:`ends`, and of states whose final values have a range.
        """
        x, _, _, _ = self._parted(y)
        given, ends, ranged = list[Array](), self.ends(y), list[Array]()
        first = len(ends) - self.inequalities
        ends[first:] *= ends[first:].real > 0.0
        for row, name in zip(x, self.instance.model.spec.state_names, strict=True):
            value = self.instance.final.get(name)
            if isinstance(value, float | int):
                given.append(row - value)
            elif name in self.instance.ranges:
                beyond = row - np.clip(row.real, *self.instance.ranges[name])
                ranged.append(beyond * (beyond.real != 0.0))
        return np.array([*given, *ends, *ranged]).reshape(-1, y.shape[1])

    @property
    def inequalities(self) -> int:
        """Return the number of terminal rows that are inequalities; they are the last ones."""
        return len(stated(self.instance.model).spec.terminal_inequalities)

    def on_the_way(self, y: Array) -> Array:
        """Return the residuals of all conditions at waypoints, shape (k, M)."""
        x, _, t, p = self._parted(y)
        spec = self.instance.model.spec
        count = sum(one.conditions for one in spec.interior)
        if not count:
            return np.empty((0, y.shape[1]), y.dtype)
        found = np.asarray(self.instance.model.interior_batch(t, x, p)).reshape(count, -1)
        return np.broadcast_to(found, (count, y.shape[1]))
