"""Kernels: the functions of a generated module, loaded, checked and, where that is worthwhile, compiled.

All numeric code uses a model through :class:`Kernels` only: plain functions and two array wrappers for the trajectory
loops, never sympy.
"""

from __future__ import annotations

from satsym.kernels.core import Kernels
from satsym.kernels.loading import from_text, load, shipped

__all__ = ["Kernels", "from_text", "load", "shipped"]
