"""What the ITS documents print, judged a second time by hand: sympy, scipy and arithmetic, nothing of satsym's.

Each route takes the printed rows of a document and a key, computes, and returns the verdict that it reaches.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import sympy as sp

from tests.support.ledgers import whole

Rows: TypeAlias = Mapping[str, Mapping[str, Any]]
Route: TypeAlias = Callable[[Rows, str], str]

START = (1.0, 1.0, 1.0, 1.0)
STATES = ("r", "r_dot", "theta", "theta_dot")

r, rd, th, thd, t, sigma, omega, m, lam = sp.symbols("r r_dot theta theta_dot t sigma omega m lam")
x1, x2, x3, x4, u1, u2, c1, c2 = sp.symbols("x1 x2 x3 x4 u1 u2 c1 c2")
l1, l2, l3, l4 = sp.symbols("lambda1 lambda2 lambda3 lambda4")
A = sp.Matrix([[0, 1, 0, 0], [3 * omega**2, 0, 0, 2 * omega], [0, 0, 0, 1], [0, -2 * omega, 0, 0]])
C = sp.Matrix([[1, 0, 0, 0], [0, 0, 1, 0]])


@cache
def rows(document: str) -> Rows:
    """Printed rows by item and part."""
    ledger = tomllib.loads(whole(document))
    return {f"{row['item']} {row.get('part', '')}".strip(): row for row in ledger["row"]}


def formula(row: Mapping[str, Any]) -> sp.Expr:
    """The right-hand side of what a row prints, in its own letters."""
    return sp.sympify(row["printed"].split("=")[-1])


def same(one: sp.Expr, other: sp.Expr) -> bool:
    return sp.simplify(one - other) == 0


@cache
def angular_acceleration() -> sp.Expr:
    """From Newton's law along the axes, not from components in a turning frame."""
    time = sp.Symbol("time")
    distance, angle = sp.Function("distance")(time), sp.Function("angle")(time)
    along = sp.Matrix([-sp.sin(angle), sp.cos(angle)])
    place = distance * sp.Matrix([sp.cos(angle), sp.sin(angle)])
    push = along.dot(place.diff(time, 2)) - u2
    found = sp.solve(sp.simplify(push), angle.diff(time, 2))[0]
    return sp.simplify(found.subs({distance.diff(time): x2, angle.diff(time): x4}).subs(distance, x1))


@cache
def hamiltonian() -> sp.Expr:
    radial = x1 * x4**2 - sigma**3 * omega**2 / x1**2 + u1
    effort = (c1 * u1**2 + c2 * u2**2) / 2
    return effort + l1 * x2 + l2 * radial + l3 * x4 + l4 * angular_acceleration()


def one_of_many_circles(document: Rows, key: str) -> str:
    """r = sigma solves the equation before it, and so does every other radius with a rate of its own."""
    left, right = (sp.sympify(side) for side in document["section 4.1 equilibrium, cubes"]["printed"].split("="))
    radius, rate = (sp.Symbol(name) for name in ("r", "theta_dot"))
    rest = sp.sympify(left - right)
    assert rest.subs({radius: sigma, rate: omega}) == 0
    others = [rest.subs({radius: k * sigma, rate: omega * sp.sqrt(sp.Rational(1, k**3))}) for k in (2, 3, 5)]
    return "unsound" if all(sp.simplify(other) == 0 for other in others) else "confirmed"


def angular_rate(document: Rows, key: str) -> str:
    """(4.27) of the thesis, (12) of the paper: u2 with the wrong sign, right before, and the Hamiltonian has it so."""
    printed = formula(document[key])
    model = formula(document["2.13 tangential" if "2.13 tangential" in document else "II (2) tangential"])
    right = same(model.subs({rd: x2, thd: x4, r: x1}), angular_acceleration())
    slip = same(printed.subs(u2, -u2), angular_acceleration())
    assert slip
    assert right
    following = formula(document["4.28" if "4.28" in document else "III (14)"])
    assert same(sp.diff(following, l4), printed), "carried on"
    return "confirmed" if same(printed, angular_acceleration()) else "wrong"


