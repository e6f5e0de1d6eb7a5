"""Claims of the ITS documents about motions, costs, units and the Earth, judged a second time by hand."""

from __future__ import annotations

import math
import re
from functools import cache

import numpy as np
import pint
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

from tests.support.its_routes import START, STATES, Route, Rows

MU, EARTH, DAY = 398600.4418, 6378.137, 86164.0905
REFERENCE = {"r": 1.0, "r_dot": 0.0, "theta": 60.0, "theta_dot": 1.0}
UNITS = pint.UnitRegistry()


@cache
def end_of_motion(control: float) -> tuple[float, ...]:
    """States after 60: for no control by Barker's equation, else by DOP853."""
    if control == 0.0:
        d = 7.0  # tan of half the true anomaly: (D + D^3/3)/2 is 2/3 at the start, D = 1, and 60 more here
        assert math.isclose((d + d**3 / 3.0) / 2.0 - 2.0 / 3.0, 60.0)
        return (1 + d * d) / 2, 2 * d / (1 + d * d), 1 + 2 * (math.atan(d) - math.atan(1)), 4 / (1 + d * d) ** 2
    found = solve_ivp(
        lambda _, x: [x[1], x[0] * x[3] ** 2 - 1 / x[0] ** 2 + control, x[3], (control - 2 * x[1] * x[3]) / x[0]],
        (0.0, 60.0),
        START,
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
    )
    return tuple(found.y[:, -1])


def returned(*names: str) -> Route:
    """Whether the states are near the reference after 60, without control or with u1 = u2 = 0.005."""

    def route(document: Rows, key: str) -> str:
        away = [
            any(abs(end_of_motion(u)[STATES.index(n)] - REFERENCE[n]) > 0.1 * max(1.0, REFERENCE[n]) for n in names)
            for u in (0.0, 0.005)
        ]
        return "wrong" if all(away) else "confirmed"

    return route


def halved_guess(document: Rows, key: str) -> str:
    """J is a sum of squares, 0 at u = 0; where a listing is printed, the digits are the guess 0.01 after a mean."""
    printed, n = document[key]["printed"], 250
    if "appendix B u1" not in document:
        return "wrong" if "0.0" in str(printed) else "confirmed"
    control = eval(document["appendix B u1"]["printed"].replace(".*", "*").strip("u1=;"), {"u1sb": 0.0, "oldu1": 0.01})  # noqa: S307, our own ledger
    if isinstance(printed, list):
        lines = [(float(a), float(b), j) for a, b, j in printed]
    elif "'0.005'" in printed:
        return "artefact" if control == 0.005 else "wrong"
    else:
        a, b, j = re.search(r"c1=(\d+), c2=(\d+)\).J == '(0\.\d{4})'", printed).groups()  # type: ignore[union-attr]
        lines = [(float(a), float(b), j)]
    for a, b, j in lines:
        assert float(j) > 0.0
        if f"{0.5 * (a + b) * control**2 * (60.0 / n) * (n + 1):.4f}" != j:
            return "wrong"
    return "artefact"


def proportional(document: Rows, key: str) -> str:
    """J over c1 + c2 is the same in all lines of the table: it measures the weights."""
    table = document["table 4.2" if "table 4.2" in document else "table 1"]["printed"]
    ratios = [float(j) / (float(a) + float(b)) for a, b, j in table]
    largest = max(table, key=lambda line: float(line[2]))
    assert np.ptp(ratios) < 2e-6
    assert largest[0] == largest[1], "equal weights make it largest, too"
    return "wrong"


def unreachable(document: Rows, key: str) -> str:
    """Pushed outwards and forwards at random, the satellite only moves away; h and E never fall."""
    rng = np.random.default_rng(4)
    worst = math.inf
    for _ in range(20):
        levels = rng.uniform(0.0, 1.0, (2, 12)) * rng.choice([1e-3, 0.03, 1.0])

        def field(time: float, x: np.ndarray, levels: np.ndarray = levels) -> list[float]:
            a, b = levels[:, min(int(time / 5.0), 11)]
            return [x[1], x[0] * x[3] ** 2 - 1 / x[0] ** 2 + a, x[3], (b - 2 * x[1] * x[3]) / x[0]]

        x = solve_ivp(field, (0.0, 60.0), START, rtol=1e-8, atol=1e-10, max_step=0.5).y
        energy, momentum = (x[1] ** 2 + (x[0] * x[3]) ** 2) / 2 - 1 / x[0], x[0] ** 2 * x[3]
        assert (np.diff(x[0]) > 0).all()
        assert (np.diff(momentum) > -1e-6).all()
        assert (energy > -1e-6).all()
        worst = min(worst, x[0, -1])
    return "wrong" if worst > 2.0 else "confirmed"


def effort(document: Rows, key: str) -> str:
    """The costs of a thrust in each of many intervals: no combination that leads to zero has less, by least squares."""
    linear, n = np.array([[0, 1, 0, 0], [3, 0, 0, 2], [0, 0, 0, 1], [0, -2, 0, 0]], dtype=float), 1200
    h, push = 60.0 / n, np.array([[0, 0], [1, 0], [0, 0], [0, 1.0]])
    once, half = expm(h * linear), expm(0.5 * h * linear)
    columns, step = [], h * half @ push
    for _ in range(n):
        columns.append(step)
        step = once @ step
    thrusts = np.linalg.lstsq(np.hstack(columns), -expm(60.0 * linear) @ np.ones(4), rcond=None)[0]
    return "wrong" if 0.5 * 10.0 * h * (thrusts**2).sum() > 3.0 else "confirmed"


