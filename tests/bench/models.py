"""Two thousand random models that are right, and slips planted in them: what is refused, and how long it takes.

Each model is a derivation file, which is derived, generated, verified, written and loaded as `satsym derive FILE --out
DIR` and an instance do, in a process of its own. Then one term is changed, by 1e-6 to 1e-1 of itself, in what a step
derives, and one in the text of a function; the second is also loaded with a new digest, where only what contradicts
other functions can be seen.

    python -m tests.bench.models [--count 2000] [--first 0] [--slips 1] [--processes 1] [--keep DIR]

Of all models that are refused, or take more than 120 s of processor time, `--keep` writes the files.
"""

from __future__ import annotations

import argparse
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pickle
import random
import re
import resource
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import wait
from pathlib import Path
from types import FrameType

from satsym.kernels import loading
from satsym.report import artefacts
from satsym.status import BadInput
from satsym.symbolic import Derivation, Model, Problem, derive, loader
from tests.support import slips
from tests.support.random_models import random_model
from tests.support.slips import Slip

SECONDS = 120.0
"""Of processor time that a model may take."""

LONGER = 60.0
"""That it is given besides, for the slips."""

MEMORY = 4 * 2**30
"""Bytes that it may take."""

SHOWN = 10
"""Of the slowest models."""


class TimeUp(BaseException):
    """Nothing that handles errors of algebra handles it."""


@dataclass
class Outcome:
    """What came of one model.

    Attributes
    ----------
    stage
        The last one that was begun, ``"loaded"`` at the end of all; ``"slips"`` where those could not be planted.
    refusal
        Why it went no further.
    in_steps, in_texts, in_modules
        Slips, and what the module was refused with where it was loaded.
    """

    seed: int
    kind: str
    stage: str = "derived"
    refusal: str = ""
    seconds: float = 0.0
    in_steps: list[Slip] = field(default_factory=list)
    in_texts: list[Slip] = field(default_factory=list)
    in_modules: list[str] = field(default_factory=list)

    @property
    def bad(self) -> bool:
        """Whether it was refused or took too long."""
        return bool(self.refusal) or self.seconds > SECONDS


def attempt(seed: int, planted: int) -> Outcome:
    """Derive, generate and load a model, and plant slips in it."""
    statement = random_model(seed)
    found, began = Outcome(seed, statement.kind), time.process_time()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / f"stating_{seed}.py"
        path.write_text(statement.text(), encoding="utf-8")
        try:
            with loader.explained():
                (subject,) = loader.load(path)
                with loader.explained(path, subject):
                    kept = [derive(subject)]
                    found.stage = "generated"

                    def again(asked: Problem | Model) -> Derivation:
                        if asked is not subject:
                            kept.append(derive(asked))
                        return kept[-1]

                    made = artefacts.files(subject, again, path, folder)
            found.stage = "loaded"
            artefacts.write(made, folder)
            loading.load(f"./{subject.name}", folder)
        except (BadInput, TimeUp) as error:
            found.refusal = str(error).partition(": ")[2] if isinstance(error, BadInput) else "takes too long"
        except Exception as error:  # whatever it is, it is a finding
            found.refusal = f"{type(error).__name__}: {error}"
        found.seconds = time.process_time() - began
        if not found.bad:
            try:
                _plant(found, kept[-1], made[f"{subject.name}.py"], folder, planted)
            except Exception as error:
                found.stage, found.refusal = "slips", f"{type(error).__name__}: {error}"
    return found


def _plant(found: Outcome, derivation: Derivation, text: str, folder: Path, count: int) -> None:
    rng = random.Random(f"slips {found.seed}")
    for k in range(count):
        if (slip := slips.in_step(derivation, rng)) is not None:
            found.in_steps.append(slip)
        if (changed := slips.in_text(derivation, text, rng)) is not None:
            seen = slips.in_module(changed[1], f"changed{k}", folder)
            found.in_texts.append(changed[0])
            found.in_modules.append(seen)


def _alone(seed: int, planted: int, end: int) -> None:
    """In a process of its own: send the outcome and end."""

    def over(_sign: int, _frame: FrameType | None) -> None:
        raise TimeUp

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    # a library that never comes back to Python hears no signal; the system ends it then
    most = int(SECONDS + 2.0 * LONGER)
    resource.setrlimit(resource.RLIMIT_CPU, (most, most))
    signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, SECONDS + LONGER, 1.0)
    try:
        found = attempt(seed, planted)
    except TimeUp:
        found = Outcome(seed, random_model(seed).kind, "slips", "takes too long")
    signal.setitimer(signal.ITIMER_PROF, 0.0)
    with os.fdopen(end, "wb") as pipe:
        pickle.dump(found, pipe)
    os._exit(0)


