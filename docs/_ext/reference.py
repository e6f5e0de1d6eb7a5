"""The command line and the names of Python, as the program itself says them."""

import inspect
import os
import re
from importlib import import_module
from pathlib import Path
from typing import Any

import click
from sphinx.application import Sphinx

GROUPS = {
    "Instances and solutions": (
        "load Instance solve Solution simulate front.solution.Trajectory front.curves.Curve export"
    ),
    "Certificates and proofs": "solution.Certificate solution.Check solution.Competitors prove",
    "Many instances": "study front.studies.Study solvers.repeated.Repeated",
    "Linear systems and orbits": "analyse lqr front.analysing.Analysis front.analysing.Regulator",
    "Derivations": "derive front.derivation.Derivation front.derivation.Equation check audit front.auditing.Audit",
    "Defining a model": "Variable FirstOrder Newton Problem Free Box Ball Annulus Angle",
}
"""Names in satsym, and in its modules, by what they are for."""
SHOWN_WHOLE = list(GROUPS)[:-1]
"""With methods and properties; what is stated is on a page of its own."""
MEMBERS = "   :members:\n   :inherited-members: Mapping, Generic, ABC, NDArrayOperatorsMixin\n"
COMMANDS = """This page lists every command with its options and examples, as `satsym COMMAND --help` prints them. For
tasks, see [how to](../howto.md); for a first use, see [start in five minutes](../start.md).
"""
HEAD = "<!-- Written by `make docs`: do not edit. -->\n"


def commands() -> str:
    """Each command with its help."""
    os.environ["COLUMNS"] = "80"
    from satsym.cli.app import program

    context = program.make_context("satsym", [], resilient_parsing=True)
    parts = [HEAD, "# Commands\n", COMMANDS, _block(program.get_help(context))]
    for name in program.list_commands(context):
        command = program.get_command(context, name)
        inside = click.Context(command, info_name=name, parent=context)
        parts.append(f"## satsym {name}\n\n{_block(command.get_help(inside))}")
    return "\n".join(parts)


def interface() -> str:
    """Each public name, and what it returns, with signature and docstring."""
    import satsym

    if missing := set(satsym.__all__).difference(*(names.split() for names in GROUPS.values())):
        raise ValueError(f"docs/_ext/reference.py: in no group: {sorted(missing)}")
    parts = [HEAD, "# In Python\n", "`import satsym` loads nothing; each name is loaded when it is first used.\n"]
    for title, names in GROUPS.items():
        parts.append(f"## {title}\n\n```{{eval-rst}}")
        for name in names.split():
            value, path = _found(name)
            kind = "class" if inspect.isclass(value) else "function"
            parts.append(f".. auto{kind}:: {path}\n" + (MEMBERS if title in SHOWN_WHOLE and kind == "class" else ""))
        parts.append("```\n")
    return "\n".join(parts)


def _found(name: str) -> tuple[object, str]:
    """What has a name, and the path that it is known by: those without a dot are satsym's own."""
    module, _, last = f"satsym.{name}".rpartition(".")
    return getattr(import_module(module), last), f"{module}.{last}"


def _block(text: str) -> str:
    return f"```text\n{text.strip()}\n```\n"


def _write(app: Sphinx) -> None:
    folder = Path(app.srcdir, "reference")
    folder.mkdir(exist_ok=True)
    for name, text in (("commands", commands()), ("python", interface())):
        path = folder / f"{name}.md"
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def _legible(app: Sphinx, what: str, name: str, value: object, options: object, signature: Any, returns: Any) -> Any:
    """A signature without the modules of types, and with empty mappings where dataclasses make them."""
    if not signature:
        return None
    legible = re.sub(r"~(?:\w+\.)+", "", signature).replace("<factory>", "{}")
    return legible.replace("lambda _: ...", "lambda _: None"), returns


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension with Sphinx."""
    app.connect("autodoc-process-signature", _legible)
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True}
