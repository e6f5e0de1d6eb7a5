"""Linear systems: matrices, eigenvalues and ranks exactly; how their motions behave, by the motions themselves.

Wherever a system is asked for, the name of a model, a member of a family or a square matrix will do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache, lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.measurements import measurement
from satsym.auditing.propositions.values import Record, Undecided, is_exact
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_LATE = 40.0
"""From here on motions are compared: what grows like t doubles until twice this time, what is bounded does not."""
_MOMENTS = 16
"""How often they are looked at before and after; what turns is not always at its largest."""
_NODES = 40
_ZERO = 1e-9


@measurement
@cache
def system(model: str) -> Record:
    """A linear model: its exact matrices A, B and C, and the names of its states, inputs and outputs."""
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup.library import derivation

    found = system_of(derivation(model))
    parts = {"A": found.a, "B": found.b, "C": found.c}
    names = {"states": list(found.states), "inputs": list(found.inputs), "outputs": list(found.outputs)}
    return Record(model, {**parts, **names})


@measurement
def inputs_of(of: Any, inputs: Sequence[str]) -> Record:
    """A system with some of its inputs alone."""
    whole = system_of(of)
    return Record(whole.name, {**whole.parts, "B": _columns(whole, inputs), "inputs": list(inputs)})


@measurement
def dual(of: Any) -> Record:
    """The system with A', C' and B' for A, B and C: inputs and outputs change places."""
    whole = system_of(of)
    return Record(f"the dual of {whole.name}", {"A": whole.part("A").T, "B": whole.part("C").T, "C": whole.part("B").T})


@measurement
def eigenvalues(of: Any) -> list[Any]:
    """All eigenvalues, each as often as it is a root of the characteristic polynomial; exact if the matrix is.

    Those of a matrix with plain numbers are sorted by their real parts, and then downwards by their imaginary parts.
    """
    a = matrix(of)
    if is_exact(a):
        return [e.value for e in spectrum_of(a).eigenvalues for _ in range(e.algebraic)]
    return sorted(np.linalg.eigvals(a).tolist(), key=lambda z: (round(z.real, 9), -z.imag))


@measurement
def closed_loop(of: Any, gain: Any, inputs: Sequence[str] = ()) -> Record:
    """x' = (A - B K) x, of some inputs alone; letters of A are taken as 1."""
    whole = system_of(of)
    a = numbers(whole.part("A")) - numbers(_columns(whole, inputs)) @ numbers(gain)
    return Record(f"{whole.name} with feedback", {**whole.parts, "A": a})


@measurement
def stabilisable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Whether some feedback makes all real parts negative: by Hautus' test at each eigenvalue that is not so."""
    whole = system_of(of)
    a, b = numbers(whole.part("A")), numbers(_columns(whole, inputs))
    lost = [
        v for v in np.linalg.eigvals(a) if v.real > -_ZERO and _rank(np.hstack([v * np.eye(len(a)) - a, b])) < len(a)
    ]
    return not lost


@measurement
def algebraic(eigenvalue: Any, of: Any) -> int:
    """How often an eigenvalue is a root of the characteristic polynomial."""
    return int(_eigenvalue(eigenvalue, of).algebraic)


@measurement
def geometric(eigenvalue: Any, of: Any) -> int:
    """How many independent eigenvectors an eigenvalue has."""
    return int(_eigenvalue(eigenvalue, of).geometric)


@measurement
def eigenvectors(of: Any) -> list[Record]:
    """Independent eigenvectors as columns, each with its eigenvalue: ``value``, ``vector``; exact."""
    return _eigenvectors(matrix(of))


@measurement
def growth_rate(of: Any) -> float:
    """The exponent with which motions grow in the long run, by e^(At) itself; what grows like a power of t has none."""
    sizes = [_largest(numbers(matrix(of)), start, start + _LATE) for start in (_LATE, 2.0 * _LATE)]
    if not (sizes[0] > 0.0 and math.isfinite(sizes[1])):
        raise Undecided("motions grow or shrink beyond all numbers")
    return math.log(sizes[1] / sizes[0]) / _LATE


@measurement
def rank(of: Any) -> int:
    """Rank of a matrix, exact where its entries are."""
    return int(of.rank()) if is_exact(of) else int(np.linalg.matrix_rank(np.asarray(of, dtype=float)))


@measurement
def dimension(of: Any) -> int:
    """How many states a system has, or rows a matrix."""
    return int(matrix(of).shape[0])


@measurement
def controllability(of: Any, inputs: Sequence[str] = ()) -> Any:
    """The matrix [B, AB, ..., A^(n-1) B], of some inputs alone."""
    whole = system_of(of)
    return _krylov(whole.part("A"), _columns(whole, inputs))


@measurement
def observability(of: Any, outputs: Sequence[str] = ()) -> Any:
    """The matrix [C; CA; ...; C A^(n-1)], of some outputs alone."""
    whole = system_of(of)
    rows = whole.part("C")
    if outputs:
        rows = rows.extract([_place(whole, "outputs", name) for name in outputs], list(range(rows.cols)))
    return _krylov(whole.part("A").T, rows.T).T