def outcomes(seeds: Sequence[int], planted: int, processes: int) -> Iterator[Outcome]:
    """Those of all models, each derived in a fork of this process."""
    running: dict[int, tuple[int, int]] = {}
    left = list(reversed(seeds))
    while left or running:
        while left and len(running) < processes:
            seed = left.pop()
            out, end = os.pipe()
            if (process := os.fork()) == 0:
                os.close(out)
                _alone(seed, planted, end)
            os.close(end)
            running[out] = (seed, process)
        for out in wait(list(running)):
            seed, process = running.pop(out)
            with os.fdopen(out, "rb") as pipe:
                sent = pipe.read()
            os.waitpid(process, 0)
            yield pickle.loads(sent) if sent else Outcome(seed, random_model(seed).kind, "?", "ended without a word")


def kind_of(refusal: str) -> str:
    """A refusal without the names and numbers in it."""
    short = re.sub(r"model\d+(_\w+)?|\./\w+", "M", refusal)
    short = re.sub(r"\d\.?\d*(e[+-]\d+)?", "0", short)
    return re.sub(r"generated \w+|\w+ contradicts", "F", short)[:110]


def report(found: Sequence[Outcome], wall: float) -> Iterator[str]:
    """Tables: what was refused, what took longest, and which slips were seen."""
    bad = [one for one in found if one.bad]
    total = sum(one.seconds for one in found)
    yield f"{len(found)} models, {len(found) - len(bad)} derived, generated and loaded; {total:.0f} s of {wall:.0f} s"
    kinds = Counter(one.kind for one in found)
    yield "  " + ", ".join(f"{kind} {count}" for kind, count in kinds.most_common())
    refused: dict[str, list[Outcome]] = defaultdict(list)
    for one in bad:
        refused[kind_of(one.refusal or "takes too long")].append(one)
    for kind, those in sorted(refused.items(), key=lambda item: -len(item[1])):
        yield f"{len(those):5d} {kind}  (models {', '.join(str(one.seed) for one in those[:6])})"
    yield "slowest, in seconds of processor time:"
    for one in sorted(found, key=lambda each: -each.seconds)[:SHOWN]:
        yield f"{one.seconds:7.1f}  model {one.seed} ({one.kind})"
    yield from _planted("slips in steps", [(one, slip, slip.caught) for one in found for slip in one.in_steps])
    yield from _planted("slips in texts", [(one, slip, slip.caught) for one in found for slip in one.in_texts])
    loaded = [(one, *each) for one in found for each in zip(one.in_texts, one.in_modules, strict=True)]
    yield from _planted("the same in modules that are loaded", loaded)


def _planted(title: str, tried: Sequence[tuple[Outcome, Slip, str]]) -> Iterator[str]:
    """How many were caught, by how much of their sums they change; those that were not."""
    real = [(one, slip, caught) for one, slip, caught in tried if slip.effect or caught]
    seen = sum(1 for *_, caught in real if caught)
    yield f"{title}: {len(real)} planted, {seen} caught; {len(tried) - len(real)} without any effect"
    decades: dict[int, list[bool]] = defaultdict(list)
    for _, slip, caught in real:
        decades[slip.decade].append(bool(caught))
    for decade, those in sorted(decades.items()):
        yield f"    1e{decade:+03d} of the sum: {sum(those)} of {len(those)}"
    for one, slip, caught in real:
        if not caught:
            share = f"{slip.change:.1e} of a term that is {slip.share:.1e} of its sum"
            yield f"    missed: model {one.seed}, {slip.place}: {share}, {slip.term}"


def main() -> int:
    """Run what the command line asks for; how many models or slips are not as they should be, at most one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("--count", 2000), ("--first", 0), ("--slips", 1), ("--processes", 1)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    began, found = time.monotonic(), []
    for one in outcomes(range(given.first, given.first + given.count), given.slips, given.processes):
        found.append(one)
        if one.bad:
            print(f"model {one.seed} ({one.kind}), {one.seconds:.0f} s: {one.stage}: {one.refusal}", flush=True)
            if given.keep:
                given.keep.mkdir(parents=True, exist_ok=True)
                text = f"# {one.refusal}\n{random_model(one.seed).text()}"
                (given.keep / f"model{one.seed}.py").write_text(text, encoding="utf-8")
    print("\n".join(report(found, time.monotonic() - began)))
    missed = any(slip.effect and not slip.caught for one in found for slip in (*one.in_steps, *one.in_texts))
    return int(missed or any(one.bad for one in found))


if __name__ == "__main__":
    sys.exit(main())
