"""Trajectories as files, and results read back from them."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from satsym.report.files import Content
from satsym.solution import Flight, Invariant, Iteration, Solution
from satsym.status import BadInput, Status
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.spec import ProblemSpec

Stored = dict[str, NDArray[Any]]

SAME = 1e-9
"""Difference of initial states that is none, relative to their size along the way."""


class _Kept(msgspec.Struct):
    """A conserved quantity in result.json."""

    initial: float | None
    drift: float | None


class _Result(msgspec.Struct):
    """What of result.json is read back; the rest is in the trajectory."""

    model: str
    instance: str
    method: str = ""
    message: str = ""
    objective: float | None = None
    iterations: int = 0
    wall_s: float | None = None
    feedback: str = ""
    invariants: dict[str, _Kept] = {}
    metrics: dict[str, float | None] = {}


def contents(found: Solution | Flight) -> dict[str, Content]:
    """``trajectory.npz`` and ``trajectory.csv`` of a solution or a flight.

    The first holds ``times`` (N+1), ``x`` (n, N+1), ``u`` (m, N+1), for a solution ``lam`` (n, N+1), the names in
    ``states`` and ``controls``, and the ``status``; for a solution also ``history`` (2, K), cost and residual of each
    iteration, and ``switching`` (2, M), controls by their number from 0 and the times at which they meet or leave a
    bound. The second has a header and a line for each node: time, states, controls, costates as ``lambda_STATE``; its
    numbers read back exactly.
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
        more["history"] = np.array([(one.objective, one.residual) for one in found.history]).reshape(-1, 2).T
        more["switching"] = np.array(met, dtype=float).reshape(-1, 2).T

    def lines() -> Iterator[bytes]:
        yield (",".join(header) + "\n").encode()
        for row in np.vstack(list(arrays.values())).T:
            yield (",".join(map(repr, row.tolist())) + "\n").encode()

    return {
        "trajectory.npz": lambda stream: np.savez(stream, **arrays, **more),
        "trajectory.csv": lambda stream: stream.writelines(lines()),
    }


def read(instance: Instance, folder: Path) -> Solution | Flight:
    """What ``satsym solve`` or ``satsym simulate`` wrote into a folder; without the certificate of a solution.

    Parameters
    ----------
    instance
        Of which the folder holds a result.
    folder
        With trajectory.npz and result.json.

    Raises
    ------
    BadInput
        If one of the files is missing or damaged, or belongs to another instance.
    """
    result, stored = _result(folder / "result.json"), _stored(folder / "trajectory.npz")
    spec = instance.model.spec
    if (result.model, result.instance) != (spec.name, instance.name):
        theirs = printable(f"{result.instance} (model {result.model})")
        raise _unusable(folder / "result.json", f"is of {theirs}, not of {instance.name} (model {spec.name})")
    if not _fits(stored, spec):
        raise _unusable(folder / "trajectory.npz", f"does not hold what a trajectory of {spec.name} has")
    if not _starts_at(stored["x"], instance.initial):
        raise _unusable(folder / "trajectory.npz", f"starts elsewhere than {instance.name}, which has changed since")
    return _solution(instance, result, stored) if "lam" in stored else _flight(instance, result, stored)


def _solution(instance: Instance, result: _Result, stored: Stored) -> Solution:
    controls, met = stored["switching"]
    return Solution(
        instance=instance,
        method=result.method,
        status=Status(str(stored["status"])),
        message=result.message,
        objective=_float(result.objective),
        times=stored["times"],
        x=stored["x"],
        u=stored["u"],
        lam=stored["lam"],
        switching_times=tuple(tuple(met[controls == i].tolist()) for i in range(len(stored["u"]))),
        iterations=result.iterations,
        history=tuple(Iteration(k, float(cost), float(left)) for k, (cost, left) in enumerate(stored["history"].T)),
        wall_s=_float(result.wall_s),
    )


def _flight(instance: Instance, result: _Result, stored: Stored) -> Flight:
    return Flight(
        instance=instance,
        feedback=result.feedback,
        status=Status(str(stored["status"])),
        message=result.message,
        times=stored["times"],
        x=stored["x"],
        u=stored["u"],
        invariants={name: Invariant(_float(k.initial), _float(k.drift)) for name, k in result.invariants.items()},
        metrics={name: _float(value) for name, value in result.metrics.items()},
    )


def _result(path: Path) -> _Result:
    try:
        return msgspec.json.decode(path.read_bytes(), type=_Result)
    except OSError as error:
        raise _missing(path, error) from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise _unusable(path, f"cannot be read ({printable(str(error))})") from None


def _stored(path: Path) -> Stored:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except OSError as error:
        raise _missing(path, error) from None
    except (ValueError, EOFError, TypeError, AttributeError, KeyError, zipfile.BadZipFile) as error:
        raise _unusable(path, f"cannot be read ({printable(str(error))})") from None


def _fits(stored: Stored, spec: ProblemSpec) -> bool:
    """Whether the arrays have the names, shapes and kinds that :func:`contents` gives them."""
    texts = {"states": list(spec.state_names), "controls": list(spec.control_names)}
    if not {"times", "x", "u", "status", *texts} <= stored.keys():
        return False
    count = stored["times"].size
    shapes: dict[str, tuple[int, ...]] = {
        "times": (count,),
        "x": (len(spec.states), count),
        "u": (len(spec.controls), count),
    }
    if "lam" in stored:
        if not {"history", "switching"} <= stored.keys():
            return False
        shapes |= {"lam": shapes["x"]} | {name: (2, stored[name].size // 2) for name in ("history", "switching")}
    return (
        all(stored[name].tolist() == names for name, names in texts.items())
        and all(stored[name].shape == shape and stored[name].dtype.kind == "f" for name, shape in shapes.items())
        and stored["status"].tolist() in [status.value for status in Status]
    )


def _starts_at(x: NDArray[Any], initial: Sequence[float]) -> bool:
    """Whether the first of some states is the given one, where it is known, but for rounding."""
    if not x.shape[1]:
        return True
    off = np.abs(x[:, 0] - initial)
    return not (off > SAME * np.nanmax(np.abs(x), axis=1, initial=0.0)).any()


def _float(value: float | None) -> float:
    return math.nan if value is None else value


def _missing(path: Path, error: OSError) -> BadInput:
    reason = error.strerror or "not a file"
    return _unusable(path, f"cannot be opened ({reason})")


def _unusable(path: Path, why: str) -> BadInput:
    return BadInput(
        f"{printable(str(path))}: {why}; `satsym solve X --out {printable(str(path.parent))}` writes it anew"
    )
