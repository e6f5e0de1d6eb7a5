"""Whether what satsym says depends on the processor: the same verdicts with other kernels of OpenBLAS and NumPy.

`make test-processors` solves and analyses some 80 cases in a process for each set of kernels, and once more with
initial values that differ in the thirteenth digit. Status, verdict and objective must be the same in all. Kernels that
this processor cannot run are skipped, names that stand for the same kernels are run once, and both are said. It ends
with 1 where anything differs.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

from tests.bench.children import Child, Said, serve, tell

CORES = {"Haswell": ("avx2", "fma"), "Zen": ("avx2", "fma"), "SkylakeX": ("avx512f",), "Prescott": ()}
"""Names of OPENBLAS_CORETYPE, and the flags of a processor that can run such kernels."""

WITHOUT_FMA = "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-AVX,-FMA,-FMA4"
"""What glibc's functions then do not use: sines and exponentials differ in their last digits."""

MOVED = 1e-13
"""By this share of themselves initial values are moved."""

SAME = 1e-7
"""Largest relative difference of objectives that are the same."""

LONG = ("returns", "lapan-minimum-time-100s", "hypersensitive-10000", "reorientation", "shuttle", "shuttle-heating")
"""Shipped instances that take too long for what they show."""

SAMPLE = (
    "soft-return",
    "double-integrator-fuel",
    "transfer-time",
    "analyse geo-lqr",
    "lqr uny-lqr",
)
"""What continuous integration looks at."""

ANALYSED = (
    "geo-lqr",
    "uny-lqr",
    "lapan-coupling",
    "lapan-roll-yaw",
    "lapan-roll-yaw-lqr",
    "gravity-gradient",
    "molniya",
)
REGULATED = ("geo-lqr", "uny-lqr", "uny-lqr-both", "lapan-roll-yaw-lqr")


@dataclass(frozen=True)
class Kernels:
    """Settings under which all cases are run."""

    name: str
    settings: Mapping[str, str]
    moved: float = 0.0


def cases() -> dict[str, Callable[[float], Said]]:
    """What is run, by name: functions of the share by which initial values are moved."""
    found: dict[str, Callable[[float], Said]] = {}
    for name in shipped():
        if name not in LONG:
            found[name] = lambda moved, name=name: _solved(_loaded(name), moved)  # type: ignore[misc]
    for name in ANALYSED:
        found[f"analyse {name}"] = lambda moved, name=name: _analysed("analyse", name)  # type: ignore[misc]
    for name in REGULATED:
        found[f"lqr {name}"] = lambda moved, name=name: _analysed("lqr", name)  # type: ignore[misc]
    for name in ("THRIFTY", "SMOOTH"):
        found[f"landing {name.lower()}"] = lambda moved, name=name: _solved(_landing(name), moved)  # type: ignore[misc]
    for order, tf in ((2, 2.4), (3, 3.0), (3, 5.0), (4, 6.0)):
        title = f"{order} integrators in {tf:g}"
        found[title] = lambda moved, order=order, tf=tf: _solved(_integrators(order, tf), moved)  # type: ignore[misc]
    return found


def shipped() -> list[str]:
    """The names of the instances that come with satsym."""
    files = resources.files("satsym.instances").iterdir()
    return sorted(one.name.removesuffix(".toml") for one in files if one.name.endswith(".toml"))


def _loaded(name: str) -> Any:
    from satsym import instance

    return instance.load(name)


def _landing(name: str) -> Any:
    import satsym
    from tests.solvers import test_steered_magnitudes as landings

    bounds = {"T": (0, landings.STRONGEST), "b": (-0.15, 0.15)}
    given = {"initial": landings.START, "final": landings.GROUND, "tf": landings.LASTING, "control": bounds}
    return satsym.Instance.of(getattr(landings, name), **given).case


def _integrators(order: int, tf: float) -> Any:
    from tests.switching.test_flat_ends import integrators_instance

    return integrators_instance(order, tf).case


def _solved(case: Any, moved: float) -> Said:
    from satsym.solvers import solve

    given = replace(case, initial=tuple(value * (1.0 + moved) for value in case.initial))
    found = solve(given)
    verdict = found.certificate.verdict.value if found.certificate else ""
    return {"status": found.status.value, "verdict": verdict, "objective": found.objective}


def _analysed(what: str, name: str) -> Said:
    import satsym

    found = getattr(satsym, what)(name)
    text = str(found).splitlines()
    return {"status": "; ".join(line.strip() for line in text[:2]), "verdict": "", "objective": math.nan}


def answered(asked: list[Any]) -> Said:
    """What comes of a case, of its name and the share by which initial values are moved; of nothing, the kernels."""
    from satsym.status import BadInput

    if not asked:
        return _kernels()
    try:
        return cases()[asked[0]](asked[1])
    except BadInput as error:
        return {"status": f"refused: {error}", "verdict": "", "objective": math.nan}


