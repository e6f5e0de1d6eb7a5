"""What a shell completes, asked as bash asks."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.test_cli import Run, run

__all__ = ["run"]

BASH = shutil.which("bash")


@pytest.mark.skipif(BASH is None, reason="needs bash")
@pytest.mark.parametrize(
    ("typed", "completed"),
    [
        ("so", ["solve"]),
        ("solve soft-return-g", ["soft-return-geo"]),
        ("solve my_", ["my_case.toml"]),
        ("analyse clohessy", ["clohessy_wiltshire"]),
        ("latex small_sys", ["small_systems"]),
        ("audit its_t", ["its_thesis"]),
        ("solve soft-return --meth", ["--method"]),
        ("solve soft-return --method col", ["collocation"]),
    ],
)
def test_the_tab_key_completes(run: Run, tmp_path: Path, typed: str, completed: list[str]) -> None:
    (tmp_path / "my_case.toml").touch()
    (tmp_path / "my_notes.txt").touch()
    code, script, err = run("completion", "bash")
    assert (code, err) == (0, "")
    (tmp_path / "satsym").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m satsym "$@"\n')
    (tmp_path / "satsym").chmod(0o755)
    asked = f"{script}\nCOMP_WORDS=(satsym {typed}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); COMPREPLY=()\n"
    asked += '_satsym_completion satsym; printf "%s\\n" "${COMPREPLY[@]}"'
    paths = {"PATH": f"{tmp_path}:{os.environ['PATH']}", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    done = subprocess.run(
        ["bash", "-c", asked], cwd=tmp_path, env=os.environ | paths, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == completed


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_are_served_too(run: Run, shell: str) -> None:
    code, script, _ = run("completion", shell)
    assert code == 0
    assert "_SATSYM_COMPLETE" in script


def test_another_shell_is_refused_with_those_there_are(run: Run) -> None:
    code, out, err = run("completion", "csh")
    assert (code, out) == (2, "")
    assert "'bash', 'zsh', 'fish'" in err
