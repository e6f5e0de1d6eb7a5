"""Times satsym beside its peers and prints one table a subject: `make bench`.

Ratios are multiples of a table's first row, formed pair by pair from runs that took turns; nothing is left out, lost
rows included. Times of different machines do not compare, ratios nearly do.
"""

from __future__ import annotations

from time import perf_counter

import rows
from commands import commands
from ends import ends
from loops import sweeps, trajectories
from machine import described
from orbits import many as orbits
from regulators import many, one
from startup import startup

SUBJECTS = (trajectories, sweeps, commands, startup, ends, one, many, orbits)


def main() -> None:
    """Run every subject; exit code 0 whatever was reached, for a busy machine is no fault of the code."""
    start, tables = perf_counter(), []
    print(described(), flush=True)
    for subject in SUBJECTS:
        tables.append(subject())
        print(rows.text(tables[-1]), flush=True)
    print(f"\n{rows.summary(tables)}, {perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
