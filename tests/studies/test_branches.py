"""Branches of minima in studies: jumps are seen, rows take what costs less beside them, and it is said how many did."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from satsym.arrays import Array
from satsym.front.studies import Study, study
from satsym.report.plots.studies import figures
from satsym.report.results.studies import numbers
from satsym.report.results.study_table import path_of
from satsym.studies.branches import ORIGIN, jumping
from satsym.symbolic import Problem
from tests.support.chunks import Here
from tests.support.models import build, k, q, scalar, w

WELLS: Problem = scalar("two_wells_at_the_end", w, w**2 / 2, 5 * (q**2 - 1) ** 2 + k * q, "free")
MAP = {"initial.q": (-0.6, 0.6, 9), "parameters.k": (-3.0, 3.0, 5)}
LINE = {"initial.q": (-0.6, 0.6, 13)}


def least(start: float, tilt: float) -> float:
    """Speeds are constant: what is left is a polynomial in the final state."""
    end = Polynomial([0.0, 1.0])
    cost = (end - start) ** 2 / 2.0 + 5.0 * (end**2 - 1.0) ** 2 + tilt * end
    return float(min(cost(root.real) for root in cost.deriv().roots() if abs(root.imag) < 1e-9))


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = "[parameters]\nk = 0.05\n[initial]\nq = 0.4\n[time]\ntf = 1.0\n"
    return build(tmp_path_factory.mktemp("wells"), WELLS, text).path


@pytest.fixture(scope="module")
def mapped(case: Path) -> Study:
    return study(case, case.parent / "map", vary=MAP, executor=lambda: Here(None), workers=1)


@pytest.mark.slow
def test_each_row_of_a_map_has_the_deeper_of_two_wells_and_says_on_which_side_it_is(mapped: Study) -> None:
    """Each row follows its neighbours, and all lie in one well until the other is known to be deeper somewhere."""
    truth = [least(*one) for one in zip(mapped["initial.q"], mapped["parameters.k"], strict=True)]
    assert np.allclose(mapped["objective"], truth, rtol=1e-8, atol=1e-8)
    found = mapped.summary["branches"]
    moved = mapped["origin"] == ORIGIN
    assert 0 < moved.sum() <= found["changed"]
    assert set(mapped["branch"]) == {1.0, 2.0}
    right = mapped["x_final.q"] > 0.0
    assert len(set(zip(right, mapped["branch"], strict=True))) == 2, "a branch is a well"
    table = mapped["branch"].reshape(9, 5)
    assert found["borders"] == (np.diff(table, axis=0) != 0).sum() + (np.diff(table, axis=1) != 0).sum()
    assert f"{found['changed']} cases changed to a branch with a lower cost" in repr(mapped)


@pytest.mark.slow
def test_branches_come_out_the_same_with_any_number_of_workers(mapped: Study, case: Path) -> None:
    again = study(case, case.parent / "again", vary=MAP, workers=2)
    for name in ("table.csv", "result.json", "study.json"):
        assert (again.folder / name).read_bytes() == (mapped.folder / name).read_bytes(), name


def test_trajectories_are_those_of_the_answers_that_rows_took(case: Path) -> None:
    found = study(case, case.parent / "line", vary=LINE, trajectories=True, executor=lambda: Here(None), workers=1)
    assert found.summary["branches"]["changed"] > 0
    with np.load(found.folder / "trajectories-000.npz") as stored:
        ends = [stored[f"{row}.x"][0, -1] for row in range(13)]
    assert np.allclose(ends, found["x_final.q"], rtol=0.0, atol=1e-12)


def test_pictures_show_where_branches_meet(mapped: Study) -> None:
    page = figures(numbers(path_of(mapped.folder), mapped.summary))["overview"]
    crosses = sum(len(line.get_xdata()) for line in page.axes[0].lines)
    assert crosses == mapped.summary["branches"]["borders"]


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (np.exp(np.linspace(0.0, 4.0, 12)), []),
        (np.sin(np.linspace(0.0, 6.0, 25)), []),
        (np.abs(np.linspace(-1.0, 1.2, 12)), []),
        (np.full(9, 3.0) + 1e-9 * np.cos(np.arange(9.0) ** 2), []),
        (np.linspace(0.0, 1.0, 12) + (np.arange(12) > 6), [6]),
        (np.linspace(0.0, 1.0, 12) + (np.arange(12) == 5), [4, 5]),
        (np.linspace(0.0, 1.0, 12) + (np.arange(12) == 0), [0]),
    ],
    ids=["growth", "wave", "corner", "rounding", "step", "a row alone", "the first row"],
)
def test_a_jump_is_more_than_what_rows_nearby_change_by(values: Array, expected: list[int]) -> None:
    places = np.arange(float(len(values)))
    assert np.flatnonzero(jumping(places, values[:, None])).tolist() == expected
    assert not jumping(places[:3], np.array([[0.0], [9.0], [0.0]])).any()


def test_rows_without_an_answer_between_others_divide_no_branch() -> None:
    places, values = np.array([0.0, 1.0, 2.0, 6.0, 7.0, 8.0]), np.array([0.0, 1.0, 2.0, 6.0, 7.0, 8.0])
    assert not jumping(places, values[:, None]).any()
