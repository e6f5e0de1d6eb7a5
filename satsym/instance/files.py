"""Instance files: finding them by name or path, and reading TOML that may contain anything."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from satsym import source_files
from satsym.status import BadInput
from satsym.wording import printable, shown, some, suggestion

SHIPPED = Path(__file__).parent.parent / "instances"
MAX_BYTES = 1_000_000

# tomllib takes time quadratic in the number of parts of a dotted key: more than a minute for 64000 of them
MAX_PARTS = 20
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MAX_PARTS}}}")
_MANY_DIGITS = re.compile(r"[0-9][0-9_]{4000,}")


def shipped() -> list[str]:
    """Return the names of the instances that come with satsym."""
    return sorted(path.stem for path in SHIPPED.glob("*.toml"))


def titles() -> dict[str, str]:
    """Return the titles of shipped instances by name, without reading a model."""
    return {name: read(SHIPPED / f"{name}.toml").get("title", "") for name in shipped()}


def locate(name_or_path: str) -> Path:
    """Return the file of a shipped instance, or the path that was given.

    Raises
    ------
    BadInput
        If it is neither a shipped name nor looks like a path.
    """
    path = Path(name_or_path)
    if path.name == name_or_path and _exists(own := SHIPPED / f"{name_or_path}.toml"):
        return own
    if path.suffix == ".toml" or len(path.parts) > 1 or _exists(path):
        return path
    raise BadInput(
        f"there is no instance of this name; {_instead(name_or_path)} (`satsym instances` lists all; or give the "
        "path of a TOML file)"
    )


def _instead(name: str) -> str:
    """Suggest what to write for an unknown name: a local file, an instance of a model, or a similar name."""
    if _exists(Path(f"{name}.toml")):
        return f'did you mean "{printable(name)}.toml"?'
    if source_files.is_model(name) and (
        own := [one for one in shipped() if read(SHIPPED / f"{one}.toml")["model"] == name]
    ):
        return f"instances of this model: {some(own)}"
    return suggestion(name, shipped())


def read(path: Path) -> dict[str, Any]:
    """Read a TOML file whose numbers are all finite.

    Raises
    ------
    BadInput
        For whatever keeps it from being read.
    """
    return parsed(text(path))


def parsed(found: str) -> dict[str, Any]:
    """Parse TOML whose numbers are all finite.

    Raises
    ------
    BadInput
        If it is something else.
    """
    if _LONG_KEY.search(found):
        raise BadInput(f"a key has more than {MAX_PARTS} parts joined by dots; see the shipped instances for the keys")
    return finite(_parse(found))


def finite(tree: dict[str, Any]) -> dict[str, Any]:
    """Return the tree of an instance file after a check that all its numbers are finite.

    Raises
    ------
    BadInput
        At the first that is not.
    """
    for key, value in _leaves(tree):
        if not _finite(value):
            raise BadInput(f"{key}: the number is {_excess(value)}; give a finite number")
    return tree


def _parse(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"not valid TOML: {printable(str(error), 150)}; {_repair(str(error))}") from None
    except RecursionError:
        raise BadInput("brackets are nested too deeply; a matrix needs only two levels") from None
    except ValueError:
        # Python reads no int of more than 4300 digits; one of a few hundred is too large as well, but has a key
        shorter = _MANY_DIGITS.sub("9" * 400, text)
        if shorter == text:
            raise BadInput("a number is out of range; give numbers with fewer digits") from None
    return _parse(shorter)


def _repair(error: str) -> str:
    """Suggest the usual repair for an error of the TOML parser."""
    if error.startswith("Invalid value"):
        return 'put text in quotes, as in "free"'
    if "end of document after" in error:
        return "correct the file at this place; numbers are written with a decimal point"
    return "correct the file at this place"


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def text(path: Path) -> str:
    """Return the text of an instance file, which may contain anything.

    Raises
    ------
    BadInput
        If it cannot be read, is too large, or is no text.
    """
    try:
        if path.suffix == ".py" and path.is_file():
            raise BadInput(
                "is a Python file, but a TOML file is needed; derive a model with `satsym derive FILE --out "
                'DIR`, then create an instance of the model that begins with model = "DIR/NAME"'
            )
        if path.is_dir():
            raise BadInput("is a directory; give the path of a TOML file")
        if not path.is_file():
            # also a device or a pipe, which might never end
            what = "is not a regular file" if path.exists() else "no such file"
            raise BadInput(f"{what}; give the path of a TOML file, or one of {some(shipped())}")
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a path"
        raise BadInput(f"cannot be read ({reason}); check its name and permissions") from None
    if len(data) > MAX_BYTES:
        raise BadInput(
            f"larger than {MAX_BYTES} bytes, which is too large for an instance file; remove what does not belong "
            "to the instance"
        )
    try:
        found = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadInput(f"not UTF-8 text (byte {error.start}); save it as UTF-8") from None
    if "\0" in found:
        raise BadInput("contains NUL characters, so it is not a text file; give the path of a TOML file")
    return found


def _leaves(tree: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield every value that is no table or list, in the file's order, with its key for messages."""
    stack: list[tuple[str, Any]] = [("", tree)]
    while stack:
        key, value = stack.pop()
        if isinstance(value, dict):
            stack.extend((_join(key, name, entry), entry) for name, entry in reversed(value.items()))
        elif isinstance(value, list):
            stack.extend((key, entry) for entry in reversed(value))
        else:
            yield key, value


def _join(table: str, name: str, value: Any) -> str:
    if isinstance(value, dict):
        name = f"[{table[1:-1]}.{name}]" if table else f"[{name}]"
    else:
        name = f"{table} {name}" if table else name
    return printable(name, 150)


def _finite(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return True
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _excess(value: Any) -> str:
    return shown(value) if isinstance(value, float) else "too large"
