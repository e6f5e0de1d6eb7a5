"""Trajectories as files, and reading of saved results."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from satsym.instance.ends import Side
from satsym.instance.numbers import changed
from satsym.instance.unknowns import Place
from satsym.report.results import files, sets
from satsym.report.results.certificate import Stored as StoredCertificate
from satsym.report.results.certificate import absent
from satsym.report.results.files import Content
from satsym.report.results.objects import units, with_units
from satsym.report.results.set_list import LIST, unusable
from satsym.solution import CostInterval, Event, Invariant, Iteration, Simulation, Solution
from satsym.status import BadInput, Status
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.spec import ProblemSpec

Stored = dict[str, NDArray[Any]]

ARRAYS = "trajectory.npz"
COMMANDS = ("solve", "simulate")
"""Commands whose results hold a trajectory."""

_LAW = re.compile(r"[a-z][a-z-]{0,29}\Z")
"""Pattern of the names of methods and feedback laws."""

EQUAL_STATES = 1e-9
"""Largest relative difference up to which initial states count as equal."""


class _Kept(msgspec.Struct):
    """A conserved quantity in result.json."""

    initial: float | None
    drift: float | None


class _Event(msgspec.Struct):
    """An event on the way in result.json."""

    kind: str
    name: str
    t: float


class _Result(msgspec.Struct):
    """The part of result.json that is read back; the rest is in the trajectory."""

    command: str
    model: str
    instance: str
    settings: dict[str, float] = msgspec.field(name="set", default_factory=dict)
    method: str = ""
    message: str = ""
    objective: float | None = None
    iterations: int = 0
    wall_s: float | None = None
    certificate: StoredCertificate | None = None
    parameters_found: dict[str, float | None] = {}
    cost_interval: tuple[float, float] | None = None
    smoothing: float = 0.0
    events: list[_Event] = []
    ends_met: dict[str, Side | None] = {}
    feedback: str = ""
    invariants: dict[str, _Kept] = {}
    metrics: dict[str, float | None] = {}


def contents(found: Solution | Simulation) -> dict[str, Content]:
    """Return ``trajectory.npz`` and ``trajectory.csv`` of a solution or a simulation.

    The first holds ``times`` (N+1), ``x`` (n, N+1), ``u`` (m, N+1), for a solution ``lam`` (n, N+1), the names in
    ``states`` and ``controls``, and the ``status``; for a solution also ``history`` (2, K), cost and residual of each
    iteration, and ``switching`` (2, M), controls by their number from 0 and the times at which they meet or leave a
    bound. The second has a header with units in brackets, as ``r [km]``, and a line for each node: time, states,
    controls, costates as ``lambda_STATE``; its numbers read back exactly.
    """
    spec = found.instance.model.spec
    arrays: dict[str, Any] = {"times": found.times, "x": found.x, "u": found.u}
    header = ["t", *spec.state_names, *spec.control_names]
    # dtype, because an array of no names would be one of floats.
    more: dict[str, Any] = {
        "states": np.array(spec.state_names, dtype=str),
        "controls": np.array(spec.control_names, dtype=str),
        "status": np.array(found.status.value),
    }
    if isinstance(found, Solution):
        arrays["lam"] = found.lam
        header += [f"lambda_{name}" for name in spec.state_names]
        met = [(i, time) for i, times in enumerate(found.switching_times) for time in times]
        more["history"] = (
            np.array([(spec.objective(one.objective), one.residual) for one in found.history]).reshape(-1, 2).T
        )
        more["switching"] = np.array(met, dtype=float).reshape(-1, 2).T

    def lines() -> Iterator[bytes]:
        yield (",".join(with_units(header, units(spec))) + "\n").encode()
        for row in np.vstack(list(arrays.values())).T:
            yield (",".join(map(repr, row.tolist())) + "\n").encode()

    files: dict[str, Content] = {
        "trajectory.npz": lambda stream: np.savez(stream, **arrays, **more),
        "trajectory.csv": lambda stream: stream.writelines(lines()),
    }
    for k, one in enumerate(found.intermediate if isinstance(found, Solution) else ()):
        files |= {f"step-{k:03d}.csv": contents(one)["trajectory.csv"]}
    return files


def read(instance: Instance, folder: Path) -> tuple[Solution | Simulation, sets.Found]:
    """Return what ``satsym solve`` or ``satsym simulate`` wrote into a folder.

    Parameters
    ----------
    instance
        Of which the folder holds a result.
    folder
        With a whole set of files, see :mod:`satsym.report.results.sets`.

    Returns
    -------
    The result, and the set that it comes from.

    Raises
    ------
    BadInput
        If one of the files is missing or damaged, or belongs to another instance.
    """
    found = sets.read(folder, [ARRAYS])
    listing, place = folder / LIST, folder / ARRAYS
    result, spec = _result(listing, found.result), instance.model.spec
    if (result.model, result.instance) != (spec.name, instance.name):
        theirs = printable(f"{result.instance} (model {result.model})")
        raise unusable(listing, f"belongs to {theirs}, not to {instance.name} (model {spec.name})")
    if result.command not in COMMANDS or ARRAYS not in found.contents:
        raise unusable(listing, f"was written by `satsym {printable(result.command)}`, which writes no trajectory")
    with_options = [f" --set {printable(name)}={value!r}" for name, value in result.settings.items()]
    again = partial(unusable, command=result.command, more="".join(with_options))
    if not _LAW.match(result.method if result.command == "solve" else result.feedback):
        raise again(listing, "names neither a method nor a feedback")
    try:
        stored = files.unpacked(found.contents[ARRAYS])
    except ValueError as error:
        raise again(place, f"cannot be read ({printable(str(error), 120)})") from None
    if not _fits(stored, spec, result.command == "solve"):
        raise again(place, f"does not contain a trajectory of {spec.name}")
    try:
        instance = changed(instance, result.settings)
    except BadInput as error:
        raise again(listing, f"cannot be read ({printable(str(error), 200)})") from None
    instance = _with_found(instance, result.parameters_found, stored)
    instance = instance.meeting(
        {k: v for k, v in result.ends_met.items() if v is not None and k in instance.end_limits}
    )
    if not _starts_at(stored["x"], _begun(instance, result.feedback)):
        raise again(place, f"does not start from the initial state of {instance.name}, which has changed since then")
    make = _solution if result.command == "solve" else _flight
    return make(instance, result, stored), found


def _with_found(instance: Instance, parameters: Mapping[str, float | None], stored: Stored) -> Instance:
    """Return the instance with the found values of its free numbers, if there is an answer."""
    for unknown in instance.free:
        if unknown.place is Place.PARAMETER:
            values = np.array([absent(parameters.get(unknown.name))])
        else:
            values = (stored["times"] if unknown.place is Place.TIME else stored["x"][unknown.index])[:1]
        if len(values) and np.isfinite(values).all():
            instance = unknown.at(instance, float(values[0]))
    return instance


def _solution(instance: Instance, result: _Result, stored: Stored) -> Solution:
    controls, met = stored["switching"]
    spec = instance.model.spec
    history = [(spec.objective(float(value)), float(left)) for value, left in stored["history"].T]
    return Solution(
        instance=instance,
        method=result.method,
        status=Status(str(stored["status"])),
        message=result.message,
        objective=spec.objective(absent(result.objective)),
        times=stored["times"],
        x=stored["x"],
        u=stored["u"],
        lam=stored["lam"],
        switching_times=tuple(tuple(met[controls == i].tolist()) for i in range(len(stored["u"]))),
        iterations=result.iterations,
        history=tuple(Iteration(k, cost, left) for k, (cost, left) in enumerate(history)),
        wall_s=absent(result.wall_s),
        certificate=result.certificate.certificate(spec) if result.certificate else None,
        interval=_interval(result, spec),
        events=tuple(Event(one.kind, one.name, one.t) for one in result.events),
    )


def _interval(result: _Result, spec: ProblemSpec) -> CostInterval | None:
    """Return the interval of the least cost, where it is stored."""
    if result.cost_interval is None:
        return None
    lower, upper = sorted(spec.objective(end) for end in result.cost_interval)
    return CostInterval(lower, upper, result.smoothing)


def _flight(instance: Instance, result: _Result, stored: Stored) -> Simulation:
    return Simulation(
        instance=instance,
        feedback=result.feedback,
        status=Status(str(stored["status"])),
        message=result.message,
        times=stored["times"],
        x=stored["x"],
        u=stored["u"],
        invariants={name: Invariant(absent(k.initial), absent(k.drift)) for name, k in result.invariants.items()},
        metrics={name: absent(value) for name, value in result.metrics.items()},
    )


def _result(path: Path, content: bytes) -> _Result:
    try:
        found = msgspec.json.decode(content, type=_Result)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise unusable(path, f"cannot be read ({printable(str(error))})") from None
    return found


def _fits(stored: Stored, spec: ProblemSpec, solved: bool) -> bool:
    """Tell whether the arrays have the names, shapes and kinds of :func:`contents`, and valid times."""
    texts = {"states": list(spec.state_names), "controls": list(spec.control_names)}
    numbers = {"times", "x", "u"} | ({"lam", "history", "switching"} if solved else set())
    if stored.keys() != {"status", *texts, *numbers}:
        return False
    count = stored["times"].size
    shapes: dict[str, tuple[int, ...]] = {
        "times": (count,),
        "x": (len(spec.states), count),
        "u": (len(spec.controls), count),
    }
    if solved:
        shapes |= {"lam": shapes["x"]} | {name: (2, stored[name].size // 2) for name in ("history", "switching")}
    return (
        all(stored[name].tolist() == names for name, names in texts.items())
        and all(stored[name].shape == shape and stored[name].dtype.kind == "f" for name, shape in shapes.items())
        and stored["status"].tolist() in [status.value for status in Status]
        and _passes(stored)
    )


def _passes(stored: Stored) -> bool:
    """Tell whether times never decrease, where there is any motion; switching times must be numbers."""
    times, switching = stored["times"], stored.get("switching", np.empty(0))
    if not np.isfinite(switching).all() or not np.isfinite(stored["x"]).any():
        return bool(np.isfinite(switching).all())
    return bool(np.isfinite(times).all() and (np.diff(times) >= 0).all() and np.ptp(times) > 0)


def _begun(instance: Instance, feedback: str) -> Sequence[float]:
    """Return the initial states of a motion: under a classical law, those after its impulse."""
    if feedback != "classical":
        return instance.initial
    from satsym.analysis.classical.law import loop

    states: list[float] = loop(instance).start(np.array(instance.initial))[: len(instance.initial)].tolist()
    return states


def _starts_at(x: NDArray[Any], initial: Sequence[float]) -> bool:
    """Tell whether the first states are the given ones, where they are known, up to rounding."""
    if not x.shape[1]:
        return True
    with np.errstate(all="ignore"):
        off = np.abs(x[:, 0] - initial)
        return not (off > EQUAL_STATES * np.nanmax(np.abs(x), axis=1, initial=0.0)).any()
