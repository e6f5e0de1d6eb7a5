"""The exact side of an analysis, where a model's derivation can be found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from satsym.kernels import Kernels


def exact(model: Kernels) -> dict[str, Any] | None:
    """What sympy finds about a shipped linear model, as ``satsym analyse --json`` prints it.

    Returns
    -------
    dict or None
        ``None`` for a model that was loaded by path, that is not linear with constant coefficients, or whose entries
        are beyond exact linear algebra.
    """
    if model.origin is None or model.origin[1] is not None or not model.spec.linear:
        return None
    from satsym.status import BadInput
    from satsym.symbolic import DerivationError
    from satsym.symbolic.analysis import NotExact, analyse
    from satsym.symbolic.analysis.listing import exact_object
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup.library import derivation

    try:
        return exact_object(analyse(system_of(derivation(model.spec.name))))
    except (BadInput, DerivationError, NotExact):
        return None
