"""Decomposition of a matrix into invariant subspaces of its characteristic factors; Jordan form and companion form.

On the subspace of an irreducible factor f, A is the sum of two commuting matrices: S, which obeys f(S) = 0 and has
no Jordan blocks but single ones, and N, a power of which vanishes (the Jordan-Chevalley decomposition). Projector,
S and N are polynomials in A with coefficients from the field of the entries, so that no eigenvalue is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.analysis.field import Field, exact, never_zero
from satsym.symbolic.analysis.spectrum import LAMBDA, Factor, Spectrum


@dataclass(frozen=True)
class Component:
    """The part of a matrix that belongs to one factor of its characteristic polynomial.

    All matrices of a component vanish on the invariant subspaces of the other factors.
    """

    factor: Factor
    """Irreducible factor of the characteristic polynomial that belongs to the component."""
    projector: DomainMatrix
    """The projector onto the component's invariant subspace."""
    semisimple: DomainMatrix
    nilpotent: DomainMatrix
    """The matrices S and N of the component; their sum is A times the projector."""

    @property
    def nilpotent_powers(self) -> list[DomainMatrix]:
        """Return the projector, N, N^2, ... up to the last power of N that does not vanish."""
        found = [self.projector]
        for _ in range(max(self.factor.blocks) - 1):
            found.append(found[-1] * self.nilpotent)
        return found


def components(of: Spectrum) -> tuple[Component, ...]:
    """Return the components of a matrix, one for each factor; their projectors add up to the identity."""
    return tuple(_component(of, factor) for factor in of.factors)


def images(matrix: DomainMatrix, vector: DomainMatrix, count: int) -> list[DomainMatrix]:
    """Return the columns w, M w, M^2 w, ... for a vector w and a matrix M, ``count`` of them."""
    found = [vector]
    for _ in range(count - 1):
        found.append(matrix * found[-1])
    return found


def eigenvector(
    field: Field, factor: Factor, root: sp.Expr, matrix: DomainMatrix, vector: DomainMatrix
) -> sp.ImmutableMatrix:
    """Return an eigenvector of a matrix M for a root of a factor f, from a vector w with f(M) w = 0.

    It is f(M)/(M - root) w.
    """
    weights: list[sp.Expr] = []
    for coefficient in factor.coefficients[:-1]:
        weights.append(sp.expand((weights[-1] if weights else 0) * root + coefficient))
    found = sp.zeros(vector.shape[0], 1)
    for image, weight in zip(images(matrix, vector, factor.degree), reversed(weights), strict=True):
        found += sp.Matrix(field.matrix(image)) * weight
    return sp.ImmutableMatrix(found.applyfunc(sp.expand))


def whole(field: Field, vector: DomainMatrix) -> DomainMatrix:
    """Multiply a column by its common denominator, so that no entry has a denominator."""
    denominators = [sp.fraction(field.domain.to_sympy(row[0]))[1] for row in vector.to_dense().to_list()]
    return vector * field.domain.from_sympy(sp.lcm([sp.Integer(1), *denominators]))


def without_common_factor(vectors: Sequence[sp.MatrixBase]) -> list[sp.ImmutableMatrix]:
    """Divide vectors by the common factor of all their entries; leave them where entries have roots of sums."""
    entries = [e for vector in vectors for e in vector if e != 0]
    if not entries or any(not e.is_rational_function(*e.free_symbols) for e in entries):
        return [sp.ImmutableMatrix(v) for v in vectors]
    common = sp.gcd(entries)
    if not never_zero(common):
        return [sp.ImmutableMatrix(v) for v in vectors]
    return [sp.ImmutableMatrix(v.applyfunc(lambda e: sp.expand(sp.cancel(e / common)))) for v in vectors]


def _component(of: Spectrum, factor: Factor) -> Component:
    field, f = of.field, factor.polynomial
    power = f ** max(factor.blocks)
    others = sp.Poly(1, LAMBDA, domain=field.domain)
    for other in of.factors:
        if other is not factor:
            others *= other.polynomial ** max(other.blocks)
    one = others * others.invert(power) if others.degree() else others
    projector = field.at(one, of.matrix)
    simple = field.at(_newton(f, power), of.matrix) * projector
    return Component(factor, projector, simple, of.matrix * projector - simple)


def _newton(f: sp.Poly, power: sp.Poly) -> sp.Poly:
    """Return, by Newton's method, the polynomial that is a root of f modulo a power of f, and s modulo f itself."""
    root = sp.Poly(LAMBDA, LAMBDA, domain=f.domain).rem(power)
    while not (value := f.compose(root).rem(power)).is_zero:
        slope = f.diff(LAMBDA).compose(root).rem(power)
        root = (root - value * slope.invert(power)).rem(power)
    return root


