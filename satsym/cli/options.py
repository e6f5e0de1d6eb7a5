"""Arguments and options that several commands have."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from satsym.report import texts
from satsym.status import BadInput


class Place(click.Path):
    """A path to write to or to read from; none is empty, which would be the current folder."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """As of click.

        Raises
        ------
        BadInput
            If it is empty.
        """
        if value == "":
            name = param.opts[-1] if param else "path"
            raise BadInput(f"{name}: the name is empty; give one, or . for the current folder")
        return super().convert(value, param, ctx)


def place_option(*names: str, metavar: str, help: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """An option that takes a path."""
    return click.option(*names, metavar=metavar, type=Place(), help=help)


language_option = click.option(
    "--lang",
    "language",
    type=click.Choice(texts.languages()),
    default="en",
    help="Language of the text.",
    show_default=True,
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
subject_argument = click.argument("subject", metavar="X")
trajectory_option = place_option(
    "--out", metavar="DIR", help="Write trajectory.npz, trajectory.csv and result.json there; they replace a result."
)
out_option = place_option("--out", metavar="DIR", help="Write result.json there; it replaces a result.")


def plot_option(command: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Whether to draw, for a command, whose results go into a folder of its name."""
    return click.option(
        "--plot", is_flag=True, help=f"Draw pictures too; without --out into results/NAME/{command}, with all else."
    )
