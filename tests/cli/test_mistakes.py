"""Mistakes that newcomers make: one line says what, where, and what to write instead."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym.instance.files import SHIPPED
from tests.cli.test_cli import Run, case, run

__all__ = ["case", "run"]

OPTIONS = {
    "both bounds at once": ("control.u1=0.1", "bounds are control.u1.lower and control.u1.upper"),
    "a parameter of another model": ("parameters.lowest=1", "available: parameters.sigma"),
    "a letter too few": ("parameters.sigm=1", 'did you mean "parameters.sigma"?'),
    "a state without its table": ("r=1", 'did you mean "initial.r"?'),
}
CHANGES = {
    "text without quotes": ('theta = "reference"', "theta = reference", "put text in quotes"),
    "a decimal comma": ("r = 1.1", "r = 1,1", "numbers are written with a decimal point"),
    "a norm where there are bounds": ("[-0.05, 0.05]", "0.1\nmax_norm = 0.05", "u1: got 0.1; give both bounds"),
}


@pytest.mark.parametrize("mistake", OPTIONS)
def test_a_number_that_is_set_by_a_wrong_name(run: Run, mistake: str) -> None:
    given, instead = OPTIONS[mistake]
    code, out, err = run("solve", "return-to-orbit-005", "--set", given)
    assert (code, out, err.count("\n")) == (3, "", 1)
    assert instead in err
    assert "parameters.omega" not in err or "available" in err


@pytest.mark.parametrize("mistake", CHANGES)
def test_an_instance_with_a_mistake(run: Run, tmp_path: Path, mistake: str) -> None:
    right, wrong, instead = CHANGES[mistake]
    text = (SHIPPED / "return-to-orbit-005.toml").read_text(encoding="utf-8")
    assert right in text
    (tmp_path / "mine.toml").write_text(text.replace(right, wrong, 1), encoding="utf-8")
    code, out, err = run("solve", "mine.toml")
    assert (code, out, err.count("\n")) == (3, "", 1)
    assert err.startswith("satsym: mine.toml: ")
    assert instead in err


def test_what_only_a_solver_finds_wrong_names_the_file_too(run: Run, tmp_path: Path) -> None:
    """A path constraint that the initial state breaks; of what comes with satsym the name is enough."""
    text = (SHIPPED / "return-above.toml").read_text(encoding="utf-8")
    (tmp_path / "low.toml").write_text(text.replace("r = 1.1", "r = 0.9", 1), encoding="utf-8")
    code, _, err = run("solve", "low.toml")
    assert code == 3
    assert err.startswith("satsym: low.toml: initial: path constraint ")
    assert run("lqr", "soft-return")[2].startswith("satsym: soft-return: [lqr]: missing; add ")


def test_a_name_of_something_else_leads_to_the_instances(run: Run, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("")
    for name, instead in (("mine", 'did you mean "mine.toml"?'), ("fuller-x", '"fuller"'), ("hill", "available")):
        assert instead in run("solve", name)[2]
    assert "instances of this model: ends-1-given" in run("solve", "polar_orbit")[2]
