"""Three hundred files that pretend to be generated modules, each loaded by path from an instance.

Whatever the file, `satsym solve` ends within bounds of time and memory, with an exit code that says what it is, at most
one line of error, no warning and no traceback; and nothing happens that arithmetic does not do.

    python tests/bench/fuzz_generated.py [--count 300] [--seed 0]
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import io
import os
import random
import resource
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

GENERATED = Path(__file__).resolve().parents[2] / "generated"
MODELS = ("double_integrator_energy", "double_integrator_time")
SECONDS, MEGABYTES = 20.0, 700
"""That one file may take, and the memory of them all."""

CASE = """
model = "./fuzzed"
title = "Whatever comes"
[initial]
q = 0.0
q_dot = 0.0
[final]
q = 1.0
q_dot = 0.0
[time]
tf = {tf}
[control]
u1 = [-9.0, 9.0]
[solver]
max_seconds = 2.0
"""
HOSTILE = (
    *("__import__('os').system('touch it_ran')", "open('it_ran', 'w')", "eval('1')", "exec('1')", "().__class__"),
    *("(lambda: 1)()", "[x for x in ()]", "10**10**10", "1 << 10**9", "'a'*10**9", "np.load('a')", "math.__loader__"),
    *("f'{1}'", "await x", "yield", "(w := 1.0)", "1e999", "nan", "0x" + "f" * 9999, "globals()", "breakpoint()"),
)
FORBIDDEN = ("os.system", "os.exec", "os.posix_spawn", "os.fork", "os.remove", "subprocess.Popen", "socket.", "ctypes.")


def textual(rng: random.Random, text: str) -> str:
    """Some characters replaced, left out or put in."""
    for _ in range(rng.randint(1, 4)):
        start, length = rng.randrange(len(text)), rng.randint(0, 12)
        instead = "".join(rng.choice("abirx_.,:;=+-*/()[]{}'\"\\@# \n\t01e\0é") for _ in range(rng.randint(0, 8)))
        text = text[:start] + instead + text[start + length :]
    return text


def syntactic(rng: random.Random, text: str) -> str:
    """An expression or a statement put where another one was."""
    tree = ast.parse(text)
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    function = rng.choice(functions)
    for _ in range(rng.randint(1, 3)):
        nodes = list(ast.walk(function))
        kind = rng.choice((ast.expr, ast.expr, ast.stmt))
        places = [
            (values, k)
            for node in nodes
            for values in vars(node).values()
            if isinstance(values, list)
            for k, old in enumerate(values)
            if isinstance(old, kind)
        ]
        if places:
            values, k = rng.choice(places)
            values[k] = rng.choice([node for node in nodes if isinstance(node, kind) and node is not function])
    lines = text.splitlines()
    with contextlib.suppress(RecursionError):  # an expression put inside itself
        lines[function.lineno - 1 : function.end_lineno] = ast.unparse(function).splitlines()
    return "\n".join(lines) + "\n"


def number(rng: random.Random, text: str) -> str:
    """One literal or sign changed, as a hand would."""
    old, new = rng.choice((("0.5", "1.5"), ("1.0", "2.0"), ("-", "+"), ("+", "-"), ("*", "/"), ("0.0", "1.0")))
    places = [k for k in range(text.index("def "), len(text)) if text.startswith(old, k)]
    start = rng.choice(places)
    return text[:start] + new + text[start + len(old) :]


def hostile(rng: random.Random, text: str) -> str:
    """Code that would do something, in an expression, as a statement or in MODEL."""
    code = rng.choice(HOSTILE)
    where = rng.choice(("\n\nMODEL", "'format': 1", "    return ", "u1 = ", "import math\n", "1.0"))
    instead = {
        "\n\nMODEL": f"\n\n{code}\n\nMODEL",
        "'format': 1": f"'format': {code}",
        "import math\n": f"import math\n{code}\n",
    }.get(where, f"{where if '=' in where else '    return '}{code}\n")
    return text.replace(where, instead, 1)


def truncated(rng: random.Random, text: str) -> str:
    """The beginning of a file."""
    return text[: rng.randrange(len(text))]


def huge(rng: random.Random, text: str) -> str:
    """More than anybody writes."""
    filling = rng.choice(("1\n", "a;", "# comment\n", "x = 1.0\n", "0.0,", '"""a"""\n'))
    return text + filling * (rng.choice((10**4, 10**5, 10**6)) // len(filling))


def nested(rng: random.Random, text: str) -> str:
    """Deeper than Python goes."""
    deep = rng.choice((90, 1000, 10**5))
    code = rng.choice(("(" * deep + "1.0" + ")" * deep, "-" * deep + "1.0", "1.0" + "+1.0" * deep, "[" * deep))
    return text.replace("    return ", f"    new = {code}\n    return ", 1)


TEXTS: tuple[Callable[[random.Random, str], str], ...] = (
    *(textual, syntactic, number, hostile, truncated, huge, nested),
)


def place(rng: random.Random, folder: Path) -> str:
    """Put something where the module should be; what it is."""
    from satsym.kernels.digest import sealed

    path = folder / "fuzzed.py"
    kind = rng.choice((*TEXTS, *TEXTS, "bytes", "nothing", "FIFO", "/dev/zero", "directory", "circle"))
    if callable(kind):
        changed = kind(rng, (GENERATED / f"{rng.choice(MODELS)}.py").read_text(encoding="utf-8"))
        with contextlib.suppress(ValueError):  # nowhere left to put a digest
            changed = sealed(changed) if rng.random() < 0.7 else changed
        path.write_bytes(changed.encode("utf-8", "replace"))
        return kind.__name__
    if kind == "bytes":
        path.write_bytes(rng.randbytes(rng.choice((0, 1, 100, 10**5))))
    elif kind == "FIFO":
        os.mkfifo(path)
    elif kind == "directory":
        path.mkdir()
    elif kind in ("/dev/zero", "circle"):
        path.symlink_to("/dev/zero" if kind == "/dev/zero" else path)
    return str(kind)


def peak() -> int:
    """The most memory of this process, in MB; what `resource` says begins with that of the process that started it."""
    try:
        status = Path("/proc/self/status").read_text(encoding="utf-8")
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    return int(status.partition("VmHWM:")[2].split()[0]) // 1024


def attempt(rng: random.Random, events: list[str]) -> tuple[str, int, list[str]]:
    """One file: its kind, the exit code, and what is wrong with how it ended."""
    from satsym.cli import main

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        kind = place(rng, folder)
        case = folder / "case.toml"
        case.write_text(CASE.format(tf=rng.choice(("1.0", '"free"'))), encoding="utf-8")
        out, err, began = io.StringIO(), io.StringIO(), time.process_time()
        events.clear()
        with warnings.catch_warnings(record=True) as caught, contextlib.redirect_stdout(out):
            warnings.simplefilter("always")
            with contextlib.redirect_stderr(err):
                try:
                    code = main(["solve", str(case)])
                except SystemExit as ending:
                    code = ending.code
        seen, lines = list(events), err.getvalue().strip().splitlines()
        wrong = [f"warning: {w.message}" for w in caught] + [f"did {event}" for event in seen]
        wrong += ["ran"] if (folder / "it_ran").exists() or Path("it_ran").exists() else []
        wrong += [f"exit {code}"] if code not in (0, 3, 4, 5) else []
        wrong += ["traceback"] if "Traceback" in err.getvalue() + out.getvalue() else []
        wrong += [f"{len(lines)} lines of error"] if code == 3 and len(lines) != 1 else []
        took = time.process_time() - began
        wrong += [f"{took:.0f} s"] if took > SECONDS else []
    return kind, int(code or 0), wrong


def run(count: int, seed: int) -> int:
    """All of them; how many ended badly."""
    events: list[str] = []

    def watched(event: str, arguments: tuple[object, ...]) -> None:
        writes = event == "open" and isinstance(arguments[1], str) and set(arguments[1]) & set("wax+")
        if event.startswith(FORBIDDEN) or writes:
            events.append(f"{event}{arguments}"[:100])

    sys.addaudithook(watched)
    ended: Counter[tuple[str, int]] = Counter()
    bad = 0
    for k in range(count):
        kind, code, wrong = attempt(random.Random(f"{seed} {k}"), events)
        ended[kind, code] += 1
        if wrong:
            bad += 1
            print(f"file {k} ({kind}): {'; '.join(wrong)}")
    memory = peak()
    for (kind, code), times in sorted(ended.items()):
        print(f"{kind:12} exit {code}: {times}")
    print(f"{count} files, {bad} ended badly; at most {memory} MB")
    return bad + (memory > MEGABYTES)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    sys.exit(min(1, run(given.count, given.seed)))
