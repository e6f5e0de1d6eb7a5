"""Named choices of users in instance files, on the command line and in Python."""

from __future__ import annotations

from enum import Enum


class Choice(str, Enum):
    """The base class of named choices."""

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the names of all choices."""
        return tuple(each.value for each in cls)


class Command(Choice):
    """The command that a study applies to each row."""

    SOLVE = "solve"
    SIMULATE = "simulate"
    LQR = "lqr"


class Checked(Choice):
    """The extent of certificates in a study: none, all but competitors, these for some rows, or as ``satsym solve``."""

    NONE = "none"
    LOCAL = "local"
    SAMPLE = "sample"
    FULL = "full"


FEEDBACKS = ("none", "lqr", "classical", "switching", "pulses")
"""Control laws that a simulation can follow."""


class TableFormat(Choice):
    """The file format of a study's table."""

    CSV = "csv"
    PARQUET = "parquet"

    @property
    def file(self) -> str:
        """Return the name of a table's file in this format."""
        return f"table.{self.value}"


class Sampling(Choice):
    """The way to draw a sample: Sobol' points with random shift and scramble, Latin hypercubes, independent points."""

    SOBOL = "sobol"
    LHS = "lhs"
    RANDOM = "random"
