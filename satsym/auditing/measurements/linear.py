"""Linear systems: exact matrices, eigenvalues and ranks; controllability and observability from Gramians.

A system may be given as the name of a model, a member of a family, or a square matrix.
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
"""Length of the time interval over which controllability and observability are tested."""
_ZERO, _DEPENDENT = 1e-9, 1e-7


def system(of: Any) -> Record:
    """Return a linear system: exact matrices A, B and C, and names of states, inputs and outputs.

    A member of a family is returned unchanged; a matrix becomes a system without inputs.
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
    """Return a system with only the given inputs, or unchanged if none are given."""
    whole = system(of)
    if not inputs:
        return whole
    chosen, b = [_place(whole, "inputs", name) for name in inputs], whole.part("B")
    return Record(whole.name, {**whole.parts, "B": b.extract(list(range(b.rows)), chosen), "inputs": list(inputs)})


def dual(of: Any) -> Record:
    """Return the dual system, with A', C' and B' in place of A, B and C."""
    whole = system(of)
    return Record(f"the dual of {whole.name}", {"A": whole.part("A").T, "B": whole.part("C").T, "C": whole.part("B").T})


def eigenvalues(of: Any) -> list[Any]:
    """Return all eigenvalues, repeated by algebraic multiplicity; exact if the matrix is exact.

    Eigenvalues of a numerical matrix are sorted by increasing real part, then by decreasing imaginary part.
    """
    a = system(of).part("A")
    if is_exact(a):
        return [e.value for e in _spectrum(a).eigenvalues for _ in range(e.algebraic)]
    return sorted(np.linalg.eigvals(a).tolist(), key=lambda z: (round(z.real, 9), -z.imag))


def closed_loop(of: Any, gain: Any, inputs: Sequence[str] = ()) -> Record:
    """Return the closed loop x' = (A - B K) x with only the given inputs; letters in A are set to 1."""
    whole = system(of)
    a = numbers(whole.part("A")) - numbers(inputs_of(whole, inputs).part("B")) @ numbers(gain)
    return Record(f"{whole.name} with feedback", {**whole.parts, "A": a})


def stabilisable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Return whether some feedback stabilises the system, by the Hautus test at each eigenvalue that is not stable."""
    whole = inputs_of(of, inputs)
    a, b = numbers(whole.part("A")), numbers(whole.part("B"))
    left = [np.hstack([v * np.eye(len(a)) - a, b]) for v in np.linalg.eigvals(a) if v.real > -_ZERO]
    return all(int(np.linalg.matrix_rank(each, tol=_DEPENDENT)) == len(a) for each in left)


def algebraic(eigenvalue: Any, of: Any) -> int:
    """Return the algebraic multiplicity of an eigenvalue."""
    return int(_eigenvalue(eigenvalue, of).algebraic)


def geometric(eigenvalue: Any, of: Any) -> int:
    """Return the geometric multiplicity of an eigenvalue."""
    return int(_eigenvalue(eigenvalue, of).geometric)


@kept
def eigenvectors(of: Any) -> list[Record]:
    """Return independent exact eigenvectors as columns (``vector``), each with its eigenvalue (``value``)."""
    a = system(of).part("A")
    return [
        Record(f"eigenvector {k + 1} for {e.value}", {"value": e.value, "vector": column})
        for e in _spectrum(a).eigenvalues
        for k, column in enumerate((a - e.value * a.eye(a.rows)).nullspace(simplify=True))
    ]


def jordan(of: Any) -> Record:
    """Return a basis P of Jordan chains of an exact matrix, as columns, and the eigenvalue of each column."""
    from satsym.symbolic.analysis.components import jordan_form

    found = jordan_form(_spectrum(system(of).part("A")))
    if found is None:
        raise Undecided("no closed form of the eigenvalues")
    return Record("the Jordan form", {"P": found.basis, "values": [found.form[i, i] for i in range(found.form.rows)]})


def routh(coefficients: Sequence[Any]) -> list[list[Any]]:
    """Return the rows of the Routh array, padded with zeros, up to the first row that begins with zero.

    The coefficients are those of a polynomial, the highest power first, or a matrix of one row.
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
    """Return the coefficients of det(s I - A), the highest power first."""
    a = system(of).part("A")
    return list(a.charpoly().all_coeffs()) if is_exact(a) else list(np.poly(a))


def rank(of: Any) -> int:
    """Return the rank of a matrix, exact if the entries are exact."""
    return int(of.rank()) if is_exact(of) else int(np.linalg.matrix_rank(np.asarray(of, dtype=float)))


def dimension(of: Any) -> int:
    """Return the number of states of a system, or of rows of a matrix."""
    return int(system(of).part("A").shape[0])


def controllability(of: Any, inputs: Sequence[str] = ()) -> Any:
    """Return the controllability matrix [B, AB, ..., A^(n-1) B] for the given inputs."""
    whole = inputs_of(of, inputs)
    return _krylov(whole.part("A"), whole.part("B"))


def observability(of: Any, outputs: Sequence[str] = ()) -> Any:
    """Return the observability matrix [C; CA; ...; C A^(n-1)] for the given outputs."""
    whole = system(of)
    rows = whole.part("C")
    if outputs:
        rows = rows.extract([_place(whole, "outputs", name) for name in outputs], list(range(rows.cols)))
    return _krylov(whole.part("A").T, rows.T).T


def controllable(of: Any, inputs: Sequence[str] = ()) -> bool:
    """Return whether a system is controllable, judged by its Gramian, not by a rank."""
    return _definite(gramian(inputs_of(of, inputs), _INTERVAL))


def observable(of: Any) -> bool:
    """Return whether a system is observable, judged by the Gramian of the dual system, not by a rank."""
    return controllable(dual(of))


def gramian(of: Any, t: float) -> Array:
    """Return the integral of e^(-As) B B' e^(-A's) over [0, t], from one exponential of twice the size (Van Loan)."""
    whole = system(of)
    a, b = -numbers(whole.part("A")), numbers(whole.part("B"))
    n = len(a)
    both = flow(np.block([[-a, b @ b.T], [np.zeros((n, n)), a.T]]), t)
    return np.asarray(both[n:, n:].T @ both[:n, n:])


def flow(of: Any, t: float) -> Array:
    """Return e^(At), computed by scaling and squaring; letters in A are set to 1."""
    from scipy.linalg import expm

    return np.asarray(expm(t * numbers(system(of).part("A"))))


@cache
def _spectrum(a: Any) -> Any:
    """Return the exact eigenvalues of a matrix with their multiplicities."""
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
