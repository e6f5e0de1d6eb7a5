"""``satsym check``: one printed formula, judged."""

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
  satsym check '\\ddot x - 2n\\dot y - 3n^2x = 0' --model hill
  satsym check 'r_ddot = r*theta_dot^2 - mu/r^2 + u1' --model polar_orbit
  satsym check '\\dot\\lambda_1 = -\\frac{\\partial H}{\\partial x_1}' --model polar_orbit
  satsym check "x'' + x = u" --model van_der_pol --let x=x1 --let u=u
  satsym check 'v_dot = a - k v^2' --model DIR/sled      a model of your own, after satsym derive sled.py --out DIR

Put the formula in single quotes, so that the shell does not change its backslashes."""


@command(epilog=EXAMPLES)
@click.argument("formula", metavar="FORMULA")
@click.option(
    "--model",
    "model",
    metavar="NAME",
    required=True,
    help="The model against whose derivation the formula is checked: a shipped one, or DIR/NAME.",
    shell_complete=names.completed(names.models),
)
@click.option("--let", metavar="LETTER=NAME", multiple=True, help="What a printed letter means; may be repeated.")
@click.option("--free", is_flag=True, help="The formula describes the uncontrolled motion.")
@json_option
def check(formula: str, model: str, let: tuple[str, ...], free: bool, as_json: bool) -> ExitCode:
    """Check a printed formula, and name what is wrong with it.

    FORMULA is LaTeX or plain notation. The formula is compared with every equation that satsym derives for the model,
    in any rearrangement. Letters that the model does not have are guessed, and the guess is printed; --let corrects
    it. Exit codes: 0 right, 5 wrong, 4 undecided.
    """
    from satsym.auditing.check.answer import check_in
    from satsym.auditing.check.answers import as_object, worst
    from satsym.report.terminal.audit import checked_text

    found = check_in(formula, model, Path(), let, free)
    answer(as_json, as_object(formula, found), lambda: checked_text(found))
    return _CODES[worst(found).verdict]


_CODES = {"right": ExitCode.DONE, "wrong": ExitCode.CERTIFICATE_FAILED, "undecided": ExitCode.NO_ANSWER}
