"""What is checked in as written by the machine is what the machine writes."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym import source_files
from satsym.report import artefacts
from satsym.symbolic import loader
from tests.support import derived as shared

STATED = {problem.name: (path, problem) for path in source_files.shipped() for problem in loader.load(path)}


@pytest.mark.parametrize("name", shared.each())
def test_the_generated_files_of_a_model_are_what_its_derivation_leads_to(name: str, repository: Path) -> None:
    path, _ = STATED[name]
    files = artefacts.files(shared.stated(name), shared.derived, path, repository / "generated")
    assert artefacts.differences(files, repository / "generated", whole=False) == []


@pytest.mark.parametrize("name", STATED)
def test_a_generated_file_names_the_content_of_the_file_it_is_derived_from(name: str, repository: Path) -> None:
    path, _ = STATED[name]
    assert f"{path.name} {source_files.digest_of(path)}\n" in (repository / "generated" / f"{name}.py").read_text()


def test_no_generated_file_is_left_over(repository: Path) -> None:
    files = {f"{name}{suffix}": "" for name in STATED for suffix in artefacts.SUFFIXES}
    there = {path.name for path in (repository / "generated").iterdir() if path.name.endswith(artefacts.SUFFIXES)}
    assert there - {artefacts.KEPT} == set(files)
