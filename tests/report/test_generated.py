"""What is checked in as written by the machine is what the machine writes."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import pytest

from satsym import sources
from satsym.report import artefacts
from satsym.symbolic import loader
from tests.support import derived as shared

STATED = {problem.name: (path, problem) for path in sources.shipped() for problem in loader.load(path)}

WRITTEN_BY = sources.digest(["satsym.report.artefacts"])

SHARE = 3
"""Of the models every third is derived, another third after each change of what writes them; a whole run derives all."""


def drawn(name: str) -> Any:
    """One case, left to whole runs unless what writes it draws it: the same for all processes and machines."""
    draw = hashlib.blake2b(f"{WRITTEN_BY} {name}".encode(), digest_size=2).digest()
    return pytest.param(name, marks=() if int.from_bytes(draw) % SHARE == 0 else pytest.mark.study)


@pytest.mark.parametrize("name", [drawn(name) for name in STATED])
def test_the_generated_files_of_a_model_are_what_its_derivation_leads_to(name: str, repository: Path) -> None:
    path, _ = STATED[name]
    files = artefacts.files(shared.stated(name), shared.derived, path, repository / "generated")
    assert artefacts.differences(files, repository / "generated", whole=False) == []


@pytest.mark.parametrize("name", STATED)
def test_a_generated_file_names_the_content_of_the_file_it_is_derived_from(name: str, repository: Path) -> None:
    path, _ = STATED[name]
    assert f"{path.name} {sources.digest_of(path)}\n" in (repository / "generated" / f"{name}.py").read_text()


def test_no_generated_file_is_left_over(repository: Path) -> None:
    files = {f"{name}{suffix}": "" for name in STATED for suffix in artefacts.SUFFIXES}
    there = {path.name for path in (repository / "generated").iterdir() if path.suffix in artefacts.SUFFIXES}
    assert there - {artefacts.KEPT} == set(files)
