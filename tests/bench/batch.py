"""Many instances at once, beside C, plain NumPy and CasADi in a loop: `make bench-batch`.

Arguments are the numbers of the tables that are wanted; without any all are made.

Ratios are formed pair by pair within one run, of processor time but for the study, which has two processes.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

import growth
import numpy as np
import numpy_calls
import regulators
import rows
import single
from compiled_c import compiler
from ends import program
from machine import asked_for, described
from peers import Missing
from rows import Goal, Row, Table
from timing import Samples, interleaved

MOTIONS, STEPS = 4096, 50
OPTIMA, LOOPED, CHUNK = 1000, 40, 250
"""Optima, those of them that a loop is given, and those that are columns of the same arrays."""
RETURNS = 10_000
SAME = 1e-9
"""Difference of initial costates from those by collocation, one by one, relative to their size, that is none."""

Advance = Callable[[np.ndarray, np.ndarray, np.ndarray], None]


def by_c() -> Advance:
    """By gcc with all that this machine has."""
    source = Path(__file__).with_name("batch.c")
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "batch.so"
        flags = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC"]
        subprocess.run([compiler(), *flags, "-o", str(library), str(source)], check=True)
        function = ctypes.CDLL(str(library)).advance

    def run(y: np.ndarray, u: np.ndarray, p: np.ndarray) -> None:
        given = (ctypes.c_void_p(rows.ctypes.data) for rows in (y, u, p))
        function(ctypes.c_double(0.01), ctypes.c_long(STEPS), ctypes.c_long(y.shape[1]), *given)

    return run


def plain(y: np.ndarray, u: np.ndarray, p: np.ndarray) -> None:
    """As one writes it in NumPy."""
    mu, h = p[0] ** 3 * p[1] ** 2, 0.01

    def f(y: np.ndarray) -> np.ndarray:
        return np.array([y[1], y[0] * y[3] ** 2 - mu / y[0] ** 2 + u[0], y[3], (u[1] - 2 * y[1] * y[3]) / y[0]])

    for _ in range(STEPS):
        k1 = f(y)
        k2 = f(y + h / 2 * k1)
        k3 = f(y + h / 2 * k2)
        k4 = f(y + h * k3)
        y += h / 6 * (k1 + 2 * (k2 + k3) + k4)


def motions(rounds: int = 7) -> Table:
    """RK4 steps of many motions."""
    from satsym.kernels import load
    from satsym.kernels.blocks import block_step
    from satsym.solvers.simulation import batch

    kernels, rng = load("polar_orbit"), np.random.default_rng(0)
    step = block_step(kernels.compiled())
    y = np.array([1.0, 0.0, 0.0, 1.0])[:, None] + 0.05 * rng.uniform(-1.0, 1.0, (4, MOTIONS))
    u, p = 0.01 * rng.uniform(-1.0, 1.0, (2, MOTIONS)), np.ones((8, MOTIONS))

    def on_arrays(y: np.ndarray, u: np.ndarray, p: np.ndarray) -> None:
        y[:] = batch.simulate(kernels, [0.0, 0.01 * STEPS], y, p, STEPS, u=u)[:, -1]

    advances: dict[str, Advance] = {
        "C, gcc -O3 -march=native -ffast-math": by_c(),
        "satsym, numba": lambda y, u, p: step(0.0, 0.01, STEPS, y, u, p),
        "satsym, NumPy": on_arrays,
        "NumPy as one writes it": plain,
    }
    ends: dict[str, np.ndarray] = {}
    for name, advance in advances.items():
        ends[name] = y.copy()
        advance(ends[name], u, p)
    by = dict(zip(("C", "numba", "numpy", "plain"), advances, strict=True))
    found = interleaved({name: lambda a=a: a(y.copy(), u, p) for name, a in advances.items()}, rounds, least=0.05)
    shares = {
        by["numba"]: [Goal("of C", found[by["C"]].times(found[by["numba"]]), 0.9, True)],
        by["numpy"]: [
            Goal("of C", found[by["C"]].times(found[by["numpy"]]), 0.12, True),
            Goal("of what one writes", found[by["plain"]].times(found[by["numpy"]]), 2.0, True),
        ],
    }
    made, unit = [], 1e9 / (MOTIONS * STEPS)
    for name, one in found.items():
        off = float(np.abs(ends[name] - ends[by["C"]]).max())
        goals = (*shares.get(name, ()), Goal("off by", off, 1e-12))
        made.append(Row(name, one.least * unit, one.middle * unit, one.times(found[by["C"]]), goals))
    return Table(f"1. RK4 for {MOTIONS} motions of the polar orbit", "nanoseconds a step of one", tuple(made))


def population(count: int) -> list[Any]:
    """Rendezvous after a revolution, from all around."""
    from satsym import instance

    case, rng = instance.load("return-to-orbit"), np.random.default_rng(1)
    low, high = np.array([0.9, -0.1, -0.1, 0.9]), np.array([1.1, 0.1, 0.1, 1.1])
    return [replace(case, initial=tuple(rng.uniform(low, high).tolist())) for _ in range(count)]


def optima(rounds: int = 5) -> list[Table]:
    """Optima from cold starts, and their certificates."""
    from satsym.solvers import two_point
    from satsym.solvers.batch.certificate import minima
    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.solving import solved_together

    cases, loop = population(OPTIMA), program()
    parts = [cases[at : at + CHUNK] for at in range(0, OPTIMA, CHUNK)]

    def together(compiled: bool) -> list[tuple[Any, Any]]:
        found = []
        for part in parts:
            many = Many.of(part[0], part, compiled)
            found.append((many, solved_together(many).nodes))
        return found

    numba, numpy, ipopt = "satsym, numba", "satsym, NumPy", f"CasADi, Ipopt in a loop ({LOOPED} of them)"
    answers = {numba: together(True), numpy: together(False)}
    truth = np.array([two_point.solve(one).lam[:, 0] for one in cases[:LOOPED]])
    calls: dict[str, Callable[[], object]] = {
        numba: lambda: together(True),
        numpy: lambda: together(False),
        ipopt: lambda: [loop(np.array(one.initial)) for one in cases[:LOOPED]],
    }
    found = interleaved(calls, rounds, least=0.0)
    each = {
        name: Samples(tuple(s / (LOOPED if name == ipopt else OPTIMA) for s in one.seconds))
        for name, one in found.items()
    }
    made = []
    for name, one in each.items():
        goals: list[Goal] = []
        if name in answers:
            wanted = 30.0 if name == numba else 5.0
            goals.append(Goal("times faster than Ipopt", each[ipopt].times(one), wanted, True))
            z = np.concatenate([nodes.z[4:, 0] for _, nodes in answers[name]], axis=1)[:, :LOOPED].T
            solved = np.concatenate([nodes.solved for _, nodes in answers[name]])
            off = np.abs(z - truth).max(axis=1)[solved[:LOOPED]] / np.abs(truth).max(axis=1)[solved[:LOOPED]]
            goals += [Goal("costates off", float(off.max()), SAME), Goal("solved", float(solved.mean()), 0.99, True)]
        if name == numba:
            goals.append(Goal("microseconds", one.middle * 1e6, 100.0))
        made.append(Row(name, one.least * 1e6, one.middle * 1e6, one.times(each[numba]), tuple(goals)))
    first = Table(f"2. {OPTIMA} rendezvous optima from cold starts, one core", "microseconds each", tuple(made))
    checks = {name: lambda pairs=pairs: [minima(*pair) for pair in pairs] for name, pairs in answers.items()}
    for check in checks.values():
        check()
    took = interleaved(checks, rounds, least=0.0)
    made = []
    for name, one in took.items():
        confirmed = np.concatenate([minima(*pair) for pair in answers[name]]).mean()
        goals = [
            Goal("of solving", one.times(found[name]), 2.0),
            Goal("confirmed", float(confirmed), 0.99, True),
        ]
        own = Samples(tuple(seconds / OPTIMA for seconds in one.seconds))
        made.append(Row(name, own.least * 1e6, own.middle * 1e6, one.times(took[numba]), tuple(goals)))
    second = Table("3. Their certificates without competitors", "microseconds each", tuple(made))
    return [first, second]


def bodies(count: int) -> tuple[list[Any], np.ndarray]:
    """Bodies on a line from anywhere to anywhere at any rate, and their least times in closed form."""
    from satsym import instance

    case, rng = instance.load("double-integrator-time"), np.random.default_rng(2)
    found, known = [], []
    for _ in range(count):
        (q, v), (goal, last) = start, end = rng.uniform(-3.0, 3.0, 2).tolist(), rng.uniform(-2.0, 2.0, 2).tolist()
        low, high = -(10.0 ** rng.uniform(-0.5, 0.5)), 10.0 ** rng.uniform(-0.5, 0.5)
        final = dict(zip(("q", "q_dot"), end, strict=True))
        found.append(replace(case, initial=tuple(start), final=final, lower=(low,), upper=(high,)))
        times = []
        for first, then in ((low, high), (high, low)):
            squared = (goal - q + v * v / (2 * first) - last * last / (2 * then)) / (0.5 / first - 0.5 / then)
            for turning in (squared**0.5, -(squared**0.5)) if squared >= 0.0 else ():
                arcs = (turning - v) / first, (last - turning) / then
                times += [sum(arcs)] if min(arcs) >= 0.0 else []
        known.append(min(times))
    return found, np.array(known)


def least_times(rounds: int = 3) -> Table:
    """Least times of bodies on a line, all of them: cold, in a random order."""
    from satsym.solvers.batch.switching.arrivals import first_arrivals
    from satsym.solvers.batch.switching.certificate import minima

    cases, known = bodies(RETURNS)
    parts = [cases[at : at + CHUNK] for at in range(0, RETURNS, CHUNK)]

    def solved() -> list[Any]:
        return [first_arrivals(part, True) for part in parts]

    answers, ours, checks = solved(), "satsym, numba", "their certificates"
    found = interleaved({ours: solved, checks: lambda: [minima(one) for one in answers]}, rounds, least=0.0)
    each = {name: Samples(tuple(s / RETURNS for s in one.seconds)) for name, one in found.items()}
    there, durations = (np.concatenate([getattr(one, name) for one in answers]) for name in ("solved", "durations"))
    wrong = int((np.abs(durations / known - 1.0)[there] > SAME).sum())
    clear = np.concatenate([minima(one) for one in answers]).mean()
    goals = {
        ours: (
            Goal("microseconds", each[ours].middle * 1e6, 60.0),
            Goal("wrong", wrong, 0.0),
            Goal("found", float(there.mean()), 0.999, True),
        ),
        checks: (Goal("confirmed", float(clear), 0.99, True),),
    }
    made = [Row(k, one.least * 1e6, one.middle * 1e6, one.times(each[ours]), goals[k]) for k, one in each.items()]
    return Table(f"5. {RETURNS} least times of a body on a line, one core", "microseconds each", tuple(made))


def linear(rounds: int = 3) -> Table:
    """Linear problems with given ends, without bounds."""
    from satsym import instance
    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.solving import has_closed_form, in_closed_form
    from satsym.solvers.linear import solve

    case, rng = instance.load("double-integrator-energy"), np.random.default_rng(3)
    case = replace(case, lower=(-np.inf,), upper=(np.inf,))
    cases = [replace(case, initial=tuple(rng.uniform(-1.0, 1.0, 2).tolist())) for _ in range(RETURNS)]
    parts = [cases[at : at + CHUNK] for at in range(0, RETURNS, CHUNK)]

    def solved() -> list[Any]:
        return [in_closed_form(many) for part in parts if has_closed_form(many := Many.of(case, part, False))]

    answers, name = solved(), "satsym, NumPy"
    one = interleaved({name: solved}, rounds, least=0.0)[name]
    each = Samples(tuple(seconds / RETURNS for seconds in one.seconds))
    truth = np.array([solve(one).lam[:, 0] for one in cases[:LOOPED]])
    found = np.concatenate([one.z[2:, 0] for one in answers], axis=1)
    off = float((np.abs(found[:, :LOOPED].T - truth).max(axis=1) / np.abs(truth).max(axis=1)).max())
    there = float(np.concatenate([one.solved for one in answers]).mean())
    goals = (
        Goal("microseconds", each.middle * 1e6, 25.0),
        Goal("costates off", off, SAME),
        Goal("solved", there, 0.999, True),
    )
    row = Row(name, each.least * 1e6, each.middle * 1e6, None, goals)
    return Table(f"6. {RETURNS} linear problems with given ends, one core", "microseconds each", (row,))


def study() -> Table:
    """A whole study by its command, machine code being there."""
    command = [str(Path(sys.executable).parent / "satsym"), "study", "return-to-orbit", "--sample", str(RETURNS)]
    command += ["--uniform", "initial.r=0.9,1.1", "--uniform", "initial.theta_dot=0.9,1.1", "--seed", "1"]
    with tempfile.TemporaryDirectory() as folder:
        began = perf_counter()
        subprocess.run([*command, "--out", folder, "--workers", "2"], check=True, capture_output=True)
        took = perf_counter() - began
    goals = (Goal("seconds on the wall", took, 10.0),)
    title = f"4. satsym study: {RETURNS} returns to the orbit with their certificates, two processes"
    return Table(title, "seconds", (Row("satsym study", took, took, None, goals),))


def two_processes(count: int = 100_000) -> Table:
    """A large study by one process and by two: on the wall, of the processor, and what the largest process holds."""
    command = [str(Path(sys.executable).parent / "satsym"), "study", "return-to-orbit", "--sample", str(count)]
    command += ["--uniform", "initial.r=0.9,1.1", "--uniform", "initial.theta_dot=0.9,1.1", "--seed", "1"]
    took, work, held = {}, {}, {}
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            began = perf_counter()
            whole = [*command, "--out", folder, "--workers", str(workers)]
            running = subprocess.Popen(whole, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, status, used = os.wait4(running.pid, 0)  # with its own processes, which it has waited for
            running.returncode = os.waitstatus_to_exitcode(status)
            took[workers], work[workers] = perf_counter() - began, used.ru_utime + used.ru_stime
            held[workers] = used.ru_maxrss / 1024.0
        if running.returncode:
            raise subprocess.CalledProcessError(running.returncode, whole)
    quicker = Goal("x", took[1] / took[2], 1.6, True)
    made = []
    for workers, name in ((1, "one process"), (2, "two")):
        memory = Goal("megabytes of the largest process", held[workers], 500.0)
        goals = (memory,) if workers == 1 else (quicker, memory)
        note = f"{work[workers]:.3g} s of the processor, load {os.getloadavg()[0]:.1f}"
        made.append(Row(name, took[workers], took[workers], None, goals, note))
    return Table(f"9. satsym study: {count} returns to the orbit", "seconds on the wall", tuple(made))


def main() -> None:
    """Run all; exit code 0 whatever was reached."""
    print(described(), flush=True)
    tables: list[Table] = []
    subjects = {"1": lambda: [motions()], "2": optima, "4": lambda: [study()], "5": lambda: [least_times()]}
    subjects |= {"6": lambda: [linear()], "7": lambda: [regulators.many()]}
    subjects |= {"8": lambda: [growth.growth()], "9": lambda: [two_processes()]}
    subjects |= {"10": lambda: single.single(population(single.COUNT)), "12": lambda: [numpy_calls.numpy_calls()]}
    for subject in [subjects[number] for number in asked_for(subjects)]:
        try:
            made = subject()
        except Missing as error:
            print(f"\nleft out: {error}")
            continue
        for table in made:
            print(rows.text(table), flush=True)
        tables += made
    print(f"\n{rows.summary(tables)}")


if __name__ == "__main__":
    main()
