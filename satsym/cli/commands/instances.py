"""``satsym instances``: what can be solved as it stands."""

from __future__ import annotations

import click

from satsym.cli.options import json_option
from satsym.cli.output import answer
from satsym.status import ExitCode

EXAMPLES = """\b
Example:
  satsym instances

The type is that of the transversality conditions: 1 final time and final state given, 2 final time free,
3 final state free, 4 final time free and final state on the reference, 5 both free."""


@click.command(epilog=EXAMPLES)
@json_option
def instances(as_json: bool) -> ExitCode:
    """List the instances that can be solved as they stand."""
    from satsym import instance
    from satsym.report.results.objects import instance_object
    from satsym.report.terminal.listing import instances_text

    loaded = [instance.load(name) for name in instance.shipped()]
    answer(as_json, {"instances": [instance_object(each) for each in loaded]}, lambda: instances_text(loaded))
    return ExitCode.DONE
