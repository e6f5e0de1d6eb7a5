"""What the second variation owes to the end: a quadratic form in the end and the final time, and what ties these.

To the second variation along the way, the end adds a form in the total variations dx and dt of the final state and
time; constraints there, linearised, tie them (Bryson and Ho, Applied Optimal Control, 6.3 and 6.6). Both are the
derivatives of the boundary residual, the costates taken along their own motion; multipliers of terminal constraints
are in it, and with them the curvature of these.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.collocation.scaling import final_argument


@dataclass(frozen=True, eq=False)
class EndForm:
    """The form and the ties in the variations (delta x, delta t_f), the former at the final time as it was."""

    form: Array
    """Shape (n + e, n + e), symmetric; e is 1 where the final time is free, else 0."""
    ties: Array
    """Rows that vanish, shape (c, n + e), each of about unit size: of fixed states, then of terminal constraints."""
    sizes: Array
    """What these were divided by, shape (c,)."""


def final_values(solution: Solution) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Final time, states and costates, as kernels take them."""
    return float(solution.times[-1]), tuple(solution.x[:, -1].tolist()), tuple(solution.lam[:, -1].tolist())


def fixed_states(instance: Instance) -> NDArray[np.bool_]:
    """Which states have their end given or on the reference, shape (n,)."""
    return np.asarray(np.array(final_argument(instance)).reshape(3, -1)[:2].any(axis=0))


def multipliers(
    instance: Instance, tf: float, x: tuple[float, ...], lam: tuple[float, ...]
) -> tuple[tuple[float, ...], Array]:
    """Multipliers of the terminal constraints that fit best, and the boundary residual with these."""
    count, final = len(instance.model.spec.multipliers), final_argument(instance)

    def at(nu: tuple[float, ...]) -> Array:
        return np.array(
            instance.model.boundary(tf, x, lam, nu, instance.parameters, instance.control_set.arguments, final)
        )

    residual = at((0.0,) * count)
    if not count:
        return (), residual
    # The residual is affine in the multipliers. A final time that is given has no condition to be met.
    slopes = np.stack([at(tuple(unit)) - residual for unit in np.eye(count)], axis=1)
    rows = slice(None, None if instance.tf is None else -1)
    nu = np.linalg.lstsq(slopes[rows], -residual[rows], rcond=None)[0]
    return tuple(nu.tolist()), residual + slopes @ nu


def boundary_slopes(solution: Solution) -> tuple[float, Array, Array]:
    """The final time, how the boundary residuals change at the end, and the canonical rates there.

    Returns
    -------
    Final time; derivatives by states, costates, multipliers and final time, shape (n+q+1, 2n+q+1); rates (2n,).
    """
    instance = solution.instance
    tf, x, lam = final_values(solution)
    arguments = instance.parameters, instance.control_set.arguments
    nu, _ = multipliers(instance, tf, x, lam)
    table = instance.model.boundary_jacobian(tf, x, lam, nu, *arguments, final_argument(instance))
    slopes = np.array(table).reshape(len(x) + len(nu) + 1, -1)
    return tf, slopes, np.array(instance.model.canonical(tf, x, lam, *arguments))


def end_form(solution: Solution, scale: Array) -> EndForm:
    """The form at the end of a solution.

    Parameters
    ----------
    solution
        Whose.
    scale
        Units of states and costates, shape (2n,), whose products are all the same; a variation of the final time has
        the duration as its unit, the form the product of the units of a state and its costate.
    """
    instance, n = solution.instance, len(solution.x)
    tf, slopes, rates = boundary_slopes(solution)
    free_time, fixed = instance.tf is None, fixed_states(instance)
    # By dx, then by the final time with the costates along their own motion.
    by_end = np.column_stack([slopes[:, :n], slopes[:, n : 2 * n] @ rates[n:] + slopes[:, -1]])
    # Rows of free states read lambda - S_x - nu' psi_x: what multiplies dx, with the sign changed.
    form = np.zeros((n + 1, n + 1))
    form[:n][~fixed] = -by_end[:n][~fixed]
    form[n] = by_end[-1]
    ties = np.concatenate([by_end[:n][fixed], by_end[n:-1]])
    lasting = tf - float(solution.times[0])
    total = np.zeros((n + 1, n + free_time))  # (dx, dt) by (delta x, dt)
    total[:n, :n] = np.diag(scale[:n])
    if free_time:
        total[:, n] = lasting * np.append(rates[:n], 1.0)
    reduced, tied = total.T @ form @ total / (scale[0] * scale[n]), ties @ total
    sizes = np.maximum(np.abs(tied).max(axis=1, initial=0.0), 1e-300)
    return EndForm((reduced + reduced.T) / 2.0, tied / sizes[:, None], sizes)
