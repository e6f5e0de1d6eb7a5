"""The command line and the names of Python, as the program itself says them."""

import inspect
import os
from pathlib import Path

import click
from sphinx.application import Sphinx

HEAD = "<!-- Written by `make docs`: do not edit. -->\n"


def commands() -> str:
    """Each command with its help."""
    os.environ["COLUMNS"] = "80"
    from satsym.cli.app import program

    context = program.make_context("satsym", [], resilient_parsing=True)
    parts = [HEAD, "# Commands\n", _block(program.get_help(context))]
    for name in program.list_commands(context):
        command = program.get_command(context, name)
        inside = click.Context(command, info_name=name, parent=context)
        parts.append(f"## satsym {name}\n\n{_block(command.get_help(inside))}")
    return "\n".join(parts)


def interface() -> str:
    """Each public name with its signature and what its docstring says."""
    import satsym

    parts = [HEAD, "# In Python\n", "`import satsym` loads nothing; each name is loaded when it is first used.\n"]
    for name in satsym.__all__:
        value = getattr(satsym, name)
        parts.append(f"## satsym.{name}\n\n{_block(_signature(name, value) + chr(10) + (inspect.getdoc(value) or ''))}")
        for method, function in inspect.getmembers(value, inspect.isroutine) if inspect.isclass(value) else ():
            if not method.startswith("_") and inspect.getdoc(function) and function.__module__.startswith("satsym"):
                said = _signature(f"{name}.{method}", function) + "\n" + (inspect.getdoc(function) or "")
                parts.append(f"### {name}.{method}\n\n{_block(said)}")
    return "\n".join(parts)


def _signature(name: str, value: object) -> str:
    try:
        return f"{name}{inspect.signature(value)}\n"
    except (TypeError, ValueError):
        return f"{name}\n"


def _block(text: str) -> str:
    return f"```text\n{text.strip()}\n```\n"


def _write(app: Sphinx) -> None:
    folder = Path(app.srcdir, "reference")
    folder.mkdir(exist_ok=True)
    for name, text in (("commands", commands()), ("python", interface())):
        path = folder / f"{name}.md"
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """As Sphinx wants it."""
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True}
