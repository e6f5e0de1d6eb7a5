"""Which linear motions no control within its bounds brings to their ends: planes found for some show it of others.

To look for such a plane takes long, to see on which side of one an end lies does not. What none shows is left open.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solvers.batch.many import Many
from satsym.solvers.switching.linear.by_reach import separated_by, separating


def unreachable(many: Many, instances: Sequence[Instance], which: NDArray[np.intp]) -> dict[int, str]:
    """Why there is no answer, of those of which it is known.

    Parameters
    ----------
    many, instances
        Linear motions of one system with given ends and times.
    which
        That are asked for; in their order planes are looked for.
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
