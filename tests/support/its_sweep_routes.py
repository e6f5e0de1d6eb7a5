"""The numerical methods that the ITS documents print, judged a second time: series by hand, and the listing executed.

The lines of the listing are turned into Python as they stand and run; nothing of satsym is used.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from tests.support.its_routes import Rows

INDICES = {"(i+1)": "[i+1]", "(j+1)": "[j+1]", "(i)": "[i]", "(j)": "[j]"}
HALF = {"1": 0.0, "2": 0.5, "3": 0.5, "4": 1.0}
PATH_START, COSTATES = (1.2, 0.1, 0.0, 0.8), (0.3, -0.2, 0.1, 0.4)


def python(line: str) -> str:
    """A MATLAB line as Python over arrays that are counted from zero."""
    text = line.rstrip(";").replace(".*", "*").replace("./", "/").replace(".^", "**")
    for matlab, ours in INDICES.items():
        text = text.replace(matlab, ours)
    return text


# ------------------------------------------------------------------ formulas of chapter 2, by series


def inconsistent(document: Rows, key: str) -> str:
    """For y' = y: the step over h, as h goes to zero, must be y. Stages that are not printed are the textbook's."""
    y, h = sp.symbols("y h")
    printed = {int(n): "h" in row["printed"].split("y_n")[-1] for n, row in _stages(document).items()}
    chosen = [int(n) for n, row in _stages(document).items() if row is document[key]] or [1, 2, 3, 4]
    fractions, slopes = {1: 0, 2: sp.Rational(1, 2), 3: sp.Rational(1, 2), 4: 1}, [y]
    for n in (2, 3, 4):
        step = h if n not in chosen or printed[n] else 1
        slopes.append(y + step * fractions[n] * slopes[-1])
    total = (slopes[0] + 2 * slopes[1] + 2 * slopes[2] + slopes[3]) / 6
    return "confirmed" if sp.simplify(total.subs(h, 0) - y) == 0 else "wrong"


def _stages(document: Rows) -> dict[str, object]:
    names = {"k1": "II (18)", "k2": "II (19)", "k3": "II (20)", "k4": "II (21)"}
    return {k[1]: document.get(f"2.19 {k}", document.get(name)) for k, name in names.items()}  # type: ignore[misc]


def fifth_power(document: Rows, key: str) -> str:
    """What one step of the textbook's method leaves of exp(h)."""
    h = sp.Symbol("h")
    k1 = sp.Integer(1)
    k2 = 1 + h / 2 * k1
    k3 = 1 + h / 2 * k2
    k4 = 1 + h * k3
    left = sp.series(sp.exp(h) - 1 - h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), h, 0, 7).removeO()
    power = sp.Poly(left, h).monoms()[-1][0]
    return "wrong" if power == 5 else "confirmed"


# ------------------------------------------------------------------ section 4.4, backwards


def rates(x: Sequence[float]) -> list[float]:
    return [x[1], x[0] * x[3] ** 2 - 1 / x[0] ** 2, x[3], -2 * x[1] * x[3] / x[0]]


def slope(x: Sequence[float]) -> np.ndarray:
    """Costates change at the rate -F' lambda."""
    r, v, _, w = x
    f = np.array(
        [[0, 1, 0, 0], [2 / r**3 + w**2, 0, 0, 2 * r * w], [0, 0, 0, 1], [2 * v * w / r**2, -2 * w / r, 0, -2 * v / r]]
    )
    return -f.T


@cache
def path() -> Callable[[float], np.ndarray]:
    found = solve_ivp(
        lambda _, x: rates(x), (0, 1), PATH_START, method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True
    )
    return found.sol  # type: ignore[no-any-return]


@cache
def first_costates() -> np.ndarray:
    found = solve_ivp(lambda s, y: slope(path()(s)) @ y, (1, 0), COSTATES, method="DOP853", rtol=1e-12, atol=1e-13)
    return found.y[:, -1]  # type: ignore[no-any-return]


