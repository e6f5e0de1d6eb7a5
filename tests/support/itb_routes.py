"""What the ledger of itb_eigen finds fault with, found once more by other means; nothing here touches the judge.

Each route takes the rows of the ledger as they are printed, and returns the verdict that it reaches.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import scipy.constants
import scipy.integrate
import scipy.linalg
import scipy.special
import sympy as sp

from tests.support import ledgers

Rows: TypeAlias = Mapping[str, dict[str, Any]]
Route: TypeAlias = Callable[[Rows, str], str]

NEWTON, SUN = 6.67430e-11, 1.989e30
MU, R0, V0, YEAR = NEWTON * SUN, 1.496e11, 29.78e3, 3.154e7
SPEEDS = (29.78e3, 34.78e3, 42.38e3)


@cache
def rows() -> Rows:
    """Rows by their keys, as the file has them."""
    tree = tomllib.loads(ledgers.whole("itb_eigen"))
    return {f"{row['item']} {row.get('part', '')}".strip(): row for row in tree["row"]}


def pieces(document: Rows) -> list[str]:
    """The program as it is printed in pieces."""
    return [line for k in range(1, 9) for line in document[f"listing {k} lines"]["printed"]]


def whole(document: Rows) -> list[str]:
    """The whole program."""
    return list(document["program lines"]["printed"])


def rates(state: np.ndarray) -> np.ndarray:
    """Velocity and Newton's acceleration, also of complex states."""
    place = state[:3]
    return np.concatenate([state[3:], -MU * place / np.sqrt((place**2).sum()) ** 3])


def jacobian(state: np.ndarray) -> np.ndarray:
    """Of the rates, by a complex step."""
    found = np.zeros((6, 6))
    for k in range(6):
        shifted = state.astype(complex)
        shifted[k] += 1e-8j
        found[:, k] = rates(shifted).imag / 1e-8
    return found


def growth_rate(speed: float = V0) -> float:
    """The largest real part of an eigenvalue at the start, with this speed."""
    return float(np.linalg.eigvals(jacobian(np.array([R0, 0.0, 0.0, 0.0, speed, 0.0]))).real.max())


def same_for_all_orbits(document: Rows, key: str) -> str:
    """The eigenvalues are the same for three speeds, two of them below that of escape: no rule can be right for all."""
    bound = [0.5 * speed**2 - MU / R0 < 0.0 for speed in SPEEDS]
    largest = [growth_rate(speed) for speed in SPEEDS]
    return "wrong" if len(set(bound)) > 1 and np.ptp(largest) <= 1e-12 * largest[0] else "confirmed"


def zeros_of_two_kinds(document: Rows, key: str) -> str:
    """x' = 0 and x1' = x2, x2' = 0 have the same eigenvalues; the second grows."""
    still, shear = np.zeros((2, 2)), np.array([[0.0, 1.0], [0.0, 0.0]])
    assert np.array_equal(np.linalg.eigvals(still), np.linalg.eigvals(shear))
    grows = [np.linalg.norm(scipy.linalg.expm(1e3 * a)) > 100.0 for a in (still, shear)]
    return "wrong" if grows == [False, True] else "confirmed"


def on_the_move(document: Rows, key: str) -> str:
    """The initial velocity in the text is not zero, so that the point of the Jacobian is no equilibrium."""
    line = next(line for line in whole(document) if line.startswith("v0 ="))
    numbers = [float(x) for x in re.search(r"\[(.*)\]", line)[1].split(",")]
    return "wrong" if any(numbers) else "confirmed"


def force_from_potential(document: Rows, key: str) -> str:
    """m times minus the gradient of -mu/r, against what is printed; the formula printed after it is right."""
    x, y, z, mu, m = sp.symbols("x y z mu m", positive=True)
    r = sp.sqrt(x**2 + y**2 + z**2)
    force = -m * sp.diff(-mu / r, x)
    put = {"r_vector": x, "r": r, "mu": mu}
    texts = (document[name]["printed"].split(" = ")[1] for name in (key, "II.1.b equation of motion"))
    printed, later = (sp.sympify(text, locals={n: sp.Symbol(n) for n in put}).subs(put) for text in texts)
    assert sp.simplify(later - force / m) == 0
    return "misprint" if sp.simplify(printed - force) != 0 else "confirmed"


