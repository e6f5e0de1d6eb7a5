"""Arguments and options that several commands have."""

from __future__ import annotations

from pathlib import Path

import click

json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
subject_argument = click.argument("subject", metavar="X")
out_option = click.option(
    "--out",
    metavar="DIR",
    type=click.Path(path_type=Path),
    help="Write trajectory.npz, trajectory.csv and result.json there.",
)
plot_option = click.option("--plot", is_flag=True, help="Draw pictures too; without --out into results/NAME.")
