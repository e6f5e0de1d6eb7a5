"""What the functions of constraints along the way must have to do with each other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from satsym.arrays import Array
from satsym.kernels.evaluation import FAINT, Evaluation, size
from satsym.kernels.relations import Relation, along, derivative


def of_path_constraints(of: Evaluation) -> Iterator[Relation]:
    """Gradients and rates are derivatives; what vanishes on the boundary stays there with the multiplier."""
    orders = np.array([one.order for one in of.kernels.spec.path_constraints])
    second = orders > 1
    yield from derivative(of, "path_gradient", "path_constraints", ("x",))
    rates, law = of("path_rates"), of("control_law")
    first, terms = along(of, "path_constraints", of("dynamics"))
    yield Relation("path_rates", "first rates of the constraints", rates[:, 0], first, terms)
    faster, terms = along(of, "path_rates", of("dynamics"))
    wanted = np.where(second[:, None], faster[:, 0], 0.0)
    yield Relation("path_rates", "second rates of the constraints", rates[:, 1], wanted, terms[:, 0])
    vanishing, last = of("path_vanishing"), of("path_rates", u=law)
    wanted = np.where(second[:, None], last[:, 1], last[:, 0])
    yield Relation("path_vanishing", "the last rate under the law", vanishing[:, 0], wanted, FAINT * size(last).max())
    for k, order in enumerate(orders):
        found, terms = _rates_on_boundary(of, k)
        if order > 1:
            yield Relation("path_vanishing", "and its rate", vanishing[k, 1], found[k, 0], terms[k, 0])
        zero = found[k, order - 1]
        yield Relation("path_multiplier", "keeps to the boundary", zero, np.zeros_like(zero), terms[k, order - 1])
        kept = of("path_rates", u=of("boundary_control")[k])[k, order - 1]
        sizes = np.abs(of.slope("path_rates", "u") * of("boundary_control")[k]).sum(axis=-2)[k, order - 1]
        yield Relation("boundary_control", "keeps the last rate zero", kept, np.zeros_like(kept), sizes)


def _rates_on_boundary(of: Evaluation, which: int) -> tuple[Array, Array]:
    """Rates of what vanishes along the extremal on the boundary of one constraint, and sizes of their terms."""
    law = of("control_law")
    eta, push = of("path_multiplier")[which], of("path_gradient")[which]
    forced = of("costate_rate", u=law) - eta * push
    by_state, terms = along(of, "path_vanishing", of("dynamics", u=law))
    parts = of.slope("path_vanishing", "lam") * forced
    return by_state + parts.sum(axis=-2), terms + np.abs(parts).sum(axis=-2)
