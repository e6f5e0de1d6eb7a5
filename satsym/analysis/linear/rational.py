"""Matrices with rational entries: characteristic polynomial, Jordan blocks, signs and ranks, decided exactly.

The characteristic polynomial is split by multiplicity, and where roots are multiple into irreducible factors f; the
ranks of f(A), f(A)^2, ... determine the Jordan blocks. Roots are numbers with error bounds. The number of roots on the
imaginary axis is counted beforehand: those iw for which w is a real root of both parts of p(iw), that is, the roots of
gcd(p(s), p(-s)) = e(s^2) for which e has a negative root. Bounds are narrowed until all others are off the axis. The
matrices of a linearisation are fractions where the model and its parameters contain only rational numbers. For these
the generated functions are called with fractions in place of floats. Decimals count as written: a parameter of at most
15 digits, and a number in a formula that is a simple fraction or has few digits. Where a root, a sine or a number of
more digits occurs, the matrices are not known exactly.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array
from satsym.kernels import Kernels

if TYPE_CHECKING:
    from flint import acb, fmpq, fmpq_mat, fmpz_poly

BITS = 192
"""Least number of bits to which roots of a polynomial are enclosed."""


@dataclass(frozen=True, eq=False)
class Rational:
    """The exact matrices of a linear system with rational entries."""

    A: fmpq_mat
    B: fmpq_mat
    C: fmpq_mat

    def with_inputs(self, columns: Sequence[int]) -> Rational:
        """Return the system with only some of its inputs."""
        from flint import fmpq_mat

        chosen = [row[j] for row in self.B.tolist() for j in columns]
        return Rational(self.A, fmpq_mat(self.B.nrows(), len(columns), chosen), self.C)

    def transposed(self) -> Rational:
        """Return the dual system."""
        return Rational(self.A.transpose(), self.C.transpose(), self.B.transpose())


@dataclass(frozen=True, eq=False)
class Root:
    """An eigenvalue, and the sizes of its Jordan blocks, the largest first."""

    value: acb
    """The eigenvalue with an error bound; real or imaginary part exactly zero where they are."""
    blocks: tuple[int, ...]

    @property
    def rounded(self) -> complex:
        """Return the eigenvalue rounded to the nearest floats."""
        return nearest(self.value)


def nearest(value: acb) -> complex:
    """Return the floats nearest to the midpoint of a ball; the library's own conversion truncates."""
    parts = (part.mid().fmpq() for part in (value.real, value.imag))
    return complex(*(int(part.p) / int(part.q) for part in parts))


def matrix(rows: ArrayLike | Sequence[Sequence[Fraction]]) -> fmpq_mat:
    """Return an exact matrix, shape (n, m), from floats, each as the fraction that it is, or from fractions."""
    from flint import fmpq_mat

    table = np.asarray(rows, dtype=object)
    n, m = table.shape
    return fmpq_mat(n, m, [_fraction(value) for value in table.ravel().tolist()])


def _fraction(value: float | Fraction) -> fmpq:
    from flint import fmpq

    return fmpq(*value.as_integer_ratio())


def characteristic(A: fmpq_mat) -> list[Fraction]:
    """Return the coefficients of det(s - A), highest power first."""
    return [Fraction(int(c.p), int(c.q)) for c in reversed(A.charpoly().coeffs())]


def roots(A: fmpq_mat) -> list[Root]:
    """Return the distinct eigenvalues of a square matrix."""
    found: list[Root] = []
    for factor, multiplicity in A.charpoly().numer().factor_squarefree()[1]:
        if multiplicity == 1:
            found += [Root(value, (1,)) for value in located(factor)]
            continue
        for irreducible, _ in factor.factor()[1]:
            blocks = _blocks(A, irreducible, multiplicity)
            found += [Root(value, blocks) for value in located(irreducible)]
    return found


