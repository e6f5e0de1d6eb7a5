"""Arguments and options that several commands share."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from satsym.cli import names
from satsym.cli.output import VOICE, Voice
from satsym.report import said, texts
from satsym.report.look import FORMATS, SCREEN, SIZES, Look
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.instance import Instance


class Place(click.Path):
    """The type of an option for a path to write or read; the empty path, the current folder, is refused."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert a value as click does.

        Raises
        ------
        BadInput
            If it is empty.
        """
        if value == "":
            name = param.opts[-1] if param else "path"
            raise BadInput(f"{name}: the name is empty; give a name, or . for the current folder")
        return super().convert(value, param, ctx)


def place_option(*names: str, metavar: str, help: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Declare an option that takes a path."""
    return click.option(*names, metavar=metavar, type=Place(), help=help)


class Language(click.ParamType):
    """The type of an option for a language with texts."""

    name = "language"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the value, if it is a language.

        Raises
        ------
        BadInput
            If it is none.
        """
        return said.known(value, "--lang")


def _spoken(_context: click.Context, _option: click.Parameter, value: str | None) -> None:
    if value is not None:
        said.ask(value)


language_option = click.option(
    "--lang",
    type=Language(),
    metavar=f"[{'|'.join(texts.languages())}]",
    expose_value=False,
    is_eager=True,
    callback=_spoken,
    help=f"Language of the output; by default the one that {said.VARIABLE} names, or English.",
)


def _voice(asked: Voice) -> Callable[[click.Context, click.Parameter, bool], None]:
    def heard(_context: click.Context, _option: click.Parameter, value: bool) -> None:
        if value:
            VOICE.set(asked)

    return heard


_quiet = click.option(
    "--quiet",
    "-q",
    is_flag=True,
    expose_value=False,
    callback=_voice(Voice.QUIET),
    help="Print errors only; results go into files, or are printed with --json.",
)
_verbose = click.option(
    "--verbose",
    "-v",
    is_flag=True,
    expose_value=False,
    callback=_voice(Voice.VERBOSE),
    help="Report progress line by line on stderr.",
)


def shared_options(command: Any) -> Any:
    """Add the options that all commands have."""
    return _quiet(_verbose(language_option(command)))


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
long_option = click.option("--long", "whole", is_flag=True, help="List all entries in one table, with their details.")
subject_argument = click.argument("subject", metavar="X", shell_complete=names.completed(names.instances))
trajectory_option = place_option(
    "--out",
    metavar="DIR",
    help="Write trajectory.npz, trajectory.csv, instance.toml and result.json to this folder, replacing any "
    "earlier result.",
)
out_option = place_option(
    "--out", metavar="DIR", help="Write result.json to this folder, replacing any earlier result."
)

set_option = click.option(
    "--set",
    "values",
    multiple=True,
    metavar="KEY=VALUE",
    help="Change a value of the instance, such as initial.r=1.05; for the keys, see `satsym study`.",
)


def with_values(case: Instance, values: Sequence[str]) -> tuple[Instance, dict[str, float]]:
    """Return an instance with the values of ``--set``, and these by key.

    The module of studies, which reads them, is loaded only if there are any.
    """
    if not values:
        return case, {}
    from satsym.instance.numbers import changed
    from satsym.studies.reading import settings

    given = settings(case, values)
    return changed(case, given), given


def plot_options(command: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Add the options of pictures, as ``look``, to a command with results in a folder of its name."""
    drawn = click.option(
        "--plot", is_flag=True, help=f"Also draw pictures. Without --out, all files go into results/NAME/{command}."
    )

    def decorated(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def called(*, plot: bool, formats: tuple[str, ...], size: str | None, untitled: bool, **arguments: Any) -> Any:
            if (formats or size or untitled) and not plot:
                raise click.UsageError("--format, --size and --no-title require --plot.")
            return function(look=_look(formats, untitled, size) if plot else None, **arguments)

        return drawn(_format_option(_size_option(_title_option(called))))

    return decorated


def look_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of how pictures look, as ``look``, to a command that only draws."""

    @functools.wraps(function)
    def called(*, formats: tuple[str, ...], size: str | None, untitled: bool, **arguments: Any) -> Any:
        return function(look=_look(formats, untitled, size), **arguments)

    return _format_option(_size_option(_title_option(called)))


def _look(formats: tuple[str, ...], untitled: bool, size: str | None) -> Look:
    return Look(tuple(dict.fromkeys(formats)) or SCREEN.formats, not untitled, size or SCREEN.size)


_format_option = click.option(
    "--format",
    "formats",
    metavar="KIND",
    type=click.Choice(FORMATS),
    multiple=True,
    help=f"File format of the pictures: {', '.join(FORMATS)}. May be given several times; png by default.",
)
_size_option = click.option(
    "--size",
    metavar="SIZE",
    type=click.Choice(tuple(SIZES)),
    help=f"Size of the pictures: {', '.join(f'{name} ({what})' for name, what in SIZES.items())}.",
)
_title_option = click.option(
    "--no-title", "untitled", is_flag=True, help="Leave out the titles, for pictures that have a caption."
)