@measurement
def controllable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Whether some input carries every state to every other: by the Gramian, not by a rank."""
    whole = system_of(of)
    return _definite(_gramian(numbers(whole.part("A")), numbers(_columns(whole, inputs))))


@measurement
def observable(of: Any) -> bool:
    """Whether the output over an interval tells the state it began at: by the Gramian, not by a rank."""
    whole = system_of(of)
    return _definite(_gramian(numbers(whole.part("A")).T, numbers(whole.part("C")).T))


@measurement
def flow(of: Any, t: float) -> Array:
    """e^(At), by scaling and squaring; letters of A are taken as 1."""
    from scipy.linalg import expm

    return np.asarray(expm(t * numbers(matrix(of))))


@measurement
def stable(of: Any) -> bool:
    """Whether motions that start near zero stay near it: by e^(At) itself, later and later."""
    early, late = _sizes(of)
    return late <= 1.5 * early


@measurement
def asymptotically_stable(of: Any) -> bool:
    """Whether motions that start near zero stay near it and die out: by e^(At) itself, later and later."""
    early, late = _sizes(of)
    return late <= 1.5 * early and late < 1e-3


def system_of(of: Any) -> Record:
    """A system by its name, or as it stands; a matrix is one without inputs."""
    if isinstance(of, str):
        return system(of)
    return of if isinstance(of, Record) else Record("the system", {"A": of})


def matrix(of: Any) -> Any:
    """A of a system, or a matrix as it stands."""
    return system_of(of).part("A")


def numbers(of: Any) -> Array:
    """A matrix with numbers, its letters taken as 1."""
    return _numbers(of) if is_exact(of) else np.asarray(of, dtype=float)


@lru_cache(maxsize=4096)
def _numbers(of: Any) -> Array:
    found = np.array(of.subs(dict.fromkeys(of.free_symbols, 1)).tolist(), dtype=float).reshape(of.shape)
    found.flags.writeable = False
    return found


@cache
def _eigenvectors(a: Any) -> list[Record]:
    return [
        Record(f"eigenvector {k + 1} for {e.value}", {"value": e.value, "vector": column})
        for e in spectrum_of(a).eigenvalues
        for k, column in enumerate((a - e.value * a.eye(a.rows)).nullspace(simplify=True))
    ]


@cache
def spectrum_of(a: Any) -> Any:
    """The exact eigenvalues of a matrix, with their multiplicities."""
    from satsym.symbolic.analysis import spectrum

    return spectrum(a)


def _eigenvalue(value: Any, of: Any) -> Any:
    for entry in spectrum_of(matrix(of)).eigenvalues:
        if entry.value == value or (not is_exact(value) and abs(complex(entry.value) - complex(value)) < _ZERO):
            return entry
    raise BadInput(f"{value} is no eigenvalue of {system_of(of).name}")


def _rank(of: Any) -> int:
    return int(np.linalg.matrix_rank(of, tol=1e-7))


def _place(whole: Record, of: str, name: str) -> int:
    known = whole.part(of)
    if name not in known:
        raise BadInput(f"{whole.name} has no {shown(name)}; {suggestion(name, known)}")
    return int(known.index(name))


def _columns(whole: Record, inputs: Sequence[str]) -> Any:
    b = whole.part("B")
    if not inputs:
        return b
    return b.extract(list(range(b.rows)), [_place(whole, "inputs", name) for name in inputs])


def _krylov(a: Any, b: Any) -> Any:
    blocks = [b]
    for _ in range(a.rows - 1):
        blocks.append(a * blocks[-1])
    return b.hstack(*blocks)


def _gramian(a: Array, b: Array, end: float = 2.0) -> Array:
    """The integral of e^(As) B B' e^(A's) over [0, end], by Gauss-Legendre quadrature."""
    from scipy.linalg import expm

    places, weights = np.polynomial.legendre.leggauss(_NODES)
    total = np.zeros_like(a)
    for place, weight in zip(places, weights, strict=True):
        column = expm(0.5 * end * (place + 1.0) * a) @ b
        total += 0.5 * end * weight * column @ column.T
    return total


def _definite(gramian: Array) -> bool:
    sizes = np.linalg.eigvalsh(gramian)
    if sizes[-1] <= 0.0:
        return False
    if 1e-13 < sizes[0] / sizes[-1] < 1e-10:
        raise Undecided(f"the Gramian is nearly singular ({sizes[0] / sizes[-1]:.0e})")
    return bool(sizes[0] / sizes[-1] >= 1e-10)


def _sizes(of: Any) -> tuple[float, float]:
    """The largest norm of e^(At) around some time, and around twice that time."""
    a = matrix(of)
    return _exact_sizes(a) if is_exact(a) else _sizes_of(numbers(a))


@cache
def _exact_sizes(a: Any) -> tuple[float, float]:
    return _sizes_of(numbers(a))


def _sizes_of(a: Array) -> tuple[float, float]:
    early, late = (_largest(a, start, 1.25 * start) for start in (_LATE, 2.0 * _LATE))
    return (early, late) if math.isfinite(early) and math.isfinite(late) else (1.0, math.inf)


def _largest(a: Array, start: float, end: float) -> float:
    """The largest norm of e^(At) at some moments."""
    here, step = flow(a, start), flow(a, (end - start) / _MOMENTS)
    largest = 0.0
    for _ in range(_MOMENTS):
        largest = max(largest, float(np.linalg.norm(here, 2))) if np.isfinite(here).all() else math.inf
        here = step @ here
    return largest
