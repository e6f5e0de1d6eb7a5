"""``satsym models``: what instances can name as their model."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import answer
from satsym.status import ExitCode

EXAMPLES = """\b
Examples:
  satsym models
  satsym models polar_orbit             its states, controls and parameters, with units and defaults
  satsym models DIR/my_model            one that `satsym derive my_model.py --out DIR` wrote"""


@command(epilog=EXAMPLES)
@click.argument("model", required=False, shell_complete=names.completed(names.models))
@json_option
def models(model: str | None, as_json: bool) -> ExitCode:
    """List the models that instances can be made of.

    With MODEL, describe that one in full.
    """
    from satsym import kernels
    from satsym.report.results.objects import model_object
    from satsym.report.terminal.listing import model_text, models_text

    specs = [kernels.load(name, Path()).spec for name in ([model] if model else kernels.shipped())]
    answer(
        as_json,
        {"models": [model_object(spec) for spec in specs]},
        lambda: model_text(specs[0]) if model else models_text(specs),
    )
    return ExitCode.DONE
