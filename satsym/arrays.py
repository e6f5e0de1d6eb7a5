"""The type of arrays of numbers: their shapes stand in docstrings, their last axis counts times or instances."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