def _kernels() -> Said:
    """What OpenBLAS and NumPy say that they use in this process."""
    import numpy as np
    from threadpoolctl import threadpool_info

    from satsym.lapack import lapack

    lapack()
    features: Mapping[str, bool] = np._core._multiarray_umath.__cpu_features__  # type: ignore[attr-defined]
    dispatched: list[str] = np._core._multiarray_umath.__cpu_dispatch__  # type: ignore[attr-defined]
    blas = sorted({one["architecture"] for one in threadpool_info() if one.get("internal_api") == "openblas"})
    return {"blas": blas, "numpy": [name for name in dispatched if features.get(name)]}


def configurations() -> tuple[list[Kernels], list[str]]:
    """Sets of kernels that this machine can run, the first being its own; and what is left out, with the reason."""
    flags = _flags()
    own, seen = Kernels("this machine", {}), {}
    found, left = [own], []
    seen[_header(own)] = own.name
    options = [Kernels(f"OpenBLAS for {core}", {"OPENBLAS_CORETYPE": core}) for core in CORES]
    numpy = _header(own)[1]
    wide = [name for name in numpy if "512" in name or name == "X86_V4"] or list(numpy[-1:])
    if wide:
        options.append(Kernels(f"NumPy without {' '.join(wide)}", {"NPY_DISABLE_CPU_FEATURES": " ".join(wide)}))
    for one in options:
        core = one.settings.get("OPENBLAS_CORETYPE", "")
        missing = [flag for flag in CORES.get(core, ()) if flag not in flags]
        if missing:
            left.append(f"{one.name}: skipped, this processor has no {' '.join(missing)}")
            continue
        header = _header(one)
        if header in seen:
            left.append(f"{one.name}: the same kernels as those of {seen[header]!r}")
            continue
        seen[header] = one.name
        found.append(one)
    if "fma" in flags:  # which no kernel's name shows
        found.append(Kernels("C library without FMA", {"GLIBC_TUNABLES": WITHOUT_FMA}))
    return [*found, Kernels(f"initial values moved by {MOVED:g}", {}, MOVED)], left


def _flags() -> set[str]:
    """Of this processor; all that matter where nobody tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    flags = next((line for line in lines if line.startswith("flags")), "")
    return set(flags.partition(":")[2].split()) or set(CORES["Haswell"])


def _header(one: Kernels) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The kernels that OpenBLAS and NumPy say they use under these settings."""
    said = _child(one).ask([])
    if "blas" not in said:
        raise RuntimeError(f"{one.name}: {said['said']}")
    return tuple(said["blas"]), tuple(said["numpy"])


_CHILDREN: dict[tuple[tuple[str, str], ...], Child] = {}
"""The processes that were begun, by their settings."""


def _child(one: Kernels) -> Child:
    """The process under these settings, which answers all that is asked under them."""
    settings = tuple(sorted(one.settings.items()))
    if settings not in _CHILDREN:
        _CHILDREN[settings] = Child("tests.bench.processors", "--child", settings=one.settings)
    return _CHILDREN[settings]


def _answers(one: Kernels, names: list[str]) -> Iterator[Said]:
    """What a process says of the cases under these settings."""
    for name in names:
        said = _child(one).ask([name, one.moved])
        if "said" in said:  # an error that is the same everywhere says nothing of processors
            raise RuntimeError(f"{name} ({one.name}): {said['said']}")
        yield {"case": name, **said}


def differs(one: Said, other: Said) -> list[str]:
    """What differs between two answers to a case."""
    found = [f"{key} {one[key]!r} and {other[key]!r}" for key in ("status", "verdict") if one[key] != other[key]]
    values = one["objective"], other["objective"]
    apart = abs(values[0] - values[1]) > SAME * max(map(abs, values))
    if apart or math.isnan(values[0]) != math.isnan(values[1]):
        found.append(f"objective {values[0]:.12g} and {values[1]:.12g}")
    return found


def run(names: list[str]) -> int:
    """Run all configurations; 1 where anything differs from the first."""
    try:
        return _compared(names)
    finally:
        while _CHILDREN:
            _CHILDREN.popitem()[1].end()


def _compared(names: list[str]) -> int:
    todo, left = configurations()
    print("\n".join(left))
    known: dict[str, Said] = {}
    different = 0
    for one in todo:
        seconds = 0.0
        for number, said in enumerate(_answers(one, names), 1):
            tell(f"{one.name}: {number} of {len(names)}, {said['case']}")
            seconds += said["seconds"]
            first = known.setdefault(said["case"], said)
            for what in differs(first, said):
                different += 1
                print(f"{said['case']}: {what} ({todo[0].name}; {one.name})", flush=True)
        tell("")
        print(f"{one.name}: {len(names)} cases, {seconds:.0f} s", flush=True)
    print(f"{different} differences" if different else "no difference")
    return int(different > 0)


if __name__ == "__main__":
    asked = sys.argv[1:]
    if asked == ["--child"]:
        serve(answered)
    else:
        sys.exit(run(list(SAMPLE) if asked == ["--sample"] else asked or list(cases())))
