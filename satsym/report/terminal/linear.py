"""What an analysis or a regulator says to people, as plain text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from satsym.analysis.linear.stability import UNSTABLE, shown
from satsym.report.results.exact import omitted_because
from satsym.report.results.unit_names import COST, of_regulator, time_unit
from satsym.report.terminal.solution import joined
from satsym.report.terminal.table import figure, table, wrapped

if TYPE_CHECKING:
    from satsym.analysis.linear.equilibrium import Linearisation
    from satsym.analysis.linear.ranks import Reach
    from satsym.analysis.linear.routh import Routh
    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.regulator.feedback import Design
    from satsym.arrays import Array


def analysis_text(found: Analysis, colour: bool = False) -> str:
    """Summary of an analysis."""
    about, system = found.about, found.about.system
    verdict = found.stability.verdict or "undecided"
    if colour:
        verdict = f"\x1b[{31 if verdict == UNSTABLE else 32}m{verdict}\x1b[0m"
    header = ("eigenvalue", "algebraic", "geometric", "Jordan blocks")
    eigenvalues = [
        (complex_number(each.value), str(each.algebraic), str(each.geometric), ", ".join(map(str, each.blocks)))
        for each in found.eigenvalues
    ]
    return joined(
        [
            [about.model.spec.title, f"{about.model.spec.name}, {_where(about)}: {verdict}"],
            wrapped(found.stability.reason),
            _point(about),
            _matrix("A", system.A, system.states, system.states),
            _matrix("B", system.B, system.states, system.inputs),
            _matrix("C", system.C, system.outputs, system.states),
            table([header, *eigenvalues], right=(1, 2)),
            _mode_table(found),
            _polynomial("characteristic polynomial", found.polynomial, found.routh),
            _reach("controllability", "controllable", "inputs", found.controllability, len(system.states))
            + _reach("observability", "observable", "outputs", found.observability, len(system.states)),
            wrapped(omitted_because(about)),
        ]
    )


def regulator_text(design: Design) -> str:
    """Summary of a regulator."""
    found, about, system = design.regulator, design.about, design.regulator.system
    over = "an infinite horizon" if found.horizon is None else f"a horizon of {figure(found.horizon)}, at its beginning"
    name = about.model.spec.name if design.instance is None else design.instance.name
    facts = [("Riccati residual", figure(found.residual, 2))]
    if found.error is not None:
        facts.append(("estimated error of P", figure(found.error, 2)))
    if design.deviation is not None:
        unit = of_regulator(about.model.spec, system.inputs, design.relative)
        cost = figure(found.cost(design.deviation), 10)
        facts.append(("cost from the initial state", cost if unit in ("1", COST) else f"{cost} {unit}"))
    eigenvalues = [(complex_number(value),) for value in found.eigenvalues]
    return joined(
        [
            [design.title, f"{name}, model {about.model.spec.name}: u = -K x for {over}"],
            _matrix("K", found.K, system.inputs, system.states),
            _matrix("P", found.P, system.states, system.states),
            table([("closed-loop eigenvalue",), *eigenvalues]),
            _polynomial("characteristic polynomial of the closed loop", found.polynomial, found.routh),
            table([("", ""), *facts])[1:],
        ]
    )


def _where(about: Linearisation) -> str:
    if about.model.spec.linear:
        found = "which is linear"
    else:
        found = "linearised about its reference" if about.on_reference else "linearised about an equilibrium"
    return found if about.constant else f"{found}, its coefficients at t = {figure(about.t0)}"


def _point(about: Linearisation) -> list[str]:
    """The point of linearisation, where it is not zero."""
    if not about.point.any():
        return []
    rows = [
        (state.symbol, figure(value, 10), "" if state.unit == "1" else state.unit)
        for state, value in zip(about.model.spec.states, about.point, strict=True)
    ]
    return table([("state", f"at t = {figure(about.t0)}", "unit"), *rows], right=(1,))


def _matrix(letter: str, matrix: Array, rows: Sequence[str], columns: Sequence[str]) -> list[str]:
    if not matrix.size:
        return []
    lines = [(name, *(figure(value) for value in row)) for name, row in zip(rows, matrix, strict=True)]
    return table([(letter, *columns), *lines], right=range(1, len(columns) + 1))


def _mode_table(found: Analysis) -> list[str]:
    """What each mode is, how long it takes and which states carry it."""
    unit = time_unit(found.about.model.spec)
    header = ("mode", "", f"period{unit and f' [{unit}]'}", "damping ratio", f"time constant{unit and f' [{unit}]'}")
    rows = [
        (
            shown(each.eigenvalue.value),
            each.name,
            *(
                "" if value is None else figure(value)
                for value in (each.period, each.damping_ratio, each.time_constant)
            ),
            ", ".join(f"{name} {share:.0%}" for name, share in each.carried_by()),
        )
        for each in found.modes
    ]
    return table([(*header, "carried by"), *rows], right=(2, 3, 4))


def _polynomial(what: str, coefficients: Array, array: Routh) -> list[str]:
    terms = [
        (figure(c, 10), f"s^{power}" if power > 1 else "s" if power else "")
        for power, c in zip(range(len(coefficients) - 1, -1, -1), coefficients, strict=True)
        if c
    ]
    written = " + ".join(f"{'' if c == '1' and s else c}{' ' if s and c != '1' else ''}{s}" for c, s in terms)
    column = ", ".join(figure(value, 6) for value in array.column)
    count = array.sign_changes
    says = f"{count} sign change{'s' * (count != 1)}: {count or 'no'} right-half-plane root{'s' * (count != 1)}"
    axis = f", {array.on_axis} on the imaginary axis" if array.on_axis else ""
    met = f" (met: {array.special_case})" if array.special_case else ""
    return wrapped(f"{what}: {written.replace('+ -', '- ')}") + wrapped(f"Routh column: {column}; {says}{axis}{met}")


def _reach(word: str, verb: str, kind: str, found: Reach | None, n: int) -> list[str]:
    if found is None:
        return [f"  {word}: there are no {kind}"]
    alone = [
        f"{name} alone {each.rank}" + (f" (without the mode s = {_modes(each)})" if each.lost else "")
        for name, each in found.alone.items()
    ]
    return wrapped(f"{word}: {verb} subspace of dimension {found.rank} of {n}; " + ", ".join(alone))


def _modes(found: Reach) -> str:
    return ", ".join(shown(each.value) for each in found.lost if each.value.imag >= 0.0)


def complex_number(value: complex) -> str:
    """A complex number as tables show it."""
    if value.imag == 0.0:
        return figure(value.real, 10)
    if value.real == 0.0:
        return f"{figure(value.imag, 10)}i"
    sign = "-" if value.imag < 0.0 else "+"
    return f"{figure(value.real, 10)} {sign} {figure(abs(value.imag), 10)}i"
