"""Examination of a saved result: a new certificate, and a comparison of result.json with the other files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from satsym import methods
from satsym.instance import Instance
from satsym.report.results import trajectory
from satsym.report.results.certificate import plain
from satsym.report.results.objects import solution_object
from satsym.report.results.set_list import LIST, unusable
from satsym.solution import Certificate, Solution
from satsym.solvers.certificate import certify
from satsym.status import Verdict

NOT_COMPARED = frozenset(("satsym", "message", "iterations", "wall_s", "certificate", "instance_file", "continuation"))
"""Keys of result.json about how a solution was found, which occur in no other file and are not compared.

The certificate is computed anew.
"""


@dataclass(frozen=True)
class Difference:
    """A value of result.json that differs from the other files.

    Attributes
    ----------
    key
        Where it stands, such as ``x_final.r``.
    stated, found
        In result.json, and by the trajectory and the problem.
    """

    key: str
    stated: Any
    found: Any


@dataclass(frozen=True, eq=False)
class Examination:
    """The outcome of examining a saved result.

    Attributes
    ----------
    solution
        As it was saved.
    stated
        The verdict that the result claims, if it has a certificate.
    certificate
        Computed anew; ``None`` without an answer.
    differences
        Of result.json from the other files.
    """

    solution: Solution
    stated: Verdict | None
    certificate: Certificate | None
    differences: tuple[Difference, ...]


def examine(instance: Instance, folder: Path, compared: bool = True) -> Examination:
    """Examine the result of ``satsym solve`` in a folder.

    Parameters
    ----------
    instance
        That the result is of, see :func:`satsym.report.results.problem.read`.
    compared
        Whether competitors are looked for.

    Raises
    ------
    BadInput
        If the folder holds no such result, or one of its files cannot be used.
    """
    solution, found = trajectory.read(instance, folder)
    if not isinstance(solution, Solution):
        raise unusable(folder / LIST, "is the result of a simulation, which has no certificate")
    stated = msgspec.json.decode(found.result)
    anew = msgspec.json.decode(msgspec.json.encode(plain(solution_object(solution))))
    if solution.method not in methods.METHODS:
        raise unusable(folder / LIST, "names no method")
    known = {key: value for key, value in stated.items() if key in anew and key not in NOT_COMPARED}
    anew["instance"] = (stated.get("instance_file") or {}).get("name", "").removesuffix(".toml") or anew["instance"]
    if solution.interval is not None:  # the motion that is shown costs as much as the upper end
        anew["objective"] = instance.model.spec.objective(solution.interval.upper)
    differences = tuple(_differences(known, {key: anew[key] for key in known}))
    differences += tuple(_of_nothing(solution))
    verdict = solution.certificate.verdict if solution.certificate else None
    known_events = not any(one.key.startswith("events") for one in differences)
    return Examination(solution, verdict, certify(solution, compared) if known_events else None, differences)


def _of_nothing(solution: Solution) -> Iterator[Difference]:
    """Return the events of features that the problem does not have."""
    spec = solution.instance.model.spec
    names = {*spec.control_names, *(one.name for one in spec.path_constraints)} | {one.name for one in spec.interior}
    for place, event in enumerate(solution.events):
        if event.name not in names:
            yield Difference(f"events[{place}].name", event.name, None)


def _differences(stated: Any, found: Any, key: str = "") -> Iterator[Difference]:
    """Return the values in which two objects differ, by their keys."""
    if isinstance(stated, Mapping) and isinstance(found, Mapping) and stated.keys() == found.keys():
        for name in stated:
            yield from _differences(stated[name], found[name], f"{key}.{name}" if key else name)
    elif isinstance(stated, list) and isinstance(found, list) and len(stated) == len(found):
        for place, (one, other) in enumerate(zip(stated, found, strict=True)):
            yield from _differences(one, other, f"{key}[{place}]")
    elif stated != found:
        yield Difference(key, stated, found)
