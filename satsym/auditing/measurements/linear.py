"""Linear systems: matrices, eigenvalues and ranks exactly; how their motions behave, by the motions themselves.

Wherever a system is asked for, the name of a model, a member of a family or a square matrix will do.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from satsym.arrays import Array, kept
from satsym.auditing.propositions.relations import equal
from satsym.auditing.propositions.values import Record, Undecided, is_exact, numbers
from satsym.records import shelf
from satsym.status import BadInput
from satsym.wording import refuse_unknown

_INTERVAL = 2.0
"""Over which inputs act, and outputs are seen, to tell whether they do all that they can."""
_ZERO, _DEPENDENT = 1e-9, 1e-7


def system(of: Any) -> Record:
    """A linear model: its exact matrices A, B and C, and the names of its states, inputs and outputs.

    A member of a family is one as it stands, a matrix one without inputs.
    """
    if isinstance(of, str):
        return _of_model(of, shelf.path_of(of))
    return of if isinstance(of, Record) else Record("the system", {"A": of})


@cache
def _of_model(name: str, _: Path | None) -> Record:
    from satsym.symbolic.lookup import library

    try:
        found = library.linear_system(name)
    except BadInput as error:
        raise Undecided(str(error)) from None
    parts = {"A": found.a, "B": found.b, "C": found.c}
    names = {"states": list(found.states), "inputs": list(found.inputs), "outputs": list(found.outputs)}
    return Record(name, {**parts, **names})


def inputs_of(of: Any, inputs: Sequence[str]) -> Record:
    """A system with some of its inputs alone, if they are named."""
    whole = system(of)
    if not inputs:
        return whole
    chosen, b = [_place(whole, "inputs", name) for name in inputs], whole.part("B")
    return Record(whole.name, {**whole.parts, "B": b.extract(list(range(b.rows)), chosen), "inputs": list(inputs)})


def dual(of: Any) -> Record:
    """The system with A', C' and B' for A, B and C: inputs and outputs change places."""
    whole = system(of)
    return Record(f"the dual of {whole.name}", {"A": whole.part("A").T, "B": whole.part("C").T, "C": whole.part("B").T})


def eigenvalues(of: Any) -> list[Any]:
    """All eigenvalues, each as often as it is a root of the characteristic polynomial; exact if the matrix is.

    Those of a matrix with plain numbers are sorted by their real parts, and then downwards by their imaginary parts.
    """
    a = system(of).part("A")
    if is_exact(a):
        return [e.value for e in _spectrum(a).eigenvalues for _ in range(e.algebraic)]
    return sorted(np.linalg.eigvals(a).tolist(), key=lambda z: (round(z.real, 9), -z.imag))


def closed_loop(of: Any, gain: Any, inputs: Sequence[str] = ()) -> Record:
    """x' = (A - B K) x, of some inputs alone; letters of A are taken as 1."""
    whole = system(of)
    a = numbers(whole.part("A")) - numbers(inputs_of(whole, inputs).part("B")) @ numbers(gain)
    return Record(f"{whole.name} with feedback", {**whole.parts, "A": a})


def stabilisable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Whether some feedback makes all real parts negative: by Hautus' test at each eigenvalue that is not so."""
    whole = inputs_of(of, inputs)
    a, b = numbers(whole.part("A")), numbers(whole.part("B"))
    left = [np.hstack([v * np.eye(len(a)) - a, b]) for v in np.linalg.eigvals(a) if v.real > -_ZERO]
    return all(int(np.linalg.matrix_rank(each, tol=_DEPENDENT)) == len(a) for each in left)


def algebraic(eigenvalue: Any, of: Any) -> int:
    """How often an eigenvalue is a root of the characteristic polynomial."""
    return int(_eigenvalue(eigenvalue, of).algebraic)


def geometric(eigenvalue: Any, of: Any) -> int:
    """How many independent eigenvectors an eigenvalue has."""
    return int(_eigenvalue(eigenvalue, of).geometric)


@kept
def eigenvectors(of: Any) -> list[Record]:
    """Independent eigenvectors as columns, each with its eigenvalue: ``value``, ``vector``; exact."""
    a = system(of).part("A")
    return [
        Record(f"eigenvector {k + 1} for {e.value}", {"value": e.value, "vector": column})
        for e in _spectrum(a).eigenvalues
        for k, column in enumerate((a - e.value * a.eye(a.rows)).nullspace(simplify=True))
    ]


