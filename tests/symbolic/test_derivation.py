"""What is derived is true: held against other libraries, other coordinates, simulation and brute force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.optimize import root
from sympy import Matrix, cos, sin, sqrt
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

from satsym.symbolic import (
    Definition,
    Derivation,
    DerivationError,
    FirstOrder,
    Newton,
    Problem,
    Variable,
    derive,
    loader,
    symbols_of,
    t,
)
from tests.support import derived as shared

POLAR, *_ = loader.load(Path(__file__).resolve().parents[2] / "derivations" / "polar_orbit.py")
NUMERIC = [
    {
        "Clip": lambda value, lower, upper: np.clip(value, lower, upper),
        "Shorten": lambda norm_squared, limit: np.minimum(1.0, limit / np.sqrt(norm_squared)),
    },
    "numpy",
]


def variables(names: str, unit: str = "1", **others: Any) -> tuple[Variable, ...]:
    return tuple(Variable(name, name, unit, **others) for name in names.split())


def function_of(derivation: Derivation, expressions: Any, **values: float) -> Callable[..., np.ndarray]:
    """Numeric function of named arguments, definitions and given values filled in."""
    found = sp.Matrix(expressions)
    for d in derivation.model.definitions:
        found = found.subs(symbols_of((d.variable,))[0], d.value)
    names = sorted({s.name: s for s in found.free_symbols}.items())
    numeric = sp.lambdify([s for _, s in names], list(found), NUMERIC)
    return lambda **point: np.array(numeric(*(({**values, **point})[name] for name, _ in names)), dtype=float)


def simulated(derivation: Derivation, start: list[float], until: float, costates: bool = False, **values: float) -> Any:
    """Integrate the derived first-order form (and the costates), from time zero."""
    names = [v.symbol for v in derivation.model.states]
    rates = list(derivation.rhs("first_order"))
    if costates:
        names += [f"lambda_{v.symbol}" for v in derivation.model.states]
        law = {c: derivation.equation(f"control_law.{c}").rhs for c in symbols_of(derivation.model.controls)}
        rates = [e.subs(law) for e in (*rates, *derivation.rhs("costate_equations"))]
    f = function_of(derivation, rates, **values)
    return solve_ivp(
        lambda time, y: f(t=time, **dict(zip(names, y, strict=True))),
        (0.0, until),
        start,
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        dense_output=True,
    )


@pytest.fixture(scope="module")
def polar() -> Derivation:
    return derived(POLAR.name)


# Models with nothing in common but Newton's law.

MU = variables("mu", positive=True)
(mu,) = symbols_of(MU)


def cartesian(axes: str) -> Newton:
    states, controls = variables(f"{axes} {' '.join('v' + a for a in axes.split())}"), variables("u1 u2 u3"[: 3 * 3])
    n = len(axes.split())
    place, speed = symbols_of(states)[:n], symbols_of(states)[n:]
    controls = controls[:n]
    position = Matrix(place)
    return Newton(
        name=f"cartesian_{n}",
        title="Two bodies in Cartesian coordinates",
        states=states,
        controls=controls,
        parameters=MU,
        coordinates=dict(zip(place, speed, strict=True)),
        directions={f"e_{a}": sp.eye(n)[:, k] for k, a in enumerate(axes.split())},
        position=position,
        forces={
            "gravity": -mu / sqrt(position.dot(position)) ** 3 * position,
            "thrust": Matrix(symbols_of(controls)),
        },
    )


def spherical() -> Newton:
    states = (
        *variables("r", positive=True),
        *variables("theta phi", kind="angle"),
        *variables("r_dot theta_dot phi_dot"),
    )
    controls = variables("u1 u2 u3")
    r, theta, phi, r_dot, theta_dot, phi_dot = symbols_of(states)
    u1, u2, u3 = symbols_of(controls)
    e_r = Matrix([cos(theta) * cos(phi), sin(theta) * cos(phi), sin(phi)])
    e_theta = Matrix([-sin(theta), cos(theta), 0])
    e_phi = Matrix([-cos(theta) * sin(phi), -sin(theta) * sin(phi), cos(phi)])
    return Newton(
        name="spherical",
        title="Two bodies in spherical coordinates",
        states=states,
        controls=controls,
        parameters=MU,
        coordinates={r: r_dot, theta: theta_dot, phi: phi_dot},
        directions={"e_r": e_r, "e_theta": e_theta, "e_phi": e_phi},
        position=r * e_r,
        forces={"gravity": -mu / r**2 * e_r, "a": u1 * e_r, "b": u2 * e_theta, "c": u3 * e_phi},
    )


def rotating() -> Newton:
    """Axes that turn at a constant rate about a fixed centre of attraction."""
    states, controls, parameters = variables("x1 y1 vx vy"), variables("ux uy"), variables("mu Omega", positive=True)
    x, y, vx, vy = symbols_of(states)
    ux, uy = symbols_of(controls)
    _, turn = symbols_of(parameters)
    e_x, e_y = Matrix([cos(turn * t), sin(turn * t)]), Matrix([-sin(turn * t), cos(turn * t)])
    place = x * e_x + y * e_y
    return Newton(
        name="rotating",
        title="Two bodies seen from turning axes",
        states=states,
        controls=controls,
        parameters=parameters,
        coordinates={x: vx, y: vy},
        directions={"e_x": e_x, "e_y": e_y},
        position=place,
        forces={"gravity": -mu / sqrt(x**2 + y**2) ** 3 * place, "thrust": ux * e_x + uy * e_y},
    )


LINE = variables("q1 v1")
q1, v1 = symbols_of(LINE)
PUSH = variables("u1")
(u1,) = symbols_of(PUSH)
K = variables("k", positive=True)
(k,) = symbols_of(K)


def on_a_line(force: sp.Expr, place: sp.Expr = q1) -> Newton:
    """A point on a line, at a given function of its coordinate."""
    return Newton(
        name="line",
        title="Motion on a line",
        states=LINE,
        controls=PUSH,
        parameters=K,
        coordinates={q1: v1},
        directions={"e_1": Matrix([1])},
        position=Matrix([place]),
        forces={"given": Matrix([force]), "push": Matrix([u1])},
    )


NEWTON_MODELS = {
    "cartesian 2-D": cartesian("x1 y1"),
    "cartesian 3-D": cartesian("x1 y1 z1"),
    "spherical": spherical(),
    "rotating axes": rotating(),
    "driven, stretched line": on_a_line(-k * v1 + cos(t), place=q1 + k * q1**3 / 3 + sin(t)),
}
SUBJECTS: dict[str, Problem | Newton] = {POLAR.name: POLAR, **NEWTON_MODELS}


def derived(name: str) -> Derivation:
    """The derivation of one of the models."""
    return shared.derived(SUBJECTS[name])


# Equations of motion.


def accelerations_by_lagrange(model: Newton) -> tuple[list[sp.Symbol], Callable[..., np.ndarray]]:
    """Second derivatives of the coordinates by sympy.physics.mechanics, which knows nothing of directions."""
    moving = {q: dynamicsymbols(q.name) for q in model.coordinates}
    back = {f.diff(dynamicsymbols._t): model.coordinates[q] for q, f in moving.items()}
    time = {t: dynamicsymbols._t}
    frame, origin, point = ReferenceFrame("N"), Point("O"), Point("P")
    axes = (frame.x, frame.y, frame.z)

    def vector(components: Matrix) -> Any:
        rates = {model.coordinates[q]: f.diff(dynamicsymbols._t) for q, f in moving.items()}
        found = Matrix(components).subs(rates).subs(moving).subs(time)
        return sum((c * axis for c, axis in zip(found, axes, strict=False)), 0 * frame.x)

    origin.set_vel(frame, 0)
    point.set_pos(origin, vector(model.position))
    point.set_vel(frame, point.pos_from(origin).dt(frame))
    kinetic = point.vel(frame).dot(point.vel(frame)) / 2
    forces = [(point, vector(f)) for f in model.forces.values()]
    method = LagrangesMethod(kinetic, list(moving.values()), forcelist=forces, frame=frame)
    method.form_lagranges_equations()
    mass, load = (
        m.subs(back).subs({f: q for q, f in moving.items()}).subs(dynamicsymbols._t, t)
        for m in (method.mass_matrix, method.forcing)
    )
    symbols = sorted(mass.free_symbols | load.free_symbols, key=lambda s: s.name)
    numeric = sp.lambdify(symbols, [mass, load], "numpy")

    def solve(*values: float) -> np.ndarray:
        matrix, forcing = numeric(*values)
        return np.linalg.solve(np.array(matrix, dtype=float), np.array(forcing, dtype=float)).ravel()

    return symbols, solve


@pytest.mark.slow
@pytest.mark.parametrize("name", [POLAR.name, "cartesian 2-D", "rotating axes", "driven, stretched line"])
def test_equations_of_motion_are_those_of_lagrange(name: str) -> None:
    found = derived(name)
    model = found.model
    assert isinstance(model, Newton)
    symbols, by_lagrange = accelerations_by_lagrange(model)
    ours = sp.lambdify(symbols, [found.equation(f"equations_of_motion.{q}").rhs for q in model.coordinates], "numpy")
    rng = np.random.default_rng(7)
    for _ in range(20):
        point = rng.uniform(0.5, 1.4, len(symbols))
        np.testing.assert_allclose(ours(*point), by_lagrange(*point), rtol=1e-11, atol=1e-12)


@pytest.mark.study
def test_spherical_equations_are_those_of_the_textbook() -> None:
    r, _, phi, r_dot, theta_dot, phi_dot = symbols_of(spherical().states)
    a, b, c = symbols_of(spherical().controls)
    textbook = {
        "r": r * phi_dot**2 + r * theta_dot**2 * cos(phi) ** 2 - mu / r**2 + a,
        "theta": -2 * r_dot * theta_dot / r + 2 * theta_dot * phi_dot * sin(phi) / cos(phi) + b / (r * cos(phi)),
        "phi": -2 * r_dot * phi_dot / r - theta_dot**2 * sin(phi) * cos(phi) + c / r,
    }
    for name, expected in textbook.items():
        assert sp.simplify(derived("spherical").equation(f"equations_of_motion.{name}").rhs - expected) == 0


def test_turning_axes_give_coriolis_and_centrifugal_terms() -> None:
    x, y, vx, vy = symbols_of(rotating().states)
    ux, uy = symbols_of(rotating().controls)
    _, turn = symbols_of(rotating().parameters)
    distance = sqrt(x**2 + y**2)
    expected = {
        "x1": 2 * turn * vy + turn**2 * x - mu * x / distance**3 + ux,
        "y1": -2 * turn * vx + turn**2 * y - mu * y / distance**3 + uy,
    }
    for name, acceleration in expected.items():
        found = derived("rotating axes").equation(f"equations_of_motion.{name}").rhs
        assert sp.simplify(found - acceleration) == 0


def test_thrust_stands_apart_from_gravity() -> None:
    """The form matters, too: nobody wants the thrust multiplied and divided by the cube of the distance."""
    found = derived("cartesian 2-D").equation("equations_of_motion.x1").rhs
    assert symbols_of(cartesian("x1 y1").controls)[0] in found.args


def test_polar_simulation_is_the_cartesian_one(polar: Derivation) -> None:
    """Thrust on, both ways round: the same place at the same time."""
    radial, tangential, until = 0.03, -0.05, 5.0

    def in_the_plane(_time: float, y: np.ndarray) -> np.ndarray:
        place, speed = y[:2], y[2:]
        out = place / np.linalg.norm(place)
        along = np.array([-out[1], out[0]])
        return np.concatenate([speed, -place / np.linalg.norm(place) ** 3 + radial * out + tangential * along])

    cartesian_end = solve_ivp(
        in_the_plane, (0, until), [1.2, 0.0, 0.1, 0.8], method="DOP853", rtol=1e-12, atol=1e-13
    ).y[:, -1]
    r, r_dot, theta, theta_dot = simulated(
        polar, [1.2, 0.1, 0.0, 0.8 / 1.2], until, sigma=1.0, omega=1.0, u1=radial, u2=tangential
    ).y[:, -1]
    polar_end = [
        r * np.cos(theta),
        r * np.sin(theta),
        r_dot * np.cos(theta) - r * theta_dot * np.sin(theta),
        r_dot * np.sin(theta) + r * theta_dot * np.cos(theta),
    ]
    np.testing.assert_allclose(polar_end, cartesian_end, atol=1e-10)


def test_linearisation_predicts_neighbouring_simulations(polar: Derivation) -> None:
    """Transition matrix of A(t), from the variational equation, against differences of simulations."""
    n, start, until = 4, np.array([1.1, 0.02, 0.0, 0.9]), 2.0
    values = {"sigma": 1.0, "omega": 1.0, "u1": 0.02, "u2": -0.01}
    names = [v.symbol for v in polar.model.states]
    f = function_of(polar, polar.rhs("first_order"), **values)
    a = function_of(polar, [e.rhs for e in polar.step("linearisation").equations if e.name.startswith("A_")], **values)

    def variational(time: float, y: np.ndarray) -> np.ndarray:
        point = dict(zip(names, y[:n], strict=True)) | {"t": time}
        return np.concatenate([f(**point), (a(**point).reshape(n, n) @ y[n:].reshape(n, n)).ravel()])

    first = np.concatenate([start, np.eye(n).ravel()])
    transition = solve_ivp(variational, (0, until), first, method="DOP853", rtol=1e-11, atol=1e-12).y[n:, -1]
    h = 1e-5
    ends = [simulated(polar, list(start + s * h * e), until, **values).y[:, -1] for e in np.eye(n) for s in (1, -1)]
    differences = np.array([(ends[2 * i] - ends[2 * i + 1]) / (2 * h) for i in range(n)]).T
    np.testing.assert_allclose(transition.reshape(n, n), differences, rtol=1e-6, atol=1e-7)


# What the uncontrolled motion keeps.


ALL_ROUND = {f"angular_momentum_{axis}" for axis in "xyz"}


def kept(name: str) -> set[str]:
    found = derived(name)
    return {e.name for e in found.step("conserved").equations} if "conserved" in found else set()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        (POLAR.name, {"energy", "angular_momentum"}),
        ("cartesian 2-D", {"energy", "angular_momentum"}),
        ("cartesian 3-D", {"energy", *ALL_ROUND}),
        ("spherical", {"energy", *ALL_ROUND}),
        ("rotating axes", {"jacobi_integral", "angular_momentum"}),
        ("driven, stretched line", set()),
    ],
)
def test_symmetry_finds_what_is_conserved(name: str, expected: set[str]) -> None:
    assert kept(name) == expected


@pytest.mark.parametrize(
    "name", [POLAR.name, "cartesian 3-D", pytest.param("spherical", marks=pytest.mark.slow), "rotating axes"]
)
def test_conserved_quantities_are_constant_in_simulation(name: str) -> None:
    found = derived(name)
    values = {"mu": 1.3, "sigma": 1.2, "omega": 0.8, "Omega": 0.4}
    values |= {v.symbol: 0.0 for v in found.model.controls}
    names = [v.symbol for v in found.model.states]
    start = {"r": 1.1, "theta_dot": 0.9, "r_dot": 0.1, "x1": 1.0, "y1": 0.2, "vy": 1.0, "phi": 0.3, "phi_dot": 0.2}
    path = simulated(found, [start.get(s, 0.1) for s in names], 6.0, **values)
    quantities = function_of(found, found.rhs("conserved"), **values)
    along = np.array([quantities(**dict(zip(names, path.sol(s), strict=True))) for s in np.linspace(0, 6, 25)])
    np.testing.assert_allclose(along - along[0], 0, atol=1e-8)


def test_energy_of_an_ellipse_is_that_of_vis_viva(polar: Derivation) -> None:
    """Energy -mu/2a and angular momentum sqrt(mu a (1 - e^2)), at perigee and at apogee."""
    a, e, g = 1.5, 0.4, 2.0
    quantities = function_of(polar, polar.rhs("conserved"), sigma=g ** (1 / 3), omega=1.0)
    h = np.sqrt(g * a * (1 - e**2))
    for r in (a * (1 - e), a * (1 + e)):
        np.testing.assert_allclose(quantities(r=r, r_dot=0.0, theta_dot=h / r**2), [-g / (2 * a), h], rtol=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("force", "expected"),
    [
        (-k * q1, "energy"),
        (-k * q1**3 + sp.exp(-q1) + sin(q1), "energy"),
        (-k / (1 + q1**2), "energy"),
        (sp.Integer(0), "energy momentum_q1"),
        (-k * v1, ""),
        (-k * q1 * v1**2, ""),
        (-k * q1 + cos(t), ""),
    ],
    ids=str,
)
def test_only_forces_with_a_potential_keep_the_energy(force: sp.Expr, expected: str) -> None:
    found = derive(on_a_line(force))
    kept = {e.name for e in found.step("conserved").equations} if "conserved" in found else set()
    assert kept == set(expected.split())


def test_a_force_with_decimals_is_derived_even_if_sympy_cannot_divide_its_polynomials() -> None:
    assert "first_order" in derive(on_a_line(0.2 * (k * q1 - q1) / (1 + 1 / q1**6) - 1 / (2 * q1**2)))


def test_forces_that_only_look_conservative_keep_nothing() -> None:
    """A curl: each component can be integrated, the potential does not exist."""
    model = cartesian("x1 y1")
    x, y, *_ = symbols_of(model.states)
    swirl = replace(model, forces={"swirl": Matrix([-y, x])})
    assert "conserved" not in derive(swirl)


def test_a_reference_with_the_wrong_gravity_is_refused() -> None:
    (definition,) = POLAR.model.definitions
    wrong = replace(POLAR.model, definitions=(Definition(definition.variable, 2 * definition.value),))
    with pytest.raises(DerivationError, match="reference does not satisfy"):
        derive(wrong)


# The minimum principle.

double_integrator = Problem(
    name="double_integrator",
    title="Double integrator",
    model=FirstOrder(name="di", title="", states=LINE, controls=PUSH, parameters=K, rates={q1: v1, v1: u1}),
    running_cost=u1**2 / 2,
    terminal_cost=k * (q1 - sp.Rational(3, 10) * t) ** 2 / 2 + k * v1**2 / 5,
)
van_der_pol = Problem(
    name="van_der_pol",
    title="Van der Pol",
    model=FirstOrder(
        name="vdp",
        title="",
        states=LINE,
        controls=PUSH,
        parameters=K,
        rates={q1: v1, v1: k * (1 - q1**2) * v1 - q1 + u1 * (2 + cos(t))},
    ),
    running_cost=(q1**2 + t * v1**2 + u1**2) / 2,
    control_set="box",
)
two_body_ball = Problem(
    name="two_body_ball",
    title="Two bodies, thrust of bounded size",
    model=cartesian("x1 y1"),
    running_cost=k * (symbols_of(variables("u1"))[0] ** 2 + symbols_of(variables("u2"))[0] ** 2) / 2,
    control_set="ball",
)
two_body_ball = replace(two_body_ball, model=replace(two_body_ball.model, parameters=(*MU, *K)))


PROBLEMS = (POLAR, van_der_pol, two_body_ball)
SUBJECTS |= {p.name: p for p in PROBLEMS}


def hamiltonian_by_hand(name: str, p: dict[str, Any]) -> Any:
    """H typed in from the physics, for complex arguments."""
    lam = {key.removeprefix("lambda_"): value for key, value in p.items() if key.startswith("lambda_")}
    if name == "polar_orbit":
        gravity = p["sigma"] ** 3 * p["omega"] ** 2
        rates = {
            "r": p["r_dot"],
            "r_dot": p["r"] * p["theta_dot"] ** 2 - gravity / p["r"] ** 2 + p["u1"],
            "theta": p["theta_dot"],
            "theta_dot": (p["u2"] - 2 * p["r_dot"] * p["theta_dot"]) / p["r"],
        }
        cost = (p["c1"] * p["u1"] ** 2 + p["c2"] * p["u2"] ** 2) / 2
    elif name == "van_der_pol":
        speed = p["k"] * (1 - p["q1"] ** 2) * p["v1"] - p["q1"] + p["u1"] * (2 + np.cos(p["t"]))
        rates = {"q1": p["v1"], "v1": speed}
        cost = (p["q1"] ** 2 + p["t"] * p["v1"] ** 2 + p["u1"] ** 2) / 2
    else:
        pull = -p["mu"] / (p["x1"] ** 2 + p["y1"] ** 2) ** 1.5
        rates = {"x1": p["vx1"], "y1": p["vy1"], "vx1": pull * p["x1"] + p["u1"], "vy1": pull * p["y1"] + p["u2"]}
        cost = p["k"] * (p["u1"] ** 2 + p["u2"] ** 2) / 2
    return cost + sum(lam[s] * rate for s, rate in rates.items())


def random_points(found: Derivation, count: int) -> list[dict[str, float]]:
    """Values of everything that occurs in H."""
    model, rng = found.model, np.random.default_rng(11)
    names = [v.symbol for v in (*model.states, *model.controls, *model.parameters)]
    names += ["t", *(f"lambda_{v.symbol}" for v in model.states)]
    return [
        dict(zip(names, rng.uniform(0.4, 1.6, len(names)) * rng.choice([0.9, 1.1]), strict=True)) for _ in range(count)
    ]


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_costates_and_stationarity_are_complex_step_gradients(problem: Problem) -> None:
    found = derived(problem.name)
    model, h = found.model, 1e-40
    conditions = [e for e in found.step("stationarity").equations if e.lhs == 0]
    ours = function_of(found, [*(-found.rhs("costate_equations")), *(e.rhs for e in conditions)])
    value = function_of(found, [found.equation("hamiltonian.H").rhs])
    for point in random_points(found, 10):
        slopes = [
            hamiltonian_by_hand(problem.name, {**point, v.symbol: point[v.symbol] + 1j * h}).imag / h
            for v in (*model.states, *model.controls)
        ]
        np.testing.assert_allclose(ours(**point), slopes, rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(value(**point)[0], hamiltonian_by_hand(problem.name, point), rtol=1e-13)


def test_double_integrator_is_the_textbook_one() -> None:
    found = derive(double_integrator)
    lambda_q, lambda_v = sp.symbols("lambda_q1 lambda_v1", real=True)
    assert [e.rhs for e in found.step("costate_equations").equations] == [0, -lambda_q]
    assert found.equation("control_law.u1").rhs == -lambda_v
    assert sp.expand(found.equation("minimised_hamiltonian.H_star").rhs - (lambda_q * v1 - lambda_v**2 / 2)) == 0


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_control_law_beats_every_admissible_control(problem: Problem) -> None:
    """Brute force: a fine grid of the control set finds nothing cheaper, and its best is the law."""
    found = derived(problem.name)
    names = [v.symbol for v in found.model.controls]
    law = function_of(found, found.rhs("control_law"))
    bounds = {f"{u}_{end}": 0.4 * s for u in names for end, s in (("min", -1), ("max", 1.2))} | {"u_max": 0.5}
    if problem.control_set == "box":
        axes = [np.linspace(bounds[f"{u}_min"], bounds[f"{u}_max"], 401) for u in names]
        grid = np.stack([g.ravel() for g in np.meshgrid(*axes)])
    else:
        angle, radius = np.meshgrid(np.linspace(0, 2 * np.pi, 721), np.linspace(0, bounds["u_max"], 201))
        grid = np.stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()])
    active = 0
    for index, point in enumerate(random_points(found, 12)):
        # small costates for half of the points, so that bounds are active in some and idle in others
        point |= {s: point[s] * (0.2 if index % 2 else 1.0) for s in point if s.startswith("lambda_")}
        chosen = law(**point, **bounds)
        competitors = hamiltonian_by_hand(problem.name, {**point, **dict(zip(names, grid, strict=True))})
        best = hamiltonian_by_hand(problem.name, {**point, **dict(zip(names, chosen, strict=True))})
        assert best <= competitors.min() + 1e-12
        np.testing.assert_allclose(chosen, grid[:, competitors.argmin()], atol=6e-3)
        active += bool(
            np.isclose(np.abs(chosen), [bounds[f"{u}_max"] for u in names]).any()
            or np.isclose(np.abs(chosen), 0.4).any()
            or np.isclose(np.linalg.norm(chosen), bounds["u_max"])
        )
    assert 0 < active < 12


def test_hamiltonian_changes_only_as_time_enters() -> None:
    """Along an extremal dH/dt is the explicit slope of H, which for Van der Pol here is not zero."""
    found = derive(replace(van_der_pol, control_set="free"))
    names = ["q1", "v1", "lambda_q1", "lambda_v1"]
    path = simulated(found, [0.8, 0.1, 0.3, -0.2], 2.0, costates=True, k=0.7)
    h = found.equation("minimised_hamiltonian.H_star").rhs
    value, slope = (function_of(found, [e], k=0.7) for e in (h, sp.diff(h, t)))

    def at(f: Callable[..., np.ndarray], time: float) -> float:
        return float(f(t=time, **dict(zip(names, path.sol(time), strict=True)))[0])

    for time in np.linspace(0.2, 1.8, 9):
        difference = (at(value, time + 1e-4) - at(value, time - 1e-4)) / 2e-4
        assert difference == pytest.approx(at(slope, time), abs=1e-6)


def optimum(found: Derivation, start: list[float], final_time: float, weight: float) -> tuple[float, np.ndarray, float]:
    """Least cost of the double integrator with a free end; initial costates; H + S_t at the end."""
    names = ["q1", "v1", "lambda_q1", "lambda_v1"]
    end = function_of(found, [found.equation(f"boundary_conditions.lambda_{s}").rhs for s in ("q1", "v1")], k=weight)

    def miss(lam: np.ndarray) -> np.ndarray:
        y = simulated(found, [*start, *lam], final_time, costates=True).y[:, -1]
        return y[2:] - end(t=final_time, **dict(zip(names, y, strict=True)))

    lam = root(miss, [0.0, 0.0], tol=1e-12).x
    path = simulated(found, [*start, *lam], final_time, costates=True)
    last = dict(zip(names, path.y[:, -1], strict=True)) | {"t": final_time}
    nodes, weights = np.polynomial.legendre.leggauss(12)
    u = -path.sol(final_time * (nodes + 1) / 2)[3]
    terminal = function_of(found, [double_integrator.terminal_cost], k=weight)(**last)[0]
    condition = found.equation("boundary_conditions.final_time").lhs
    h_star = found.equation("minimised_hamiltonian.H_star").rhs
    stationary = function_of(found, [condition.subs(sp.Symbol("H", real=True), h_star)], k=weight)(**last)[0]
    return terminal + final_time / 4 * float(weights @ u**2), lam, stationary


def test_transversality_is_the_slope_of_the_least_cost() -> None:
    """The least cost J* changes by lambda with the start, and by H + S_t with the final time (envelope theorem)."""
    found = derive(double_integrator)
    start, final_time, weight, h = [0.5, -0.2], 1.5, 2.0, 1e-4
    _, lam, stationary = optimum(found, start, final_time, weight)

    def least(q: float, v: float, end: float) -> float:
        return optimum(found, [q, v], end, weight)[0]

    by_start = [
        (least(start[0] + h, start[1], final_time) - least(start[0] - h, start[1], final_time)) / (2 * h),
        (least(start[0], start[1] + h, final_time) - least(start[0], start[1] - h, final_time)) / (2 * h),
    ]
    by_time = (least(*start, final_time + h) - least(*start, final_time - h)) / (2 * h)
    np.testing.assert_allclose(by_start, lam, atol=1e-7)
    assert by_time == pytest.approx(stationary, abs=1e-7)


# Derivations as data.


def test_addresses_find_equations(polar: Derivation) -> None:
    assert polar.equation("polar_orbit:costate_equations.r") == polar.equation("costate_equations.r")
    assert polar.equation("costate_equations.r").lhs.name == "d_lambda_r"
    for step in polar.steps:
        for equation in step.equations:
            assert polar.equation(f"polar_orbit:{step.name}.{equation.name}") is equation


@pytest.mark.parametrize(
    ("address", "help_in_it"),
    [
        ("polar_orbit:costates.r", "costate_equations"),
        ("polar_orbit:costate_equations.radius", "r, r_dot, theta, theta_dot"),
        ("polar_orbit:costate_equations", "r, r_dot, theta, theta_dot"),
        ("lunar:costate_equations.r", "polar_orbit"),
        ("", "costate_equations"),
    ],
)
def test_wrong_addresses_are_answered_with_the_right_ones(polar: Derivation, address: str, help_in_it: str) -> None:
    with pytest.raises(KeyError, match=help_in_it):
        polar.equation(address)


def test_every_step_follows_from_earlier_ones_and_was_checked(polar: Derivation) -> None:
    known = {"directions", "position", "forces", "rates", "cost", "definitions"}
    for step in polar.steps:
        assert set(step.follows_from) <= known, step.name
        assert len({c.claim for c in step.checks}) >= 2, step.name
        assert all(c.passed for c in step.checks)
        assert len({e.name for e in step.equations}) == len(step.equations) > 0
        known.add(step.name)


def test_every_symbol_of_the_polar_derivation_has_a_notation(polar: Derivation) -> None:
    matrices = {e.lhs.name for s in ("linearisation", "second_derivative") for e in polar.step(s).equations}
    used = {s.name for step in polar.steps for e in step.equations for s in (e.lhs - e.rhs).free_symbols}
    assert used - matrices <= set(polar.notation)


def test_a_model_without_a_cost_is_derived_up_to_its_linearisation() -> None:
    found = derived("cartesian 2-D")
    assert found.name == "cartesian_2"
    assert "linearisation" in found
    assert "hamiltonian" not in found


def test_deriving_twice_gives_the_same() -> None:
    assert derive(van_der_pol).steps == derive(van_der_pol).steps