@dataclass(frozen=True)
class JordanBlock:
    """An eigenvalue and the size of one of its Jordan blocks."""

    eigenvalue: sp.Expr
    size: int


@dataclass(frozen=True)
class JordanForm:
    """The Jordan form J of a matrix A with a basis T, so that A T = T J."""

    blocks: tuple[JordanBlock, ...]
    """Jordan blocks in the order in which they stand in J."""
    form: sp.ImmutableMatrix
    """The Jordan matrix J, with ones above the diagonal."""
    basis: sp.ImmutableMatrix
    """The matrix T of eigenvectors and generalised eigenvectors; each block begins with its eigenvector."""


def jordan_form(of: Spectrum) -> JordanForm | None:
    """Return the Jordan form of a matrix; ``None`` where an eigenvalue has no closed form."""
    if not of.closed_form:
        return None
    blocks: list[JordanBlock] = []
    columns: list[sp.ImmutableMatrix] = []
    for component in components(of):
        chains = _chains(of.field, component)
        for root in component.factor.roots:
            for chain in chains:
                blocks.append(JordanBlock(root, len(chain)))
                vectors = [eigenvector(of.field, component.factor, root, component.semisimple, w) for w in chain]
                columns += without_common_factor(vectors)
    form = sp.diag(*(sp.Matrix.jordan_block(b.size, b.eigenvalue) for b in blocks))
    return JordanForm(tuple(blocks), sp.ImmutableMatrix(form), sp.ImmutableMatrix(sp.Matrix.hstack(*columns)))


def _chains(field: Field, component: Component) -> list[list[DomainMatrix]]:
    """Return the Jordan chains N^(k-1) w, ..., N w, w, one for each block of size k of the factor.

    Chains are independent if their first vectors are, together with the images of these under S.
    """
    size = component.projector.shape[0]
    outside = DomainMatrix.eye(size, field.domain).to_dense() - component.projector
    firsts: list[DomainMatrix] = []
    found: list[list[DomainMatrix]] = []
    for length in component.factor.blocks:
        beyond = component.nilpotent**length
        kernel = DomainMatrix.vstack(outside, beyond).nullspace()
        for k in range(kernel.shape[0]):
            chain = [whole(field, kernel[k, :].transpose())]
            for _ in range(length - 1):
                chain.insert(0, component.nilpotent * chain[0])
            first = images(component.semisimple, chain[0], component.factor.degree)
            if DomainMatrix.hstack(*firsts, *first).rank() == len(firsts) + len(first):
                firsts += first
                found.append(chain)
                break
    return found


@dataclass(frozen=True)
class CompanionForm:
    """A basis T in which one input drives a chain of integrators.

    T^-1 A T is ``matrix``, and T^-1 b is the last unit vector.
    """

    matrix: sp.ImmutableMatrix
    """The companion matrix of the characteristic polynomial."""
    basis: sp.ImmutableMatrix
    """The matrix T of the change of basis."""


def companion_matrix(coefficients: Sequence[sp.Expr]) -> sp.ImmutableMatrix:
    """Return the companion matrix of a monic polynomial: ones above the diagonal, the last row -a_k.

    Coefficients are given highest power first.
    """
    size = len(coefficients) - 1
    last = [-c for c in reversed(list(coefficients)[1:])]
    return sp.ImmutableMatrix(size, size, lambda i, j: last[j] if i == size - 1 else sp.Integer(int(j == i + 1)))


def companion_form(of: Spectrum, b: sp.MatrixBase) -> CompanionForm | None:
    """Return the companion form for one input; ``None`` if that input does not control all states.

    Parameters
    ----------
    of
        A, with its spectrum.
    b
        The input's column, shape (n, 1).
    """
    a = of.field.matrix(of.matrix)
    field, (matrix, column, row) = exact(a, b, sp.Matrix([of.coefficients]))
    columns = [column]  # from the last one to the first: b, A b + a_1 b, A (A b + a_1 b) + a_2 b, ...
    for coefficient in row.to_list()[0][1:-1]:
        columns.append(matrix * columns[-1] + column * coefficient)
    basis = DomainMatrix.hstack(*reversed(columns))
    if basis.rank() < a.rows:
        return None
    return CompanionForm(companion_matrix(of.coefficients), field.matrix(basis))
