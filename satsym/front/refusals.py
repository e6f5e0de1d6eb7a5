"""Bad input in Python: the line that says what is wrong below the caller's own, without what lies between."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from satsym.status import BadInput

Given = ParamSpec("Given")
Answer = TypeVar("Answer")


def in_one_line(function: Callable[Given, Answer]) -> Callable[Given, Answer]:
    """The function, whose refusals have a traceback that ends at it; SATSYM_DEBUG=1 in the environment keeps all."""

    @wraps(function)
    def asked(*args: Given.args, **options: Given.kwargs) -> Answer:
        try:
            return function(*args, **options)
        except BadInput as error:
            if os.environ.get("SATSYM_DEBUG"):
                raise
            raise error.with_traceback(None) from None

    return asked
