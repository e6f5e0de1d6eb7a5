"""The Jordan form, and a basis in which a matrix takes it."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.analysis.components import Component, components, eigenvector, images, whole, without_common_factor
from satsym.symbolic.analysis.field import Field
from satsym.symbolic.analysis.spectrum import Spectrum


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
