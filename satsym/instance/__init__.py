"""Instances: the numbers of one case of a model, read from TOML and checked.

:func:`load` returns an :class:`Instance` in the model's units, or raises :class:`~satsym.status.BadInput` with one line
that names the file, the key, the fault and what to write. Instances are data: nothing in them is ever evaluated.
"""

from __future__ import annotations

from satsym.instance.files import shipped, titles
from satsym.instance.loading import Written, load, read
from satsym.instance.schema import SolverOptions
from satsym.instance.types import Guess, Instance, LqrOptions

__all__ = ["Guess", "Instance", "LqrOptions", "SolverOptions", "Written", "load", "read", "shipped", "titles"]
