"""Quantities over time that can be evaluated at any time, and behave as arrays of their values at the nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.arrays import Array
from satsym.front.tables import name_of
from satsym.status import BadInput
from satsym.wording import shown, suggestion

ROUNDING = 1e-12
"""Fraction of the duration by which a time may lie outside the trajectory and still be moved to its end."""


class Curve(np.lib.mixins.NDArrayOperatorsMixin):
    """One quantity, or several, over time.

    ``x(t)`` is the value at a time, or at an array of times; ``x[0, -1]`` and ``numpy.asarray(x)`` are values at the
    nodes; ``x["r"]`` is the component with that name, again as a curve. Arithmetic gives plain arrays.

    Parameters
    ----------
    what
        Name of the curve in messages.
    times
        The nodes, shape (N+1,).
    values
        Values at the nodes, shape (N+1,) or (k, N+1).
    names
        Names of the components, if there are several.
    between
        Function of times, shape (M,), that returns values of shape (M,) or (k, M).
    absent
        The reason why there are no values, if there are none.
    """

    def __init__(
        self,
        what: str,
        times: Array,
        values: Array,
        names: Sequence[str],
        between: Callable[[Array], Array],
        absent: str = "",
    ) -> None:
        self._what, self._times, self._values, self._absent = what, times, values, absent
        self.names, self._between = tuple(names), between

    def __call__(self, t: ArrayLike) -> Any:
        """Return the values at a time, or at an array of times of any shape.

        Returns
        -------
        float or array
            Values in the shape of `t`; for several components an array of shape (k, ...).

        Raises
        ------
        BadInput
            If there is no trajectory, or a time lies outside the trajectory.
        """
        if self._absent:
            raise BadInput(f"{self._what}: {self._absent}")
        try:
            asked = np.asarray(t, dtype=float)
        except (TypeError, ValueError):
            raise BadInput(f"{self._what}: {shown(t)} is not a time; give a number, or an array of numbers") from None
        begin, end = float(self._times[0]), float(self._times[-1])
        room = ROUNDING * (end - begin)
        outside = asked[~((asked >= begin - room) & (asked <= end + room))]
        if outside.size:
            raise BadInput(
                f"{self._what}: the time {float(outside[0]):.10g} does not lie between {begin:.10g} and {end:.10g}"
            )
        found = self._between(np.clip(asked.ravel(), begin, end))
        shaped = found.reshape((*found.shape[:-1], *asked.shape))
        return float(shaped) if shaped.ndim == 0 else shaped

    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            if not isinstance(getattr(key, "name", None), str):
                return self._values[key]
            key = name_of(key)
        if key not in self.names:
            raise BadInput(f"{self._what}: has no {shown(key)}; {suggestion(key, self.names)}")
        place = self.names.index(key)
        what, values = f'{self._what}["{key}"]', self._values[place]
        return Curve(what, self._times, values, (), lambda t: self._between(t)[place], self._absent)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self._values, dtype=dtype) if copy or dtype else self._values

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        plain = [np.asarray(one) if isinstance(one, Curve) else one for one in inputs]
        return getattr(ufunc, method)(*plain, **options)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._values, name)

    def __len__(self) -> int:
        return len(self._values)

    def __iter__(self) -> Iterator[Any]:
        return iter(self._values)

    def __repr__(self) -> str:
        of = f" of {', '.join(self.names)}" if self.names else ""
        return f"{self._what}{of}: a function of time, and an array of shape {self._values.shape}"
