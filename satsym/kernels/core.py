"""The Kernels object: a model's description and functions, and the trajectory loops on arrays.

Scalar functions and loops may be compiled with numba, from the code that Python runs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from satsym import activity
from satsym.arrays import Array
from satsym.kernels.contract import BATCH, LOOPS
from satsym.spec import ProblemSpec
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.kernels.functions import Functions
else:
    Functions = object


def compile_functions(functions: Mapping[str, Any], *, cache: bool) -> dict[str, Any]:
    """Return the functions with scalar forms and loops as numba dispatchers, which compile at the first call.

    Parameters
    ----------
    functions
        Functions of one module by name.
    cache
        Whether machine code is kept beside the module's file. numba reads such a cache with pickle, so a
        folder that is not trusted must not offer one.

    Raises
    ------
    BadInput
        If numba is not installed.
    """
    try:
        import numba
    except ImportError:
        raise BadInput(
            "backend 'numba': numba is not installed; install the extra: pip install 'satsym[fast]'"
        ) from None
    result = dict(functions)
    if not functions:
        return result
    activity.tell("compiling; the first time this can take half a minute ...")
    # The copies share fresh globals, in which a function finds the compiled form of another.
    scope = dict(next(iter(functions.values())).__globals__)
    for name, function in functions.items():
        if name.endswith(BATCH):
            continue
        copy = FunctionType(function.__code__, scope, name, function.__defaults__)
        try:
            result[name] = numba.njit(copy, error_model="numpy", cache=cache)
        except RuntimeError:  # nowhere to keep a cache
            result[name] = numba.njit(copy, error_model="numpy")
        scope[name] = result[name]
    return result


Backend = Literal["python", "numba"]
Function = Callable[..., Any]

_ARITHMETIC = (ZeroDivisionError, OverflowError, ValueError, TypeError)
"""Errors that Python floats and ``math`` raise where arrays give inf or nan.