def jordan(of: Any) -> Record:
    """A basis P of chains of an exact matrix, as columns, and the eigenvalue that belongs to each."""
    from satsym.symbolic.analysis.components import jordan_form

    found = jordan_form(_spectrum(system(of).part("A")))
    if found is None:
        raise Undecided("no closed form of the eigenvalues")
    return Record("the Jordan form", {"P": found.basis, "values": [found.form[i, i] for i in range(found.form.rows)]})


def routh(coefficients: Sequence[Any]) -> list[list[Any]]:
    """The rows of Routh's array by its plain rule, padded with zeros, up to one that begins with zero.

    Coefficients are those of a polynomial, the highest power first, or a matrix of one row.
    """
    given = list(coefficients)
    width = (len(given) + 1) // 2
    zero = given[0] - given[0]
    found = [[*line, *[zero] * (width - len(line))] for line in (given[0::2], given[1::2])]
    while len(found) < len(given) and not equal(found[-1][0], 0).holds:
        above, line = found[-2:]
        after = [(line[0] * a - above[0] * b) / line[0] for a, b in zip(above[1:], line[1:], strict=True)]
        found.append([*after, zero])
    return found


def characteristic(of: Any) -> list[Any]:
    """Coefficients of det(s I - A), the highest power first."""
    a = system(of).part("A")
    return list(a.charpoly().all_coeffs()) if is_exact(a) else list(np.poly(a))


def rank(of: Any) -> int:
    """Rank of a matrix, exact where its entries are."""
    return int(of.rank()) if is_exact(of) else int(np.linalg.matrix_rank(np.asarray(of, dtype=float)))


def dimension(of: Any) -> int:
    """How many states a system has, or rows a matrix."""
    return int(system(of).part("A").shape[0])


def controllability(of: Any, inputs: Sequence[str] = ()) -> Any:
    """The matrix [B, AB, ..., A^(n-1) B], of some inputs alone."""
    whole = inputs_of(of, inputs)
    return _krylov(whole.part("A"), whole.part("B"))


def observability(of: Any, outputs: Sequence[str] = ()) -> Any:
    """The matrix [C; CA; ...; C A^(n-1)], of some outputs alone."""
    whole = system(of)
    rows = whole.part("C")
    if outputs:
        rows = rows.extract([_place(whole, "outputs", name) for name in outputs], list(range(rows.cols)))
    return _krylov(whole.part("A").T, rows.T).T


def controllable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Whether some input carries every state to every other: by the Gramian, not by a rank."""
    return _definite(gramian(inputs_of(of, inputs), _INTERVAL))


def observable(of: Any) -> bool:
    """Whether the output over an interval tells the state it began at: by the Gramian, not by a rank."""
    return controllable(dual(of))


def gramian(of: Any, t: float) -> Array:
    """The integral of e^(-As) B B' e^(-A's) over [0, t]: from one exponential of twice the size (Van Loan)."""
    whole = system(of)
    a, b = -numbers(whole.part("A")), numbers(whole.part("B"))
    n = len(a)
    both = flow(np.block([[-a, b @ b.T], [np.zeros((n, n)), a.T]]), t)
    return np.asarray(both[n:, n:].T @ both[:n, n:])


def flow(of: Any, t: float) -> Array:
    """e^(At), by scaling and squaring; letters of A are taken as 1."""
    from scipy.linalg import expm

    return np.asarray(expm(t * numbers(system(of).part("A"))))


@cache
def _spectrum(a: Any) -> Any:
    """The exact eigenvalues of a matrix, with their multiplicities."""
    from satsym.symbolic.analysis import spectrum

    return spectrum(a)


def _eigenvalue(value: Any, of: Any) -> Any:
    for entry in _spectrum(system(of).part("A")).eigenvalues:
        if entry.value == value or (not is_exact(value) and abs(complex(entry.value) - complex(value)) < _ZERO):
            return entry
    raise BadInput(f"{value} is not an eigenvalue of {system(of).name}")


def _place(whole: Record, of: str, name: str) -> int:
    known = whole.part(of)
    refuse_unknown(f"{whole.name} has no", name, known)
    return int(known.index(name))


def _krylov(a: Any, b: Any) -> Any:
    blocks = [b]
    for _ in range(a.rows - 1):
        blocks.append(a * blocks[-1])
    return b.hstack(*blocks)


def _definite(gramian: Array) -> bool:
    sizes = np.linalg.eigvalsh(gramian)
    if sizes[-1] <= 0.0:
        return False
    if 1e-13 < sizes[0] / sizes[-1] < 1e-10:
        raise Undecided(f"the Gramian is nearly singular ({sizes[0] / sizes[-1]:.0e})")
    return bool(sizes[0] / sizes[-1] >= 1e-10)