def _blocks(A: fmpq_mat, factor: fmpz_poly, multiplicity: int) -> tuple[int, ...]:
    """Return the block sizes of each root of an irreducible factor f of a matrix A.

    Each block of size k or more lowers the rank of f(A)^k by the degree of f.
    """
    size, degree = A.nrows(), factor.degree()
    value = at(factor, A)
    ranks, power = [size], value
    while size - ranks[-1] < degree * multiplicity:
        ranks.append(power.rank())
        power = power * value
    at_least = [(a - b) // degree for a, b in pairwise(ranks)]
    return tuple(sum(count > i for count in at_least) for i in range(at_least[0]))


def at(polynomial: fmpz_poly, A: fmpq_mat) -> fmpq_mat:
    """Evaluate a polynomial at a square matrix by Horner's rule."""
    from flint import fmpq_mat

    n = A.nrows()
    one = fmpq_mat(n, n, [int(i == j) for i in range(n) for j in range(n)])
    value = one * 0
    for coefficient in reversed(polynomial.coeffs()):
        value = value * A + one * coefficient
    return value


def located(polynomial: fmpz_poly) -> list[acb]:
    """Return the roots of a polynomial without multiple roots; real parts on the imaginary axis are exactly zero."""
    from flint import acb, ctx

    degree, bits = polynomial.degree(), BITS
    while True:
        with ctx.workprec(bits):
            found = _complex_roots(polynomial)
            off = [value.real > 0 or value.real < 0 for value in found]
            if sum(off) == degree - _on_axis(polynomial):
                return [
                    value if away else acb(0, 0 if value.imag.contains(0) else value.imag)
                    for value, away in zip(found, off, strict=True)
                ]
        bits *= 2


def _on_axis(polynomial: fmpz_poly) -> int:
    """Count the roots on the imaginary axis of a polynomial without multiple roots."""
    from flint import fmpz_poly

    coefficients = polynomial.coeffs()
    mirrored = fmpz_poly([-c if k % 2 else c for k, c in enumerate(coefficients)])
    shared = polynomial.gcd(mirrored).coeffs()
    zero = int(shared[0] == 0)
    squares = fmpz_poly(shared[zero::2])
    return zero + 2 * sum(value.imag == 0 and value.real < 0 for value in _complex_roots(squares))


def _complex_roots(polynomial: Any) -> list[acb]:
    """Enclose the complex roots of a polynomial without multiple roots."""
    return [value for value, _ in polynomial.complex_roots()]


def reached(A: fmpq_mat, B: fmpq_mat) -> tuple[int, list[Root]]:
    """Return the dimension of the controllable subspace, and the uncontrollable eigenvalues."""
    from flint import fmpq_mat

    n = A.nrows()
    powers = [B]
    for _ in range(n - 1):
        powers.append(A * powers[-1])
    unit = [[int(i == j) for j in range(n)] for i in range(n)]
    columns = [row for power in powers for row in power.transpose().tolist()]
    # independent columns of (B, AB, ...), filled up with unit vectors
    whole = fmpq_mat(n, len(columns) + n, [v for row in zip(*columns, *unit, strict=True) for v in row])
    pivots = _pivots(whole.rref()[0].tolist())
    rank = sum(p < len(columns) for p in pivots)
    if rank == n:
        return n, []
    chosen = [(columns + unit)[p] for p in pivots]
    basis = fmpq_mat(n, n, [v for row in chosen for v in row]).transpose()
    form = basis.solve(A * basis).tolist()
    rest = [v for row in form[rank:] for v in row[rank:]]
    return rank, roots(fmpq_mat(n - rank, n - rank, rest))


def _pivots(rows: Iterable[Sequence[Any]]) -> list[int]:
    firsts = (next((j for j, value in enumerate(row) if value != 0), None) for row in rows)
    return [first for first in firsts if first is not None]


SIMPLE = 10_000
"""Largest denominator of a simple fraction; of other floats, one in a hundred million looks like one."""
DIGITS_OF_PARAMETERS, DIGITS_OF_FORMULAS = 15, 12
"""Most digits of a number that is read as its printed decimal: of a user's parameter, and of a value in a formula. A
computed float usually has more."""

SAME_AS_FLOATS = (0, 1)
"""Arguments at which functions have exact values, such as sin(0) and log(1)."""


class NotRational(ArithmeticError):
    """A number is not known as a fraction."""


class Ratio:
    """A fraction with the operations of floats, for formulas that are written for floats."""

    __slots__ = ("value",)

    def __init__(self, value: Fraction) -> None:
        self.value = value

    def __float__(self) -> float:
        if self.value in SAME_AS_FLOATS:
            return float(self.value)
        raise NotRational

    def __bool__(self) -> bool:
        return self.value != 0

    def __neg__(self) -> Ratio:
        return Ratio(-self.value)

    def __abs__(self) -> Ratio:
        return Ratio(abs(self.value))

    def __pow__(self, power: float | Ratio) -> Ratio:
        exponent = fraction(power)
        if exponent.denominator != 1:
            raise NotRational
        return Ratio(self.value ** int(exponent))


def _forward(name: str) -> Callable[[Ratio, Any], Any]:
    function = getattr(operator, name)
    return lambda one, other: _wrapped(function(one.value, fraction(other)))


def _backward(name: str) -> Callable[[Ratio, Any], Any]:
    function = getattr(operator, name)
    return lambda one, other: _wrapped(function(fraction(other), one.value))


def _wrapped(value: Any) -> Any:
    return Ratio(value) if isinstance(value, Fraction) else value


for _name in ("add", "sub", "mul", "truediv"):
    setattr(Ratio, f"__{_name}__", _forward(_name))
    setattr(Ratio, f"__r{_name}__", _backward(_name))
for _name in ("eq", "ne", "lt", "le", "gt", "ge"):
    setattr(Ratio, f"__{_name}__", _forward(_name))


def fraction(number: float | Ratio) -> Fraction:
    """Return a number of a formula as a fraction.

    Raises
    ------
    NotRational
        If it has too many digits to be one.
    """
    if isinstance(number, Ratio):
        return number.value
    if not np.isfinite(number):
        raise NotRational
    simple = Fraction(number).limit_denominator(SIMPLE)
    if float(simple) == number:
        return simple
    written = _written(number, DIGITS_OF_FORMULAS)
    if written is None:
        raise NotRational
    return written


def _written(number: float, digits: int) -> Fraction | None:
    """Return the decimal that a float was read from; ``None`` if that has more digits."""
    shortest = repr(float(number))
    mantissa = shortest.partition("e")[0].replace(".", "").lstrip("-0").rstrip("0")
    return Fraction(shortest) if len(mantissa) <= digits else None


def given(number: float) -> Any:
    """Return a user's number as a fraction: its decimal, or the float itself where it has too many digits."""
    written = _written(number, DIGITS_OF_PARAMETERS)
    return number if written is None else Ratio(written)


def exact_matrices(model: Kernels, parameters: Sequence[float], t0: float, point: Array) -> Rational | None:
    """Return A, B and C of a linearisation; ``None`` where they, or its point, are not known exactly.

    Parameters
    ----------
    point
        The reference at t0, zero, or an equilibrium, shape (n,).
    """
    if model.backend != "python":
        return None
    n, m, k = len(point), len(model.spec.controls), len(model.spec.outputs)
    p, t, rest = tuple(map(given, parameters)), given(t0), (0.0,) * m
    try:
        x = [*model.reference(t, p)] if model.spec.has_reference else list(map(given, point.tolist()))
        if not (model.spec.has_reference or model.spec.linear) and any(map(fraction, model.dynamics(t, x, rest, p))):
            return None
        A, B = model.jacobian_x(t, x, rest, p), model.jacobian_u(t, x, rest, p) if m else ()
        C = model.output_matrix(t, p) if k else ()
        return Rational(*(_matrix(*each) for each in ((A, n, n), (B, n, m), (C, k, n))))
    except (ArithmeticError, TypeError, ValueError):
        return None


def _matrix(values: Sequence[float | Ratio], rows: int, columns: int) -> Any:
    return matrix(np.array([fraction(value) for value in values], dtype=object).reshape(rows, columns))
