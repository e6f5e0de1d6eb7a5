"""A generated function for many columns at once, all of its arguments arrays with a column for each."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import prod
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.kernels.batch import compiling
from satsym.kernels.batch.inlined import inlined
from satsym.kernels.batch.workspace import Workspace, element, function, loaded, over_blocks, over_lanes, stored
from satsym.kernels.contract import BATCH, GROUPS, TUPLES, pointwise, sizes
from satsym.kernels.core import Kernels

BLOCK = 2048
"""Columns that NumPy is given at a time: so many rows of them stay in the processor's cache."""

Columns = Callable[..., Array]
"""Takes the function's arguments, rows of columns or numbers for all columns, and ``out=``."""


def columns(kernels: Kernels, name: str, compiled: bool) -> Columns:
    """A function for many columns.

    Parameters
    ----------
    kernels, name
        The model, and which of its functions of one point.
    compiled
        By machine code, from the very lines of the scalar form; else by the batch form, block by block.

    Returns
    -------
    Callable
        Of the arguments in order: times of shape (K,) or one for all, others of shape (rows, K) or (rows,). The result
        has the shape of the function's and K after it.

    Raises
    ------
    BadInput
        If it is to be compiled and cannot be.
    """
    signature, counts = pointwise(kernels.spec)[name], sizes(kernels.spec)
    shape = tuple(counts[letter] for letter in signature.shape)
    rows = [prod(counts[letter] for letter in GROUPS.get(each, "")) for each in signature.arguments]
    run = _machine(kernels, name) if compiled else _arrays(kernels, name, signature.arguments)

    def many(*given: Any, out: Array | None = None) -> Array:
        tables = [np.asarray(one, dtype=float) for one in given]
        times = [each == "t" for each in signature.arguments]
        lengths = (one.shape[-1] for one, alone in zip(tables, times, strict=True) if one.ndim == 2 - alone)
        count = max(lengths, default=1)
        whole = [
            np.ascontiguousarray(np.broadcast_to(one if alone or one.ndim == 2 else one[:, None], shaped))
            for one, alone, size in zip(tables, times, rows, strict=True)
            for shaped in [(count,) if alone else (size, count)]
        ]
        found = np.empty((*shape, count)) if out is None else out
        run(whole, found.reshape(-1, count))
        return found

    return many


def _machine(kernels: Kernels, name: str) -> Callable[[list[Array], Array], None]:
    many = compiling.compiled(kernels.spec.name, text(kernels, name))["many"]
    return lambda given, out: many(*given, out)


def _arrays(kernels: Kernels, name: str, arguments: tuple[str, ...]) -> Callable[[list[Array], Array], None]:
    batch = kernels.functions[name + BATCH]

    def run(given: list[Array], out: Array) -> None:
        shaped = out.reshape(*_shape(kernels, name), out.shape[-1])
        for at in range(0, out.shape[-1], BLOCK):
            own = slice(at, at + BLOCK)
            parts = [
                tuple(one[:, own]) if each in TUPLES else one[..., own]
                for each, one in zip(arguments, given, strict=True)
            ]
            with np.errstate(all="ignore"):
                batch(*parts, out=shaped[..., own])

    return run


def _shape(kernels: Kernels, name: str) -> tuple[int, ...]:
    counts = sizes(kernels.spec)
    return tuple(counts[letter] for letter in pointwise(kernels.spec)[name].shape)


@lru_cache(maxsize=64)
def text(kernels: Kernels, name: str) -> str:
    """The module that is compiled for a function."""
    signature, counts, own = pointwise(kernels.spec)[name], sizes(kernels.spec), Workspace()
    rows = {each: prod(counts[letter] for letter in GROUPS.get(each, "")) for each in signature.arguments}
    places = {each: own.place(each, rows[each]) for each in signature.arguments}
    out, results = own.place("out", prod(counts[k] for k in signature.shape)), prod(counts[k] for k in signature.shape)

    def load(begin: int) -> Callable[[int], str]:
        return lambda k: element(begin, k)

    body = inlined(compiling.module_text(kernels), name, {each: load(at) for each, at in places.items()}, "a_")
    stores = [f"{element(out, k)} = {result}" for k, result in enumerate(body.results)]
    block = []
    for each, at in places.items():
        time = [f"w[{at} + j] = t[at + min(j, width - 1)]"]
        block += over_lanes(time) if each == "t" else loaded(at, each, rows[each])
    block += [*over_lanes([*body.lines, *stores]), *stored(out, "out", results)]
    head = f"many({', '.join(signature.arguments)}, out)"
    lines = function(head, [f"w = np.zeros({own.size})", *over_blocks("out.shape[1]", block)])
    return "\n".join([*compiling.HEAD, *lines]) + "\n"
