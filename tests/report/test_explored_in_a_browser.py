"""The sliders of an interactive page, moved in a browser without a window, where there is one."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym import instance
from satsym.report.page.explored import Answer
from satsym.report.page.run import Given, render
from satsym.solution import Solution
from satsym.solvers import solve

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
QUIET = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]
playwright = pytest.importorskip("playwright.sync_api", reason="pip install 'satsym[pages]'")
pytestmark = [pytest.mark.skipif(BROWSER is None, reason="there is no Chromium here"), pytest.mark.slow]


@pytest.fixture(scope="module")
def answers() -> list[Solution]:
    case = instance.load("double-integrator-time")
    return [solve(replace(case, initial=(place, 0.0))) for place in (1.0, 4.0)]


@pytest.fixture(scope="module")
def page(answers: list[Solution], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    path: Path = tmp_path_factory.mktemp("page") / "page.html"
    found = [Answer(one, f"initial.q = {one.x[0, 0]:g}") for one in answers]
    path.write_text(render(answers[0], None, Given("double-integrator-time"), "en", found), encoding="utf-8")
    with playwright.sync_playwright() as started:
        engine = started.chromium.launch(executable_path=BROWSER, args=QUIET)
        opened = engine.new_page(viewport={"width": 1200, "height": 900})
        errors: list[str] = []
        asked: list[str] = []
        opened.on("pageerror", lambda error: errors.append(str(error)))
        opened.on("request", lambda request: asked.append(request.url))
        opened.goto(path.as_uri())
        opened.wait_for_selector("#explore-reading td[data-panel]")
        yield opened
        assert errors == []
        assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
        engine.close()


JOINED = (2.0 / 199.0) ** 2 / 8.0 + 1e-6
"""Error of straight lines between the 200 nodes of each of several answers, over 2 s with an acceleration of one."""


def value(page: Any, panel: int) -> float:
    return float(page.locator(f'td[data-panel="{panel}"]').text_content().split()[0].replace("−", "-"))


def test_the_slider_moves_the_time_of_the_table_and_of_the_curves(page: Any) -> None:
    page.locator("#explore-time").fill("250")
    assert page.locator("#explore-stated").text_content() == "t = 0.5 s"
    assert value(page, 0) == pytest.approx(1.0 - 0.5 * 0.5**2, abs=JOINED)
    assert value(page, 1) == pytest.approx(-0.5, abs=1e-5)
    assert value(page, 2) == -1.0, "the control, before it switches"
    assert page.locator('td[data-panel="1"]').text_content().endswith(" m/s"), "a value has its unit"
    marked = "data.filter((d) => d.mode === 'lines+markers').map((d) => [d.x[1], d.y[1]])"
    cursors = page.evaluate(f"document.getElementById('explore-panels').{marked}")
    np.testing.assert_allclose(cursors[0], [0.5, 0.875], atol=JOINED)
    page.locator("#explore-time").fill("750")
    assert value(page, 2) == 1.0


def test_the_other_slider_chooses_another_answer(page: Any) -> None:
    page.locator("#explore-answer").fill("1")
    page.locator("#explore-time").fill("500")
    assert "initial.q = 4" in page.locator("#explore-cost").text_content()
    assert page.locator("#explore-stated").text_content() == "t = 2 s", "half of the time that it takes"
    assert value(page, 0) == pytest.approx(2.0, abs=1e-4)
    page.locator("#explore-answer").fill("0")


def test_a_page_that_becomes_dark_has_other_colours(page: Any) -> None:
    colour = "document.getElementById('explore-panels').layout.font.color"
    light = page.evaluate(colour)
    page.emulate_media(color_scheme="dark")
    page.wait_for_function(f"{colour} !== '{light}'")
    page.emulate_media(color_scheme="light")
    page.wait_for_function(f"{colour} === '{light}'")


def test_the_slider_moves_the_animation_of_the_page(page: Any) -> None:
    """Its own discs stand where the time of the slider has them, and do not move by themselves."""
    page.evaluate(ANIMATED)
    seen = "getComputedStyle(document.getElementById('disc')).transform"
    page.locator("#explore-time").fill("250")
    assert page.evaluate(seen) == "matrix(1, 0, 0, 1, 25, 0)"
    page.wait_for_timeout(200)
    assert page.evaluate(seen) == "matrix(1, 0, 0, 1, 25, 0)"


ANIMATED = """document.querySelector("main").insertAdjacentHTML("beforeend",
  "<section id='motion'><style>@keyframes d{to{transform:translate(100px,0)}}</style><figure class='motion driven'>" +
  "<svg><circle id='disc' class='body' style='animation-name:d'/></svg></figure></section>")"""


def test_it_plays_and_pauses(page: Any) -> None:
    page.locator("#explore-time").fill("0")
    page.locator("#explore-play").click()
    page.wait_for_function("Number(document.getElementById('explore-time').value) > 20")
    page.locator("#explore-play").click()
    still = page.locator("#explore-stated").text_content()
    page.wait_for_timeout(200)
    assert page.locator("#explore-stated").text_content() == still


def test_pointing_at_a_curve_sets_the_time_of_all(page: Any) -> None:
    panels = page.locator("#explore-panels .nsewdrag").first
    panels.scroll_into_view_if_needed()
    box = panels.bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    page.wait_for_timeout(400)
    said = page.locator("#explore-stated").text_content()
    assert float(said.removeprefix("t = ").removesuffix(" s")) == pytest.approx(1.0, abs=0.05)