Shapes are checked beforehand. TypeError comes from complex numbers, the results of fractional powers of negative
numbers.
"""


@dataclass(frozen=True, eq=False)
class Kernels(Functions):
    """A model that solvers can call.

    Every generated function is an attribute (``kernels.dynamics(t, x, u, p)``), with the loops ``forward``,
    ``backward`` and ``symplectic`` wrapped for arrays; ``functions`` holds the loops as they were generated.
    """

    spec: ProblemSpec
    """Names, units and kinds of the model."""
    functions: Mapping[str, Function]
    """The generated functions by name."""
    backend: Backend = "python"
    """``"python"`` (floats, without waiting) or ``"numba"`` (each function is compiled at its first call)."""
    origin: tuple[str, Path | None] | None = None
    """Arguments of :func:`satsym.kernels.load`, so that another process can load the kernels again."""
    text: str | None = None
    """Text of a module that is not shipped, from which another process can create the same kernels."""

    def __post_init__(self) -> None:
        # Instance attributes, not __getattr__: solvers call these in inner loops.
        vars(self).update({name: f for name, f in self.functions.items() if name not in LOOPS})

    if not TYPE_CHECKING:  # types come from the contract

        def __getattr__(self, name: str) -> Function:
            raise AttributeError(f"model {self.spec.name} has no function {name}" if "spec" in vars(self) else name)

    def forward(
        self, times: ArrayLike, x0: Sequence[float], u: ArrayLike, u_mid: ArrayLike, p: Sequence[float]
    ) -> tuple[Array, Array, float]:
        """Integrate the states forward with RK4 and the running cost with Simpson's rule.

        Parameters
        ----------
        times
            Nodes, shape (N+1,).
        x0
            State at the first node, n numbers.
        u, u_mid
            Controls at nodes and midpoints, shapes (m, N+1) and (m, N).
        p
            Parameters, in the model's order.

        Returns
        -------
        x, x_mid : arrays of shapes (n, N+1) and (n, N)
            States at nodes and (Hermite) midpoints.
        cost : float
            Integral of the running cost; nan if the trajectory is not finite, 0 for a model without a cost.

        Notes
        -----
        Never raises for a division by zero or an overflow: what lies beyond is nan (or inf).
        """
        nodes, steps = _nodes(times)
        n, m = len(self.spec.states), len(self.spec.controls)
        cost, x, x_mid = self._run(
            "forward",
            [nodes, _numbers(x0, n, "x0"), _table(u, m, steps + 1, "u"), _table(u_mid, m, steps, "u_mid")],
            _numbers(p, len(self.spec.parameters), "p"),
            steps,
        )
        if not np.isfinite(x[:, -1]).all():
            cost = float("nan")
        return x, x_mid, 0.0 if cost is None else cost

    def backward(
        self,
        times: ArrayLike,
        lam_f: Sequence[float],
        x: ArrayLike,
        x_mid: ArrayLike,
        u: ArrayLike,
        u_mid: ArrayLike,
        p: Sequence[float],
    ) -> tuple[Array, Array]:
        """Integrate the costates backward with RK4 along a trajectory.

        Parameters
        ----------
        times, u, u_mid, p
            As in :meth:`forward`.
        lam_f
            Costate at the last node, n numbers.
        x, x_mid
            States, shapes (n, N+1) and (n, N), as :meth:`forward` returns them.

        Returns
        -------
        lam, lam_mid : arrays of shapes (n, N+1) and (n, N)
            Costates at nodes and midpoints; nan (or inf) before the point where they cease to be finite.
        """
        nodes, steps = _nodes(times)
        n, m = len(self.spec.states), len(self.spec.controls)
        _, lam, lam_mid = self._run(
            "backward",
            [
                nodes,
                _numbers(lam_f, n, "lam_f"),
                _table(x, n, steps + 1, "x"),
                _table(x_mid, n, steps, "x_mid"),
                _table(u, m, steps + 1, "u"),
                _table(u_mid, m, steps, "u_mid"),
            ],
            _numbers(p, len(self.spec.parameters), "p"),
            steps,
        )
        return lam, lam_mid

    def symplectic(self, times: ArrayLike, x0: Sequence[float], p: Sequence[float]) -> Array:
        """Integrate the states without control by kicks and drifts: sixth order, symplectic for constant steps.

        Parameters
        ----------
        times
            Nodes, shape (N+1,); they may run backward.
        x0, p
            As in :meth:`forward`.

        Returns
        -------
        array of shape (n, N+1)
            States at nodes; nan (or inf) beyond the point where they cease to be finite.

        Raises
        ------
        BadInput
            If the model has no such loop: ``spec.separable`` says whether.
        """
        self.require_separable()
        nodes, steps = _nodes(times)
        start, numbers = _numbers(x0, len(self.spec.states), "x0"), _numbers(p, len(self.spec.parameters), "p")
        loop, nan = self.functions["symplectic"], float("nan")
        if self.backend == "numba":
            x = np.full((len(start), steps + 1), nan)
            loop(nodes, start, numbers, tuple(x))
            return x
        rows = tuple([nan] * (steps + 1) for _ in start)
        with suppress(*_ARITHMETIC):
            loop(nodes.tolist(), start, numbers, rows)
        return _real(rows)

    def require_separable(self) -> None:
        """Raise BadInput unless the model has a symplectic loop."""
        if not self.spec.separable:
            reason = "its accelerations are not derived from a potential in the coordinates alone; use RK4"
            raise BadInput(f"{self.spec.name}: no symplectic integrator applies to this model: {reason}")

    def in_domain(self, x: ArrayLike) -> bool:
        """Tell whether the states that must be positive are so, at every node of ``x``, shape (n,) or (n, N+1)."""
        rows = np.asarray(x, dtype=float)
        return all(bool((rows[i] > 0.0).all()) for i, state in enumerate(self.spec.states) if state.positive)

    def compiled(self) -> Kernels:
        """Return kernels whose functions are compiled with numba (extra ``fast``) from the same code; they are cached.

        Raises
        ------
        BadInput
            If numba is not installed.
        """
        return self if self.backend == "numba" else self._compiled

    @cached_property
    def _compiled(self) -> Kernels:

        shipped = self.origin is not None and self.origin[1] is None
        return replace(self, functions=compile_functions(self.functions, cache=shipped), backend="numba")

    def _run(self, name: str, given: list[Any], p: tuple[float, ...], steps: int) -> tuple[float | None, Array, Array]:
        """Call a loop on fresh outputs filled with nan; for the Python backend arrays become lists."""
        loop, n, nan = self.functions[name], len(self.spec.states), float("nan")
        if self.backend == "numba":
            given = [tuple(value) if isinstance(value, np.ndarray) and value.ndim == 2 else value for value in given]
            at_nodes, at_midpoints = np.full((n, steps + 1), nan), np.full((n, steps), nan)
            return loop(*given, p, tuple(at_nodes), tuple(at_midpoints)), at_nodes, at_midpoints
        given = [value.tolist() if isinstance(value, np.ndarray) else value for value in given]
        node_lists = tuple([nan] * (steps + 1) for _ in range(n))
        midpoint_lists = tuple([nan] * steps for _ in range(n))
        try:
            result = loop(*given, p, node_lists, midpoint_lists)
        except _ARITHMETIC:
            result = nan
        return nan if isinstance(result, complex) else result, _real(node_lists), _real(midpoint_lists)


def _nodes(times: ArrayLike) -> tuple[Array, int]:
    # A copy, so that read-only times are no second type to compile for.
    nodes = np.array(times, dtype=float)
    if nodes.ndim != 1 or len(nodes) < 1:
        raise ValueError(f"times must be a sequence of nodes, not an array of shape {nodes.shape}")
    return nodes, len(nodes) - 1


def _real(rows: Sequence[list[Any]]) -> Array:
    try:
        return np.array(rows, dtype=float)
    except TypeError:
        return np.array([[float("nan") if isinstance(v, complex) else v for v in row] for row in rows])


def _numbers(values: Sequence[float], count: int, name: str) -> tuple[float, ...]:
    if len(values) != count:
        raise ValueError(f"{name} must hold {count} numbers, not {len(values)}")
    return tuple(map(float, values))


def _table(values: ArrayLike, rows: int, columns: int, name: str) -> Array:
    table = np.array(values, dtype=float, order="C")
    if table.shape != (rows, columns):
        raise ValueError(f"{name} must have shape {(rows, columns)}, not {table.shape}")
    return table