def thesis_hamiltonian(document: Rows, key: str) -> str:
    assert same(formula(document["4.28 first line"]), hamiltonian()), "right one line before"
    assert same(sp.diff(formula(document[key]), l4), formula(document["4.35"])), "carried on"
    return "confirmed" if same(formula(document[key]), hamiltonian()) else "wrong"


def paper_hamiltonian(document: Rows, key: str) -> str:
    """Wrong, and (18) is the derivative of what is printed; it is printed nowhere else."""
    printed = formula(document[key])
    assert same(sp.diff(printed, l4), formula(document["III (18)"])), "carried on"
    return "confirmed" if same(printed, hamiltonian()) else "wrong"


def state_equation(document: Rows, key: str) -> str:
    """What comes after uses the right sign: the costate equations."""
    later = formula(document["4.36" if key == "4.35" else "III (19)"])
    assert same(later, -sp.diff(hamiltonian(), x1))
    return "confirmed" if same(formula(document[key]), sp.diff(hamiltonian(), l4)) else "misprint"


def canonical_state(document: Rows, key: str) -> str:
    """x4' = dH*/dx4 (printed) against dH*/d lambda4, with the stationary controls put in."""
    found = hamiltonian().subs({u1: -l2 / c1, u2: -l4 / (c2 * x1)})
    rate = angular_acceleration().subs(u2, -l4 / (c2 * x1))
    assert document[key]["printed"].endswith("H_star_x4")
    assert same(sp.diff(found, l4), rate)
    return "confirmed" if same(sp.diff(found, x4), rate) else "misprint"


def end_on_a_curve(document: Rows, key: str) -> str:
    """dx = c' dt in the first variation (H + S_t) dt + (S_x - lambda) dx."""
    names = sp.symbols("H_star S_t S_x lam theta_dot")
    energy, s_t, s_x, costate, slope = names
    printed = sp.sympify(document[key]["printed"].split("=")[0], locals={str(n): n for n in names})
    return "confirmed" if same(printed, energy + s_t + (s_x - costate) * slope) else "misprint"


def varied_start(document: Rows, key: str) -> str:
    """The variation of a given initial state is zero; the other types print the state itself."""
    others = [row["printed"] for name, row in document.items() if name.endswith("start") and name != key]
    assert len(others) >= 4
    assert set(others) == {"x_t0 = x0"}
    return "confirmed" if document[key]["printed"] in others else "misprint"


def steady_motion(document: Rows, key: str) -> str:
    """On r = sigma, theta = omega t: rates (0, 0, omega, 0), and none depends on theta."""
    rates = sp.Matrix([rd, r * thd**2 - sigma**3 * omega**2 / r**2, thd, -2 * rd * thd / r])
    on = rates.subs({r: sigma, rd: 0, thd: omega})
    assert "titik setimbang" in document[key]["original"]
    if sp.simplify(on) == sp.zeros(4, 1):
        return "confirmed"
    return "unsound" if rates.diff(th) == sp.zeros(4, 1) and on[2] == omega else "wrong"


def from_zero_differences(document: Rows, key: str) -> str:
    """The linearisation is right; the line before says u1 whatever r is, and so cannot lead to it."""
    place = {r: sigma, thd: omega, u1: 0}
    exact = r * thd**2 - sigma**3 * omega**2 / r**2 + u1
    linear = sum(sp.diff(exact, v).subs(place) * (v - place[v]) for v in (r, thd, u1))
    printed, before = (formula(document[k]) for k in (key, "4.19 line 3"))
    assert same(printed, linear)
    return "confirmed" if same(printed, before) else "unsound"


def written_out_state(document: Rows, key: str) -> str:
    """The third row of A x is x3' = sigma (theta_dot - omega)."""
    printed = sp.Matrix([[sp.sympify(e) for e in row] for row in document[key]["printed"]])
    rate = sigma * (thd - omega)
    assert same((A * printed.subs(omega * t, omega))[2], rate)
    return "confirmed" if same((A * printed)[2], rate) else "misprint"