def by_velocity_it_is_zero(document: Rows, key: str) -> str:
    """The acceleration does not depend on r_dot; its derivative by r is the printed matrix."""
    place = sp.Matrix(sp.symbols("x y z", positive=True))
    mu, length = sp.Symbol("mu"), sp.sqrt(sum(q**2 for q in place))
    printed = mu * (3 * place * place.T / length**5 - sp.eye(3) / length**3)
    by_r = (-mu * place / length**3).jacobian(place)
    by_r_dot = (-mu * place / length**3).jacobian(sp.symbols("v_x v_y v_z"))
    assert document[key]["printed"] == "dv_by_dr_dot"
    assert sp.simplify(by_r - printed) == sp.zeros(3)
    return "misprint" if by_r_dot == sp.zeros(3) != printed else "confirmed"


def never_at_rest(document: Rows, key: str) -> str:
    """The size of the acceleration has no zero."""
    r = sp.Symbol("r", positive=True)
    return "wrong" if sp.solveset(1 / r**2, r, sp.S.Reals) == sp.S.EmptySet else "confirmed"


def round_the_circle(document: Rows, key: str) -> str:
    """angle' = 1 - cos(angle) has cot(angle/2) = cot(start/2) - t: it ends at rest, and passes pi however it starts."""
    t, start = sp.symbols("t start", positive=True)
    angle = 2 * sp.acot(sp.cot(start / 2) - t)
    residual = (angle.diff(t) - (1 - sp.cos(angle))).subs({start: sp.Rational(1, 7), t: 3})
    assert abs(residual.evalf(30)) < 1e-25
    end = sp.limit(sp.cos(angle.subs(start, sp.Rational(1, 500))), t, sp.oo)
    farthest = sp.cos(2 * sp.pi / 2)  # where cot(angle/2) is zero, at the time t = cot(start/2)
    return "wrong" if end == 1 and farthest == -1 else "confirmed"


def pendulum_comes_back(document: Rows, key: str) -> str:
    """From upright but for epsilon a pendulum swings with a finite period, by the elliptic integral."""
    period = 4.0 * scipy.special.ellipk(np.cos(0.5e-3) ** 2)
    fastest = np.sqrt(2.0 * (np.cos(1e-3) + 1.0))
    return "wrong" if np.isfinite(period) and fastest > 1.0 else "confirmed"


def resonance(document: Rows, key: str) -> str:
    """q1' = w q2 + p1 and so on: (A^2 + w^2)^2 = 0 with A^2 + w^2 not zero, so that e^(At) has terms t cos(w t)."""
    turn, w = np.array([[0.0, 1.0], [-1.0, 0.0]]), 1.0
    a = np.block([[turn, np.eye(2)], [np.zeros((2, 2)), turn]])
    square = a @ a + w**2 * np.eye(4)
    assert not (square @ square).any()
    assert np.allclose(np.linalg.eigvals(a).real, 0.0, atol=1e-7)
    return "wrong" if square.any() else "confirmed"


def mass_of_the_sun(document: Rows, key: str) -> str:
    """G M of the Sun is known to ten digits; over CODATA's G it is not 1.989."""
    mass = 1.32712440018e20 / scipy.constants.value("Newtonian constant of gravitation")
    return (
        "imprecise" if f"{mass:.3e}" != document[key]["printed"].split(" ")[0].replace("e30", "e+30") else "confirmed"
    )


def two_names(document: Rows, key: str) -> str:
    """The pieces define one name and call another; the whole program has one."""
    missing = []
    for lines in (pieces(document), whole(document)):
        text = "\n".join(lines)
        missing.append(set(re.findall(r"= (calc\w+)\(", text)) - set(re.findall(r"def (\w+)\(", text)))
    return "misprint" if missing == [{"calculateJacobi"}, set()] else "confirmed"