def beyond_the_last(document: Rows, key: str) -> str:
    """Chapter 2 numbers its equations up to (2.19)."""
    last = max(int(item.split(".")[1].split()[0]) for item in document if re.fullmatch(r"2\.\d+( .*)?", item))
    return "misprint" if last < 24 else "confirmed"


def one_too_early(document: Rows, key: str) -> str:
    """The first of the equations is the one whose left-hand side is the rate of x1, or of lambda1."""
    rate, number = ("d_lambda1", 18) if "costates" in key else ("d_x1", 14)
    first = [item for item, row in document.items() if str(row.get("printed")).startswith(rate) and "III" in item]
    said = f"({number})" in document[key]["original"]
    return "misprint" if said and f"III ({number})" not in first and f"III ({number + 1})" in first else "confirmed"


def no_theorems(document: Rows, key: str) -> str:
    return "confirmed" if any(item.startswith("theorem") for item in document) else "misprint"


def left_alone(document: Rows, key: str) -> str:
    """J is a sum of squares, least where both controls are 0; then the satellite is far away after 60."""
    return "wrong" if end_of_motion(0.0)[0] > 2.0 * REFERENCE["r"] else "confirmed"


def driven_oscillator(document: Rows, key: str) -> str:
    """x'' = -x + x'^3 has the eigenvalues +-i, and its energy grows at the rate x'^4."""
    x = solve_ivp(lambda _, x: [x[1], -x[0] + x[1] ** 3], (0.0, 60.0), [0.1, 0.0], rtol=1e-9, atol=1e-12).y
    assert np.allclose(np.linalg.eigvals([[0.0, 1.0], [-1.0, 0.0]]).real, 0.0)
    return "wrong" if np.hypot(*x[:, -1]) > 1.1 * np.hypot(*x[:, 0]) else "confirmed"


def too_fast(document: Rows, key: str) -> str:
    """One degree a second at the distance of the orbit, in km/s, against what 1 km/s^2 adds in 60 s."""
    radius = (MU * (DAY / (2 * math.pi)) ** 2) ** (1 / 3)
    assert math.radians(1.0) * radius > 100.0 * math.sqrt(2 * MU / radius), "nor is it bound to the Earth"
    return "wrong" if math.radians(1.0) * radius > 1.0 * 60.0 else "confirmed"


def other_weights(document: Rows, key: str) -> str:
    """Which instance the controlled motion of a figure is that of: in 4.5 c1 is 50, in 4.13 it is 10."""
    cases = {
        n: re.search(r"reference\('([\w-]+)'", document[f"figure {n} with control"]["printed"])[1]
        for n in ("4.5", "4.13")
    }  # type: ignore[index]
    return "misprint" if cases["4.5"] != cases["4.13"] and "4.5" in document[key]["original"] else "confirmed"


def gravity(document: Rows, key: str) -> str:
    radius = (MU * (DAY / (2 * math.pi)) ** 2) ** (1 / 3)
    return "confirmed" if MU / radius**2 * 1e3 < 1e-6 else "wrong"


def polar_caps(document: Rows, key: str) -> str:
    """At latitude 82 degrees, the satellite in the same meridian is below the horizon."""
    radius, latitude = 42164.17, math.radians(82.0)
    above = radius * math.cos(latitude) - EARTH
    return "wrong" if above < 0.0 else "confirmed"


def units(printed: str, needed: str) -> Route:
    """Two units: of one dimension, and of one size where numbers are to fit."""

    def route(document: Rows, key: str) -> str:
        one, other = UNITS.Quantity(1, printed), UNITS.Quantity(1, needed)
        fits = one.dimensionality == other.dimensionality and math.isclose((one / other).to_base_units().magnitude, 1.0)
        return "confirmed" if fits else "unit error"

    return route


def not_earth(document: Rows, key: str) -> str:
    """1 km and 1 degree per second make another central body than the Earth; as plain numbers they are normalised."""
    body = 1.0**3 * math.radians(1.0) ** 2
    assert [value for _, value in document[key]["printed"]] == ["1", "1"]
    return "wrong" if abs(body / MU - 1.0) > 0.5 else "confirmed"


def degrees(document: Rows, key: str) -> str:
    """r theta_dot^2 with 1 km and 1 degree per second is not 1 km/s^2."""
    return "unit error" if not math.isclose(1.0 * math.radians(1.0) ** 2, 1.0) else "confirmed"


def force(document: Rows, key: str) -> str:
    """A mass of 1 kg gains 1 km/s in a second by 1000 N."""
    return "unit error" if UNITS.Quantity(1, "kg*km/s**2").to("newton").magnitude != 1.0 else "confirmed"


def ellipse(document: Rows, key: str) -> str:
    """Once round in a day on an ellipse in the plane of the equator: ahead of the Earth after the perigee."""
    e, mean = 0.1, 1.0
    eccentric = brentq(lambda x: x - e * math.sin(x) - mean, 0.0, math.pi)
    true = 2.0 * math.atan(math.sqrt((1.0 + e) / (1.0 - e)) * math.tan(eccentric / 2.0))
    assert "eccentricity" not in document[key]["printed"]
    return "notation" if true - mean > 0.1 else "confirmed"


def one_too_few(document: Rows, key: str) -> str:
    assert document[key]["printed"] == "n"
    return "misprint" if len(np.linspace(0.0, 60.0, 7 + 1)) == 7 + 1 else "confirmed"