def frozen_states(document: Rows, key: str) -> str:
    """Order one: halving the step halves the error that is made with the states of node n in a stage."""
    found = re.search(r"k(\d) of lambda(\d)", key)
    stages, component = ((int(found[1]),), int(found[2]) - 1) if found else ((2, 3, 4), None)

    def error(n: int) -> float:
        h, y = 1.0 / n, np.array(COSTATES)
        for i in range(n, 0, -1):
            ks: list[np.ndarray] = []
            for k in (1, 2, 3, 4):
                at = y - (HALF[str(k)] * ks[-1] if ks else 0.0)
                stage = h * slope(path()((i - HALF[str(k)]) * h)) @ at
                held = h * slope(path()(i * h)) @ at
                if k in stages:
                    stage = held if component is None else np.where(np.arange(4) == component, held, stage)
                ks.append(stage)
            y = y - (ks[0] + 2 * ks[1] + 2 * ks[2] + ks[3]) / 6
        return float(np.abs(y - first_costates()).max())

    return "wrong" if 1.7 < error(40) / error(80) < 2.3 else "confirmed"


def frozen_controls(document: Rows, key: str) -> str:
    """The state after a step, as a series in h, where a control grows like t: off by h^2 with that of node n."""
    found = re.search(r"k(\d) of x", key)
    stages = (int(found[1]),) if found else (2, 3, 4)
    h, rate = sp.Symbol("h"), sp.Integer(1)
    slopes = [rate * h * (0 if k in stages else share) for k, share in zip((1, 2, 3, 4), (0, 0.5, 0.5, 1), strict=True)]
    step = h * sum(w * s for w, s in zip((1, 2, 2, 1), slopes, strict=True)) / 6
    assert all("u1_n, u2_n" in document[f"section 4.4 step 5, k{k} of x2"]["printed"] for k in stages)
    return "wrong" if sp.simplify(step - rate * h**2 / 2) != 0 else "confirmed"


def index_slip(document: Rows, key: str) -> str:
    """lambda3 does not change here; the printed formula makes it lambda1 in one step. The listing has it right."""
    values = {f"k{k}_lambda{i}": 0.0 for k in (1, 2, 3, 4) for i in (1, 2, 3, 4)} | {"lambda1_n": 0.7, "lambda3_n": 0.2}
    assert "lambda3(j+1)" in document["appendix B costate, lambda3(j)"]["original"]
    found = eval(document[key]["printed"].partition("=")[2].strip(), {}, values)  # noqa: S307, our own ledger
    return "confirmed" if found == 0.2 else "misprint"


def zero_over_zero(document: Rows, key: str) -> str:
    with np.errstate(invalid="ignore"):
        return "wrong" if np.isnan(-np.zeros(1) / np.zeros(1)).all() else "confirmed"


# ------------------------------------------------------------------ appendix B


def line_of_the_listing(document: Rows, key: str) -> str:
    """A line, executed at random numbers, against the textbook's, and against itself with h = 1 inside the stages."""
    loop, name = re.fullmatch(r"appendix B (\w+), (\S+)", key).groups()  # type: ignore[union-attr]
    line = document[key]["original"]
    rng = np.random.default_rng(len(line))
    arrays = {f"x{i}{s}": rng.uniform(0.5, 1.5, 3) for i in range(1, 5) for s in ("", "s")}
    arrays |= {f"lambda{i}": rng.uniform(-1, 1, 3) for i in range(1, 5)} | {
        f"u{i}": rng.uniform(0, 1, 3) for i in (1, 2)
    }
    ks = {
        f"k{k}_{v}": rng.uniform(-1, 1)
        for k in range(1, 5)
        for v in (*(f"x{i}s" for i in range(1, 5)), "l1", "l2", "l3", "l4")
    }
    ks |= {f"{v}{k}": rng.uniform(-1, 1) for v in "abed" for k in range(1, 5)}
    ks |= {f"{p}{i}": rng.uniform(-1, 1) for p in ("kx", "kl") for i in range(1, 5)} | {
        v: rng.uniform(-1, 1) for v in "abed"
    }
    known = {**arrays, **ks, "h": 0.3, "sigma": 1.3, "omega": 0.7, "u1_0": 0.2, "u2_0": -0.4, "i": 0, "j": 0}
    found = eval(python(line).partition("=")[2], {}, known)  # noqa: S307, our own ledger
    return "confirmed" if math.isclose(found, textbook(loop, name, known), rel_tol=1e-12) else "wrong"


