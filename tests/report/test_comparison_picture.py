"""Instances side by side: where one curve would hide another, the difference has a panel of its own."""

from __future__ import annotations

import numpy as np
import pytest

import satsym
from satsym import instance
from satsym.analysis.comparison import case_of
from satsym.report.plots import comparison, style
from satsym.report.results.objects import times
from satsym.report.terminal.comparison import unit_of


def test_units_of_what_is_summed_up_over_time_are_shortened() -> None:
    assert times("km/s**2", "s") == "km/s"
    assert times("N*m", "N*m", "s") == "N**2*m**2*s"
    assert unit_of([case_of(instance.load("lapan-classical"))], "impulse") == "N*m*s"


@pytest.mark.parametrize(("start", "hidden"), [(1.0005, True), (1.5, False)])
def test_what_one_curve_hides_of_another_is_drawn_as_a_difference(start: float, hidden: bool) -> None:
    body = satsym.load("double-integrator-energy")
    first, other = (case_of(one.case) for one in (body, body.with_(initial={"q": start})))
    with style.applied():
        page = comparison.page([first, other])
    assert page is not None
    said = f"difference from {first.instance.name}"
    found = {axes.get_ylabel(): axes for axes in page.axes if axes.get_title(loc="left") == said}
    assert bool(found) is hidden
    if hidden:
        line = found[r"$\Delta$$q$ [mm]"].lines[0]
        assert line.get_ydata()[0] == pytest.approx(1e3 * (start - 1.0))
        times = line.get_xdata()
        wanted = other.x[0] - np.interp(times, first.times, first.x[0])
        np.testing.assert_allclose(line.get_ydata(), 1e3 * wanted, atol=1e-9)
