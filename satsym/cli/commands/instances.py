"""``satsym instances``: the shipped problems, and what an instance file may say."""

from __future__ import annotations

import click

from satsym.cli.help import command
from satsym.cli.options import json_option, long_option
from satsym.cli.output import answer, emit, emit_json
from satsym.status import ExitCode

EXAMPLES = """\b
Examples:
  satsym instances
  satsym instances --long               with model, boundary type, final time and bounds
  satsym instances soft-return          the instance file itself
  satsym instances --keys               every key of an instance file, with unit, default and meaning
  satsym instances --schema             the same, as a JSON Schema for use in editors

Boundary types: 1 final time and final state given; 2 final time free; 3 final state free, wholly or in part;
4 final time free and final state on the reference; 5 both free."""


@command(epilog=EXAMPLES)
@click.argument("name", metavar="[X]", required=False)
@click.option("--keys", is_flag=True, help="List every key of an instance file.")
@click.option("--schema", is_flag=True, help="Print the keys as a JSON Schema.")
@long_option
@json_option
def instances(name: str | None, keys: bool, schema: bool, whole: bool, as_json: bool) -> ExitCode:
    """List the shipped instances, by subject.

    An instance is a problem with its numerical data, ready to be solved. With X, print the file of that instance.
    """
    if sum((name is not None, keys, schema)) > 1:
        raise click.UsageError("Give only one of X, --keys and --schema.")
    if keys or schema:
        _said(schema or as_json)
    elif name is not None:
        _shown(name, as_json)
    else:
        _listed(as_json, whole)
    return ExitCode.DONE


def _said(as_schema: bool) -> None:
    """Print the keys that an instance file may have."""
    if as_schema:
        from satsym.instance.keys import json_schema

        emit_json(json_schema())
        return
    from satsym.report.terminal.keys import keys_text

    emit(keys_text())


def _shown(name: str, as_json: bool) -> None:
    """Print the file of one instance."""
    from satsym import instance
    from satsym.instance.files import locate, text
    from satsym.report.results.objects import instance_object
    from satsym.status import BadInput
    from satsym.wording import printable

    if as_json:
        emit_json(instance_object(instance.load(name)))
        return
    try:
        emit(text(locate(name)))
    except BadInput as error:
        raise BadInput(f"{printable(name, 200)}: {error}") from None


def _listed(as_json: bool, whole: bool) -> None:
    """Print all shipped instances."""
    from satsym import instance
    from satsym.report.results.objects import instance_object
    from satsym.report.terminal.listing import instances_text

    loaded = [instance.load(name) for name in instance.shipped()]
    answer(as_json, {"instances": [instance_object(each) for each in loaded]}, lambda: instances_text(loaded, whole))
