"""``satsym doctor``: whether everything is here that satsym needs."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import satsym
from satsym.cli.help import command
from satsym.cli.names import checkout
from satsym.cli.options import json_option
from satsym.cli.output import emit, emit_json, live
from satsym.cli.requirements import Requirement, requirements
from satsym.report.said import each, message, say
from satsym.status import ExitCode

EXAMPLES = """\b
Example:
  satsym doctor

Exit codes: 0 everything required works, 1 something required is broken."""

EXTRAS = {
    "fast": "compiled kernels, which are faster for many steps or many cases",
    "cluster": "studies on a Dask cluster",
    "table": "tables of studies as Parquet",
    "control": "comparison with python-control",
    "bench": "the programs that `make bench` compares satsym with, and Dask",
    "dev": "tests and lint",
}

PROGRAMS = (
    ("pdflatex", ("pdflatex",), "optional; makes PDFs of the documents that `satsym latex` writes"),
    ("C compiler", ("cc", "gcc", "clang", "cl"), "optional"),
)

TRIAL = "soft-return"


@command(epilog=EXAMPLES)
@json_option
def doctor(as_json: bool) -> ExitCode:
    """Check the installation.

    Checks versions, extras, programs and shipped files, and solves a small problem.
    """
    from satsym.report.terminal.table import table

    with live() as line:
        findings = _examine(lambda name: line.show(say("examining <name> ...", name=name)))
    healthy = not any(finding.broken for finding in findings)
    if as_json:
        emit_json({"healthy": healthy, "findings": [finding.as_object() for finding in findings]})
    else:
        what, found, note = each("what", "found", "note")
        rows = [tuple(map(message, (f.name, f.mark, f.value, f.note))) for f in findings]
        emit("\n".join(table([(what, "", found, note), *rows], indent="")))
    return ExitCode.DONE if healthy else ExitCode.UNFORESEEN


@dataclass(frozen=True)
class Finding:
    """The result of one check of the installation.

    Attributes
    ----------
    name, value, note
        What was checked, what was found, and a remark.
    fine
        Whether the result is as it should be.
    required
        Whether anything fails without it.
    """

    name: str
    value: str
    fine: bool = True
    required: bool = False
    note: str = ""

    @property
    def broken(self) -> bool:
        """Tell whether satsym cannot work because of this finding."""
        return self.required and not self.fine

    @property
    def mark(self) -> str:
        """Return one word about the finding for people."""
        return "ok" if self.fine else "BROKEN" if self.required else "absent"

    def as_object(self) -> dict[str, str | bool]:
        """Return the finding as an object for JSON."""
        return {
            "name": self.name,
            "value": self.value,
            "fine": self.fine,
            "required": self.required,
            "note": self.note,
        }


def _examine(announce: Callable[[str], None]) -> list[Finding]:
    """Run all checks in the order of the report; `announce` is called with the name of each next one."""
    import platform

    home = checkout()
    findings = [
        Finding("satsym", satsym.__version__, note=f"checkout {home}" if home else str(Path(satsym.__file__).parent)),
        Finding("Python", platform.python_version(), sys.version_info >= (3, 11), True, sys.executable),
    ]
    stated = requirements()
    for requirement in stated:
        if requirement.extra is None:
            announce(requirement.name)
            findings.append(_dependency(requirement))
    findings += _extras(stated)
    findings += [_program(*program) for program in PROGRAMS]
    announce("shipped files")
    findings += _shipped()
    announce(TRIAL)
    findings.append(_trial())
    return findings


def _dependency(requirement: Requirement) -> Finding:
    """Check that a package is installed, in a suitable version, and can be imported."""
    import importlib

    version = requirement.installed
    wanted = f"needs {requirement.name} {requirement.versions}".rstrip()
    if version is None:
        return Finding(requirement.name, "not installed", False, True, wanted)
    try:
        importlib.import_module(_module_of(requirement.name))
    except Exception as error:  # a broken package may raise anything
        return Finding(requirement.name, version, False, True, f"cannot be imported: {_line(error)}")
    fine = requirement.allows(version)
    return Finding(requirement.name, version, fine, True, "" if fine else wanted)


@cache
def _installed_modules() -> Mapping[str, Sequence[str]]:
    """Map the names of installed modules to their packages, for which the files of all packages are read."""
    from importlib import metadata

    return metadata.packages_distributions()


def _module_of(package: str) -> str:
    """Return the module of an installed package; that of python-flint is flint."""
    own = sorted(module for module, packages in _installed_modules().items() if package in packages)
    return package if package in own or not own else own[0]


def _extras(stated: list[Requirement]) -> Iterator[Finding]:
    for extra, purpose in EXTRAS.items():
        members = [r for r in stated if r.extra == extra]
        absent = [r.name for r in members if r.installed is None]
        if not members:
            continue
        note = f"{purpose}; without {', '.join(absent)} (pip install 'satsym[{extra}]')" if absent else purpose
        yield Finding(f"extra {extra}", f"{len(members) - len(absent)}/{len(members)}", not absent, note=note)


def _program(name: str, commands: tuple[str, ...], purpose: str) -> Finding:
    path = next(filter(None, map(shutil.which, commands)), None)
    return Finding(name, path or "not found", path is not None, note=purpose)


def _shipped() -> Iterator[Finding]:
    """Check that derivations, generated models and instances load."""
    try:
        from satsym import instance, kernels
        from satsym.symbolic import loader

        derivations, models, names = loader.shipped(), kernels.shipped(), instance.shipped()
        folder = derivations[0].parent if derivations else None
        note = f"in {folder}; `satsym derive --check` compares these files with the models"
        yield Finding("derivations", str(len(derivations)), bool(derivations), True, note)
        for name in models:
            kernels.load(name)
        yield Finding("models", str(len(models)), bool(models), True, ", ".join(models))
        for name in names:
            instance.load(name)
        yield Finding("instances", str(len(names)), bool(names), True, "all load")
    except Exception as error:
        yield Finding("shipped files", "cannot be read", False, True, _line(error))


def _trial() -> Finding:
    """Solve a small problem as a check."""
    name = f"solve {TRIAL}"
    try:
        from satsym import instance, solvers

        solution = solvers.solve(instance.load(TRIAL))
    except Exception as error:
        return Finding(name, "fails", False, True, _line(error))
    note = f"J = {solution.instance.model.spec.objective(solution.objective):.6g}, {solution.wall_s:.2g} s"
    return Finding(name, solution.status.value, solution.status.answered, True, note)


def _line(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