def zero_is_called_stable(document: Rows, key: str) -> str:
    """The rule lets zero pass; (1, t) is a motion of x1' = 0, x2' = x1, whose eigenvalues are zero."""
    assert "e.real <= 0" in document[key]["printed"]
    a = np.array([[0.0, 0.0], [1.0, 0.0]])
    grows = np.linalg.norm(scipy.linalg.expm(1e4 * a) @ [1.0, 0.0]) > 1e3
    return "wrong" if all(e.real <= 0 for e in np.linalg.eigvals(a)) and grows else "confirmed"


def label_is_a_constant(document: Rows, key: str) -> str:
    """The label is a text in the call, and the eigenvalue says unstable."""
    call = ast.parse(document[key]["printed"]).body[0].value
    label = next(k.value for k in call.keywords if k.arg == "label")
    fixed = isinstance(label, ast.Constant) and "Stable" in label.value
    return "artefact" if fixed and growth_rate() > 0.0 else "confirmed"


def not_astronomical_units(document: Rows, key: str) -> str:
    """What is drawn is divided by 1e11 m."""
    line, label = document[key]["printed"]
    divided = {float(x) for x in re.findall(r"/ ([0-9e.]+)", line)}
    return "unit error" if "AU" in label and divided != {scipy.constants.au} and len(divided) == 1 else "confirmed"


def never_shown(rows: Rows, key: str) -> str:
    """The lines that draw are called from matplotlib, and none of them opens a window or writes a file."""
    last = [line.split("(")[0] for line in whole(rows) if line.startswith("plt.")]
    assert "plt.plot" in last
    return "confirmed" if {"plt.show", "plt.savefig"} & set(last) else "wrong"


def nothing_integrated(document: Rows, key: str) -> str:
    """The pieces import the solver and never call it, and give x and y no value outside functions."""
    lines = pieces(document)
    given = [line for line in lines if "solve_ivp(" in line or re.match(r"x\b.*=", line)]
    return "wrong" if not given and "x / 1e11" in document[key]["printed"] else "confirmed"


def drawn_before_judged(document: Rows, key: str) -> str:
    """x and y have their values before the Jacobian is computed, and the drawing lines use nothing else."""
    lines = whole(document)
    first = next(i for i, line in enumerate(lines) if line.startswith("x, y, z = solution"))
    later = next(i for i, line in enumerate(lines) if line.startswith("jacobian = calc"))
    drawing = ast.walk(ast.parse("\n".join(line for line in lines if line.startswith("plt."))))
    used = {node.id for node in drawing if isinstance(node, ast.Name)}
    return "wrong" if first < later and used == {"plt", "x", "y"} else "confirmed"


def below_escape(document: Rows, key: str) -> str:
    """By the vis-viva equation: neither reading of the garbled number reaches the speed of escape."""
    readings = map(float, re.search(r"for more in \[(.*)\]", document[key]["printed"])[1].split(","))
    return "wrong" if max(readings) + V0 < np.sqrt(2.0 * MU / R0) else "confirmed"


def program_says_no(document: Rows, key: str) -> str:
    """One eigenvalue is sqrt(2 mu/r^3), which the rule does not let pass."""
    assert np.isclose(growth_rate(), np.sqrt(2.0 * MU / R0**3), rtol=1e-9)
    return "wrong" if not growth_rate() <= 0 else "confirmed"


def distance_and_vector(document: Rows, key: str) -> str:
    """r is a number in one function of the program, and is taken apart into three in the other."""
    text = "\n".join(whole(document))
    return (
        "notation" if "r = np.sqrt(" in text and "def calculateJacobi(r, v):\n    x, y, z = r" in text else "confirmed"
    )


def coordinate_and_vector(document: Rows, key: str) -> str:
    """x is a coordinate of the position, and what A is applied to."""
    both = (
        document["II.1.a position"]["printed"][0] == ["x"],
        "Ax = lambda x" in document["II.3 definition"]["original"],
    )
    return "notation" if all(both) else "confirmed"


