"""The help of commands, in the requested language.

It is written in English where a command is defined. Each paragraph, each remark beside an example and the help of each
option is a text of its own, whose translation is in ``help.toml`` of that language.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterator
from inspect import cleandoc
from itertools import pairwise
from typing import Any

import click

from satsym.report.said import explained, language, message

_AS_IT_IS = "\b\n"
"""The mark of paragraphs whose lines click keeps."""
_ENTRY = re.compile(r"(  \s*\S.*?)(?:(\s{2,})(\S.*))?")
"""A line with an example and its description."""


def texts(command: click.Command) -> Iterator[str]:
    """Return all texts in the help of a command."""
    for whole in (command.help, command.epilog):
        for paragraph in _paragraphs(whole or ""):
            entries = [_ENTRY.fullmatch(line) for line in paragraph.splitlines()]
            if any(entries):
                heads = (line for line, entry in zip(paragraph.splitlines(), entries, strict=True) if not entry)
                yield from (line for line in heads if line != _AS_IT_IS.strip("\n"))
                yield from (entry[3] for entry in entries if entry and entry[3])
            else:
                yield _joined(paragraph)
    yield from (option.help for option in command.params if isinstance(option, click.Option) and option.help)


def _paragraphs(text: str) -> list[str]:
    return [part for part in re.split(r"\n\s*\n", cleandoc(text)) if part.strip()]


def _joined(paragraph: str) -> str:
    return " ".join(paragraph.removeprefix(_AS_IT_IS).split())


def translated(text: str) -> str:
    """Return a docstring or an epilog in the requested language."""
    return cleandoc(text) if language() == "en" else "\n\n".join(map(_translated, _paragraphs(text)))


def _translated(paragraph: str) -> str:
    lines = paragraph.splitlines()
    if any(map(_ENTRY.fullmatch, lines)):
        return "\n".join(map(_line, lines))
    return explained(_joined(paragraph))


def _line(line: str) -> str:
    entry = _ENTRY.fullmatch(line)
    if entry is None:
        return explained(line)
    return f"{entry[1]}{entry[2]}{explained(entry[3])}" if entry[3] else line


class Explained(click.Command):
    """A command whose help is in the requested language."""

    def format_usage(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write how the command is called."""
        pieces = (explained(piece) for piece in self.collect_usage_pieces(ctx))
        formatter.write_usage(ctx.command_path, " ".join(pieces), f"{explained('Usage')}: ")

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write what the command does."""
        _write(formatter, self.help)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options of the command."""
        records = []
        for option in self.get_params(ctx):
            if isinstance(option, click.Option) and (record := option.get_help_record(ctx)) is not None:
                said = option.help or ""
                records.append((record[0], record[1].replace(said, explained(said)) if said else record[1]))
        if records:
            with formatter.section(explained("Options")):
                formatter.write_dl(records)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the examples and further remarks."""
        _write(formatter, self.epilog)

    def get_short_help_str(self, limit: int = 45) -> str:
        """Return what the command does, for its line in the list of commands."""
        if language() == "en":
            return super().get_short_help_str(limit)
        first = _translated(_paragraphs(self.help or "")[0]).rstrip(".")
        return first if len(first) <= limit else first[: limit - 3].rsplit(" ", 1)[0] + "..."


def _write(formatter: click.HelpFormatter, text: str | None) -> None:
    if text:
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(_laid_out(translated(text), formatter.width - formatter.current_indent))


def _laid_out(text: str, width: int) -> str:
    """Lay out paragraphs whose lines click keeps, as far as they fit; commands are never broken, for copying."""
    return "\n\n".join(_fitting(paragraph, width) for paragraph in text.split("\n\n"))


def _fitting(paragraph: str, width: int) -> str:
    """Set descriptions over several lines beside their entries, or below them where there is little room."""
    lines = paragraph.splitlines()
    entries = [_ENTRY.fullmatch(line) for line in lines]
    if max(map(len, lines)) <= width:
        return paragraph
    if not any(entries):
        return _joined(paragraph)
    beside = max((entry.start(3) for entry in entries if entry and entry[3]), default=0)
    stacked = beside > width // 2
    found: list[str] = []
    for line, entry in zip(lines, entries, strict=True):
        if entry and entry[3]:
            inset = " " * (len(line) - len(line.lstrip()) + 4 if stacked else entry.start(3))
            said = textwrap.wrap(entry[3], width, initial_indent=inset, subsequent_indent=inset)
            found += [entry[1], *said] if stacked else [line[: len(inset)] + said[0][len(inset) :], *said[1:]]
        else:
            found += [line] if entry or len(line) <= width else textwrap.wrap(line, width)
    return "\n".join(found)


def command(epilog: str) -> Callable[[Callable[..., Any]], click.Command]:
    """Declare a command with such help; ``epilog`` has its examples."""
    return click.command(cls=Explained, epilog=epilog)


def show_usage(error: click.ClickException) -> None:
    """Print a usage error on stderr, with click's wording translated."""
    if language() == "en":
        error.show()
        return
    where = error.ctx if isinstance(error, click.UsageError) else None
    if where is not None:
        hint = message(f"Try '{where.command_path} --help' for help.")
        click.echo(f"{where.get_usage()}\n{hint}\n", err=True)
    click.echo(f"{message('Error')}: {message(error.format_message())}", err=True)


def wanted_language(arguments: list[str], known: tuple[str, ...]) -> str | None:
    """Return the language that a command line requests anywhere in it, since help may come before the option."""
    for before, after in pairwise([*arguments, ""]):
        name = after if before == "--lang" else before.removeprefix("--lang=")
        if name in known and name != before:
            return name
    return None
