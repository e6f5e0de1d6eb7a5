"""All that can be said of the orbit an instance starts on, by numbers."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.analysis.orbits.elements import Elements, elements
from satsym.analysis.orbits.floquet import Floquet, floquet
from satsym.analysis.orbits.point import Point, at_start
from satsym.instance import Instance
from satsym.status import BadInput


@dataclass(frozen=True, eq=False)
class Survey:
    """The orbit of an instance of a Keplerian model: its elements, the Jacobian at its start, one revolution."""

    case: Instance
    elements: Elements
    point: Point
    floquet: Floquet


def survey(case: Instance) -> Survey:
    """Analyse the uncontrolled motion from the initial state.

    Parameters
    ----------
    case
        An instance of a model whose specification says ``keplerian``.

    Raises
    ------
    BadInput
        If the initial position is the centre, or numbers are beyond the range of floats.
    """
    try:
        state = case.model.inertial_state(case.t0, case.initial, case.parameters)
        found = elements(state[:3], state[3:6], state[6])
    except ArithmeticError:
        raise BadInput(f"{case.called}: [initial]: beyond the range of floats; check the units") from None
    except BadInput as error:
        raise BadInput(f"{case.called}: [initial]: {error}") from None
    return Survey(case, found, at_start(case, found), floquet(found))
