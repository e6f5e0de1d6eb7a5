"""The command line: thin commands, one file each; everything they do is a function elsewhere."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

__all__ = ["main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    argv
        Arguments after the program's name; those of the process by default.

    Returns
    -------
    int
        Exit code, see :class:`satsym.status.ExitCode`; 130 and 141 where the user or a closed pipe ended it.
    """
    # Read when NumPy is loaded: on matrices as small as ours, threads cost several times what they save.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from satsym.cli.app import run

        return run(argv)
    except KeyboardInterrupt:  # while the command was still being loaded
        sys.stderr.write("\nsatsym: interrupted\n")
        return 130
