"""Derivation files with a mistake or two: words, numbers, signs, lines lost, doubled or in each other's place."""

from __future__ import annotations

import random
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
_TOKEN = re.compile(r"[A-Za-z_]\w*|\d+\.?\d*|\*\*|[-+*/=(),.\[\]{}\"']")
_NUMBERS = ("0", "-1", "1e400", 'float("nan")', "None", '"x"')

SMALL = """
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("place", "s", "m", "place on the road"),)
CONTROLS = (Variable("speed", "v", "m/s", "speed"),)
PARAMETERS = (Variable("c", "c", "s", "weight", 1.0, positive=True),)
(place,), (speed,), (c,) = map(symbols_of, (STATES, CONTROLS, PARAMETERS))
walk = FirstOrder(
    name="walk", title="A walk", states=STATES, controls=CONTROLS, parameters=PARAMETERS, rates={place: speed}
)
PROBLEMS = (
    Problem(name="stroll", title="A stroll", model=walk, running_cost=c * speed**2 / 2, terminal_cost=place**2),
)
"""
"""A model that is derived in no time."""


FOLLOWED = ("polar_orbit.py", "clohessy_wiltshire.py", "examples/transfer_fuel.py", "examples/bryson_denham.py")
"""Of the shipped files one of each make: Newton's law, a linearisation, a throttled vector, path constraints."""


def sound() -> list[str]:
    """Files that users begin with: the template, the page's examples, those that they may follow."""
    page = (ROOT / "docs" / "models.md").read_text(encoding="utf-8")
    examples = [text for text in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "PROBLEMS" in text]
    template = (ROOT / "satsym" / "templates" / "model.py.txt").read_text(encoding="utf-8").replace("$name", "mine")
    return [template, *examples, *((ROOT / "derivations" / one).read_text(encoding="utf-8") for one in FOLLOWED)]


def mutated(text: str, seed: int) -> str:
    """The text with one mistake or two, always the same ones for a seed."""
    rng = random.Random(seed)
    for _ in range(rng.randint(1, 2)):
        text = _mistaken(text, rng)
    return text


def _mistaken(text: str, rng: random.Random) -> str:
    tokens = list(_TOKEN.finditer(text))
    one, other = rng.choice(tokens), rng.choice(tokens)
    numbers = [token for token in tokens if token.group()[0].isdigit()]
    match rng.randrange(6):
        case 0:
            return text[: one.start()] + text[one.end() :]
        case 1:
            return text[: one.start()] + other.group() + text[one.end() :]
        case 2:
            return text[: one.start()] + 2 * one.group() + text[one.end() :]
        case 3:
            lines = text.splitlines(keepends=True)
            del lines[rng.randrange(len(lines))]
            return "".join(lines)
        case 4 if numbers:
            number = rng.choice(numbers)
            return text[: number.start()] + rng.choice(_NUMBERS) + text[number.end() :]
        case _:  # letters swapped, as typed in haste
            word = rng.choice([token for token in tokens if len(token.group()) > 2])
            at = word.start() + rng.randrange(len(word.group()) - 1)
            return text[:at] + text[at + 1] + text[at] + text[at + 2 :]
