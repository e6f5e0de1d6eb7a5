"""``satsym prove`` and its twins in Python: exit codes, JSON, and one record whichever way it was asked for."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import satsym
from satsym.proof.record import Outcome
from satsym.status import BadInput
from tests.cli.test_cli import HEAD, Run, run

__all__ = ["run"]

KEYS = (
    "reason theorem hypotheses costate_initial nodes x_final t_final objective switching_times scope numbers "
    "unique_within digits wall_s"
).split()


def test_what_is_proved_is_said_in_words_and_in_json(run: Run) -> None:
    code, out, _ = run("prove", "double-integrator-energy")
    assert code == 0
    assert "double-integrator-energy, model double_integrator_energy: proved" in out
    assert "0.5298809642880958335" in out
    code, out, _ = run("prove", "double-integrator-energy", "--json", "--digits", "12")
    found = json.loads(out)
    assert code == 0
    assert list(found) == [*HEAD, *KEYS]
    assert (found["status"], found["digits"], found["reason"]) == ("proved", 12, "")
    assert found["objective"]["centre"] == "0.529880964288"
    assert {"name", "source", "claims"} == set(found["theorem"])
    assert all({"name", "shown", "value"} == set(one) for one in found["hypotheses"])
    assert list(found["costate_initial"]["q"]) == ["centre", "radius"]
    assert len(found["switching_times"]) == 2
    assert list(found["nodes"][0]) == ["t", "x", "costates"]
    assert found["unique_within"] == pytest.approx(1e-6)


def test_exit_codes_tell_what_is_beyond_from_what_fails(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("prove", "fuller", "--json")
    assert (code, json.loads(out)["status"]) == (4, "beyond this proof")
    code, out, _ = run("prove", "double-integrator-fuel", "--set", "time.tf=1.5", "--json")  # it takes 2 at least
    assert (code, json.loads(out)["status"]) == (5, "not proved")
    assert "no solution" in json.loads(out)["reason"]
    assert json.loads(out)["theorem"] is None
    assert run("prove", "nowhere.toml")[0] == 3
    assert run("prove", "double-integrator-time", "--digits", "3")[0] == 2
    assert run("prove", "itb-earth")[0] == 4
    code, _, _ = run("prove", "double-integrator-time", "--out", str(tmp_path / "there"))
    assert code == 0
    assert json.loads((tmp_path / "there" / "result.json").read_text())["status"] == "proved"


def test_a_solution_proves_itself_as_the_function_does() -> None:
    solution = satsym.solve("double-integrator-fuel")
    one, other = solution.prove(), satsym.prove("double-integrator-fuel")
    assert one.status is other.status is Outcome.PROVED
    assert one.objective == other.objective
    assert one.costate_initial == other.costate_initial
    assert "proved" in repr(one)
    assert json.loads(one.to_json())["objective"]["centre"].startswith("0.76393202250021")
    assert one.to_dict()["status"] == "proved"
    with pytest.raises(BadInput, match="digits"):
        satsym.prove("double-integrator-fuel", digits=3)


def test_other_values_are_proved_as_they_were_given(run: Run) -> None:
    code, out, _ = run("prove", "double-integrator-fuel", "--set", "time.tf=3.5", "--json")
    found = json.loads(out)
    assert code == 0
    assert found["numbers"]["time.tf"] == "3.5"
    assert found["set"] == {"time.tf": 3.5}
    assert float(found["objective"]["centre"]) == pytest.approx(3.5 - (3.5**2 - 4) ** 0.5)
