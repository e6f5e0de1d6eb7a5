"""How many examples Hypothesis tries: all that a test asks for, or a sample of them."""

from __future__ import annotations

from typing import Any

from hypothesis import settings

WHOLE = "whole"
"""The profile of runs that try all."""

SHARE = 3


def examples(count: int, **more: Any) -> settings:
    """So many in a whole run, a third of them in others."""
    return settings(max_examples=count if settings.get_current_profile_name() == WHOLE else count // SHARE, **more)
