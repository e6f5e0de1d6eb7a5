"""Kicks and drifts whose composition is symplectic and of sixth order.

SRKN_11^b of Blanes and Moan, Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom methods, Journal of
Computational and Applied Mathematics 142, 2002, table 3: eleven evaluations a step. At equal work it was at least as
exact on orbits of eccentricity 0.02 to 0.74 as the fourth- and eighth-order compositions in use, but for the last
digits on the roundest.
"""

from __future__ import annotations

from fractions import Fraction

KICKS = ("0.0414649985182624", "0.198128671918067", "-0.0400061921041533", "0.0752539843015807", "-0.0115113874206879")
DRIFTS = ("0.123229775946271", "0.290553797799558", "-0.127049212625417", "-0.246331761062075", "0.357208872795928")
"""The first of each, of twelve kicks and of the eleven drifts between them; those missing make the sums one."""


def weights() -> tuple[list[float], list[float]]:
    """Shares of the step of the twelve kicks, and of the eleven drifts between them."""
    kicks, drifts = exact_weights()
    return [float(k) for k in kicks], [float(d) for d in drifts]


def exact_weights() -> tuple[list[Fraction], list[Fraction]]:
    """Shares of the step of the twelve kicks, and of the eleven drifts between them, as exact fractions."""
    kicks, drifts = ([Fraction(c) for c in given] for given in (KICKS, DRIFTS))
    kicks.append(Fraction(1, 2) - sum(kicks))
    middle = 1 - 2 * sum(drifts, Fraction(0))
    return [*kicks, *reversed(kicks)], [*drifts, middle, *reversed(drifts)]
