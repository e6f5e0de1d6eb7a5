"""The matrix exponential e^(At) in closed form: exponentials, sines and cosines, polynomials in time."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.analysis.components import Component, components
from satsym.symbolic.analysis.field import Field, shortest, sign_of
from satsym.symbolic.analysis.spectrum import Spectrum
from satsym.symbolic.factoring import factored
from satsym.symbolic.model import t


def matrix_exponential(of: Spectrum) -> sp.ImmutableMatrix | None:
    """Return e^(At) in real form; ``None`` where an eigenvalue has no closed form.

    For a pair of eigenvalues that is real or complex depending on parameters, hyperbolic functions are written; their
    values are right in both cases.
    """
    if not of.closed_form:
        return None
    size = of.matrix.shape[0]
    total = sp.zeros(size, size)
    for component in components(of):
        total += _part(of.field, component)
    return sp.ImmutableMatrix(total.applyfunc(_tidied))


def _part(field: Field, component: Component) -> sp.Matrix:
    """Return e^(St) e^(Nt) on the invariant subspace of a factor."""
    found = sp.zeros(*component.projector.shape)
    for k, power in enumerate(component.nilpotent_powers):
        growth = t**k / sp.factorial(k)
        for function, matrix in _simple(field, component):
            found += sp.Matrix(field.matrix(matrix * power)) * function * growth
    return found


def _simple(field: Field, component: Component) -> list[tuple[sp.Expr, sp.MatrixBase]]:
    """Return e^(St) as a sum of functions of time times matrices."""
    factor, s, one = component.factor, component.semisimple, component.projector
    if factor.degree == 1:
        return [(sp.exp(factor.roots[0] * t), one)]
    if factor.degree == 2:
        _, b, c = factor.polynomial.rep.to_list()
        centre = -b / field.domain.convert(2)
        square = field.expression(centre * centre - c)
        even, odd = _pair(square)
        growth = sp.exp(field.expression(centre) * t)
        return [(growth * even, one), (growth * odd, s - one * centre)]
    return _biquadratic(field, component)


def _pair(square: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return cosh(d t) and sinh(d t)/d for the root d of ``square``, with sines where the square is negative."""
    if sign_of(square) == -1:
        frequency = sp.sqrt(factored(-square))
        return sp.cos(frequency * t), sp.sin(frequency * t) / frequency
    rate = sp.sqrt(factored(square))
    return sp.cosh(rate * t), sp.sinh(rate * t) / rate


def _biquadratic(field: Field, component: Component) -> list[tuple[sp.Expr, sp.MatrixBase]]:
    """Return e^(St) where f(S) = S^4 + p S^2 + q = 0, as a sum over the roots r of f.

    The summands are e^(rt) f(S) / ((S - r) f'(r)). The roots r and -r are taken together, so that only y = r^2 matters.
    """
    s, one = component.semisimple, component.projector
    p, q = (field.shown(c) for c in component.factor.polynomial.all_coeffs()[2::2])
    first = component.factor.roots[0]
    functions = [sp.Integer(0)] * 4
    if sign_of(shortest(p**2 / 4 - q)) == -1:
        a, b = first.as_real_imag()
        c, d = (sp.expand_mul(((2 * sp.expand_mul(first**2) + p) ** -1) * w) for w in (1, 1 / first))
        even = sp.cosh(a * t) * sp.cos(b * t), sp.sinh(a * t) * sp.sin(b * t)
        odd = sp.sinh(a * t) * sp.cos(b * t), sp.cosh(a * t) * sp.sin(b * t)
        for k, (weight, (real, imaginary)) in enumerate(((c, even), (d, odd))):
            for power, more in ((k, first**2 + p), (k + 2, sp.Integer(1))):
                u, v = map(sp.radsimp, sp.expand_mul(weight * more).as_real_imag())
                functions[power] += 2 * (u * real - v * imaginary)
    else:
        for y in (-p / 2 + sp.sqrt(p**2 / 4 - q), -p / 2 - sp.sqrt(p**2 / 4 - q)):
            for k, function in enumerate(_pair(shortest(y))):
                functions[k] += (y + p) / (2 * y + p) * function
                functions[k + 2] += function / (2 * y + p)
    return list(zip(map(sp.radsimp, functions), (one, s, s * s, s * s * s), strict=True))


def _tidied(entry: sp.Expr) -> sp.Expr:
    """Write an entry as a sum over its functions of time, each with its shortest coefficient."""
    functions = sorted((f for f in entry.atoms(sp.Function, sp.exp) if f.has(t)), key=sp.default_sort_key)
    return sp.Add(
        *(basis * shortest(c) for basis, c in sp.collect(sp.expand(entry), functions, evaluate=False).items())
    )
