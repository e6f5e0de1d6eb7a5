"""``satsym new``: files to start from."""

from __future__ import annotations

import re
from pathlib import Path

import click

from satsym.cli.help import command
from satsym.cli.options import place_option
from satsym.cli.output import tell
from satsym.report.said import say
from satsym.status import BadInput, ExitCode

EXAMPLES = """\b
Examples:
  satsym new my_model                           a model of your own, in my_model/
  satsym new my_case --instance soft-return     my_case.toml, ready to be edited"""

TEMPLATES = Path(__file__).parents[2] / "templates"
FILES = {
    "model.py.txt": ("{}.py", "the model: its motion and its cost"),
    "instance.toml": ("{}.toml", "an instance: the data of one case"),
    "test.py.txt": ("test_{}.py", "a test of the solution against equations typed by hand"),
}
_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_FILE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*\Z")


@command(epilog=EXAMPLES)
@click.argument("name")
@click.option("--instance", "original", metavar="X", help="Copy this shipped instance to NAME.toml instead.")
@place_option(
    "--out",
    metavar="DIR",
    help="Write to this folder; by default a model goes into NAME/ and an instance into the current folder.",
)
def new(name: str, original: str | None, out: Path | None) -> ExitCode:
    """Start a new model, or copy a shipped instance.

    A new model consists of three files that run as they are: a commented derivation file, an instance, and a test.
    Existing files are never overwritten.
    """
    from satsym.report.results.files import check_writable, write_text

    texts, following = _model(name, out or Path(name)) if original is None else _copy(name, original, out or Path())
    for path in texts:
        if path.exists():
            raise BadInput(f"{path}: already exists and is not overwritten; choose another name, or give --out DIR")
    folder = next(iter(texts)).parent
    check_writable(folder)
    for path, (text, _) in texts.items():
        write_text(path, text)
    width = max(len(str(path)) for path in texts)
    made = (f"{path!s:{width}}  {what}" for path, (_, what) in texts.items())
    tell("\n".join([*made, "", say("Next:"), *following]))
    return ExitCode.DONE


def _model(name: str, folder: Path) -> tuple[dict[Path, tuple[str, str]], list[str]]:
    """Return the files of a new model by path, with descriptions, and the commands to continue with."""
    import keyword
    import sys

    from satsym import kernels
    from satsym.wording import shown

    if keyword.iskeyword(name):
        raise BadInput(f"NAME: {name} is a Python keyword; choose another name, such as my_{name}")
    if not _NAME.match(name):
        raise BadInput(
            f"NAME: got {shown(name)}; use lower-case letters, digits and single underscores, such as my_model"
        )
    if name in {*sys.stdlib_module_names, "numpy", "pytest", "satsym", "scipy", "sympy"}:
        raise BadInput(f"NAME: {name}.py would hide a module that Python imports; choose another name")
    if name in kernels.shipped():
        raise BadInput(f"NAME: {name} is a model that comes with satsym; choose another name")
    texts = {}
    for template, (pattern, what) in FILES.items():
        text = (TEMPLATES / template).read_text(encoding="utf-8").replace("$name", name)
        texts[folder / pattern.format(name)] = (text, say(what))
    model, instance, test = texts
    return texts, [
        f"  satsym derive {model} --out {folder / 'generated'}",
        f"  satsym solve {instance} --plot",
        f"  python -m pytest {test}",
    ]


def _copy(name: str, original: str, folder: Path) -> tuple[dict[Path, tuple[str, str]], list[str]]:
    from satsym import instance
    from satsym.instance import files
    from satsym.wording import shown

    if not _FILE.match(name):
        raise BadInput(f"NAME: got {shown(name)}; use letters, digits, - and _, such as my-case")
    if original not in files.shipped():
        files.locate(original)
        raise BadInput(
            f"--instance: {shown(original)} is a path; give the name of a shipped instance (`satsym instances` lists "
            "them)"
        )
    source = files.locate(original)
    path = folder / f"{name}.toml"
    command = "solve" if instance.load(original).model.spec.has_cost else "analyse"
    content = source.read_text(encoding="utf-8"), say("a copy of <name>", name=original)
    return {path: content}, [f"  satsym {command} {path} --plot"]
