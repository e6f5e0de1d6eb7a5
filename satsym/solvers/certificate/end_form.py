"""Contribution of the end to the second variation: a quadratic form in final state and time, and linear constraints.

The end adds a form in the total variations dx and dt of the final state and time to the second variation; linearised
constraints relate these variations (Bryson and Ho, Applied Optimal Control, 6.3 and 6.6). Both are derivatives of the
boundary residual, with the costates varied along their own motion. The residual contains the multipliers of terminal
constraints, and thus their curvature.
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
    """Quadratic form and linear constraints in the variations (delta x at the nominal final time, delta t_f)."""

    form: Array
    """Matrix of the form, shape (n + e, n + e), symmetric; e is 1 if the final time is free, else 0."""
    ties: Array
    """Rows of the linear constraints, shape (c, n + e), scaled to about 1: first fixed states, then terminal
    constraints."""
    sizes: Array
    """Magnitudes by which the rows of the constraints were divided, shape (c,)."""


def final_values(solution: Solution) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Return final time, states and costates in the form that kernels take."""
    return float(solution.times[-1]), tuple(solution.x[:, -1].tolist()), tuple(solution.lam[:, -1].tolist())


def fixed_states(instance: Instance) -> NDArray[np.bool_]:
    """Return which final states are given or prescribed by the reference, shape (n,)."""
    return np.asarray(np.array(final_argument(instance)).reshape(3, -1)[:2].any(axis=0))


def multipliers(
    instance: Instance, tf: float, x: tuple[float, ...], lam: tuple[float, ...]
) -> tuple[tuple[float, ...], Array]:
    """Return the least-squares multipliers of the terminal constraints, and the boundary residual with them."""
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
    """Return the final time, the Jacobian of the boundary residual, and the canonical rates at the final time.

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
    """Return the quadratic form and the constraints at the end of a solution.

    Parameters
    ----------
    solution
        Solution whose final values are used.
    scale
        Units of states and costates, shape (2n,); the product of the units of each state and its costate is the same.
        The unit of a variation of the final time is the duration, the unit of the form is that product.
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
