"""The weights of the classical Runge-Kutta method, solved from the conditions of its order."""

from __future__ import annotations

from fractions import Fraction


def classical_weights() -> tuple[Fraction, ...]:
    """Weights of the classical stages, solved from order conditions.

    With the nodes 0, 1/2, 1/2, 1 and each stage built on the one before it, the conditions sum b = 1, sum b c = 1/2,
    sum b c^2 = 1/3 and sum b_i a_ij c_j = 1/6 of order three have one solution; it is of order four (Hairer, Norsett
    and Wanner, Solving Ordinary Differential Equations I, II.1).
    """
    c = [Fraction(0), Fraction(1, 2), Fraction(1, 2), Fraction(1)]
    chained = [Fraction(0), Fraction(0), c[2] * c[1], c[3] * c[2]]
    system = [
        [*([Fraction(1)] * 4), Fraction(1)],
        [*c, Fraction(1, 2)],
        [*(node**2 for node in c), Fraction(1, 3)],
        [*chained, Fraction(1, 6)],
    ]
    for i in range(4):
        pivot = next(row for row in system[i:] if row[i])
        system.remove(pivot)
        system.insert(i, [entry / pivot[i] for entry in pivot])
        for j in range(4):
            if j != i:
                system[j] = [e - system[j][i] * p for e, p in zip(system[j], system[i], strict=True)]
    return tuple(row[4] for row in system)
