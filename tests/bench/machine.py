"""The machine and the versions, without which no time means anything; and which parts of a bench are asked for."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from compiled_c import compiler
from peers import Missing

PACKAGES = ("numpy", "scipy", "sympy", "numba", "casadi")


def described() -> str:
    """Two lines of text."""
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    versions = [f"Python {platform.python_version()}", _compiler(), *(f"{name} {_version(name)}" for name in PACKAGES)]
    return f"{_processor()}, {os.cpu_count()} processors{load}, {platform.system()}\n{', '.join(versions)}"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _compiler() -> str:
    try:
        said = subprocess.run([compiler(), "--version"], capture_output=True, text=True).stdout
    except Missing as error:
        return str(error)
    return said.splitlines()[0] if said else "a C compiler that does not say its version"


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "missing"


def asked_for(known: Iterable[str]) -> list[str]:
    """The parts of a bench that the command line names, all where it names none; ends where there is no such part."""
    names = list(known)
    if unknown := [word for word in sys.argv[1:] if word not in names]:
        sys.exit(f"no {', '.join(unknown)}; there are {', '.join(names)}")
    return sys.argv[1:] or names