def harmonic(document: Rows, key: str) -> str:
    """The potential 1/r is harmonic, so that the diagonal of its second derivatives adds up to zero."""
    place = sp.symbols("x y z", positive=True)
    potential = 1 / sp.sqrt(sum(q**2 for q in place))
    return "unsound" if sp.simplify(sum(sp.diff(potential, q, 2) for q in place)) == 0 else "confirmed"


@cache
def monodromy() -> tuple[np.ndarray, np.ndarray]:
    """The variational equations over one revolution, by scipy, scaled; and the rates at the start."""
    start = np.array([1.0, 0.0, 0.0, 0.0, V0 / np.sqrt(MU / R0), 0.0])
    energy = 0.5 * start[4] ** 2 - 1.0
    period = 2.0 * np.pi * (-2.0 * energy) ** -1.5

    def with_slopes(_: float, y: np.ndarray) -> np.ndarray:
        place, m = y[:3], y[6:].reshape(6, 6)
        r = np.linalg.norm(place)
        slope = np.zeros((6, 6))
        slope[:3, 3:], slope[3:, :3] = np.eye(3), 3.0 * np.outer(place, place) / r**5 - np.eye(3) / r**3
        return np.concatenate([y[3:6], -place / r**3, (slope @ m).ravel()])

    done = scipy.integrate.solve_ivp(
        with_slopes, (0.0, period), np.concatenate([start, np.eye(6).ravel()]), method="DOP853", rtol=1e-12, atol=1e-13
    )
    return done.y[6:, -1].reshape(6, 6), np.concatenate([start[3:], [-1.0, 0.0, 0.0]])


def drifts_along(document: Rows, key: str) -> str:
    """After a revolution a deviation is what it was, plus a shift along the motion: nothing grows like e^(8.9 n)."""
    matrix, along = monodromy()
    shift = matrix - np.eye(6)
    across = shift - np.outer(along, along @ shift) / (along @ along)
    no_growth = np.abs(across).max() < 1e-8 and np.abs(shift @ shift).max() < 1e-7 < np.abs(shift).max()
    predicted = growth_rate() * YEAR
    return "wrong" if no_growth and predicted > 8.0 else "confirmed"


def negative_is_not_at_most_zero(document: Rows, key: str) -> str:
    """The conclusion has negative, the program less or equal."""
    line = document["program stability"]["printed"]
    return "wrong" if "negatif" in document[key]["original"] and "<= 0" in line else "confirmed"


ROUTES: dict[str, Route] = {
    "abstract classification": same_for_all_orbits,
    "I signs": zeros_of_two_kinds,
    "I Jacobian at an equilibrium": on_the_move,
    "II.1.b force": force_from_potential,
    "II.2 gravity gradient, left side": by_velocity_it_is_zero,
    "II.4 orbits have one": never_at_rest,
    "II.4 asymptotically stable": round_the_circle,
    "II.4 unstable": pendulum_comes_back,
    "II.4 decides orbits": same_for_all_orbits,
    "II.4 slightly stable": resonance,
    "listing 7 calculateJacobi": two_names,
    "listing 7 decides": same_for_all_orbits,
    "listing 8 x and y": nothing_integrated,
    "listing 8 proves": drawn_before_judged,
    "listing 8 shown": never_shown,
    **{f"{item} M_sun": mass_of_the_sun for item in ("listing 3", "program")},
    **{f"{item} stability": zero_is_called_stable for item in ("listing 7", "program")},
    **{f"{item} label": label_is_a_constant for item in ("listing 8", "program")},
    **{f"{item} {q} axis": not_astronomical_units for item in ("listing 8", "program") for q in "xy"},
    "III instability": below_escape,
    "III Earth is stable": program_says_no,
    "III letter r": distance_and_vector,
    "III letter x": coordinate_and_vector,
    "IV effective tool": same_for_all_orbits,
    "IV stable if negative": harmonic,
    "IV unstable if positive": drifts_along,
    "IV rule of the program": negative_is_not_at_most_zero,
}
