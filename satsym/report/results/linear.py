"""The objects that ``satsym analyse --json`` and ``satsym lqr --json`` print, exact ones included."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.analysis.linear.equilibrium import jacobians
from satsym.report.results.certificate import plain
from satsym.spec import MOST_LETTERS

if TYPE_CHECKING:
    from satsym.analysis.linear.equilibrium import Linearisation
    from satsym.analysis.linear.modes import Mode
    from satsym.analysis.linear.ranks import Reach
    from satsym.analysis.linear.routh import Routh
    from satsym.analysis.linear.spectrum import Eigenvalue
    from satsym.analysis.regulator.feedback import Design
    from satsym.analysis.subject import Analysis
    from satsym.arrays import Array
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.symbolic import Derivation
    from satsym.symbolic.equilibria.attitude import Continuum
    from satsym.symbolic.equilibria.momenta import Attitudes, Change


ANALYSIS = (
    *("equilibrium", "A", "B", "C", "eigenvalues", "modes", "jordan_blocks", "characteristic_polynomial", "routh"),
    *("stability", "controllability", "observability", "exact", "exact_omitted"),
)
"""Keys of an analysis, all of which are ``None`` if there is no point of linearisation."""


def analysis_object(found: Analysis | None, exact: Mapping[str, Any] | None, omitted: str = "") -> dict[str, Any]:
    """Return the object of ``satsym analyse --json``; :mod:`satsym.report.results.orbit` adds the part on orbits.

    Parameters
    ----------
    found
        ``None`` for a motion that is near no reference and no equilibrium.
    exact
        The same by exact reckoning, as strings; ``None`` where there is none.
    omitted
        Why there is none, of a linear model.
    """
    if found is None:
        return dict.fromkeys(ANALYSIS)
    system, about = found.about.system, found.about
    blocks = [(each.value, size) for each in found.eigenvalues for size in each.blocks]
    return plain(
        {
            "equilibrium": dict(zip(system.states, about.point.tolist(), strict=True)),
            "A": system.A,
            "B": system.B,
            "C": system.C,
            "eigenvalues": [eigenvalue_object(each) for each in found.eigenvalues],
            "modes": [mode_object(each) for each in found.modes],
            "jordan_blocks": [{"eigenvalue": complex(value), "size": size} for value, size in blocks],
            "characteristic_polynomial": found.polynomial,
            "routh": routh_object(found.routh),
            "stability": {"verdict": found.stability.verdict, "reason": found.stability.reason},
            "controllability": _reach(found.controllability, "by_input"),
            "observability": _reach(found.observability, "by_output"),
            "exact": exact,
            "exact_omitted": omitted or None,
        }
    )


def regulator_object(design: Design) -> dict[str, Any]:
    """Return the object of ``satsym lqr --json``; ``cost_from_initial`` is ``None`` for a model alone."""
    found, deviation = design.regulator, design.deviation
    return plain(
        {
            "inputs": found.system.inputs,
            "K": found.K,
            "P": found.P,
            "riccati_residual": found.residual,
            "riccati_error": found.error,
            "closed_loop_eigenvalues": [complex(value) for value in found.eigenvalues],
            "characteristic_polynomial": found.polynomial,
            "routh": routh_object(found.routh),
            "cost_from_initial": None if deviation is None else found.cost(deviation),
        }
    )


def routh_object(found: Routh) -> dict[str, Any]:
    """Return the object of a Routh array."""
    return {"column": found.column, "sign_changes": found.sign_changes, "special_case": found.special_case}


def eigenvalue_object(found: Eigenvalue) -> dict[str, Any]:
    """Return the object of an eigenvalue with its multiplicities."""
    return {"value": complex(found.value), "algebraic": found.algebraic, "geometric": found.geometric}


def mode_object(found: Mode) -> dict[str, Any]:
    """Return the object of a mode: its eigenvalue (with its conjugate), its name, and the part of each state.

    Times are in the unit of time of the model, the natural frequency in radians by that unit.
    """
    return {
        "eigenvalue": complex(found.eigenvalue.value),
        "name": found.name or None,
        "natural_frequency": found.frequency,
        "damping_ratio": found.damping_ratio,
        "period": found.period,
        "time_constant": found.time_constant,
        "participation": dict(found.participation),
    }


def _reach(found: Reach | None, key: str) -> dict[str, Any] | None:
    if found is None:
        return None
    return {"rank": found.rank, key: {name: each.rank for name, each in found.alone.items()}}


BY_DERIVATION = "the symbolic analysis needs the derivation of the model, which is not available"


def exact(about: Linearisation, derivation: Derivation | None = None) -> tuple[dict[str, Any] | None, str]:
    """Return the exact results on a linear model as ``satsym analyse --json`` prints them.

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
        return None, f"there is no symbolic analysis: {' '.join(str(error).split())}"


