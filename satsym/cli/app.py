"""The program ``satsym``: its commands in the order of their use, and the handling of errors.

Commands load what they need when they run, so that ``--help`` loads nothing but click.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextvars import copy_context
from functools import cache
from importlib import import_module
from typing import Any, cast

import click

from satsym.cli.help import Explained, show_usage, wanted_language
from satsym.cli.options import language_option, shared_options
from satsym.cli.output import Unheard, complain, hearable, silence, unless_unwritable
from satsym.cli.stopping import comes_of_a_stop, stopped
from satsym.report import said, texts
from satsym.report.said import explained
from satsym.status import BadInput, ExitCode
from satsym.version import __version__
from satsym.wording import printable

CLOSED_PIPE = 141
"""Exit code with which the shell reports programs that SIGPIPE ended."""

OVERVIEW = """\b
Start here:
  satsym instances                       the shipped problems
  satsym solve soft-return --plot        solve one, with pictures
  satsym latex polar_orbit -o orbit.tex  typeset its derivation
  satsym audit its_thesis                audit the derivation in a thesis

\b
Exit codes: 0 done, 2 wrong usage, 3 bad input file, 4 no solution,
5 certificate fails, 6 generated files are stale, 1 unexpected error
(set SATSYM_DEBUG=1 to see where it occurred).

`satsym COMMAND --help` has examples."""


COMMANDS = (
    "models",
    "instances",
    "new",
    "solve",
    "certify",
    "prove",
    "simulate",
    "study",
    "plot",
    "compare",
    "analyse",
    "lqr",
    "derive",
    "latex",
    "report",
    "export",
    "check",
    "read",
    "audit",
    "completion",
    "doctor",
    "bench",
)
"""Names of the commands in the order of the help."""

ABOUT_THE_MACHINE = frozenset({"bench", "completion", "doctor"})
"""Names of the commands in the room ``machine``; the others are in ``commands``."""


class Commands(Mapping[str, click.Command]):
    """The commands by name; each is loaded from the module of its name when it is looked up.

    What starts one command need not wait for all of them.
    """

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)

    def __getitem__(self, name: str) -> click.Command:
        if name not in COMMANDS:
            raise KeyError(name)
        return _loaded(name)


@cache
def _loaded(name: str) -> click.Command:
    room = "machine" if name in ABOUT_THE_MACHINE else "commands"
    command: Any = getattr(import_module(f"satsym.cli.{room}.{name}"), name)
    return shared_options(command)


class Program(Explained, click.Group):
    """The group of commands; errors end it with an exit code or one line on stderr, never with a traceback."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options and the commands of the program."""
        super().format_options(ctx, formatter)
        with formatter.section(explained("Commands")):
            widest = max(map(len, self.commands))
            room = formatter.width - 6 - widest
            formatter.write_dl([(name, self.commands[name].get_short_help_str(room)) for name in self.commands])

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit):
            raise
        except (Exception, KeyboardInterrupt) as error:
            return stopped(error) if comes_of_a_stop(error) else _failed(error)


@click.group(
    cls=Program,
    commands=cast(Any, Commands()),  # click asks for a mapping that can be written, and only reads it
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=OVERVIEW,
)
@language_option
@click.version_option(__version__, message="satsym %(version)s")
def program() -> None:
    """Derive, solve, typeset and audit the optimal control of satellites."""


def run(argv: Sequence[str] | None = None) -> int:
    """Run the program on these arguments and give its exit code."""
    return copy_context().run(_run, argv)  # the language that one run asks for is none of the next one's


def _run(argv: Sequence[str] | None) -> int:
    try:
        arguments = list(sys.argv[1:] if argv is None else argv)
        said.ask(wanted_language(arguments, ("en", *texts.languages())) or said.language())
        with hearable():  # help and usage are written by click itself
            outcome = program.main(arguments, prog_name="satsym", standalone_mode=False)
    except click.ClickException as error:
        with unless_unwritable():
            show_usage(error)
        return error.exit_code
    except click.Abort as error:  # what click makes of an interruption
        return stopped(error.__cause__ or error)
    except Unheard as error:
        return _unheard(error)
    except BadInput as error:  # before any command: no such language
        said.ask("en")
        complain(str(error))
        return ExitCode.BAD_INPUT
    return int(outcome or 0)


def _failed(error: BaseException) -> int:
    """Report in one line the error that ended a command, and return its exit code."""
    if isinstance(error, Unheard):
        return _unheard(error)
    if isinstance(error, BadInput):
        complain(str(error))
        return ExitCode.BAD_INPUT
    _unforeseen(error)
    return ExitCode.UNFORESEEN


def _unheard(error: Unheard) -> int:
    """Return the exit code where stdout cannot be written to, with a line unless a pipe was closed."""
    silence(sys.stdout)
    if isinstance(error.cause, BrokenPipeError):
        return CLOSED_PIPE
    reason = error.cause.strerror or "not open"
    complain(said.say("the standard output cannot be written (<reason>); redirect it", reason=reason))
    return ExitCode.BAD_INPUT


def _unforeseen(error: BaseException) -> None:
    if os.environ.get("SATSYM_DEBUG"):
        import traceback

        complain("\n" + "".join(traceback.format_exception(error)))
        return
    what = printable(" ".join(str(error).split()), 300)
    about = f"{type(error).__name__}{what and ': '}{what}"
    complain(said.say("unexpected <error> (set SATSYM_DEBUG=1 to see where)", error=about))
