"""Who imports whom at run time. What the sources say is checked by import-linter (``make lint``)."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

REPORT = "import json, sys; sys.stderr.write('\\n' + json.dumps([*{name.partition('.')[0] for name in sys.modules}]))"


def imported_by(code: str, cwd: Path) -> set[str]:
    """Top-level modules that are loaded once the code has run in a fresh interpreter, however it ends."""
    done = subprocess.run(
        [sys.executable, "-c", f"try:\n    {code}\nfinally:\n    {REPORT}"],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return set(json.loads(done.stderr.splitlines()[-1]))


def run_satsym(arguments: list[str], cwd: Path) -> set[str]:
    return imported_by(f"import sys; sys.argv[1:] = {arguments!r}; from satsym.cli import main; sys.exit(main())", cwd)


@pytest.mark.parametrize("instance", ["its-thesis", "soft-return"])
def test_solving_a_shipped_instance_imports_no_sympy_matplotlib_or_compiler(instance: str, tmp_path: Path) -> None:
    loaded = run_satsym(["solve", instance, "--json"], tmp_path)
    assert "numpy" in loaded
    assert not loaded & {"sympy", "matplotlib", "numba"}


@pytest.mark.parametrize("arguments", [["--help"], ["solve", "--help"]], ids=" ".join)
def test_help_imports_nothing_heavy(arguments: list[str], tmp_path: Path) -> None:
    assert not run_satsym(arguments, tmp_path) & {"numpy", "scipy", "sympy", "matplotlib", "numba", "pint"}


def test_importing_satsym_imports_nothing_else(tmp_path: Path) -> None:
    assert imported_by("import satsym", tmp_path) - imported_by("pass", tmp_path) == {"satsym"}


def test_generated_modules_import_only_math_and_numpy(repository: Path) -> None:
    modules = sorted(repository.glob("generated/[!_]*.py"))
    assert modules
    for module in modules:
        nodes = list(ast.walk(ast.parse(module.read_text(encoding="utf-8"))))
        imported = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        imported |= {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)}
        assert imported <= {"__future__", "math", "numpy"}, module.name


def test_rooms_and_files_can_be_taken_in_at_a_look(repository: Path) -> None:
    files = sorted((repository / "satsym").rglob("*.py"))
    assert len(files) > 200
    assert {path.name: count for path in files if (count := len(path.read_text("utf-8").splitlines())) > 400} == {}
    crowded = Counter(path.parent.relative_to(repository) for path in files)
    assert {str(room): count for room, count in crowded.items() if count > 20} == {}


def test_the_front_loads_sympy_only_when_something_is_derived(tmp_path: Path) -> None:
    loaded = imported_by("import satsym.front.derivation, satsym.front.solution, satsym.front.instance", tmp_path)
    assert not loaded & {"sympy", "matplotlib", "numba"}
