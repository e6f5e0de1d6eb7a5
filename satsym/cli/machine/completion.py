"""``satsym completion``: let a shell complete commands, options and names."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from satsym.cli.help import command
from satsym.cli.output import emit
from satsym.status import ExitCode

SHELLS = ("bash", "zsh", "fish")

EXAMPLES = """\b
Examples:
  source <(satsym completion bash)      for this session; put the line into ~/.bashrc to keep it
  source <(satsym completion zsh)       in ~/.zshrc, after compinit
  satsym completion fish > ~/.config/fish/completions/satsym.fish"""


@command(epilog=EXAMPLES)
@click.argument("shell", metavar="SHELL", type=click.Choice(SHELLS))
def completion(shell: str) -> ExitCode:
    """Print the completion script for a SHELL: bash, zsh or fish.

    With this script, the TAB key completes commands, options, and the names of instances, models and documents.
    """
    complete = get_completion_class(shell)
    assert complete is not None  # of all that may be chosen
    # as of a shell of a supported version; the class itself would look for the shell's program
    own = complete(click.get_current_context().find_root().command, {}, "satsym", "_SATSYM_COMPLETE")
    emit(own.source_template % own.source_vars())
    return ExitCode.DONE
