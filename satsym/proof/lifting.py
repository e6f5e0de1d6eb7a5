"""Free parameters and a free initial time as additional states, of rate zero and one, with free initial values.

A proof for the motion with these states is a proof for the stated problem. The functions of the generated module are
kept; derivatives of H by the new states are computed from its motion and costs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
from flint import arb, ctx

from satsym.instance.unknowns import Place
from satsym.kernels import Kernels
from satsym.proof.balls.arithmetic import BeyondProof, Series, constant, value
from satsym.proof.balls.jets import Jet, gradients
from satsym.proof.balls.kernel import BallKernel
from satsym.proof.laws import hamiltonian
from satsym.solution import Solution
from satsym.spec import Variable

CLOCK = Variable("t", "t", meaning="time")


class Lifted(BallKernel):
    """A module whose states are its own, then free parameters, then time where that is a state.

    Parameters
    ----------
    model
        The kernels of the model for floats.
    places
        Places of the parameters that are states.
    clocked
        Whether time is a state; the argument ``t`` is then ignored.
    on_reference
        Places of the states that end on the reference, which may depend on free numbers; these conditions are
        constraints at the end, before all others.
    """

    def __init__(self, model: Kernels, places: Sequence[int], clocked: bool, on_reference: Sequence[int]) -> None:
        super().__init__(model)
        self.places, self.clocked, self.own = tuple(places), clocked, len(self.spec.states)
        more = (*(self.spec.parameters[i] for i in places), *((CLOCK,) if clocked else ()))
        self.on_reference, self.constrained = tuple(on_reference), bool(self.spec.multipliers)
        self.spec = replace(
            self.spec,
            states=(*self.spec.states, *more),
            multipliers=(*(self.spec.states[i] for i in on_reference), *self.spec.multipliers),
            autonomous=self.spec.autonomous or clocked,
        )

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_"):
            raise AttributeError(name)
        raise BeyondProof(f"the function {name} of a motion with free parameters or a free initial time")

    def _of(self, name: str) -> Callable[..., Any]:
        """Return a function of the original module."""
        return super().__getattr__(name)

    def _parts(self, t: Any, x: Sequence[Any], p: Sequence[Any]) -> tuple[Any, Sequence[Any], list[Any]]:
        """Return time, the module's own states, and all parameters."""
        q = list(p)
        for place, v in zip(self.places, x[self.own :], strict=False):
            q[place] = v
        return (x[-1] if self.clocked else t), x[: self.own], q

    def _more(self) -> list[Series]:
        """Return the rates of the additional states."""
        return [constant(0)] * len(self.places) + [constant(1)] * self.clocked

    def dynamics(self, t: Any, x: Sequence[Any], u: Sequence[Any], p: Sequence[Any]) -> list[Any]:
        time, own, q = self._parts(t, x, p)
        return [*self._of("dynamics")(time, own, u, q), *self._more()]

    def running_cost(self, t: Any, x: Sequence[Any], u: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("running_cost")(time, own, u, q)

    def terminal_cost(self, t: Any, x: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("terminal_cost")(time, own, q)

    def terminal_constraints(self, t: Any, x: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        stated = self._of("terminal_constraints")(time, own, q) if self.constrained else ()
        if not self.on_reference:
            return stated
        curve = self._of("reference")(time, q)
        return [*(own[i] - curve[i] for i in self.on_reference), *stated]

    def control_law(self, t: Any, x: Sequence[Any], lam: Sequence[Any], p: Sequence[Any], bounds: Any) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("control_law")(time, own, lam[: self.own], q, bounds)

    def control_hessian(self, t: Any, x: Sequence[Any], u: Any, lam: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("control_hessian")(time, own, u, lam[: self.own], q)

    def switching_function(self, t: Any, x: Sequence[Any], lam: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("switching_function")(time, own, lam[: self.own], q)

    def magnitude_weight(self, t: Any, x: Sequence[Any], lam: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        return self._of("magnitude_weight")(time, own, lam[: self.own], q)

    def canonical(self, t: Any, x: Sequence[Any], lam: Sequence[Any], p: Sequence[Any], bounds: Any) -> list[Any]:
        time, own, q = self._parts(t, x, p)
        rates = self._of("canonical")(time, own, lam[: self.own], q, bounds)
        with self._unnoted():
            u = self.control_law(t, x, lam, p, bounds)
        return [*rates[: self.own], *self._more(), *rates[self.own :], *self._falls(t, x, u, lam, p)]

    def costate_rate(self, t: Any, x: Sequence[Any], u: Sequence[Any], lam: Sequence[Any], p: Sequence[Any]) -> Any:
        time, own, q = self._parts(t, x, p)
        rates = self._of("costate_rate")(time, own, u, lam[: self.own], q)
        with self._unnoted():
            return [*rates, *self._falls(t, x, u, lam, p)]

    def canonical_jacobian(self, t: Any, x: Sequence[Any], lam: Sequence[Any], p: Sequence[Any], bounds: Any) -> Any:
        n = len(x)
        with self._unnoted():
            u = self.control_law(t, x, lam, p, bounds)
            by = gradients(lambda z: self.control_law(t, z[:n], z[n:], p, bounds), [*x, *lam])
            return self._jacobian(t, x, u, lam, p, by)

    def extremal_jacobian(
        self, t: Any, x: Sequence[Any], u: Sequence[Any], lam: Sequence[Any], p: Sequence[Any]
    ) -> list[Any]:
        with self._unnoted():
            return self._jacobian(t, x, u, lam, p, [constant(0)] * (len(u) * 2 * len(x)))

    @contextmanager
    def _unnoted(self) -> Iterator[None]:
        """Evaluate without noting comparisons that another evaluation notes."""
        noted, self.answers.noted = self.answers.noted, None
        try:
            yield
        finally:
            self.answers.noted = noted

    def _falls(self, t: Any, x: Sequence[Any], u: Sequence[Any], lam: Sequence[Any], p: Sequence[Any]) -> list[Series]:
        """Return the rates of the costates of the additional states."""
        own, more = list(x[: self.own]), list(x[self.own :])
        slopes = gradients(lambda v: [hamiltonian(self, t, [*own, *v], u, lam, p)], more)
        return [-v for v in slopes]

    def _jacobian(
        self, t: Any, x: Sequence[Any], u: Sequence[Any], lam: Sequence[Any], p: Sequence[Any], by: Sequence[Any]
    ) -> list[Any]:
        """Return the derivatives of all rates by states and costates, given those of the controls."""
        n, m = len(x), len(u)
        given = [Jet(v, {i: constant(1)}) for i, v in enumerate((*x, *u))]
        rates = [_jet(v) for v in self.dynamics(t, given[:n], given[n:], p)]
        total = _jet(hamiltonian(self, t, given[:n], given[n:], lam, p))

        def through(slopes: Sequence[Any], j: int) -> Any:
            """Return the effect of the controls when component j changes."""
            parts = [s * by[a * 2 * n + j] for a, s in enumerate(slopes) if s is not None]
            return sum(parts, constant(0))

        def second(i: int, j: int) -> Any:
            return total.second.get((min(i, j), max(i, j)))

        found: list[Any] = []
        for rate in rates:
            effects = [rate.first.get(n + a) for a in range(m)]
            found += [through(effects, j) + rate.first.get(j, constant(0)) for j in range(n)]
            found += [through(effects, n + j) for j in range(n)]
        for i in range(n):
            effects = [second(i, n + a) for a in range(m)]
            for j in range(n):
                direct = second(i, j)
                found.append(-(through(effects, j) + (constant(0) if direct is None else direct)))
            found += [-(through(effects, n + j) + rates[j].first.get(i, constant(0))) for j in range(n)]
        return found


def _jet(v: Any) -> Jet:
    return v if isinstance(v, Jet) else Jet(v)


def with_more_states(kernel: Lifted, found: Solution, parameters: Sequence[Any]) -> Solution:
    """Return a solver's solution with all states of a kernel and their costates.

    Costates of additional states vanish at the beginning; that of time, if the initial time is given, vanishes at the
    end, except for the terminal cost.
    """
    count, states = len(found.times), [found.x]
    states += [np.full((1, count), found.instance.parameters[i]) for i in kernel.places]
    states += [found.times[None]] if kernel.clocked else []
    x = np.vstack(states)
    more = len(x) - len(found.x)
    ctx.cap = 1
    rates = np.zeros((more, count))
    for k in range(count):
        there = [constant(arb(float(v))) for v in x[:, k]]
        costates = [*(constant(arb(float(v))) for v in found.lam[:, k]), *[constant(0)] * more]
        u = [constant(arb(float(v))) for v in found.u[:, k]]
        t = constant(arb(float(found.times[k])))
        rates[:, k] = [float(value(v).mid()) for v in kernel.costate_rate(t, there, u, costates, parameters)[-more:]]
    steps = (rates[:, 1:] + rates[:, :-1]) / 2 * np.diff(found.times)
    added = np.hstack([np.zeros((more, 1)), np.cumsum(steps, axis=1)])
    if kernel.clocked and not any(one.place is Place.TIME for one in found.instance.free):
        added[-1] -= added[-1, -1]
    return replace(found, x=x, lam=np.vstack([found.lam, added]))
