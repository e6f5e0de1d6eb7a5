"""One instance solved again and again: what does not change is kept, and the last answer is where to begin."""

from __future__ import annotations

from satsym.solvers.repeated.repeated import Answer, Repeated

__all__ = ["Answer", "Repeated"]
