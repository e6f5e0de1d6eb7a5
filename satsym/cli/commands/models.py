"""``satsym models``: what instances can name as their model."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, long_option
from satsym.cli.output import answer
from satsym.status import ExitCode

EXAMPLES = """\b
Examples:
  satsym models
  satsym models --long                  with states and controls
  satsym models polar_orbit             its states, controls and parameters, with units and defaults
  satsym models DIR/my_model            a model written by `satsym derive my_model.py --out DIR`"""


@command(epilog=EXAMPLES)
@click.argument("model", required=False, shell_complete=names.completed(names.models))
@long_option
@json_option
def models(model: str | None, whole: bool, as_json: bool) -> ExitCode:
    """List the models, by subject.

    With MODEL, describe that model in full: states, controls and parameters, with their units and defaults.
    """
    from satsym import kernels
    from satsym.report.results.objects import model_object
    from satsym.report.terminal.listing import model_text, models_text

    specs = [kernels.load(name, Path()).spec for name in ([model] if model else kernels.shipped())]
    answer(
        as_json,
        {"models": [model_object(spec) for spec in specs]},
        lambda: model_text(specs[0]) if model else models_text(specs, whole),
    )
    return ExitCode.DONE