def left_factor(document: Rows, key: str) -> str:
    printed = sp.Matrix([[sp.sympify(e) for e in row] for row in document[key]["printed"]])
    after = sp.Matrix([[sp.sympify(e) for e in row] for row in document["section 4.1.3 CA3"]["printed"]])
    assert after == C * A**3, "the product that follows is that of the right factor"
    assert printed * A != after
    return "confirmed" if printed == C * A**2 else "misprint"


def defective(document: Rows, key: str) -> str:
    """Unstable by a Jordan block; an oscillator has zero real parts, too, and is bounded."""
    _, jordan = A.subs(omega, 1).jordan_form()
    assert any(jordan[i, i] == 0 and jordan[i, i + 1] == 1 for i in range(3)), "unstable"
    oscillator = sp.Matrix([[0, 1], [-1, 0]])
    bounded = oscillator.is_diagonalizable() and all(sp.re(v) == 0 for v in oscillator.eigenvals())
    return "unsound" if bounded and "bernilai nol" in document[key]["original"] else "confirmed"


def no_displacement(document: Rows, key: str) -> str:
    """On the reference r = sigma = 1 and theta_dot = omega = 1, which is where the motion starts."""
    state = re.search(r"\)\.(\w+) == 1", document[key]["printed"])[1]  # type: ignore[index]
    at_start = {"r": 1.0, "r_dot": 0.0, "theta": 0.0, "theta_dot": 1.0}[state]
    return "wrong" if START[STATES.index(state)] - at_start != 1.0 else "confirmed"


def two_systems(document: Rows, key: str) -> str:
    """The linear and the nonlinear rates at (1, 1, 1, 1)."""
    linear = np.array(A.subs(omega, 1), dtype=float) @ np.ones(4)
    nonlinear = np.array([1.0, 1.0 - 1.0, 1.0, -2.0])
    return "confirmed" if np.allclose(linear, nonlinear) else "wrong"


def two_meanings(first: str, second: str) -> Route:
    """A letter that stands for two expressions, which differ."""
    return lambda document, key: "confirmed" if same(sp.sympify(first), sp.sympify(second)) else "notation"


def one_force_alone(document: Rows, key: str) -> str:
    """A system in r and theta has two equations; the one that is named has the force of one direction only."""
    named = re.search(r"\((2\.\d+)\)", document[key]["original"])[1]  # type: ignore[index]
    lines = [row["printed"] for item, row in document.items() if item == named or item.startswith(f"{named} ")]
    both = all(any(force in line for line in lines) for force in ("F_r", "F_theta"))
    return "confirmed" if both else "misprint"


def two_of_four(document: Rows, key: str) -> str:
    first, last = re.findall(r"\(4\.(\d+)\)", document[key]["original"])
    named = {document[f"4.{n}"]["printed"].split(" = ")[0] for n in range(int(first), int(last) + 1)}
    return "confirmed" if named == {f"d_lambda{i}" for i in range(1, 5)} else "misprint"


def matrix_itself(document: Rows, key: str) -> str:
    """What is printed below has four rows and no lambda."""
    own = document["section 4.1.1 A" if "4.1.1" in key else "III (1)"]["printed"]
    found = sp.Matrix([[sp.sympify(entry) for entry in line] for line in own])
    return "notation" if found == A and found.charpoly(lam).as_expr().has(lam) else "confirmed"


def beyond_the_bounds(document: Rows, key: str) -> str:
    """At lambda2 = 3 the smallest of H over controls from 0 to 1 is not what (4.31) says."""
    point = {x1: 1, x2: 0, x3: 0, x4: 0, c1: 1, c2: 1, sigma: 1, omega: 1, l1: 0, l2: 3, l3: 0, l4: 0}
    h = formula(document["4.28 first line"]).subs(point)
    least = min(float(h.subs({u1: a, u2: b})) for a in np.linspace(0, 1, 21) for b in np.linspace(0, 1, 21))
    return "wrong" if abs(float(formula(document["4.31"]).subs(point)) - least) > 1.0 else "confirmed"


def controls_left(document: Rows, key: str) -> str:
    return "notation" if formula(document["III (14)"]).free_symbols >= {u1, u2} else "confirmed"
