"""Source text of steps of the canonical equations for many columns at once, to be compiled.

Every column has its own time, step and parameters; bounds are the same for all. A step is one of an explicit Runge-
Kutta method, or of the extrapolated midpoint rule; the running cost, or the derivatives of the end by the beginning,
are integrated along.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from satsym.kernels.batch.compiling import HEAD
from satsym.kernels.batch.workspace import (
    LANES,
    Inlined,
    Loads,
    Workspace,
    element,
    function,
    indented,
    inlined,
    loaded,
    over_blocks,
    over_lanes,
    over_rows,
    stored,
)
from satsym.spec import ProblemSpec

Tableau = tuple[Sequence[Sequence[float]], Sequence[float], Sequence[float]]
"""The coefficients A, b and c of an explicit Runge-Kutta method."""

CLASSICAL: Tableau = (
    ((0.0,) * 4, (0.5, 0.0, 0.0, 0.0), (0.0, 0.5, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0)),
    (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0),
    (0.0, 0.5, 0.5, 1.0),
)
"""The tableau of the classical method of order four."""

COLUMNS = 8
"""Largest number of columns of an extrapolation table."""


@dataclass(frozen=True)
class Rows:
    """The quantities that are integrated together."""

    name: str
    count: int
    columns: int = 0
    """Number of columns of derivatives with respect to the initial values of a step, among these quantities."""


def text(spec: ProblemSpec, module: str, bounds: Sequence[float], accurate: Tableau) -> str:
    """Return the source text of the module with the steps.

    Parameters
    ----------
    spec, module
        The model, and the text of its generated module.
    bounds
        The argument ``bounds`` of its functions, the same for all columns.
    accurate
        The method of higher order.
    """
    writer = _Writer(spec, module, bounds)
    n = writer.n
    plain, costing = Rows("plain", 2 * n), Rows("costing", 2 * n + 1)
    varied = Rows("varied", 2 * n + 4 * n * n, 2 * n)
    lines = [*HEAD, *writer.canonical(), *writer.cost(), *writer.varied()]
    for rows, calls in (
        (plain, ("canonical",)),
        (costing, ("canonical", "cost")),
        (varied, ("canonical", "varied")),
    ):
        body = [f"{call}(w, c, y, k)" for call in calls]
        lines += function(f"rates_{rows.name}(w, c, y, k)", body)
    lines += writer.stepping("accurate", costing, accurate)
    lines += writer.stepping("rough", varied, CLASSICAL)
    lines += [*writer.leaping(costing), *writer.leaping(varied)]
    return "\n".join(lines) + "\n"


class _Writer:
    """Writer of the functions of one model."""

    def __init__(self, spec: ProblemSpec, module: str, bounds: Sequence[float]) -> None:
        self.module, self.bounds = module, [repr(float(bound)) for bound in bounds]
        self.n, self.parameters = len(spec.states), len(spec.parameters)

    def workspace(self) -> Workspace:
        """Return a workspace in which the rows that all functions share are at the same places."""
        found = Workspace()
        for name, rows in (("p", self.parameters), ("t", 1), ("h", 1), ("slopes", 4 * self.n**2)):
            found.place(name, rows)
        return found

    def loads(self, **more: object) -> Loads:
        """Map the arguments of generated functions to their places; states and costates are at ``y``."""
        own = self.workspace()
        found: dict[str, object] = {
            "t": lambda _: f"(w[{own['t']} + j] + c * w[{own['h']} + j])",
            "x": lambda k: element("y", k),
            "lam": lambda k: element("y", self.n + k),
            "p": lambda k: element(own["p"], k),
            "bounds": lambda k: self.bounds[k],
        }
        return found | more  # type: ignore[return-value]

    def inlined(self, name: str, prefix: str, **more: object) -> Inlined:
        """Return a function of the model as inlined lines."""
        return inlined(self.module, name, self.loads(**more), prefix)

    def canonical(self) -> list[str]:
        """Write rates of states and costates, times the step, at ``y`` and the time ``c`` of the step."""
        found, step = self.inlined("canonical", "a_"), self.workspace()["h"]
        stores = [f"{element('k', i)} = w[{step} + j] * ({result})" for i, result in enumerate(found.results)]
        return function("canonical(w, c, y, k)", over_lanes([*found.lines, *stores]))

    def cost(self) -> list[str]:
        """Write the function for the slope of the running cost, the row after the costates."""
        law, step = self.inlined("control_law", "b_"), self.workspace()["h"]
        controls = [f"u_{k} = {result}" for k, result in enumerate(law.results)]
        running = self.inlined("running_cost", "d_", u=lambda k: f"u_{k}")
        store = f"{element('k', 2 * self.n)} = w[{step} + j] * ({running.results[0]})"
        return function("cost(w, c, y, k)", over_lanes([*law.lines, *controls, *running.lines, store]))

    def varied(self) -> list[str]:
        """Write the function for slopes of the derivatives by where the step begins, which are stored row by row."""
        found, own, rows = self.inlined("canonical_jacobian", "e_"), self.workspace(), 2 * self.n
        stores = [
            f"{element(own['slopes'], q)} = w[{own['h']} + j] * ({found.results[place]})"
            for q, place in enumerate(found.nonzero)
        ]
        column = [f"v{i} = w[y + {(rows + i * rows) * LANES} + z * {LANES} + j]" for i in range(rows)]
        for i in range(rows):
            terms = [
                f"{element(own['slopes'], q)} * v{place % rows}"
                for q, place in enumerate(found.nonzero)
                if place // rows == i
            ]
            column.append(f"w[k + {(rows + i * rows) * LANES} + z * {LANES} + j] = {' + '.join(terms) or '0.0'}")
        every = [f"for z in range({rows}):", *indented(over_lanes(column))]
        return function("varied(w, c, y, k)", [*over_lanes([*found.lines, *stores]), *every])

    def stepping(self, name: str, rows: Rows, tableau: Tableau) -> list[str]:
        """Write steps of a Runge-Kutta method, each of ``parts`` equal ones."""
        own, (a, b, c) = self.workspace(), tableau
        z, y = own.place("z", rows.count), own.place("y", rows.count)
        stages = [own.place(f"stage {i}", rows.count) for i in range(len(b))]
        body = []
        for i, stage in enumerate(stages):
            terms = [f"{float(weight)!r} * w[{stages[q]} + q]" for q, weight in enumerate(a[i]) if weight]
            if terms:
                body += over_rows(rows.count, [f"w[{y} + q] = w[{z} + q] + {' + '.join(terms)}"])
            body.append(f"rates_{rows.name}(w, {float(c[i])!r}, {y if terms else z}, {stage})")
        ends = [f"{float(weight)!r} * w[{stages[q]} + q]" for q, weight in enumerate(b) if weight]
        body += over_rows(rows.count, [f"w[{z} + q] += {' + '.join(ends)}"])
        divided = over_lanes([f"w[{own['h']} + j] = h[at + min(j, width - 1)] / parts"])
        moved = over_lanes([f"w[{own['t']} + j] += w[{own['h']} + j]"])
        block = [
            *self._begun(own, rows),
            *divided,
            "for part in range(parts):",
            *indented([*body, *moved]),
            *self._kept(z, rows, "ends", "transition"),
        ]
        out = "ends, transition" if rows.columns else "ends"
        head = f"{name}(t, y, h, p, parts, {out})"
        return function(head, [f"w = np.zeros({own.size})", *over_blocks("len(t)", block)])

    def leaping(self, rows: Rows) -> list[str]:
        """Write extrapolated steps, with the difference of the last two columns of the table."""
        own, size = self.workspace(), rows.count * LANES
        z, before, now, slope, rate = (own.place(name, rows.count) for name in ("z", "before", "now", "slope", "rate"))
        table = own.place("table", rows.count * COLUMNS)

        def whole(*lines: str) -> list[str]:
            return over_rows(rows.count, lines)

        midpoints = [
            "count = 2 * (column + 1)",
            *whole(f"w[{before} + q] = w[{z} + q]", f"w[{now} + q] = w[{z} + q] + w[{slope} + q] / count"),
            "for i in range(1, count):",
            f"    rates_{rows.name}(w, i / count, {now}, {rate})",
            *indented(
                whole(
                    f"after = w[{before} + q] + 2.0 / count * w[{rate} + q]",
                    f"w[{before} + q] = w[{now} + q]",
                    f"w[{now} + q] = after",
                )
            ),
            "for i in range(column):",
            "    weight = 1.0 / ((count / (2.0 * (column - i))) ** 2 - 1.0)",
            *indented(
                whole(
                    f"after = w[{now} + q] + (w[{now} + q] - w[{table} + i * {size} + q]) * weight",
                    f"w[{table} + i * {size} + q] = w[{now} + q]",
                    f"w[{now} + q] = after",
                )
            ),
            *whole(f"w[{table} + column * {size} + q] = w[{now} + q]"),
        ]
        last, one_before = f"w[{table} + (columns - 1) * {size} + q]", f"w[{table} + (columns - 2) * {size} + q]"
        block = [
            *self._begun(own, rows),
            f"rates_{rows.name}(w, 0.0, {z}, {slope})",
            "for column in range(columns):",
            *indented(midpoints),
            *whole(f"w[{now} + q] = {last}", f"w[{before} + q] = abs({last} - {one_before})"),
            *self._kept(now, rows, "ends", "transition"),
            *self._kept(before, rows, "off", "off_transition"),
        ]
        out = "ends, transition, off, off_transition" if rows.columns else "ends, off"
        head = f"leap_{rows.name}(t, y, h, p, columns, {out})"
        return function(head, [f"w = np.zeros({own.size})", *over_blocks("len(t)", block)])

    def _begun(self, own: Workspace, rows: Rows) -> list[str]:
        """Write the loads of arguments of a block of columns, and of initial values."""
        lines = loaded(own["p"], "p", self.parameters)
        for name in ("t", "h"):
            lines += over_lanes([f"w[{own[name]} + j] = {name}[at + min(j, width - 1)]"])
        lines += loaded(own["z"], "y", rows.count - rows.columns**2)
        if rows.columns:
            begin = own["z"] + rows.columns * LANES
            lines += over_rows(rows.columns**2, [f"w[{begin} + q] = 0.0"])
            unity = f"w[{begin} + i * {(rows.columns + 1) * LANES} + j] = 1.0"
            lines += [f"for i in range({rows.columns}):", *indented(over_lanes([unity]))]
        return lines

    def _kept(self, begin: int, rows: Rows, ends: str, transition: str) -> list[str]:
        lines = stored(begin, ends, rows.count - rows.columns**2)
        return lines + (stored(begin + rows.columns * LANES, transition, rows.columns**2) if rows.columns else [])
