"""What sympy finds about a linear model with letters for its parameters, and why it may find nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.analysis.linear.equilibrium import jacobians
from satsym.spec import MOST_LETTERS

if TYPE_CHECKING:
    from satsym.analysis.linear.equilibrium import Linearisation
    from satsym.arrays import Array
    from satsym.symbolic import Derivation

BY_DERIVATION = "the symbolic analysis needs the derivation of the model, which is not available"


def exact(about: Linearisation, derivation: Derivation | None = None) -> tuple[dict[str, Any] | None, str]:
    """What sympy finds about a linear model, as ``satsym analyse --json`` prints it.

    Parameters
    ----------
    derivation
        Of the model; by default that of a shipped one.

    Returns
    -------
    object : dict or None
        ``None`` for a model that is not linear with constant coefficients, and where `omitted` says why.
    omitted : str
        Why a linear model has none, in a sentence without its full stop; else empty.
    """
    model = about.model
    if omitted := omitted_because(about, derivation is not None):
        return None, omitted
    if not model.spec.linear:
        return None, ""
    from satsym.status import BadInput
    from satsym.symbolic import DerivationError
    from satsym.symbolic.analysis import NotExact, analyse, exact_object
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup import library

    try:
        return exact_object(analyse(system_of(derivation or library.derivation(model.spec.name)))), ""
    except (BadInput, DerivationError, NotExact) as error:
        return None, f"there is no exact analysis in letters: {' '.join(str(error).split())}"


def omitted_because(about: Linearisation, derived: bool = False) -> str:
    """Why a linear model has no exact analysis, as far as can be said without its derivation; else empty."""
    model = about.model
    if not model.spec.linear or not about.constant:
        return ""
    if not derived and (model.origin is None or model.origin[1] is not None):
        return BY_DERIVATION
    letters, states = _letters(about), len(model.spec.states)
    if letters * states <= MOST_LETTERS:
        return ""
    return (
        f"the symbolic analysis is omitted: with {states} states and {letters} parameters its polynomials would "
        "fill pages"
    )


def _letters(about: Linearisation) -> int:
    """On how many parameters the matrix A depends: those that change it, all of them having generic values."""
    given = np.array(about.parameters)
    generic = np.where(given == 0.0, 0.01, given) * np.random.default_rng(0).uniform(1.0, 1.01, len(given))

    def matrix(p: Array) -> Array:
        return jacobians(about.model, tuple(p.tolist()), about.t0, about.point)[0]

    before = matrix(generic)
    others = (generic * np.where(np.arange(len(given)) == k, 1.01, 1.0) for k in range(len(given)))
    return sum(not np.array_equal(matrix(p), before) for p in others)
