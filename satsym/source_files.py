"""Source files: derivations by name, and which modules of satsym a module is made of.

What was computed once need not be computed again as long as the code that computed it is the same. That code is found
by reading import statements, also those inside functions, without importing anything.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

from satsym.spec import is_name
from satsym.status import BadInput

SUFFIX = ".py"
GENERATED = "satsym.generated"
LEDGER = "ledger.toml"
"""The name of the head of a ledger that is a folder."""
DATA = ".toml"

_HOME = Path(__file__).parent
_ROOT = __name__.partition(".")[0]
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+(?P<package>[.\w]+)[ \t]+)?import\b[ \t]*"
    r"(?P<names>\((?:[^()#]|#[^\n]*)*\)|[^\n#]+)",
    re.MULTILINE,
)
_BY_NAME = re.compile(r"\bimport_module\(")


def shipped() -> list[Path]:
    """Return the derivation files that come with satsym, by name; the examples after the others."""
    folder = Path(str(files("satsym.derivations")))
    found = (sorted(place.glob(f"*{SUFFIX}")) for place in (folder, folder / "examples"))
    return [p for paths in found for p in paths if not p.name.startswith("_")]


def translations(path: Path) -> dict[str, Path]:
    """Return files beside a derivation file that translate its phrases, by language.

    An example is ``NAME.id.toml`` beside ``NAME.py``.
    """
    own = re.compile(rf"{re.escape(path.stem)}\.([a-z]{{2,3}}){re.escape(DATA)}")
    return {found[1]: each for each in sorted(path.parent.iterdir()) if (found := own.fullmatch(each.name))}


def phrases(path: Path) -> dict[str, str]:
    """Return the phrases of a translation, and what they are in its language.

    Raises
    ------
    ValueError
        If it is no such file: TOML, with a line ``"velocity" = "kecepatan"`` for each phrase.
    """
    import tomllib

    found = tomllib.loads(path.read_text(encoding="utf-8"))
    if odd := next((phrase for phrase, text in found.items() if not isinstance(text, str)), None):
        raise ValueError(f'{odd}: not a text; write lines such as "velocity" = "kecepatan"')
    return found


def models() -> list[str]:
    """Return the names of the generated models that come with satsym, without importing them."""
    found = {file.stem for folder in generated() for file in folder.glob(f"*{SUFFIX}")}
    return sorted(name for name in found if is_name(name))


def is_model(name: str) -> bool:
    """Tell whether a generated model of this name comes with satsym."""
    return is_name(name) and any((folder / f"{name}{SUFFIX}").is_file() for folder in generated())


def generated() -> list[Path]:
    """Return the folder of the generated modules."""
    found = find_spec(GENERATED)
    return [Path(folder) for folder in (found and found.submodule_search_locations) or ()]


def documents() -> list[Path]:
    """Return the ledgers that come with satsym, by name; each is a folder with a head."""
    folder = Path(str(files("satsym.derivations"))) / "documents"
    return sorted(path.parent for path in folder.glob(f"*/{LEDGER}"))


def find(name_or_path: str, folder: Path | None = None) -> Path:
    """Return the derivation file of a name, or at a path.

    Parameters
    ----------
    name_or_path
        A path ending in ``.py``; or a name: the file in ``folder`` if there is one, else the shipped one.
    folder
        Folder of the file that asks.

    Raises
    ------
    BadInput
        If there is none.
    """
    if name_or_path.endswith(SUFFIX):
        path = Path(name_or_path)
        if path.is_file():
            return path
        raise BadInput(f"{name_or_path}: no such derivation file; give the path of a .py file")
    candidates = [folder / f"{name_or_path}{SUFFIX}"] if folder else []
    candidates += [p for p in shipped() if p.stem == name_or_path]
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    known = ", ".join(p.stem for p in shipped())
    raise BadInput(f"{name_or_path}: no such derivation; give a file ending in {SUFFIX}, or one of {known}")


def digest_of(path: Path) -> str:
    """Return a digest of a file's content, whatever its line ends; empty where there is no file."""
    try:
        return hashlib.blake2b(path.read_bytes().replace(b"\r\n", b"\n"), digest_size=16).hexdigest()
    except OSError:
        return ""


def digest(modules: Iterable[str]) -> str:
    """Return a digest of the code of some modules and of all modules of satsym they import, with data files."""
    found = hashlib.blake2b(digest_size=16)
    for path in reached(tuple(modules)):
        found.update(path.relative_to(_HOME).as_posix().encode())
        found.update(digest_of(path).encode())
    return found.hexdigest()


@cache
def reached(modules: tuple[str, ...]) -> tuple[Path, ...]:
    """Return the files of some modules, of all modules of satsym they import, and the data in their folders.

    A module that imports others by names which are computed counts as importing all in its folder. The topmost package
    is there whatever is imported, and hands out the others only when it is asked to: what it imports does not count.
    """
    waiting, known = [path for name in modules for path in _files_of(name)], set()
    while waiting:
        path = waiting.pop()
        if path in known:
            continue
        known.add(path)
        known.update(_data(path.parent))
        if path.suffix == SUFFIX and path != _HOME / "__init__.py":
            waiting += _imported(path)
    return tuple(sorted(known))


def _imported(path: Path) -> Iterator[Path]:
    text = path.read_text(encoding="utf-8")
    for name in imports(text, _module(path)):
        yield from _files_of(name)
    if _BY_NAME.search(text):
        yield from path.parent.rglob(f"*{SUFFIX}")


def imports(text: str, module: str = "") -> set[str]:
    """Return dotted names that a text may import; a name imported from a package may be a module of it."""
    found = set()
    for statement in _IMPORT.finditer(text):
        listed = re.sub(r"#[^\n]*|[()]", " ", statement["names"]).split(",")
        names = [name.split()[0] for name in listed if name.strip()]
        package = statement["package"]
        if package is None:
            found.update(names)
            continue
        if package.startswith("."):
            dots = len(package) - len(package.lstrip("."))
            above = module.split(".")[:-dots]
            package = ".".join([*above, *filter(None, [package.lstrip(".")])])
        found.update([package, *(f"{package}.{name}" for name in names)])
    return found


def _module(path: Path) -> str:
    """Return the dotted name of a file; a package's ``__init__`` has one of its own, for relative imports."""
    return ".".join([_ROOT, *path.relative_to(_HOME).with_suffix("").parts])


def _files_of(name: str) -> list[Path]:
    """Return the files that importing a dotted name executes, also of its packages; none outside satsym."""
    root, *parts = name.split(".")
    if root != _ROOT:
        return []
    around = ["/".join(parts[:depth]) for depth in range(len(parts) + 1)]
    names = [place for each in around for place in (f"{each}/__init__{SUFFIX}".lstrip("/"), f"{each}{SUFFIX}")]
    return [_modules()[place] for place in names if place in _modules()]


@cache
def _modules() -> dict[str, Path]:
    """Return all source files of satsym by their place in it."""
    return {path.relative_to(_HOME).as_posix(): path for path in _HOME.rglob(f"*{SUFFIX}")}


@cache
def _data(folder: Path) -> list[Path]:
    """Return the data files in a folder."""
    return list(folder.glob(f"*{DATA}"))
