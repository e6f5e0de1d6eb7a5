"""A matrix taken apart: invariant subspaces by factors of its characteristic polynomial, Jordan and companion form.

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
    """What belongs to one factor; all matrices vanish on the other subspaces."""

    factor: Factor
    """The factor."""
    projector: DomainMatrix
    """The projector onto its subspace."""
    semisimple: DomainMatrix
    nilpotent: DomainMatrix
    """S and N there; their sum is A times the projector."""

    @property
    def nilpotent_powers(self) -> list[DomainMatrix]:
        """The projector, N, N^2, ... as far as they do not vanish."""
        found = [self.projector]
        for _ in range(max(self.factor.blocks) - 1):
            found.append(found[-1] * self.nilpotent)
        return found


def components(of: Spectrum) -> tuple[Component, ...]:
    """The components of a matrix, factor by factor; their projectors add up to the identity."""
    return tuple(_component(of, factor) for factor in of.factors)


def images(matrix: DomainMatrix, vector: DomainMatrix, count: int) -> list[DomainMatrix]:
    """w, M w, M^2 w, ...; ``count`` of them."""
    found = [vector]
    for _ in range(count - 1):
        found.append(matrix * found[-1])
    return found


def eigenvector(
    field: Field, factor: Factor, root: sp.Expr, matrix: DomainMatrix, vector: DomainMatrix
) -> sp.ImmutableMatrix:
    """An eigenvector to a root of a factor f of a matrix M, from a vector w with f(M) w = 0: f(M)/(M - root) w."""
    weights: list[sp.Expr] = []
    for coefficient in factor.coefficients[:-1]:
        weights.append(sp.expand((weights[-1] if weights else 0) * root + coefficient))
    found = sp.zeros(vector.shape[0], 1)
    for image, weight in zip(images(matrix, vector, factor.degree), reversed(weights), strict=True):
        found += sp.Matrix(field.matrix(image)) * weight
    return sp.ImmutableMatrix(found.applyfunc(sp.expand))


def whole(field: Field, vector: DomainMatrix) -> DomainMatrix:
    """A multiple of a column without denominators."""
    denominators = [sp.fraction(field.domain.to_sympy(row[0]))[1] for row in vector.to_dense().to_list()]
    return vector * field.domain.from_sympy(sp.lcm([sp.Integer(1), *denominators]))


def without_common_factor(vectors: Sequence[sp.MatrixBase]) -> list[sp.ImmutableMatrix]:
    """Vectors divided by what all their entries have in common; as they are where there are roots of sums."""
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
    """The polynomial that is a root of f modulo a power of f, and s modulo f itself: Newton's method."""
    root = sp.Poly(LAMBDA, LAMBDA, domain=f.domain).rem(power)
    while not (value := f.compose(root).rem(power)).is_zero:
        slope = f.diff(LAMBDA).compose(root).rem(power)
        root = (root - value * slope.invert(power)).rem(power)
    return root


@dataclass(frozen=True)
class JordanBlock:
    """An eigenvalue and the size of one of its blocks."""

    eigenvalue: sp.Expr
    size: int


@dataclass(frozen=True)
class JordanForm:
    """A T = T J."""

    blocks: tuple[JordanBlock, ...]
    """Jordan blocks in the order in which they stand in J."""
    form: sp.ImmutableMatrix
    """J, with ones above the diagonal."""
    basis: sp.ImmutableMatrix
    """T: eigenvectors and generalised eigenvectors as columns, those of a block from the eigenvector up."""


def jordan_form(of: Spectrum) -> JordanForm | None:
    """The Jordan form; ``None`` where an eigenvalue has no closed form."""
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
    """N^(k-1) w, ..., N w, w for each block of size k, the same for all roots of the factor.

    Chains are independent if their first vectors are, together with what S makes of these.
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
    """A basis in which one input drives a chain of integrators: T^-1 A T = matrix, T^-1 b = the last unit vector."""

    matrix: sp.ImmutableMatrix
    """The companion matrix of the characteristic polynomial."""
    basis: sp.ImmutableMatrix
    """T."""


def companion_matrix(coefficients: Sequence[sp.Expr]) -> sp.ImmutableMatrix:
    """The companion matrix of a monic polynomial, given highest power first: ones above the diagonal, then -a_k."""
    size = len(coefficients) - 1
    last = [-c for c in reversed(list(coefficients)[1:])]
    return sp.ImmutableMatrix(size, size, lambda i, j: last[j] if i == size - 1 else sp.Integer(int(j == i + 1)))


def companion_form(of: Spectrum, b: sp.MatrixBase) -> CompanionForm | None:
    """The companion form for one input; ``None`` if the input does not reach everything.

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
