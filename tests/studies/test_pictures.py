"""Pictures of studies show what there is to see: few rows far out do not hide the others, nothing is drawn twice."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.report.plots.studies import figures
from satsym.report.results.studies import Numbers, distinguishing

RNG = np.random.default_rng(0)


def drawn(values: np.ndarray) -> tuple[float, str]:
    """How far the bars of a histogram reach, and what stands above."""
    numbers = Numbers("a study", {"r [km]": RNG.uniform(size=len(values))}, {"q": values}, ["converged"] * 500, None)
    (place,) = figures(numbers)["overview"].axes
    return max(abs(end) for end in place.get_xlim()), place.get_title()


def test_rows_far_out_are_not_drawn_but_counted() -> None:
    values = RNG.normal(size=500)
    values[[3, 77]] = 1e9, -1e5
    reach, title = drawn(values)
    assert reach < 10.0
    assert "not shown: 2 of 500 cases, far from the others, with values between −1 × 10⁵ and 1 × 10⁹" in title


@pytest.mark.parametrize(
    "values", [RNG.normal(size=500), RNG.uniform(size=500), RNG.exponential(size=500), np.ones(500)]
)
def test_where_none_are_far_out_all_are_drawn(values: np.ndarray) -> None:
    _, title = drawn(np.clip(values, -4.0, 6.0))
    assert "not shown" not in title


def test_units_on_axes_are_spelled_as_people_write_them() -> None:
    cost, speed = "objective [m**2/s**3]", "v [km/s/rad]"
    grid = {speed: np.repeat([1.0, 2.0], 3), "a [m/s**2]": np.tile([1.0, 2.0, 4.0], 2)}
    for varied, shape in ((grid, (2, 3)), ({speed: np.arange(6.0)}, (6,)), (grid, None)):
        numbers = Numbers("a study", varied, {cost: np.arange(6.0)}, ["converged"] * 5 + ["infeasible"], shape)
        axes = [place for page in figures(numbers).values() for place in page.axes]
        texts = " ".join(text for place in axes for text in (place.get_xlabel(), place.get_ylabel()))
        assert "$J$ [m²/s³]" in texts
        assert "v [km/(s·rad)]" in texts
        assert "**" not in texts


def test_a_duration_that_is_the_objective_is_drawn_once() -> None:
    times = RNG.uniform(1.0, 2.0, 50)
    columns = {"objective [s]": times, "t_final [s]": times * (1.0 + 1e-13), "x_final.r": RNG.uniform(size=50)}
    assert list(distinguishing(columns, {})) == ["objective [s]", "x_final.r"]
    assert list(distinguishing({**columns, "t_final [s]": times * (1.0 + 1e-6)}, {})) == list(columns)


def test_only_the_side_that_is_far_out_is_said() -> None:
    values = RNG.normal(size=500)
    values[[3, 77]] = -2e5, -1e5
    assert (
        "not shown: 2 of 500 cases, far from the others, with values between −2 × 10⁵ and −1 × 10⁵" in drawn(values)[1]
    )


def grid(values: np.ndarray, name: str) -> object:
    """The panel of a map of so many rows and columns."""
    x, y = np.meshgrid(np.arange(float(values.shape[0])), np.arange(float(values.shape[1])), indexing="ij")
    varied, quantities = {"a": x.ravel(), "b": y.ravel()}, {name: values.ravel()}
    return figures(Numbers("", varied, quantities, ["converged"] * values.size, values.shape))["overview"].axes[0]


def test_zero_is_white_on_maps_of_what_has_both_signs() -> None:
    values = np.linspace(-1.0, 3.0, 30).reshape(6, 5)
    (mesh,) = grid(values, "v").collections
    assert mesh.get_clim() == (-3.0, 3.0)
    (mesh,) = grid(values + 1.0, "v").collections
    assert mesh.get_clim() == (0.0, 4.0)


def test_maps_of_the_cost_have_contours() -> None:
    values = np.add.outer(np.arange(6.0) ** 2, np.arange(5.0) ** 2)
    _, lines = grid(values, "objective [s]").collections
    assert len(lines.levels) > 3
    assert len(grid(values, "v [s]").collections) == 1
    assert len(grid(np.ones((6, 5)), "objective [s]").collections) == 1
