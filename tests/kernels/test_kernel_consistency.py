"""Files that were edited are told by their digest; where that was recomputed, their functions contradict each other."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.kernels import consistency, load, loading, shipped
from satsym.kernels.digest import intact, sealed
from satsym.kernels.evaluation import SMALLEST_FRACTION
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.status import BadInput
from tests.support.mutants import Mutant, is_equivalent, mutants

LOOPS = ("forward", "backward", "symplectic")
ELSEWHERE_ONLY = ("quantities", "balances", "output_matrix", "feedthrough_matrix", "routh_column")
"""Functions that nothing else in a module says: no certificate uses them, and only their two forms can disagree."""
OF_CURVES = ("beyond_switching_curve", "feedback_law", "transition_time", "first_arc_time")
"""Likewise; they are for simulations with feedback."""

CASE = """
model = "./mine"
title = "A motion between given ends"
[initial]
q = 0.0
q_dot = 0.0
[final]
q = 1.0
q_dot = 0.0
[time]
tf = 1.0
"""


@pytest.fixture
def energy(repository: Path) -> str:
    return (repository / "generated/double_integrator_energy.py").read_text(encoding="utf-8")


def solved(folder: Path, text: str) -> subprocess.CompletedProcess[str]:
    """What the command line makes of an instance of this module."""
    (folder / "mine.py").write_text(text, encoding="utf-8")
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    command = [sys.executable, "-m", "satsym", "solve", "case.toml", "--json"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_a_file_as_it_was_written_is_solved_and_certified(energy: str, tmp_path: Path):
    done = solved(tmp_path, energy)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["certificate"]["verdict"] == "certified"


@pytest.mark.parametrize("digest", [False, True])
def test_an_edited_file_is_bad_input_in_one_line_with_or_without_a_new_digest(
    energy: str, tmp_path: Path, digest: bool
):
    old, new = "    return 0.5*u1*u1\n", "    return 1.5*u1*u1\n"
    assert old in energy
    text = energy.replace(old, new, 1)
    done = solved(tmp_path, sealed(text) if digest else text)
    assert done.returncode == 3
    assert len(done.stderr.strip().splitlines()) == 1
    reason = "running_cost contradicts the other functions" if digest else "edited by hand or damaged"
    assert reason in done.stderr
    assert "satsym derive" in done.stderr


def test_a_file_without_a_digest_is_refused(energy: str, tmp_path: Path):
    line = next(line for line in energy.splitlines(keepends=True) if line.startswith("Digest: "))
    (tmp_path / "mine.py").write_text(energy.replace(line, ""), encoding="utf-8")
    with pytest.raises(BadInput, match="edited by hand or damaged"):
        load("./mine", tmp_path)


def test_ends_of_lines_do_not_count(energy: str, tmp_path: Path):
    (tmp_path / "mine.py").write_bytes(energy.replace("\n", "\r\n").encode())
    assert load("./mine", tmp_path).spec.name == "double_integrator_energy"


def test_sealing_twice_is_sealing_once(energy: str):
    assert sealed(sealed(energy)) == sealed(energy)
    assert intact(energy)
    assert not intact(energy.replace("0.5", "0.25", 1))


def test_a_shipped_module_is_examined_as_well(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(loading, "intact", lambda text: False)
    with pytest.raises(BadInput, match=r'"saddle": edited by hand or damaged'):
        loading._load_shipped.__wrapped__("saddle")


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped())
def test_shipped_modules_agree_with_themselves_to_rounding(name: str):
    kernels = load(name)
    for seed in range(3):
        worst = consistency.worst(kernels, consistency.random_places(kernels, seed), seed)
        assert worst is not None
        # 17 states along a chain of 460 operations lose two digits more than the others by cancellation
        allowed = (0.1 if name == "gimballed_wheel" else 1e-3) * consistency.LIMIT
        if worst.function == "running_cost":  # one that is none is compared with this share of the terms that cancel
            allowed = 4.0 * np.finfo(float).eps / SMALLEST_FRACTION
        assert worst.deviation < allowed, worst


KINDS = ("polar_orbit", "polar_orbit_ball", "double_integrator_energy", "double_integrator_fuel", "van_der_pol")
SAMPLED = [*KINDS, "time_varying", "hill", "two_body"]


def missed(found: list[Mutant]) -> list[str]:
    """Mutants that change something, and no relation notices."""
    places: dict[str, dict] = {}
    left = []
    for mutant in found:
        at = places.setdefault(mutant.model, consistency.random_places(mutant.kernels))
        worst = consistency.worst(mutant.kernels, at)
        if worst is not None and worst.deviation <= consistency.LIMIT and not is_equivalent_form(mutant):
            left.append(f"{mutant.model}: {mutant.function}: {mutant.was}")
    return left


def is_equivalent_form(mutant: Mutant) -> bool:
    """A loop gives numbers to nobody one by one; for it nothing is equivalent."""
    if mutant.function in LOOPS:
        return False
    return is_equivalent(mutant)


@pytest.mark.slow
@pytest.mark.parametrize("model", SAMPLED)
def test_one_changed_number_or_sign_in_any_function_is_noticed(model: str):
    found = list(mutants(model, each=1))
    assert len(found) >= 10
    assert not missed([m for m in found if m.function.removesuffix("_batch") not in OF_CURVES])


@pytest.mark.parametrize("model", KINDS)
def test_the_same_change_in_both_forms_of_a_function_is_noticed(model: str):
    """Then only what functions have to do with one another can tell."""
    found = [m for m in mutants(model, each=1, both=True) if m.function not in (*ELSEWHERE_ONLY, *OF_CURVES)]
    assert len(found) >= 10
    assert not missed(found)


def test_a_form_that_has_no_numbers_anywhere_contradicts_the_other(energy: str, tmp_path: Path):
    head, law = energy.split("def control_law_batch(", 1)
    changed = re.sub(r"out\[0\] = (.*)", r"out[0] = \1 + 0.0*np.log(-1.0)", law, count=1)
    (tmp_path / "mine.py").write_text(sealed(f"{head}def control_law_batch({changed}"), encoding="utf-8")
    with pytest.raises(BadInput, match=r"control_law contradicts .* \(the same on floats and on arrays\)"):
        load("./mine", tmp_path)


@pytest.mark.slow
def test_files_with_a_changed_function_and_a_new_digest_are_refused(tmp_path: Path):
    for k, mutant in enumerate(mutants("double_integrator_energy", each=1)):
        if is_equivalent_form(mutant):
            continue
        (tmp_path / f"mine{k}.py").write_text(mutant.text, encoding="utf-8")
        with pytest.raises(BadInput, match=r"contradicts the other functions|stores into no entry"):  # with no zeros
            load(f"./mine{k}", tmp_path)


@pytest.fixture(scope="module")
def solutions() -> dict[str, Solution]:
    names = ("soft-return", "return-to-orbit-ball", "double-integrator-energy", "double-integrator-time")
    return {(found := solve(instance.load(name))).instance.model.spec.name: found for name in names}


@pytest.mark.slow
@pytest.mark.parametrize(
    "model", ["polar_orbit", "polar_orbit_ball", "double_integrator_energy", "double_integrator_time"]
)
def test_a_solution_is_not_certified_by_kernels_that_contradict_each_other(model: str, solutions: dict[str, Solution]):
    """Where no file is loaded by path, as with shipped modules, the certificate is what notices."""
    right = solutions[model]
    assert right.certificate is not None
    assert right.certificate.verdict == "certified"
    check = next(c for c in right.certificate.checks if c.name == "kernels contradict each other")
    assert check.value < 1e-3 * check.limit
    (first,) = (m for m in mutants(model, each=1, both=True) if m.function == "hamiltonian")
    certificate = certify(replace(right, instance=replace(right.instance, model=first.kernels)))
    assert certificate is not None
    assert certificate.verdict == "failed"
    for mutant in mutants(model, each=1, seed=2):
        if mutant.function.removesuffix("_batch") in OF_CURVES:
            continue
        wrong = replace(right, instance=replace(right.instance, model=mutant.kernels))
        noticed = with_kernels_examined(right.certificate, wrong).verdict == "failed"
        assert noticed or is_equivalent_form(mutant), (mutant.function, mutant.was)


def test_a_sample_of_fuzzed_files_ends_as_it_should(repository: Path):
    """In a process of its own: what it watches for cannot be unwatched."""
    command = [sys.executable, "tests/bench/fuzz_generated.py", "--count", "30", "--seed", "1"]
    done = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "30 files, 0 ended badly" in done.stdout