def textbook(loop: str, name: str, known: dict) -> float:
    """What a line of the classical method gives, with the rates written down once more."""
    h, sg, om = known["h"], known["sigma"], known["omega"]
    names = {"initial": "abed", "state": ["x1s", "x2s", "x3s", "x4s"], "costate": ["l1", "l2", "l3", "l4"]}[loop]
    arrays = {
        "initial": ["x1", "x2", "x3", "x4"],
        "state": names,
        "costate": ["lambda1", "lambda2", "lambda3", "lambda4"],
    }[loop]
    stage_name = (lambda k, v: f"{v}{k}") if loop == "initial" else (lambda k, v: f"k{k}_{v}")
    for i, (v, array) in enumerate(zip(names, arrays, strict=True)):
        increment = {"initial": v, "state": f"kx{i + 1}", "costate": f"kl{i + 1}"}[loop]
        if name.startswith(array + "("):
            return known[array][1 if loop == "costate" else 0] + (-1 if loop == "costate" else 1) * known[increment]
        if name == increment:
            return sum(w * known[stage_name(k, v)] for k, w in zip("1234", (1, 2, 2, 1), strict=True)) / 6
        for k in "1234":
            if name != stage_name(k, v):
                continue
            here, there, sign = (1, 0, -1) if loop == "costate" else (0, 1, 1)
            fraction = HALF[k]
            before = stage_name(str(int(k) - 1), "{}") if k != "1" else ""
            y = [
                known[a][here] + sign * (fraction * known[before.format(w)] if before else 0)
                for a, w in zip(arrays, names, strict=True)
            ]
            x = [(1 - fraction) * known[f"x{n}s"][here] + fraction * known[f"x{n}s"][there] for n in range(1, 5)]
            u = [(1 - fraction) * known[f"u{n}"][here] + fraction * known[f"u{n}"][there] for n in (1, 2)]
            if loop == "initial":
                rate = [y[1], 3 * om**2 * y[0] + 2 * om * y[3] + known["u1_0"], y[3], -2 * om * y[1] + known["u2_0"]]
            elif loop == "state":
                rate = [
                    y[1],
                    y[0] * y[3] ** 2 - sg**3 * om**2 / y[0] ** 2 + u[0],
                    y[3],
                    (u[1] - 2 * y[1] * y[3]) / y[0],
                ]
            else:
                pull = 2 * sg**3 * om**2 / x[0] ** 3 + x[3] ** 2
                rate = [
                    -pull * y[1] - (2 * x[1] * x[3] - u[1]) / x[0] ** 2 * y[3],
                    -y[0] + 2 * x[3] / x[0] * y[3],
                    0.0,
                    -2 * x[0] * x[3] * y[1] - y[2] + 2 * x[1] / x[0] * y[3],
                ]
            return h * rate[i]
    raise AssertionError(f"{loop}: {name}")


@cache
def program(lines: tuple[str, ...]) -> Callable[[dict], None]:
    """The body of a loop as a function of its variables."""
    source = "\n".join(python(line) for line in lines)
    code = compile(source, "listing", "exec")
    return lambda variables: exec(code, {}, variables)  # noqa: S102, our own ledger


def body(document: Rows, loop: str) -> tuple[str, ...]:
    """The lines of a loop in their order, without the one that comes too early."""
    return tuple(
        row["original"]
        for key, row in document.items()
        if key.startswith(f"appendix B {loop}, ") and row.get("scope") == "listing"
    )


