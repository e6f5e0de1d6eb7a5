"""The statement of a study, and everything that its results depend on."""

from __future__ import annotations

import hashlib
import json
import math
import platform
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from satsym import source_files
from satsym.arrays import Array
from satsym.choices import Checked, Command, TableFormat
from satsym.instance import Instance
from satsym.instance.numbers import Key
from satsym.kernels import Kernels
from satsym.studies.reading import Design, chain
from satsym.version import __version__

LARGEST_CHUNK, FEWEST_CHUNKS = 256, 8
"""Largest number of rows of a chunk, and smallest number of chunks of a study that has enough rows."""

LIBRARIES = ("numpy", "scipy", "numba")
"""Libraries whose versions may change the last digits of results."""

PLACES = ("name", "path", "title", "model")
"""Keys of an instance that its digest omits.

Results do not depend on these keys, and the model has its own digest.
"""


@dataclass(frozen=True, eq=False)
class Study:
    """The statement of a study: many rows of one instance.

    Attributes
    ----------
    instance
        The instance whose numbers are varied.
    design
        The grid or sample of values.
    command
        The command that is applied to each row.
    checked
        The extent of certificates, for ``solve``.
    feedback
        The control law, for ``simulate``.
    compiled
        Whether kernels are compiled.
    trajectories
        Whether trajectories are kept.
    table
        The file format of the table.
    subject
        Name of the instance on the command line.
    settings
        Values that were set beside the instance file, by key; the instance contains them already.
    """

    instance: Instance
    design: Design
    command: Command = Command.SOLVE
    checked: Checked = Checked.LOCAL
    feedback: str | None = None
    compiled: bool = False
    trajectories: bool = False
    table: TableFormat = TableFormat.CSV
    subject: str = ""
    settings: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def size(self) -> int:
        """Return the number of rows of each chunk but the last, which depends on the number of rows alone."""
        return max(1, min(LARGEST_CHUNK, math.ceil(self.design.count / FEWEST_CHUNKS)))

    @property
    def chunks(self) -> int:
        """Return the number of chunks."""
        return math.ceil(self.design.count / self.size)

    def chunk(self, number: int) -> Chunk:
        """Return a chunk by its number, from 0."""
        start, count = self.place(number)
        return Chunk(number, start, self.design.rows(start, start + count))

    def place(self, number: int) -> tuple[int, int]:
        """Return the first row of a chunk, and its number of rows."""
        start = number * self.size
        return start, min(self.size, self.design.count - start)

    @cached_property
    def identity(self) -> dict[str, str]:
        """Return everything that the results depend on, by name."""
        found = {f"instance {name}": text for name, text in _parts(self.instance).items()}
        found |= {
            "command": self.command.value,
            "certificate": self.checked.value if self.command is Command.SOLVE else "none",
            "feedback": self.feedback or "",
            "trajectories": str(self.trajectories).lower(),
            "rows": str(self.design.count),
            "chunk": str(self.size),
            **self.design.stated(),
            "model": model_digest(self.instance.model),
            "code": source_files.digest(CODE),
            "backend": "numba" if self.compiled else "python",
            "satsym": __version__,
            "python": platform.python_version(),
            "machine": platform.machine(),
        }
        if self.table is not TableFormat.CSV:
            found["table"] = self.table.value
        return found | {name: _version(name) for name in LIBRARIES}

    @cached_property
    def digest(self) -> str:
        """Return a digest of the whole study: its instance, its model and all that varies."""
        return _digest(self.identity)

    @property
    def row_digest(self) -> str:
        """Return a digest of what the result of a row depends on besides its own numbers."""
        varied = {*self.design.stated(), "rows", "chunk", "table"}
        return _digest({k: v for k, v in self.identity.items() if k not in varied and not k.startswith("instance ")})

    @cached_property
    def task(self) -> Task:
        """Return the part of the study that workers need."""
        return Task(
            instance=self.instance,
            keys=self.design.keys,
            command=self.command,
            checked=self.checked,
            feedback=self.feedback,
            compiled=self.compiled,
            trajectories=self.trajectories,
            row_digest=self.row_digest,
        )


@dataclass(frozen=True, eq=False)
class Task:
    """The part of a study that workers need: all but the values, which chunks bring; fields are those of the study."""

    instance: Instance
    keys: tuple[Key, ...]
    command: Command
    checked: Checked
    feedback: str | None
    compiled: bool
    trajectories: bool
    row_digest: str


CODE = ("satsym.studies.chunks", "satsym.studies.asked", "satsym.studies.branches")
"""Modules whose code, together with everything that they import, determines the results."""


@dataclass(frozen=True, eq=False)
class Chunk:
    """Rows that are computed one after the other, in an order that depends on them alone."""

    number: int
    start: int
    values: Array
    """Values of the varied numbers, shape (rows, keys)."""

    @property
    def order(self) -> list[int]:
        """Return the places of the rows, ordered so that neighbours follow each other."""
        return list(chain(self.values))

    def apart(self) -> Iterator[Chunk]:
        """Return a chunk for each of the rows."""
        for k in range(len(self.values)):
            yield Chunk(self.number, self.start + k, self.values[k : k + 1])


def keys_of(task: Task, instances: Iterable[Instance]) -> list[str]:
    """Return for each row a short text of everything that its result depends on."""
    base, known = task.instance, _parts(task.instance)
    found = []
    for one in instances:
        own = {
            name: text if (value := getattr(one, name)) is getattr(base, name) else repr(_plain(value))
            for name, text in known.items()
        }
        found.append(_digest({**own, "": task.row_digest})[:16])
    return found


def differences(before: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    """Describe the differences between two identities, in a few words each."""
    found = []
    for name in (*before, *(name for name in now if name not in before)):
        old, new = before.get(name), now.get(name)
        if old != new:
            long = max(len(text or "") for text in (old, new)) > 60
            found.append(f"{name} differs" if long else f"{name} was {old or 'absent'} and is {new or 'absent'}")
    return found


def model_digest(kernels: Kernels) -> str:
    """Return a digest of the generated module that kernels come from."""
    if kernels.text is not None:
        return hashlib.sha256(kernels.text.encode()).hexdigest()[:32]
    module = next(iter(kernels.functions.values())).__code__.co_filename
    return source_files.digest_of(Path(module))


def _parts(instance: Instance) -> dict[str, str]:
    """Return the numbers and options of an instance, each as text."""
    names = (each.name for each in fields(instance) if each.name not in PLACES)
    return {name: repr(_plain(getattr(instance, name))) for name in names}


def _plain(value: Any) -> Any:
    return dict(value) if isinstance(value, Mapping) else value


def _digest(parts: Mapping[str, str]) -> str:
    return hashlib.blake2b(json.dumps(parts).encode(), digest_size=16).hexdigest()


def _version(name: str) -> str:
    if name == "numpy":
        return np.__version__
    try:
        return version(name)
    except PackageNotFoundError:
        return ""
