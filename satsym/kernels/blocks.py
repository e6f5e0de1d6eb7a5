"""Compiled steps for many motions at once: ``advance(t, h, steps, y, u, p)`` moves every column of y, in place.

A motion is a column of arrays, so that neighbours in memory are the same component of different motions. The generated
scalar form is inlined, for blocks of columns that stay in the processor's registers and its cache for all steps.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from satsym.kernels.batch import compiling
from satsym.kernels.batch.workspace import (
    Workspace,
    element,
    function,
    indented,
    inlined,
    loaded,
    over_blocks,
    over_lanes,
    stored,
)
from satsym.kernels.core import Kernels
from satsym.kernels.plain import weights
from satsym.spec import ProblemSpec
from satsym.status import BadInput


@lru_cache(maxsize=32)
def block_step(kernels: Kernels, symplectic: bool = False) -> Any:
    """Return compiled steps for the columns of arrays, by RK4 or by kicks and drifts.

    Raises
    ------
    BadInput
        If the kernels were not compiled.
    """
    if kernels.backend != "numba":
        raise BadInput(f"{kernels.spec.name}: a block step requires compiled kernels: call compiled() first")
    return kicks_and_drifts(kernels) if symplectic else rk4(kernels)


def rk4(kernels: Kernels) -> Any:
    """Return compiled RK4 steps under constant controls."""
    writer = _Writer(kernels)
    n = range(writer.n)
    body = [
        *writer.rates("a", "now", [writer.at(i) for i in n]),
        *(f"z{i} = {writer.at(i)} + half * a_{i}" for i in n),
        *writer.rates("b", "middle", [f"z{i}" for i in n]),
        *(f"y{i} = {writer.at(i)} + half * b_{i}" for i in n),
        *writer.rates("c", "middle", [f"y{i}" for i in n]),
        *(f"x{i} = {writer.at(i)} + h * c_{i}" for i in n),
        *writer.rates("d", "end", [f"x{i}" for i in n]),
        *(f"{writer.at(i)} += sixth * (a_{i} + 2.0 * (b_{i} + c_{i}) + d_{i})" for i in n),
    ]
    return writer.compiled(
        ["half, sixth = 0.5 * h, h / 6.0"],
        ["now = t + i * h", "middle, end = now + half, now + h", *over_lanes(body)],
    )


def kicks_and_drifts(kernels: Kernels) -> Any:
    """Return compiled symplectic steps of a separable motion, without control."""
    writer = _Writer(kernels)
    body = writer.rates("a", "t", [writer.at(i) for i in range(writer.n)])
    for q, v in pairs(kernels.spec):
        body += [f"{writer.at(v)} += kick * a_{v}", f"{writer.at(q)} += drift * {writer.at(v)}"]
    kicks, drifts = weights()
    return writer.compiled(
        [f"kicks, drifts = {tuple(kicks)!r}, {(*drifts, 0.0)!r}"],
        [
            f"for k in range({len(kicks)}):",
            "    kick, drift = h * kicks[k], h * drifts[k]",
            *indented(over_lanes(body)),
        ],
    )


def pairs(spec: ProblemSpec) -> list[tuple[int, int]]:
    """Return the positions of each coordinate and of its velocity among the states of a separable motion."""
    place = {name: k for k, name in enumerate(spec.state_names)}
    return [(place[q], place[v]) for q, v in zip(spec.coordinates, spec.velocities, strict=True)]


class _Writer:
    """Writer of the source text of one model's loop."""

    def __init__(self, kernels: Kernels) -> None:
        spec = kernels.spec
        self.name, self.text, self.own = spec.name, compiling.module_text(kernels), Workspace()
        self.n, self.rows = len(spec.states), {"u": len(spec.controls), "p": len(spec.parameters)}
        self.places = {name: self.own.place(name, rows) for name, rows in {"y": self.n, **self.rows}.items()}

    def at(self, state: int) -> str:
        """Write a state."""
        return element(self.places["y"], state)

    def rates(self, prefix: str, time: str, states: list[str]) -> list[str]:
        """Write the lines that compute the rates, named by the prefix and a number each."""

        def row(name: str) -> Callable[[int], str]:
            return lambda k: element(self.places[name], k)

        loads = {"t": lambda _: time, "x": lambda k: states[k], "u": row("u"), "p": row("p")}
        found = inlined(self.text, "dynamics", loads, f"{prefix}{prefix}_")
        return [*found.lines, *(f"{prefix}_{i} = {result}" for i, result in enumerate(found.results))]

    def compiled(self, first: list[str], step: list[str]) -> Any:
        """Compile the loop over the steps, for each block of columns."""
        loads = [line for name, at in self.places.items() for line in loaded(at, name, self.rows.get(name, self.n))]
        block = [*loads, "for i in range(steps):", *indented(step), *stored(self.places["y"], "y", self.n)]
        body = [f"w = np.zeros({self.own.size})", *first, *over_blocks("y.shape[1]", block)]
        lines = [*compiling.HEAD, *function("many(t, h, steps, y, u, p)", body)]
        return compiling.compiled(self.name, "\n".join(lines) + "\n")["many"]
