"""The exact side of an analysis, where a model's derivation can be found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from satsym.kernels import Kernels
    from satsym.symbolic import Derivation


def exact(model: Kernels, derivation: Derivation | None = None) -> dict[str, Any] | None:
    """What sympy finds about a linear model, as ``satsym analyse --json`` prints it.

    Parameters
    ----------
    derivation
        Of the model; by default that of a shipped one.

    Returns
    -------
    dict or None
        ``None`` for a model whose derivation is not at hand, because it was loaded by path, that is not linear with
        constant coefficients, or whose entries are beyond exact linear algebra.
    """
    shipped = model.origin is not None and model.origin[1] is None
    if not model.spec.linear or not (shipped or derivation):
        return None
    from satsym.status import BadInput
    from satsym.symbolic import DerivationError
    from satsym.symbolic.analysis import NotExact, analyse
    from satsym.symbolic.analysis.listing import exact_object
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup import library

    try:
        return exact_object(analyse(system_of(derivation or library.derivation(model.spec.name))))
    except (BadInput, DerivationError, NotExact):
        return None
