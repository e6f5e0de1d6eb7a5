"""Loading of instances from a name, a path or tables, with checks against their model.

The tables [classical], [switching], [driven] and [limits] are checked here, too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.instance import continuation, control, ends, files, numbers, resolve, unknowns
from satsym.instance.options import guess, lqr, solver
from satsym.instance.orbit import orbit
from satsym.instance.resolve import known, quantity, time, value_of
from satsym.instance.schema import ClassicalTable, DrivenTable, InstanceFile, SwitchingTable, check
from satsym.instance.types import ClassicalOptions, DrivenOptions, Instance
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import printable, shown

if TYPE_CHECKING:
    from satsym.kernels import Kernels

MAX_TITLE = 200


@dataclass(frozen=True, eq=False)
class Written:
    """An instance as it was written, in a file or in Python, before checks against its model."""

    tree: Mapping[str, Any]
    """Tables as TOML has them."""
    name: str
    """Name of the instance."""
    path: Path
    """File of the instance; models are looked for beside it."""
    given: str = ""
    """The name in messages; by default that of the instance."""
    model: Kernels | None = None
    """The kernels, if they are known and need not be searched."""

    def instance(self) -> Instance:
        """Return the instance after checks against its model.

        Raises
        ------
        BadInput
            With one line, ``NAME: KEY: what is wrong; what to do``.
        """
        try:
            file = check(files.finite(dict(self.tree)))
            return _resolve(self, file, self.model or _model(file.model, self.path.parent))
        except BadInput as error:
            raise BadInput(f"{_called(self.given or self.name)}: {error}") from None


def load(name_or_path: str | Path) -> Instance:
    """Read an instance and check it against its model.

    Parameters
    ----------
    name_or_path
        A shipped name, see :func:`~satsym.instance.shipped`, or the path of a TOML file.

    Returns
    -------
    Instance
        The instance; all numbers are finite and in the model's units.

    Raises
    ------
    BadInput
        With one line, ``FILE: KEY: what is wrong; what to do``.
    """
    return read(name_or_path).instance()


def read(name_or_path: str | Path) -> Written:
    """Return an instance as its file states it, without checks against its model.

    Parameters
    ----------
    name_or_path
        As for :func:`load`.

    Raises
    ------
    BadInput
        If it cannot be read.
    """
    given = str(name_or_path)
    try:
        path = files.locate(given)
        return Written(files.read(path), path.stem, path, given)
    except BadInput as error:
        raise BadInput(f"{_called(given)}: {error}") from None


def _called(given: str) -> str:
    return printable(given, 200) or shown(given)


def _model(model: str, folder: Path) -> Kernels:
    # imported here because listing the shipped instances needs no numpy
    from satsym import kernels

    if not model or not model.isprintable():
        raise BadInput(f'model: {shown(model)} is not a name; give the name of a model, such as "polar_orbit"')
    try:
        return kernels.load(model, folder)
    except BadInput as error:
        raise BadInput(f"model: {printable(str(error), 400)}") from None


def _resolve(written: Written, file: InstanceFile, model: Kernels) -> Instance:
    spec = model.spec
    if len(file.title) > MAX_TITLE or not file.title.isprintable():
        raise BadInput(
            f"title: {shown(file.title)} is not a single short line; use at most {MAX_TITLE} printable characters"
        )
    file, free = unknowns.begun(file, spec)
    t0, tf, tf_guess = resolve.times(file.time, spec)
    lower, upper, norms = control.bounds(file.control, spec)
    found = Instance(
        name=written.name,
        path=written.path,
        title=file.title,
        model=model,
        parameters=resolve.parameters(file.parameters, spec),
        initial=resolve.initial(file.initial, spec),
        final=resolve.final(ends.without_ranges(file.final, spec), spec),
        t0=t0,
        tf=tf,
        tf_guess=tf_guess,
        lower=lower,
        upper=upper,
        max_norm=norms.get(control.WHOLE, (0.0, math.inf))[1],
        norms={name: norm for name, norm in norms.items() if name != control.WHOLE},
        solver=solver(file.solver, spec),
        lqr=lqr(file.lqr, spec),
        guess=guess(file.guess, spec),
        classical=classical(file.classical, spec),
        limits=limits(file.limits, spec),
        deadband=deadband(file.switching, spec),
        driven=driven(file.driven, spec),
        free=free,
        ranges=ends.ranges(file.final, spec),
        orbit=orbit(file.orbit, spec),
    )
    changing = continuation.varied(file.continuation, spec, found)
    for one in changing:
        found = one.at(found, 1.0)
    found = replace(found, continuation=changing)
    _refuse_beside_limits(found)
    if file.study:
        for table in (file.study.vary, file.study.normal, file.study.uniform):
            for key, _ in numbers.texts(table):
                numbers.find(key, found)
    return found


def _refuse_beside_limits(instance: Instance) -> None:
    """Refuse features that are not solved together with ranges of final states or inequalities."""
    for name in instance.ranges:
        if name in instance.solver.free_angles:
            key = f"[final] {name}: a range"
            raise BadInput(f"{key} is not counted modulo a full turn; leave the state out of [solver] free_angles")
    for name in instance.end_limits:
        if instance.free:
            key = instance.free[0].key
            raise BadInput(
                f'{key}: "{resolve.FREE}" cannot be combined with limits on the final state or time ({name}); '
                "give a number"
            )
        if instance.continuation:
            raise BadInput(
                f"[continuation]: cannot be combined with limits on the final state or time ({name}); leave it out"
            )


def classical(table: ClassicalTable | None, spec: ProblemSpec) -> ClassicalOptions | None:
    """Return the classical control law that an instance states.

    Raises
    ------
    BadInput
        If a name is no state, both or neither of damping and gains are given, or a number has no meaning.
    """
    if table is None:
        return None
    if table.follows not in spec.state_names:
        have = ", ".join(spec.state_names)
        raise BadInput(f"[classical] follows: the model has no state {shown(table.follows)}; available states: {have}")
    state = spec.states[spec.state_names.index(table.follows)]
    if len(spec.controls) != 1:
        raise BadInput(
            f"[classical] the control law has one control, but the model {spec.name} has {len(spec.controls)}"
        )
    if (table.damping is None) == (table.gains is None):
        raise BadInput("[classical] damping: write either the damping, such as 0.01, or the gains, but not both")
    damping = None if table.damping is None else quantity(table.damping, _rate(spec), "[classical] damping")
    if damping is not None and damping <= 0.0:
        raise BadInput(f"[classical] damping: {shown(table.damping)} is not positive, so the loop would not be stable")
    differentiator = time(table.differentiator, "[classical] differentiator", spec)
    if differentiator < 0.0:
        raise BadInput(
            f"[classical] differentiator: {shown(table.differentiator)} is negative; give a time constant, or "
            "0 for an ideal differentiator"
        )
    if table.gains is not None and min(table.gains) <= 0.0:
        raise BadInput(
            f"[classical] gains: {shown(table.gains)} are not both positive, so the loop would not be stable"
        )
    return ClassicalOptions(
        follows=table.follows,
        command=value_of(state, table.command, "[classical] command"),
        damping=damping,
        gains=table.gains,
        differentiator=differentiator,
    )


def limits(table: Mapping[str, float | str], spec: ProblemSpec) -> dict[str, float]:
    """Return the largest magnitudes that an instance allows, by name, in the model's units.

    Raises
    ------
    BadInput
        If a name is no state or derived quantity, or a limit is not positive.
    """
    variables = (*spec.states, *spec.quantities)
    known(table, variables, "state or derived quantity", "limits")
    found = {
        v.symbol: quantity(table[v.symbol], v.unit, f"[limits] {v.symbol}") for v in variables if v.symbol in table
    }
    for name, limit in found.items():
        if limit <= 0.0:
            raise BadInput(f"[limits] {name}: {shown(table[name])} is not positive; give the largest allowed magnitude")
    return found


def deadband(table: SwitchingTable | None, spec: ProblemSpec) -> float | None:
    """Return the position error that a switching feedback tolerates.

    Raises
    ------
    BadInput
        If the model has no switching curve, or the deadband is not positive.
    """
    if table is None:
        return None
    if not spec.switching_curve:
        raise BadInput(
            f"[switching] model {spec.name} has no switching curve in closed form (only minimum-time problems "
            "of double integrators have one); leave out this table"
        )
    position = spec.states[spec.state_names.index(spec.switching_curve[0])]
    found = quantity(table.deadband, position.unit, "[switching] deadband")
    if found <= 0.0:
        raise BadInput(
            f"[switching] deadband: {shown(table.deadband)} is not positive; give the allowed error of "
            f"{position.symbol}"
        )
    return found


def driven(table: DrivenTable | None, spec: ProblemSpec) -> DrivenOptions | None:
    """Return the control that other instances compute.

    Raises
    ------
    BadInput
        If the model has no such control, or no instance is named.
    """
    if table is None:
        return None
    if table.control not in spec.control_names:
        have = ", ".join(spec.control_names) or "none"
        raise BadInput(f"[driven] control: the model has no control {shown(table.control)}; available controls: {have}")
    if not table.by:
        raise BadInput("[driven] by: an empty list; name at least one instance that determines the control")
    return DrivenOptions(table.control, tuple(table.by))


def _rate(spec: ProblemSpec) -> str:
    """Return the unit of a damping: per second, or a plain number where all numbers of the model are plain."""
    return "1/s" if any(v.unit != "1" for v in (*spec.states, *spec.parameters)) else "1"
