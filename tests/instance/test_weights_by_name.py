"""Weights of a regulator by name, as studies and --set change them; and the cross weight of an instance."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

import satsym
from satsym import instance
from satsym.analysis.regulator.feedback import designed, simulate
from satsym.instance.numbers import changed
from satsym.status import BadInput

CROSS = """
model = "clohessy_wiltshire"
title = "A regulator with a cross weight"
[initial]
x1 = 0.01
x2 = 0.0
x3 = 0.0
x4 = 0.0
[time]
tf = 40.0
[lqr]
Q = [2, 1, 1, 1]
R = [1.0]
N = [[0.1], [0.2], [0.0], [-0.3]]
inputs = ["u2"]
"""


def case(folder: Path, text: str = CROSS) -> instance.Instance:
    path = folder / "cross.toml"
    path.write_text(text, encoding="utf-8")
    return instance.load(path)


def test_the_cross_weight_of_an_instance_is_that_of_scipy_and_is_paid(tmp_path: Path) -> None:
    given = case(tmp_path)
    design = designed(given)
    A, B = design.about.system.A, design.about.system.with_inputs(["u2"]).B
    N = np.array([[0.1], [0.2], [0.0], [-0.3]])
    P = scipy.linalg.solve_continuous_are(A, B, np.diag([2.0, 1, 1, 1]), [[1.0]], s=N)
    np.testing.assert_allclose(design.regulator.P, P, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(design.regulator.K, B.T @ P + N.T, rtol=1e-9, atol=1e-10)
    paid = simulate(given, "lqr").metrics
    assert paid["lqr_cost_linear"] == pytest.approx(P[0, 0] * 1e-4, rel=1e-9)
    assert paid["lqr_cost"] == pytest.approx(paid["lqr_cost_linear"], rel=1e-5)


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ("N = [[0.1], [0.2], [0.0]]", r"\[lqr\] N: the matrix has the wrong shape; give a row for each state \(4\)"),
        ("N = [[0.1, 0], [0.2, 0], [0, 0], [0, 0]]", "a number for each active input \\(1\\)"),
    ],
)
def test_a_cross_weight_of_another_shape_is_refused(tmp_path: Path, wrong: str, complaint: str) -> None:
    with pytest.raises(BadInput, match=complaint):
        case(tmp_path, CROSS.replace("N = [[0.1], [0.2], [0.0], [-0.3]]", wrong))


def test_weights_are_changed_by_name(tmp_path: Path) -> None:
    given = case(tmp_path)
    other = changed(given, {"lqr.Q.x2": 5.0, "lqr.R.u2": 4.0, "lqr.N.x4.u2": 0.5})
    assert other.lqr is not None
    assert np.diag(other.lqr.Q).tolist() == [2.0, 5.0, 1.0, 1.0]
    assert other.lqr.R == ((4.0,),)
    assert other.lqr.N == ((0.1,), (0.2,), (0.0,), (0.5,))
    assert changed(instance.load("uny-lqr"), {"lqr.N.x1.u2": 0.5}).lqr.N == ((0.5,), (0.0,), (0.0,), (0.0,))
    with pytest.raises(BadInput, match=r"\[lqr\] R: not positive definite"):
        changed(given, {"lqr.R.u2": 0.0})
    with pytest.raises(BadInput, match=r"lqr.R.u1: .* gives no numerical value for this key"):
        changed(given, {"lqr.R.u1": 1.0})


def test_a_study_varies_all_three(tmp_path: Path) -> None:
    case(tmp_path)
    given = satsym.load(tmp_path / "cross.toml")
    axes = {"lqr.R.u2": "1:2:2", "lqr.N.x1.u2": "0.1:0.2:2"}
    satsym.study(given, tmp_path / "study", command="lqr", vary=axes, workers=1)
    with (tmp_path / "study" / "table.csv").open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    assert len(rows) == 4
    for row in rows:
        values = {name: float(row[name]) for name in axes}
        one = designed(changed(given.case, values))
        assert float(next(v for k, v in row.items() if k.startswith("cost_from"))) == pytest.approx(
            one.regulator.cost(one.deviation), rel=1e-9
        )
