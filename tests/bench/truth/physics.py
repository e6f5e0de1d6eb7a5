"""The models once more, written by hand for the independent side: nothing here comes from satsym.

Every function takes the module of elementary functions it is to use (``math`` or ``casadi``) as its first argument.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Vector = Sequence[Any]


def _nothing(*_: Any) -> tuple[Any, ...]:
    return ()


def _zero(*_: Any) -> float:
    return 0.0


@dataclass(frozen=True)
class Physics:
    """A model and its cost.

    Attributes
    ----------
    states, controls
        Names.
    parameters
        Names with defaults.
    rate, running
        f(m, t, x, u, p) and L(m, t, x, u, p).
    terminal, ends, reference
        S(m, t, x, p); psi(m, t, x, p), which vanishes; and c(m, t, p).
    kept
        g(m, t, x, p), none of which may be positive along the way.
    """

    states: tuple[str, ...]
    controls: tuple[str, ...]
    rate: Callable[..., Vector]
    running: Callable[..., Any]
    parameters: Mapping[str, float]
    terminal: Callable[..., Any] = _zero
    ends: Callable[..., Vector] = _nothing
    reference: Callable[..., Vector] = _nothing
    kept: Callable[..., Vector] = _nothing

    def given(self, parameters: Mapping[str, float]) -> tuple[float, ...]:
        """All parameters in order."""
        return tuple(float(parameters.get(name, default)) for name, default in self.parameters.items())

    def matrices(self, p: Vector) -> tuple[np.ndarray, np.ndarray]:
        """A and B of a linear model."""
        import math

        n, m = len(self.states), len(self.controls)
        columns = [self.rate(math, 0.0, row[:n], row[n:], p) for row in np.eye(n + m).tolist()]
        both = np.array(columns, dtype=float).T
        return both[:, :n], both[:, n:]


POLAR = dict.fromkeys(("sigma", "omega", "c1", "c2"), 1.0) | dict.fromkeys(("k1", "k2", "k3", "k4", "c0"), 0.0)


def _polar(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    r, v, _, w = x[0], x[1], x[2], x[3]
    mu = p[0] ** 3 * p[1] ** 2
    return v, r * w * w - mu / (r * r) + u[0], w, (u[1] - 2.0 * v * w) / r


def _polar_effort(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    return p[8] + (p[2] * u[0] * u[0] + p[3] * u[1] * u[1]) / 2.0


def _polar_miss(m: Any, t: Any, x: Vector, p: Vector) -> Any:
    sigma, omega, k1, k2, k3, k4 = p[0], p[1], p[4], p[5], p[6], p[7]
    off = (k1 * (x[0] - sigma) ** 2, k2 * x[1] ** 2, k3 * (x[2] - omega * t) ** 2, k4 * (x[3] - omega) ** 2)
    return sum(off) / 2.0


def _polar_ball_effort(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    return p[2] * (u[0] * u[0] + u[1] * u[1]) / 2.0


def _circle(m: Any, t: Any, p: Vector) -> Vector:
    return p[0], 0.0, p[1] * t, p[1]


def _kepler(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    k = len(u) if isinstance(u, list | tuple | np.ndarray) else u.shape[0]
    places, rates = [x[i] for i in range(k)], [x[k + i] for i in range(k)]
    cube = m.sqrt(sum(q * q for q in places)) ** 3
    return (*rates, *(u[i] - p[0] * places[i] / cube for i in range(k)))


def _square(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    k = len(u) if isinstance(u, list | tuple | np.ndarray) else u.shape[0]
    return sum(u[i] * u[i] for i in range(k)) / 2.0


def _hill(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    return (u[0] ** 2 + u[1] ** 2) / 2.0 + p[0] * m.exp(-(x[0] ** 2 + x[1] ** 2) / (2.0 * p[1] ** 2))


def _rendezvous(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    w = p[0]
    return x[1], 3.0 * w * w * x[0] + 2.0 * w * x[3] + u[0], x[3], u[1] - 2.0 * w * x[1]


def _one(*_: Any) -> float:
    return 1.0


def _magnitude(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    return (p[0] if len(p) else 0.0) + abs(u[0])


def _plain_magnitude(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Any:
    return abs(u[0])


def _line(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    return x[1], u[0]


def _chain(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    return x[1], x[2], u[0]


def _spring(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    return x[1], u[0] - p[0] ** 2 * x[0]


def _chosen(m: Any, t: Any, x: Vector, u: Vector, p: Vector) -> Vector:
    return u[0], u[1]


def _weighed(m: Any, t: Any, x: Vector, p: Vector) -> Any:
    return (p[0] * x[0] ** 2 + p[1] * x[1] ** 2) / 2.0


_ORBIT = ("r", "r_dot", "theta", "theta_dot")
_TWO, _XY, _SPACE = ("u1", "u2"), ("x", "y"), ("x", "y", "z")
_X = ("x1", "x2", "x3")
_BUMP = {"height": 1.0, "width": 0.3}

MODELS: dict[str, Physics] = {
    "polar_orbit": Physics(_ORBIT, _TWO, _polar, _polar_effort, POLAR, _polar_miss, reference=_circle),
    "polar_orbit_timed": Physics(_ORBIT, _TWO, _polar, _polar_effort, POLAR, _polar_miss, reference=_circle),
    "polar_orbit_ball": Physics(_ORBIT, _TWO, _polar, _polar_ball_effort, POLAR, _polar_miss, reference=_circle),
    "return_above": Physics(
        _ORBIT,
        _TWO,
        _polar,
        lambda m, t, x, u, p: (p[2] * u[0] * u[0] + p[3] * u[1] * u[1]) / 2.0,
        dict.fromkeys(("sigma", "omega", "c1", "c2"), 1.0) | {"r_min": 0.0},
        reference=_circle,
        kept=lambda m, t, x, p: (p[4] - x[0],),
    ),
    "kept_line": Physics(
        ("q", "q_dot"),
        _TWO[:1],
        _line,
        _square,
        {"ceiling": 0.0, "floor": 0.0, "fastest": 0.0},
        kept=lambda m, t, x, p: (x[0] - p[0], p[1] - x[0], x[1] - p[2]),
    ),
    "transfer_plane": Physics((*_XY, "v_x", "v_y"), ("a_x", "a_y"), _kepler, _square, {"mu": 1.0}),
    "transfer_space": Physics((*_SPACE, "v_x", "v_y", "v_z"), ("a_x", "a_y", "a_z"), _kepler, _square, {"mu": 1.0}),
    "bump_steered": Physics(_XY, _TWO, _chosen, _hill, _BUMP),
    "bump_pushed": Physics((*_XY, "v_x", "v_y"), _TWO, lambda m, t, x, u, p: (x[2], x[3], u[0], u[1]), _hill, _BUMP),
    "double_integrator_time": Physics(("q", "q_dot"), _TWO[:1], _line, _one, {}),
    "double_integrator_energy": Physics(("q", "q_dot"), _TWO[:1], _line, _square, {}),
    "double_integrator_fuel": Physics(("q", "q_dot"), _TWO[:1], _line, _magnitude, {"weight_time": 0.0}),
    "chain_time": Physics(_X, _TWO[:1], _chain, _one, {}),
    "chain_energy": Physics(_X, _TWO[:1], _chain, _square, {}),
    "chain_fuel": Physics(_X, _TWO[:1], _chain, _plain_magnitude, {}),
    "oscillator_time": Physics(_X[:2], _TWO[:1], _spring, _one, {"omega": 1.0}),
    "oscillator_energy": Physics(_X[:2], _TWO[:1], _spring, _square, {"omega": 1.0}),
    "oscillator_fuel": Physics(_X[:2], _TWO[:1], _spring, _plain_magnitude, {"omega": 1.0}),
    "rendezvous_box": Physics(("x", "x_dot", "y", "y_dot"), _TWO, _rendezvous, _square, {"omega": 1.0}),
    "rendezvous_ball": Physics(("x", "x_dot", "y", "y_dot"), _TWO, _rendezvous, _square, {"omega": 1.0}),
    "conjugate_1": Physics(
        _X[:1],
        _TWO[:1],
        lambda m, t, x, u, p: (u[0],),
        lambda m, t, x, u, p: (u[0] ** 2 - p[0] * x[0] ** 2) / 2.0,
        {"a1": 1.0},
    ),
    "conjugate_2": Physics(
        _X[:2],
        _TWO,
        _chosen,
        lambda m, t, x, u, p: (u[0] ** 2 + u[1] ** 2 - p[0] * x[0] ** 2 - p[1] * x[1] ** 2) / 2.0,
        {"a1": 1.0, "a2": 1.0},
    ),
    "end_on_ellipse": Physics(
        _X[:2],
        _TWO,
        _chosen,
        _square,
        {"a": 1.0, "b": 1.0},
        ends=lambda m, t, x, p: (x[0] ** 2 / p[0] ** 2 + x[1] ** 2 / p[1] ** 2 - 1.0,),
    ),
    "end_on_line": Physics(
        _X[:2], _TWO[:1], _line, _square, {"m": 1.0, "c": 0.0}, ends=lambda m, t, x, p: (x[1] - p[0] * x[0] - p[1],)
    ),
    "end_on_line_time": Physics(
        _X[:2], _TWO[:1], _line, _one, {"m": 1.0, "c": 0.0}, ends=lambda m, t, x, p: (x[1] - p[0] * x[0] - p[1],)
    ),
    "end_weighed": Physics(_X[:2], _TWO[:1], _line, _square, {"k1": 0.0, "k2": 0.0}, _weighed),
    "end_of_one": Physics(
        _X[:1],
        _TWO[:1],
        lambda m, t, x, u, p: (u[0],),
        _square,
        {"k1": 0.0},
        lambda m, t, x, p: p[0] * x[0] ** 2 / 2.0,
    ),
}
