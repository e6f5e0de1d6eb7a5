"""What users choose among by name in instance files, on the command line and in Python."""

from __future__ import annotations

from enum import Enum


class Choice(str, Enum):
    """One of some names."""

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Names of all choices."""
        return tuple(each.value for each in cls)


class Command(Choice):
    """What a study does with each row."""

    SOLVE = "solve"
    SIMULATE = "simulate"
    LQR = "lqr"


class Checked(Choice):
    """How much of a certificate answers get: none, all but competitors, these for some rows, or as ``satsym solve``."""

    NONE = "none"
    LOCAL = "local"
    SAMPLE = "sample"
    FULL = "full"


class TableFormat(Choice):
    """What the table of a study is written as."""

    CSV = "csv"
    PARQUET = "parquet"

    @property
    def file(self) -> str:
        """Name of the file of a table in this form."""
        return f"table.{self.value}"


class Sampling(Choice):
    """How a sample is drawn: Sobol' points with a random shift and scramble, Latin hypercubes, independent points."""

    SOBOL = "sobol"
    LHS = "lhs"
    RANDOM = "random"
