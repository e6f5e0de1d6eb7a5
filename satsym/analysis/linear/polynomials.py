"""Characteristic polynomials, companion forms and pole placement."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from satsym.analysis.linear.ranks import controllability
from satsym.analysis.linear.scaling import scaled
from satsym.analysis.linear.spectrum import shown, spectrum
from satsym.analysis.linear.system import LinearSystem
from satsym.arrays import Array
from satsym.status import BadInput

ROUNDING = 1e-13
"""A coefficient that is smaller than this, relative to what it would be if nothing in it cancelled, is zero."""


def characteristic(A: Array) -> Array:
    """Coefficients of det(s - A), highest power first, the first one 1; shape (n + 1,)."""
    values = np.array([each.value for each in spectrum(A) for _ in range(each.algebraic)])
    rate = float(np.abs(values).max()) or 1.0
    coefficients, largest = np.poly(values / rate).real, np.poly(-np.abs(values / rate))
    coefficients[np.abs(coefficients) <= ROUNDING * largest] = 0.0
    return np.asarray(coefficients * rate ** np.arange(len(values) + 1))


def companion_matrix(coefficients: Sequence[float] | Array) -> Array:
    """The matrix with this monic characteristic polynomial, its coefficients negated in the last row, lowest first."""
    n = len(coefficients) - 1
    found = np.eye(n, k=1)
    found[-1] = -np.asarray(coefficients)[:0:-1]
    return found


def companion_form(given: LinearSystem) -> tuple[Array, LinearSystem]:
    """Coordinates in which A is a companion matrix and B is (0, ..., 0, 1)'.

    Parameters
    ----------
    given
        With one input; see :meth:`LinearSystem.with_inputs`.

    Returns
    -------
    T : array of shape (n, n)
        Old coordinates from new ones, x = T z.
    system : LinearSystem
        In the new ones.

    Raises
    ------
    BadInput
        If there is not one input, or it does not reach every mode.
    """
    if len(given.inputs) != 1:
        raise BadInput(f"a companion form has one input, not {len(given.inputs)}; choose one")
    _reachable(given)
    # Horner's scheme for (s - A)^-1 B: its coefficients are the columns of T
    polynomial, columns = characteristic(given.A), [given.B]
    for coefficient in polynomial[1:-1]:
        columns.append(given.A @ columns[-1] + coefficient * given.B)
    T = np.hstack(columns[::-1])
    names = tuple(f"z{i + 1}" for i in range(len(given.states)))
    last = np.eye(len(names))[:, -1:]
    return T, LinearSystem(
        companion_matrix(polynomial), last, given.C @ T, given.D, names, given.inputs, given.outputs, given.name
    )


def place(given: LinearSystem, poles: Sequence[complex]) -> Array:
    """The gain K for which A - B K has these eigenvalues, and with several inputs is least sensitive.

    Parameters
    ----------
    given
        Whose inputs reach every mode.
    poles
        One for each state, complex ones with their conjugates.

    Returns
    -------
    array of shape (m, n)

    Raises
    ------
    BadInput
        If a mode is out of reach, or the poles are not such.
    """
    wanted = np.asarray(poles, dtype=complex)
    if len(wanted) != len(given.states) or Counter(wanted.tolist()) != Counter(wanted.conj().tolist()):
        raise BadInput(f"poles: give {len(given.states)}, complex ones together with their conjugates")
    _reachable(given)
    from scipy.signal import place_poles

    fitted = scaled(given)
    try:
        found = place_poles(fitted.A, fitted.B, wanted / fitted.rate)
    except ValueError as error:  # a pole that is asked for more often than there are inputs
        raise BadInput(f"poles: {error}") from None
    return fitted.inputs[:, None] * found.gain_matrix / fitted.states


def _reachable(given: LinearSystem) -> None:
    lost = controllability(given).lost
    if lost:
        modes = ", ".join(shown(each.value) for each in lost if each.value.imag >= 0.0)
        raise BadInput(f"{', '.join(given.inputs) or 'no input'} cannot control the mode s = {modes}; add an input")