def omitted_because(about: Linearisation, derived: bool = False) -> str:
    """Explain why a linear model has no exact analysis, as far as is clear without its derivation; else empty."""
    model = about.model
    if not model.spec.linear or not about.constant:
        return ""
    if not derived and (model.origin is None or model.origin[1] is not None):
        return BY_DERIVATION
    letters, states = _letters(about), len(model.spec.states)
    if letters * states <= MOST_LETTERS:
        return ""
    return (
        f"the symbolic analysis is omitted: with {states} states and {letters} parameters, the polynomials "
        "would fill pages"
    )


def _letters(about: Linearisation) -> int:
    """Return the number of parameters on which the matrix A depends at generic values."""
    given = np.array(about.parameters)
    generic = np.where(given == 0.0, 0.01, given) * np.random.default_rng(0).uniform(1.0, 1.01, len(given))

    def matrix(p: Array) -> Array:
        return jacobians(about.model, tuple(p.tolist()), about.t0, about.point)[0]

    before = matrix(generic)
    others = (generic * np.where(np.arange(len(given)) == k, 1.01, 1.0) for k in range(len(given)))
    return sum(not np.array_equal(matrix(p), before) for p in others)


def attitudes(given: Instance | Kernels, derivation: Derivation | None = None) -> Attitudes | None:
    """Find the equilibria of an attitude in orbit; ``None`` for another model, or without its derivation."""
    from satsym.kernels import Kernels

    model = given if isinstance(given, Kernels) else given.model
    shipped = model.origin is not None and model.origin[1] is None
    if not model.spec.equilibria or not (shipped or derivation):
        return None
    from satsym.symbolic.equilibria.momenta import survey
    from satsym.symbolic.lookup import library

    values = [v.default for v in model.spec.parameters] if isinstance(given, Kernels) else given.parameters
    numbers = {name: float(v) for name, v in zip(model.spec.parameter_names, values, strict=True) if v is not None}
    return survey(derivation or library.derivation(model.spec.name), numbers)


def attitudes_object(found: Attitudes) -> dict[str, Any]:
    """Return the object under the key ``equilibria`` of ``satsym analyse --json``."""
    whole, over = found.continuum, found.followed
    circles = None if whole is None or whole.circles is None else len(whole.circles)
    changes = [] if over is None else over.changes
    followed = None if over is None else {"parameter": found.parameter, "changes": [_change(c) for c in changes]}
    if followed is not None and over is not None:
        followed |= {"from": over.values[0], "to": over.values[-1]}
    said: dict[str, Any] = plain(
        {
            "count": found.count,
            "complex": found.complex,
            "continuum": whole and {"dimension": whole.dimension, "axis": axis(whole), "circles": circles},
            "attitudes": [
                {"cosines": each.cosines, "kind": each.kind, "eigenvalues": [complex(v) for v in each.eigenvalues]}
                for each in found.equilibria
            ],
            "followed": followed,
        }
    )
    return said


def axis(found: Continuum) -> str | None:
    """Return the name of the body's axis about which a turn changes nothing."""
    return None if found.axis is None else "xyz"[found.axis]


def _change(found: Change) -> dict[str, Any]:
    kinds = [{kind.value: count for kind, count in each.items()} for each in found.kinds]
    return {"below": found.below, "above": found.above, "counts": found.counts, "kinds": kinds}
