"""Analyses, regulators and equilibria of attitudes as plain text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from satsym.analysis.linear.spectrum import UNSTABLE, shown
from satsym.report.results.linear import axis, omitted_because
from satsym.report.results.objects import COST, of_regulator, time_unit
from satsym.report.said import counted, each, message, say
from satsym.report.terminal.table import figure, joined, table, wrapped

if TYPE_CHECKING:
    from satsym.analysis.linear.equilibrium import Linearisation
    from satsym.analysis.linear.ranks import Reach
    from satsym.analysis.linear.routh import Routh
    from satsym.analysis.regulator.feedback import Design
    from satsym.analysis.subject import Analysis
    from satsym.arrays import Array
    from satsym.symbolic.equilibria.momenta import Attitudes


def analysis_text(found: Analysis, colour: bool = False) -> str:
    """Summarise an analysis."""
    about, system = found.about, found.about.system
    verdict = message(found.stability.verdict or "undecided")
    if colour:
        verdict = f"\x1b[{31 if found.stability.verdict == UNSTABLE else 32}m{verdict}\x1b[0m"
    header = each("eigenvalue", "algebraic", "geometric", "Jordan blocks")
    eigenvalues = [
        (complex_number(one.value), str(one.algebraic), str(one.geometric), ", ".join(map(str, one.blocks)))
        for one in found.eigenvalues
    ]
    return joined(
        [
            [say(about.model.spec.title), f"{about.model.spec.name}, {_where(about)}: {verdict}"],
            wrapped(message(found.stability.reason)),
            _point(about),
            _matrix("A", system.A, system.states, system.states),
            _matrix("B", system.B, system.states, system.inputs),
            _matrix("C", system.C, system.outputs, system.states),
            table([header, *eigenvalues], right=(1, 2)),
            _mode_table(found),
            _polynomial(say("characteristic polynomial"), found.polynomial, found.routh),
            _reach(CONTROLLABILITY, found.controllability, len(system.states))
            + _reach(OBSERVABILITY, found.observability, len(system.states)),
            wrapped(message(omitted_because(about))),
        ]
    )


def regulator_text(design: Design) -> str:
    """Summarise a regulator."""
    found, about, system = design.regulator, design.about, design.regulator.system
    over = say("u = -K x for an infinite horizon")
    if found.horizon is not None:
        over = say("u = -K x, with K at the beginning of a horizon of <time>", time=figure(found.horizon))
    name = about.model.spec.name if design.instance is None else design.instance.name
    facts = [(say("Riccati residual"), figure(found.residual, 2))]
    if found.error is not None:
        facts.append((say("estimated error of P"), figure(found.error, 2)))
    if design.deviation is not None:
        unit = of_regulator(about.model.spec, system.inputs, design.relative)
        cost = figure(found.cost(design.deviation), 10)
        facts.append((say("cost from the initial state"), cost if unit in ("1", COST) else f"{cost} {unit}"))
    eigenvalues = [(complex_number(value),) for value in found.eigenvalues]
    return joined(
        [
            [say(design.title), f"{say('<name>, model <model>', name=name, model=about.model.spec.name)}: {over}"],
            _matrix("K", found.K, system.inputs, system.states),
            _matrix("P", found.P, system.states, system.states),
            table([each("closed-loop eigenvalue"), *eigenvalues]),
            _polynomial(say("characteristic polynomial of the closed loop"), found.polynomial, found.routh),
            table([("", ""), *facts])[1:],
        ]
    )


def _where(about: Linearisation) -> str:
    if about.model.spec.linear:
        found = say("which is linear")
    else:
        found = say("linearised about its reference" if about.on_reference else "linearised about an equilibrium")
    if about.constant:
        return found
    return say("<linearised>, its coefficients at t = <time>", linearised=found, time=figure(about.t0))


def _point(about: Linearisation) -> list[str]:
    """Return the point of linearisation, where it is not zero."""
    if not about.point.any():
        return []
    rows = [
        (state.symbol, figure(value, 10), "" if state.unit == "1" else state.unit)
        for state, value in zip(about.model.spec.states, about.point, strict=True)
    ]
    return table([(say("state"), say("at <times>", times=f"t = {figure(about.t0)}"), say("unit")), *rows], right=(1,))


def _matrix(letter: str, matrix: Array, rows: Sequence[str], columns: Sequence[str]) -> list[str]:
    if not matrix.size:
        return []
    lines = [(name, *(figure(value) for value in row)) for name, row in zip(rows, matrix, strict=True)]
    return table([(letter, *columns), *lines], right=range(1, len(columns) + 1))


def _mode_table(found: Analysis) -> list[str]:
    """Return a table of modes: name, time, and the states with the largest parts."""
    unit = time_unit(found.about.model.spec)
    bracket = unit and f" [{unit}]"
    header = (say("mode"), "", say("period") + bracket, say("damping ratio"), say("time constant") + bracket)
    rows = [
        (
            shown(each.eigenvalue.value),
            message(each.name),
            *(
                "" if value is None else figure(value)
                for value in (each.period, each.damping_ratio, each.time_constant)
            ),
            ", ".join(f"{name} {share:.0%}" for name, share in each.carried_by()),
        )
        for each in found.modes
    ]
    return table([(*header, say("dominant states")), *rows], right=(2, 3, 4))


def _polynomial(what: str, coefficients: Array, array: Routh) -> list[str]:
    terms = [
        (figure(c, 10), f"s^{power}" if power > 1 else "s" if power else "")
        for power, c in zip(range(len(coefficients) - 1, -1, -1), coefficients, strict=True)
        if c
    ]
    written = " + ".join(f"{'' if c == '1' and s else c}{' ' if s and c != '1' else ''}{s}" for c, s in terms)
    column = ", ".join(figure(value, 6) for value in array.column)
    count = array.sign_changes
    roots = counted(count, "right-half-plane root") if count else say("no right-half-plane roots")
    says = say(
        "Routh column: <column>; <changes>: <roots>", column=column, changes=counted(count, "sign change"), roots=roots
    )
    if array.on_axis:
        says = say("<routh>, <number> on the imaginary axis", routh=says, number=array.on_axis)
    if array.special_case:
        says = say("<routh> (special case: <case>)", routh=says, case=message(array.special_case))
    return wrapped(f"{what}: {written.replace('+ -', '- ')}") + wrapped(says)


CONTROLLABILITY = (
    "controllability: there are no inputs",
    "controllability: controllable subspace of dimension <rank> of <n>; <alone>",
)
OBSERVABILITY = (
    "observability: there are no outputs",
    "observability: observable subspace of dimension <rank> of <n>; <alone>",
)


def _reach(texts: tuple[str, str], found: Reach | None, n: int) -> list[str]:
    if found is None:
        return wrapped(say(texts[0]))
    alone = [
        say("<name> alone: <rank> (without the mode s = <mode>)", name=name, rank=one.rank, mode=_modes(one))
        if one.lost
        else say("<name> alone: <rank>", name=name, rank=one.rank)
        for name, one in found.alone.items()
    ]
    return wrapped(say(texts[1], rank=found.rank, n=n, alone=", ".join(alone)))


def _modes(found: Reach) -> str:
    return ", ".join(shown(each.value) for each in found.lost if each.value.imag >= 0.0)


def complex_number(value: complex) -> str:
    """Write a complex number for tables."""
    if value.imag == 0.0:
        return figure(value.real, 10)
    if value.real == 0.0:
        return f"{figure(value.imag, 10)}i"
    sign = "-" if value.imag < 0.0 else "+"
    return f"{figure(value.real, 10)} {sign} {figure(abs(value.imag), 10)}i"


def attitudes_text(found: Attitudes) -> str:
    """Summarise the equilibria of an attitude."""
    kinds = Counter(one.kind.value for one in found.equilibria)
    listed = ", ".join(f"{count} {message(kind)}" for kind, count in sorted(kinds.items()))
    header = (*each("nadir in body axes", "normal of the orbit, reversed"), "")
    attitudes = [
        (_vector(one.cosines[2]), _vector(one.cosines[1]), message(one.kind.value)) for one in found.equilibria
    ]
    parts = [
        [say("equilibria: <number>; <kinds>", number=_number(found), kinds=listed)],
        table([header, *sorted(attitudes)]),
    ]
    if found.followed is not None:
        changes = [
            (
                say("<low> to <high>", low=f"{c.below:.7g}", high=f"{c.above:.7g}"),
                say("<low> to <high>", low=c.counts[0], high=c.counts[1]),
                *map(_kinds, c.kinds),
            )
            for c in found.followed.changes
        ]
        last = figure(float(found.followed.values[-1]))
        bracket = say("change as <name> grows to <value>", name=found.parameter, value=last)
        parts.append(table([(bracket, *each("number", "kinds below", "kinds above")), *changes]))
    return joined(parts)


def _number(found: Attitudes) -> str:
    """State the number of equilibria, or describe the infinite set of them."""
    whole = found.continuum
    if whole is None:
        return say("<count> attitudes (<number> including complex ones)", count=found.count, number=found.complex)
    if whole.circles is None:
        text = "infinitely many: a set of dimension <n> (complex attitudes included), which is not resolved"
        return say(text, n=whole.dimension)
    text = (
        "infinitely many, in <n> families: each attitude may be turned by any angle about the body axis <axis>, "
        "and one of each family is listed below"
    )
    return say(text, n=len(whole.circles), axis=axis(whole))


def _kinds(found: object) -> str:
    assert isinstance(found, dict)
    return ", ".join(f"{count} {message(kind.value)}" for kind, count in found.items())


def _vector(values: object) -> str:
    return "(" + ", ".join(f"{round(value, 4) + 0.0:7.4f}" for value in values) + ")"  # type: ignore[attr-defined]
