"""Audits hundreds of ledgers that nobody would write: ``python -m tests.bench.fuzz_ledgers [COUNT] [FIRST]``.

Each must end with verdicts or with one line that names what is wrong: no traceback, no warning, no more than a
gigabyte, and no more work than a row may take. The seconds that are printed are of the process, and decide nothing.
"""

from __future__ import annotations

import contextlib
import io
import os
import resource
import sys
import tempfile
import time
import warnings
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from satsym.cli import main
from tests.support.ledger_fuzz import ledger

ADDRESS_SPACE = 4 << 30
"""Bytes that the process may map; what it holds is reported."""


@dataclass(frozen=True)
class Ended:
    """How the audit of a ledger ended."""

    seed: int
    code: int
    line: str
    warned: tuple[str, ...]
    seconds: float

    @property
    def fault(self) -> str:
        """What must not be; empty where all is well."""
        if self.code not in (0, 3):
            return f"exit {self.code}: {self.line}"
        if self.warned:
            return f"warns: {self.warned[0]}"
        return f"several lines: {self.line}" if self.code == 3 and "\n" in self.line else ""


def audited(seed: int, folder: Path) -> Ended:
    """Audit the ledger of a seed, in this process."""
    path = folder / f"fuzz_{seed}.toml"
    path.write_text(ledger(seed), encoding="utf-8")
    out, err, start = io.StringIO(), io.StringIO(), time.process_time()
    with warnings.catch_warnings(record=True) as warned, contextlib.redirect_stdout(out):
        warnings.simplefilter("always")
        with contextlib.redirect_stderr(err):
            code = main(["audit", str(path), "--fresh"])
    seconds = time.process_time() - start
    return Ended(seed, code, err.getvalue().strip(), tuple(str(w.message) for w in warned), seconds)


def bench(count: int, first: int) -> int:
    """Audit some ledgers one after the other; the number of faults."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    codes: Counter[int] = Counter()
    faults, slowest, refused = 0, [(0.0, 0)], 0
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        for seed in range(first, first + count):
            ended = audited(seed, Path(folder))
            codes[ended.code] += 1
            refused += "operations" in ended.line
            slowest = sorted([*slowest, (ended.seconds, seed)], reverse=True)[:5]
            if ended.fault:
                faults += 1
                sys.stdout.write(f"seed {seed}: {ended.fault}\n")
                sys.stdout.flush()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    sys.stdout.write(
        f"{count} ledgers: {codes[0]} judged, {codes[3]} refused, {refused} of them for their work, {faults} faults; "
        f"at most {memory:.0f} MB; slowest {', '.join(f'{s:.1f} s (seed {n})' for s, n in slowest)}\n"
    )
    return faults


if __name__ == "__main__":
    numbers = [int(argument) for argument in sys.argv[1:]]
    sys.exit(bool(bench(*(numbers + [500, 0][len(numbers) :]))))
