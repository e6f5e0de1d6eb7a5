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

WIDTH, LINE, PAD, GAP, LEFT, MARGIN = 900, 18, 9, 8, 640, 12
"""Width of the picture, height of a line, space above and below text, gap between floors, width of the tower, and
margin, in pixels."""
BETWEEN = 4
"""Space between the rooms of a floor, in pixels."""
COLUMN = 128
"""Where in a floor the descriptions begin, in pixels: behind the longest name."""
CHARACTERS, BESIDE = 67, 24
"""Most characters of a line of a description, and of a line beside the tower."""
STYLE = (
    "text{font-family:Helvetica,Arial,sans-serif;fill:#1b1b1b}"
    ".name{font-size:15px;font-weight:bold}.about{font-size:14px}.note{font-size:14px;fill:#444}"
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
    return text.partition("\n")[0].replace("``", "")


def picture(root: Path = ROOT) -> str:
    """The picture as SVG: the floors above each other, and to the side what derives and generates."""
    top, lines = MARGIN, list[str]()
    for rooms in floors(root):
        tall, floor = _floor(top, rooms, root)
        lines += floor
        top += tall + GAP
    height = top - GAP + MARGIN
    head = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}">',
        f"<style>{STYLE}</style>",
        f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
    ]
    return "\n".join([*head, *lines, *_sides(root), "</svg>"]) + "\n"


def _floor(top: int, rooms: list[str], root: Path) -> tuple[int, list[str]]:
    """The height of a floor, and its rooms: for each one its name and what it is for."""
    texts, at = list[str](), top + PAD + LINE - 4
    for room in rooms:
        texts.append(f'<text class="name" x="{MARGIN + 10}" y="{at}">{escape(room)}</text>')
        for line in textwrap.wrap(purpose(room, root), CHARACTERS):
            texts.append(f'<text class="about" x="{MARGIN + COLUMN}" y="{at}">{escape(line)}</text>')
            at += LINE
        at += BETWEEN
    tall = at - BETWEEN - (top + PAD + LINE - 4) + 2 * PAD
    box = f'<rect x="{MARGIN}" y="{top}" width="{LEFT}" height="{tall}" rx="5" fill="{FILLS["tower"]}"/>'
    return tall, [box, *texts]


def _sides(root: Path) -> Iterator[str]:
    """What stands beside the tower, with who may call it."""
    left, wide, top = MARGIN + LEFT + 24, WIDTH - LEFT - 2 * MARGIN - 24, MARGIN
    for room in ("codegen", "symbolic"):
        lines = textwrap.wrap(purpose(room, root), BESIDE)
        called = textwrap.wrap("called by " + ", ".join(callers(room, root)) + " only", BESIDE)
        tall = 2 * PAD + (len(lines) + len(called) + 1) * LINE + 14
        yield f'<rect x="{left}" y="{top}" width="{wide}" height="{tall}" rx="5" fill="{FILLS["side"]}"/>'
        at = top + PAD + LINE - 4
        yield f'<text class="name" x="{left + 10}" y="{at}">{room}</text>'
        for kind, part, space in (("about", lines, 4), ("note", called, 10)):
            at += space
            for line in part:
                at += LINE
                yield f'<text class="{kind}" x="{left + 10}" y="{at}">{escape(line)}</text>'
        top += tall + GAP


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
