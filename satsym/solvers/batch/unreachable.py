"""Linear motions that cannot reach their final states within the bounds on controls, as shown by separating planes.

The search for a plane takes long, but to test on which side of a known plane another final state lies does not. Motions
for which no plane is found are left open.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solvers.batch.many import Many
from satsym.solvers.switching.linear.by_reach import separated_by, separating


def unreachable(many: Many, instances: Sequence[Instance], which: NDArray[np.intp]) -> dict[int, str]:
    """Return the reasons why motions have no solution, by index, as far as this is shown.

    Parameters
    ----------
    many, instances
        Linear motions of one system with given final states and times.
    which
        Indices of the motions to be examined; planes are searched in this order.
    """
    found: dict[int, str] = {}
    left = which
    while len(left):
        plane = separating(instances[left[0]])
        if plane is None:
            left = left[1:]
            continue
        wanted = plane.costate[:, None] * many.end[:, left]
        beyond = plane.beyond(many.initial[:, left], wanted, many.lower[:, left], many.upper[:, left])
        for k in left[beyond].tolist():
            one = instances[k]
            assert one.tf is not None
            found[k] = (
                f"no control within its bounds reaches the given final state in {one.tf - one.t0:.10g}: "
                f"{separated_by(one, plane.costate)}"
            )
        beyond[0] = True
        left = left[~beyond]
    return found