def run_loop(
    document: Rows, loop: str, n: int, start: Sequence[float], tf: float, x: np.ndarray | None = None
) -> np.ndarray:
    """A loop executed as printed, sigma = omega = 1, without control; states (or costates) at the nodes."""
    arrays = {f"x{i}{s}": np.zeros(n + 1) for i in range(1, 5) for s in ("", "s")}
    arrays |= {f"lambda{i}": np.zeros(n + 1) for i in range(1, 5)} | {f"u{i}": np.zeros(n + 1) for i in (1, 2)}
    names = {"initial": "x{}", "state": "x{}s", "costate": "lambda{}"}[loop]
    if x is not None:
        arrays |= {f"x{i + 1}s": x[i].copy() for i in range(4)}
    for i, value in enumerate(start):
        arrays[names.format(i + 1)][n if loop == "costate" else 0] = value
    variables = {**arrays, "h": tf / n, "sigma": 1.0, "omega": 1.0, "u1_0": 0.0, "u2_0": 0.0}
    step = program(body(document, loop))
    for i in range(n):
        step(variables | {"i": i, "j": n - 1 - i})
    return np.array([arrays[names.format(i + 1)] for i in range(4)])


def first_order_loop(document: Rows, key: str) -> str:
    """Order one: the executed loop's error halves with the step."""
    loop = key.split()[2].rstrip(",")
    linear = np.array([[0, 1, 0, 0], [3, 0, 0, 2], [0, 0, 0, 1], [0, -2, 0, 0]], dtype=float)

    def error(n: int) -> float:
        if loop == "initial":
            return float(np.abs(run_loop(document, loop, n, PATH_START, 1.0)[:, -1] - expm(linear) @ PATH_START).max())
        if loop == "state":
            return float(np.abs(run_loop(document, loop, n, PATH_START, 1.0)[:, -1] - path()(1.0)).max())
        x = path()(np.linspace(0.0, 1.0, n + 1))
        return float(np.abs(run_loop(document, loop, n, COSTATES, 1.0, x)[:, 0] - first_costates()).max())

    return "wrong" if 1.7 < error(100) / error(200) < 2.3 else "confirmed"


def not_yet_defined(document: Rows, key: str) -> str:
    variables = {"x4s": np.ones(2), "i": 0}
    try:
        exec(python(document[key]["printed"][0]), {}, variables)  # noqa: S102, our own ledger
    except NameError:
        return "wrong"
    return "confirmed"


def least_squares(document: Rows, key: str) -> str:
    """MATLAB's b/a of two rows solves q a = b in the sense of least squares: one number."""
    lambda4, x1 = np.array([[0.1, -0.4, 0.3]]), np.array([[1.0, 1.5, 2.0]])
    q = np.linalg.lstsq(x1.T, -lambda4.T, rcond=None)[0]
    return "wrong" if q.size == 1 and not np.allclose(q, -lambda4 / x1) else "confirmed"


def backward_test(document: Rows, key: str) -> str:
    """From the guess 0.01 the law 0 gives 0.005: the controls changed by all of themselves, and the loop ends."""
    tol, old, new, n = 0.01, 0.01, 0.005, 250
    error = tol * (n + 1) * new - (n + 1) * (old - new)
    settled = tol * (n + 1) * 0.2 - 0.0
    return "wrong" if not error > tol and settled > tol else "confirmed"


def guess_for_ever(document: Rows, key: str) -> str:
    """The loop gone through twenty times with the law 0: with the last control for oldu1 it would come to 0."""
    names = {"u1sb": np.zeros(3), "u2sb": np.zeros(3), "oldu1": np.ones(3), "oldu2": np.ones(3), "tol": 0.01}
    for _ in range(20):
        for line in document[key]["printed"]:
            exec(python(line).replace("sum", "np.sum").replace("abs", "np.abs"), {"np": np}, names)  # noqa: S102, our own ledger
    return "wrong" if np.allclose(names["u1"], 0.5) else "confirmed"
