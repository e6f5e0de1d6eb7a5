"""The picture of the architecture, made from the contracts in pyproject.toml: what may import what.

    python docs/_ext/floors.py

writes ``docs/_static/architecture.svg``; a test compares it with the contracts.
"""

import ast
import textwrap
import tomllib
from collections.abc import Iterator
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "_static" / "architecture.svg"

WIDTH, FLOOR, GAP, LEFT, MARGIN = 900, 66, 8, 640, 12
"""Width of the picture, height of a floor, gap between floors, width of the tower, and margin, in pixels."""
CHARACTERS, NAMES, BESIDE = 74, 62, 25
"""Most characters of a line that says what a floor is for, of a line of names, and of a line beside the tower."""
STYLE = (
    "text{font-family:Helvetica,Arial,sans-serif;fill:#1b1b1b}"
    ".name{font-size:16px;font-weight:bold}.about{font-size:14px}.note{font-size:14px;fill:#444}"
)
FILLS = {"tower": "#dbe9f6", "side": "#fbe3cf"}


def contracts(root: Path = ROOT) -> list[dict[str, object]]:
    """The contracts on imports, as pyproject.toml states them."""
    return list(tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"])


def floors(root: Path = ROOT) -> list[list[str]]:
    """The rooms on each floor of satsym/, from the top downwards."""
    layers = next(one["layers"] for one in contracts(root) if one.get("containers") == ["satsym"])
    return [[room.strip() for room in layer.replace("|", ":").split(":")] for layer in layers]


def callers(room: str, root: Path = ROOT) -> list[str]:
    """The rooms that may import one to the side, where a contract protects it."""
    found = (one for one in contracts(root) if one.get("protected_modules") == [f"satsym.{room}"])
    return [name.removeprefix("satsym.") for name in next(found)["allowed_importers"]]


def purpose(room: str, root: Path = ROOT) -> str:
    """The first sentence of a room's docstring."""
    folder = root / "satsym" / room
    path = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
    text = ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""
    return text.partition("\n")[0]


def picture(root: Path = ROOT) -> str:
    """The picture as SVG: the floors above each other, and to the side what derives and generates."""
    rows = floors(root)
    height = 2 * MARGIN + len(rows) * (FLOOR + GAP) - GAP
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}">',
        f"<style>{STYLE}</style>",
        f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
    ]
    for k, rooms in enumerate(rows):
        lines += _floor(MARGIN + k * (FLOOR + GAP), rooms, root)
    lines += _sides(height, root)
    return "\n".join([*lines, "</svg>"]) + "\n"


def _floor(top: int, rooms: list[str], root: Path) -> Iterator[str]:
    """One floor: its name and what it is for; or, where it holds several rooms, their names."""
    yield f'<rect x="{MARGIN}" y="{top}" width="{LEFT}" height="{FLOOR}" rx="5" fill="{FILLS["tower"]}"/>'
    lines = [("name", line) for line in textwrap.wrap(", ".join(rooms), NAMES)]
    if len(rooms) == 1:
        lines += [("about", line) for line in textwrap.wrap(purpose(rooms[0], root), CHARACTERS)[:2]]
    first = top + FLOOR // 2 + 5 - 9 * (len(lines) - 1)
    for k, (kind, line) in enumerate(lines):
        at = first + 18 * k
        yield f'<text class="{kind}" x="{MARGIN + 10}" y="{at}">{escape(line)}</text>'


def _sides(height: int, root: Path) -> Iterator[str]:
    """What stands beside the tower, with who may call it."""
    left, wide, tall = MARGIN + LEFT + 24, WIDTH - LEFT - 2 * MARGIN - 24, (height - 2 * MARGIN - GAP) // 2
    for k, room in enumerate(("codegen", "symbolic")):
        top = MARGIN + k * (tall + GAP)
        yield f'<rect x="{left}" y="{top}" width="{wide}" height="{tall}" rx="5" fill="{FILLS["side"]}"/>'
        yield f'<text class="name" x="{left + 10}" y="{top + 22}">{room}</text>'
        lines = textwrap.wrap(purpose(room, root), BESIDE)
        for j, line in enumerate(lines):
            yield f'<text class="about" x="{left + 10}" y="{top + 44 + 17 * j}">{escape(line)}</text>'
        called = textwrap.wrap("called by " + ", ".join(callers(room, root)) + " only", BESIDE)
        for j, line in enumerate(called):
            at = top + 58 + 17 * (len(lines) + j)
            yield f'<text class="note" x="{left + 10}" y="{at}">{escape(line)}</text>'


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
