"""Ledgers that nobody would write: shipped rows with slips in them, and rows made to go on without end. All seeded."""

from __future__ import annotations

import random
import re
from functools import cache

from satsym.auditing.ledger import documents
from tests.support.ledgers import HEAD, Row, row, text, whole

_NAMES = ("x1", "x2", "x3", "x4", "u1", "u2", "sigma", "omega", "lambda1", "p")
_OURS = ("r", "r_dot", "theta", "theta_dot", "u1", "u2", "sigma", "omega")
_CALLS = ("sin", "cos", "tan", "exp", "log", "sqrt", "abs", "sign", "sinh", "cosh", "atan", "asin")
_NUMBERS = ("0", "1", "20", "1e30", "0.5", "10**20", "999999999999", "1e-30", "1e400", "1" + "0" * 29, "1" * 5000)
_TOKEN = re.compile(r"[A-Za-z_][A-Za-z_0-9]*|[0-9.]+|\*\*|[-+*/()\[\],='\" ]")
_PROGRAM = (
    "import numpy as np",
    "from scipy.integrate import solve_ivp",
    "from scipy.linalg import eig",
    "a = np.ones(5)",
    "a = np.zeros((10**6, 10**6))",
    "a = np.zeros((300, 300))",
    "b = np.eye(316)",
    "c = eig(b)",
    "ok = all(eig(b) for x in np.zeros(99999))",
    "ok = all(all(y == y for y in np.zeros(99999)) for x in np.zeros(99999))",
    "s = f'{a}{a}{a}'",
    "a = [a, a, a, a, a, a, a, a, a, a]",
    "a = f'{a}{a}{a}{a}{a}{a}{a}{a}'",
    "a = np.array(a)",
    "v = np.zeros((1, 99999)) <= np.zeros((99999, 1))",
    "v = np.zeros((2, 40000))[[0, 1, 0, 1, 0, 1, 0]]",
    "x = 9.0**9**9**9",
    "x = " + "+".join(["1"] * 5000),
    "def f(t, y):\n    return np.sqrt(y)",
    "def g(n):\n    return g(n) + g(n)",
    "x = g(1)",
    "solution = solve_ivp(f, (1, 1e18), [1.0])",
    "solution = solve_ivp(f, (0, 1e9), [1.0], method='LSODA', rtol=1e-13, atol=1e-13)",
    "solution = solve_ivp(f, (0, 10), np.zeros(90000), method='Radau')",
    "solution = solve_ivp(np.sqrt, (1, 1e18), [1.0])",
    "t = np.linspace(0, 1, 10**9)",
    "print('a'*10**9)",
    "x = 'a'*10**9*10**9",
    "for i in range(10**12): x = i",
    "while True: x = 1",
)


def ledger(seed: int) -> str:
    """The text of the ledger of a seed."""
    rng = random.Random(seed)
    return _slipped(rng) if rng.random() < 0.6 else _hostile(rng)


@cache
def _shipped() -> tuple[tuple[str, tuple[str, ...]], ...]:
    """What stands before the rows of each shipped ledger, and its rows."""
    texts = [whole(path.name) for path in documents.shipped()]
    return tuple((head, tuple(rows)) for head, *rows in (whole.split("[[row]]") for whole in texts))


def _slipped(rng: random.Random) -> str:
    head, rows = rng.choice(_shipped())
    chosen = rng.sample(rows, 2)
    quoted = {name for entry in chosen for name in re.findall(r"'([^']+)'", entry)}
    chosen += [other for other in rows if other not in chosen and _key(other) in quoted]
    chosen[0] = _changed(rng, chosen[0])
    if rng.random() < 0.2:
        head = _changed(rng, head)
    return head + "".join(f"[[row]]{entry}" for entry in chosen)


def _key(entry: str) -> str:
    found = (re.search(rf'^{key} = "([^"]*)"', entry, re.M) for key in ("item", "part"))
    return " ".join(match[1] for match in found if match)


def _changed(rng: random.Random, block: str) -> str:
    """A block of lines with one to four tokens changed, where formulas stand."""
    for _ in range(rng.randint(1, 4)):
        places = [m for m in _TOKEN.finditer(block) if not m[0].isspace() and "= " in block[: m.start()]]
        match = rng.choice(places)
        token = match[0]
        new = rng.choice(
            [
                rng.choice(_NUMBERS),
                rng.choice(_NAMES),
                f"{rng.choice(_CALLS)}({token})",
                f"({token})**{rng.choice(_NUMBERS)}",
                f"{token}*{token}",
                "",
                rng.choice("+-*/()[],='"),
                "exp(exp(exp(20)))",
            ]
        )
        block = block[: match.start()] + new + block[match.end() :]
    return block


def _hostile(rng: random.Random) -> str:
    kind = rng.random()
    if kind < 0.45:
        printed, holds = _expression(rng, _NAMES, 5), _expression(rng, _OURS, 4)
        return text([row("1", printed, holds)])
    if kind < 0.65:
        return text([row("1", "x1", _matrices(rng))])
    if kind < 0.75:
        number = f"{rng.choice(_NUMBERS)} {rng.choice(['km', 'm**9*s**9', 'm**9**9', '1', 'deg'])}"
        return text([row("1", number, _expression(rng, ("altitude",), 3), "number")])
    if kind < 0.82:
        entries = "".join(f'\na{i} = "{_doubled(rng, i)}"' for i in range(1, 40))
        derived = f'\n[derived]\na0 = "r"{entries}\n'
        return text([row("1", "x1", "a39")], HEAD.replace("\n[inputs]", derived + "\n[inputs]"))
    lines = [*_PROGRAM[:3], *rng.choices(_PROGRAM, k=rng.randint(1, 12))]
    rows: list[Row] = [row("1", "\n".join(lines).split("\n"), "runs_through()", "claim")]
    return text(rows)


def _doubled(rng: random.Random, i: int) -> str:
    return rng.choice(["a{0}*a{0}", "sin(a{0}+a{0})", "exp(a{0})", "a{0}**20", "1/(a{0}+1)+a{0}"]).format(i - 1)


def _expression(rng: random.Random, names: tuple[str, ...], depth: int) -> str:
    if depth == 0 or rng.random() < 0.1:
        return rng.choice(names) if rng.random() < 0.8 else rng.choice(_NUMBERS)
    one, other = (_expression(rng, names, depth - 1) for _ in range(2))
    return rng.choice(
        [
            f"({one} + {other})",
            f"({one} - {other})",
            f"{one}*{other}",
            f"({one})/({other})",
            f"({one})**{rng.choice(['2', '3', '20', '0.5', '(1/3)', '(-7)'])}",
            f"{rng.choice(_CALLS)}({one})",
            f"{rng.choice(['min', 'max', 'atan2'])}({one}, {other})",
        ]
    )


def _matrices(rng: random.Random) -> str:
    n = rng.randint(2, 9)
    rows = ", ".join(f"[{', '.join(_expression(rng, _OURS, 1) for _ in range(n))}]" for _ in range(n))
    by = ", ".join(rng.choices(_OURS, k=rng.randint(1, 15)))
    return rng.choice(
        [
            f"det([{rows}])",
            f"entry(inverse([{rows}]), 1, 1)",
            f"entry(matrix([{rows}])**20, 1, 1)",
            f"det(controllability([{rows}], [{rows}]))",
            f"rank([{rows}])",
            f"diff({_expression(rng, _OURS, 4)}, {by})",
            f"subs({_expression(rng, _OURS, 3)}, r={_expression(rng, _OURS, 3)})",
            f"solve({_expression(rng, _OURS, 3)}*r + 1, r)",
        ]
    )
