"""The command line: thin commands, one file each; everything they do is a function elsewhere."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence

from satsym.cli.stopping import stopped, terminable

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
        Exit code, see :class:`satsym.status.ExitCode`; 130, 141 and 143 where the user, a closed pipe or the system
        ended it.
    """
    # Read when NumPy is loaded: on matrices as small as ours, threads cost several times what they save.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if argv is None and not sys.warnoptions:
        # What libraries have to say of our arithmetic is for us, not for users; it is heard where warnings are asked
        # for (python -W), and in the tests.
        warnings.simplefilter("ignore")
    try:
        with terminable():
            from satsym.cli.app import run

            return run(argv)
    except KeyboardInterrupt as error:  # while the command was still being loaded, or was over
        return stopped(error)
