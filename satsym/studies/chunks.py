"""Computation of a chunk in a worker, which caches what all chunks of a study share."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from satsym.instance import Instance
from satsym.instance import numbers as keys
from satsym.status import BadInput
from satsym.studies import rows
from satsym.studies.asked import Chunk, Command, Study, Task, keys_of
from satsym.studies.rows import Cases, Failure, Row, Work


def computed(packed: bytes, chunk: Chunk) -> list[Row]:
    """Compute the rows of a chunk, in their order in the study.

    Parameters
    ----------
    packed
        The study, see :func:`packed`; a worker unpacks it once.
    """
    task = unpacked(packed)
    given = [_instance(task, values) for values in chunk.values.tolist()]
    cases = {k: one for k in chunk.order if isinstance(one := given[k], Instance)}
    found = begun(task)(list(zip(keys_of(task, cases.values()), cases.values(), strict=True)))
    done = dict(zip(cases, found, strict=True))
    return [done.get(k) or rows.failed("", Failure.BAD_INPUT, str(one)) for k, one in enumerate(given)]


def pack(study: Study) -> bytes:
    """Return what workers need of a study as bytes that any of them can unpack."""
    return pickle.dumps(study.task)


@lru_cache(maxsize=4)
def unpacked(packed: bytes) -> Task:
    """Return a study from the bytes that :func:`pack` makes."""
    found: Task = pickle.loads(packed)
    return found


def _instance(task: Task, values: Sequence[float]) -> Instance | str:
    """Return the instance of a row, or the reason why there is none."""
    try:
        return keys.at(task.instance, task.keys, tuple(values))
    except BadInput as error:
        return str(error)


def begun(task: Task) -> Work:
    """Return the function that computes a chunk, independent of what the worker computed before."""
    if task.command is Command.SOLVE:
        from satsym.studies.solving import solving

        return solving(task)
    if task.command is Command.SIMULATE:
        return _simulating(task)
    return _regulated


def _simulating(task: Task) -> Work:
    from satsym.analysis.regulator.feedback import simulate

    def simulated(key: str, instance: Instance) -> Row:
        instance.require_numbers()
        return rows.of_simulation(key, simulate(instance, task.feedback), task.trajectories)

    return rows.one_by_one(simulated)


def _regulated(cases: Cases) -> list[Row]:
    """Design all regulators at once, and unclear cases one by one."""
    from satsym.analysis.regulator.many import regulators

    instances = [instance for _, instance in cases]
    alike = bool(cases) and all(one.lqr is instances[0].lqr and not one.free for one in instances)
    found = regulators(instances) if alike else None
    if found is None:
        return rows.one_by_one(_designed)(cases)
    assert instances[0].lqr is not None
    names = instances[0].lqr.inputs, instances[0].model.spec.state_names
    return [
        rows.of_regulator(key, names, found.K[k], found.eigenvalues[k], found.residual[k], found.cost[k])
        if found.clear[k]
        else rows.tried(_designed, key, instance)
        for k, (key, instance) in enumerate(cases)
    ]


def _designed(key: str, instance: Instance) -> Row:
    """Design the regulator of a single row."""
    from satsym.analysis.regulator.feedback import designed

    instance.require_numbers()
    with np.errstate(all="ignore"):
        design = designed(instance)
    found, deviation = design.regulator, design.deviation
    cost = None if deviation is None else found.cost(deviation)
    names = found.system.inputs, found.system.states
    return rows.of_regulator(key, names, found.K, found.eigenvalues, found.residual, cost)
