"""The page of a run: it needs nothing but itself, says what the result says, and moves as the solution does."""

from __future__ import annotations

import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import satsym
from satsym import instance
from satsym.analysis.regulator.feedback import simulate
from satsym.report.html.markup import Markup, math, prose
from satsym.report.page import answer
from satsym.report.page.answer import typeset
from satsym.report.page.derived import Derived
from satsym.report.page.motion import SECONDS, SIDE, TURNS, motion
from satsym.report.page.run import Given, overview, pictures, problem, render
from satsym.report.plots.scene import Scene
from satsym.report.plots.space.attitudes import Attitude
from satsym.report.plots.space.views import from_aside
from satsym.report.terminal.certificate import condition_rows, verdict_text
from satsym.report.terminal.solution import solution_text
from satsym.report.texts import load
from satsym.solution import Certificate, Check, Solution
from satsym.status import Status, Verdict
from satsym.symbolic import loader
from tests.cli.test_cli import Run, case, run
from tests.support.derived import derived, stated
from tests.support.solved import solve

__all__ = ["case", "run"]

PAGES = Path(satsym.__file__).parent / "report"


class Page(HTMLParser):
    """What is looked for in a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.headings: list[int] = []
        self.tags: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.tags.add(tag)
        self.ids += [given["id"] or ""] if "id" in given else []
        target = given.get("href") or given.get("xlink:href") or ""
        self.links += [target] if target else []
        self.loaded += [given["src"] or ""] if "src" in given else []
        self.headings += [int(tag[1])] if re.fullmatch("h[1-6]", tag) else []


@pytest.fixture(scope="module")
def solution() -> Solution:
    return solve(instance.load("soft-return"))


@pytest.fixture
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave pictures out of pages, where these are looked at for their words."""
    monkeypatch.setattr("satsym.report.page.run.pictures", lambda _solution, _texts: [])
    monkeypatch.setattr("satsym.report.page.run.overview", lambda _solution, _texts: Markup())


CELL = '<td class="number">'
"""What a number of a table begins with."""


@pytest.fixture(scope="module")
def text(solution: Solution) -> str:
    return render(solution, derived(loader.problem("polar_orbit")[0]), Given("soft-return"))


@pytest.mark.slow
def test_it_loads_nothing_and_all_its_links_lead_somewhere_in_it(text: str) -> None:
    page = Page(text)
    assert not page.tags & {"script", "link", "img", "iframe"}
    assert not page.loaded
    assert not re.search(r"@import|url\((?!#)", text)
    assert len(page.ids) == len(set(page.ids))
    assert {link[1:] for link in page.links} <= set(page.ids)
    assert all(link.startswith("#") for link in page.links)
    assert all(after - before <= 1 for before, after in zip(page.headings, page.headings[1:], strict=False))


@pytest.mark.slow
def test_it_says_what_the_result_says(text: str, solution: Solution) -> None:
    assert f"<dt>Cost</dt><dd>{solution.objective:.10g}</dd>" in text  # an orbit of radius 1 has no units
    given = solution.instance.path.read_text(encoding="utf-8").splitlines()[0]
    assert given.replace('"', "&quot;").replace("'", "&#x27;") in text


def test_it_says_of_the_certificate_what_the_terminal_says(text: str, solution: Solution) -> None:
    found = solution.certificate
    assert found is not None
    section = unescape(text.partition('<section id="certificate">')[2].partition("</section>")[0])
    printed = [line.split() for line in solution_text(solution).splitlines()]
    assert "3, final time given, final state wholly or partly free" in text
    assert "boundary type 3, final time given, final state wholly or partly free".split() in printed
    assert verdict_text(found).capitalize() in section
    for said, measured, limit, _ in condition_rows(found)[1:]:
        assert f"{said} {measured} {limit}".split() in printed
        assert f'scope="row">{said}</th>{CELL}{typeset(measured)}</td>{CELL}{typeset(limit)}</td>' in section, said


def test_a_condition_that_failed_and_one_that_holds_are_told_apart_on_the_page() -> None:
    checks = (Check("kernels contradict each other", 1.0, 1e-9), Check("boundary residual", 1e-12, 1e-9))
    found = Certificate(Verdict.FAILED, 0.0, 0.0, 0.0, 0.0, 1.0, None, checks)
    shown = answer.certificate(found, instance.load("soft-return").model.spec, load("en"))
    assert f"generated kernels do not agree with each other</th>{CELL}1</td>{CELL}1 × 10⁻⁹</td><td>FAILED</td>" in shown
    assert f"boundary conditions satisfied</th>{CELL}1 × 10⁻¹²</td>{CELL}1 × 10⁻⁹</td><td>\N{CHECK MARK}</td>" in shown
    assert "elsewhere" not in shown, "said of certified answers only"


@pytest.mark.slow
def test_the_facts_have_the_times_of_points_on_the_way() -> None:
    found = solve(instance.load("inspection"))
    (event,) = found.events
    assert f"<dd>interior viewpoint at {event.t:.10g}</dd>" in answer.facts(found, load("en"))


def test_the_problem_comes_first_and_the_derivation_after_what_it_leads_to(text: str, solution: Solution) -> None:
    order = re.findall(r'<section id="(\w+)">', text)
    assert order == "problem answer motion pictures certificate derivation reproduce".split()
    problem = text.partition('<section id="problem">')[2].partition("</section>")[0]
    assert "<math" in problem, "what is minimised"
    for state, value in zip(solution.instance.model.spec.states, solution.instance.initial, strict=True):
        symbol = re.escape(math(state.latex))
        assert re.search(rf'scope="row">{symbol}</th>{CELL}{value:g}</td><td>free</td>', problem), state.symbol


def test_bounds_and_ranges_are_stated_with_the_problem() -> None:
    page = problem(instance.load("return-to-geo"), None, (), load("en"))
    u1, theta = re.escape(math("u_1")), re.escape(math(r"\theta"))
    assert re.search(rf'scope="row">{u1}</th>{CELL}−4 × 10⁻⁸</td>{CELL}4 × 10⁻⁸</td><td>km/s²</td>', page)
    ranged = problem(instance.load("return-to-geo-window"), None, (), load("en"))
    assert re.search(rf'scope="row">{theta}</th>{CELL}0.000349\d+</td><td>\[6.3003\d+, 6.3004\d+\]</td>', ranged)
    assert "The motion lasts from 0 s to 86400 s." in page
    free = problem(instance.load("transfer-time"), None, (), load("en"))
    assert "the final time is free" in free


def test_every_step_of_the_derivation_is_there_with_its_equations_and_checks(text: str) -> None:
    steps = derived(loader.problem("polar_orbit")[0]).steps
    text = text.partition('<section id="derivation">')[2]
    assert text.count('class="step"') == len(steps)
    assert text.count('<ul class="checks"') == len(steps)
    assert text.count("<li>") == sum(len(step.checks) for step in steps)
    for name in ("hamiltonian.H", "control_law.u1"):
        assert f'id="polar_orbit:{name}"' in text
    assert not re.search(r"\\[a-z]+|\$[^<]*\$", text)


def test_named_constants_are_defined_before_the_steps_that_refer_to_them(text: str) -> None:
    text = text.partition('<section id="problem">')[2]
    stated, steps = text.split('class="step"', 1)
    equation = stated.partition('id="polar_orbit:declared.mu"')[2]
    assert re.sub(r"\s+", "", re.sub("<[^>]*>", "", equation)).lstrip(">").startswith("μ=σ3ω2(1)")
    assert re.search(r'the named constants\W<a href="#polar_orbit:declared.mu">\(1\)</a>', steps)


def test_the_disc_ends_where_the_path_ends_and_stands_there_without_motion(text: str) -> None:
    path = re.search(r'<path d="M([^"]*)" class="path">', text)
    frames = re.search(r"@keyframes path\{.*?100%\{transform:translate\((.*?)px,(.*?)px\)\}\}", text)
    still = re.search(r'class="body of-path" style="animation-name:path;transform:translate\((.*?)px,(.*?)px\)"', text)
    assert path is not None
    assert frames is not None
    assert still is not None
    last = tuple(map(float, path[1].split("L")[-1].split()))
    assert tuple(map(float, frames.groups())) == tuple(map(float, still.groups())) == last
    assert re.search(
        r"prefers-reduced-motion: reduce\) \{\s*\.motion:not\(\.driven\) :is\(\.body, \.frame\) \{ animation", text
    )
    assert "#pause:checked ~ svg .body { animation-play-state: paused; }" in text


def test_what_is_too_near_its_reference_to_be_told_from_it_moves_as_it_is_seen_from_there() -> None:
    """Five kilometres above a geostationary slot are a tenth of a pixel of its orbit."""
    scene = Scene.of(solve(instance.load("return-to-geo")))
    drawn = str(motion(scene, load("en")))
    assert "seen from the reference point" in drawn
    path = re.search(r'<path d="M([^"]*)" class="path">', drawn)
    cross = re.search(r'<path d="M([-.\d]+) ([-.\d]+)h12', drawn)
    assert path is not None
    assert cross is not None
    (x, y), *_, last = [tuple(map(float, place.split())) for place in path[1].split("L")]
    origin = float(cross[1]) + 6.0, float(cross[2])
    np.testing.assert_allclose(last, origin, atol=0.06)
    ahead, above = scene.x[2, 0] * scene.x[0, 0], 5.0
    np.testing.assert_allclose((x - origin[0]) / (origin[1] - y), ahead / above, rtol=0.01)


@pytest.mark.slow
def test_burns_are_drawn_in_pieces_and_the_caption_says_what_this_picture_has() -> None:
    scene = Scene.of(solve(instance.load("transfer-fuel")))
    drawn = str(motion(scene, load("en"), driven=True))
    burns = re.search(r'<path d="([^"]*)" class="burns">', drawn)
    assert burns is not None
    assert burns[1].count("M") == 3
    caption = drawn.partition("<figcaption>")[2]
    for said in ("The ring follows the target.", "Thick arcs are burns.", "The slider of the section Explore sets"):
        assert said in caption, said
    assert "reference" not in caption, "it has none"
    assert "inadmissible" not in caption


def test_a_body_that_turns_is_shown_turn_by_turn_and_stands_at_its_end_without_motion() -> None:
    """Its third axis is where the rotation has it, seen from aside."""
    drawn = str(motion(Scene.of(simulate(instance.load("gravity-gradient"), None)), load("en")))
    frames = re.findall(r'<g class="frame( last)?" style="animation-delay:([-.\d]+)s">', drawn)
    assert len(frames) == TURNS
    assert [last for last, _ in frames] == [""] * (TURNS - 1) + [" last"]
    starts = [float(delay) for _, delay in frames]
    assert starts[0] == -SECONDS
    assert starts == sorted(starts)
    assert "All angles are magnified" in drawn, "they are small"
    found = Attitude.of(Scene.of(simulate(instance.load("gravity-gradient"), None)))
    assert found is not None
    ends = re.findall(r'<path d="M[-.\d ]+L([-.\d ]+)" class="axis-3">', drawn)
    view = from_aside(("", "", "")).axes @ found.turns[-1] @ np.array([0.0, 0.0, 1.15])
    last = [float(value) for value in ends[-1].split()]
    np.testing.assert_allclose(last, [0.5 * SIDE + 0.3 * SIDE * view[0], 0.5 * SIDE - 0.3 * SIDE * view[1]], atol=0.06)


@pytest.mark.usefixtures("without_pictures")  # which have a test of their own
def test_the_same_run_gives_the_same_page_and_a_failed_one_says_so(solution: Solution) -> None:
    short = replace(solution, certificate=None)
    indonesian = render(short, None, Given("soft-return"), "id")
    assert indonesian == render(short, None, Given("soft-return"), "id")
    assert "6,283185307" in indonesian  # as in its pictures and formulas
    assert "1,1" in re.findall(f"{CELL}([^<]*)</td>", indonesian)
    assert "6.283185307" in render(short, None, Given("soft-return"), "en")
    failed = render(replace(solution, certificate=None, message="<b>no & way"), None, Given("x"), "en")
    assert "&lt;b&gt;no &amp; way" in failed


@pytest.mark.usefixtures("without_pictures")
def test_the_commands_that_reproduce_it_name_the_file_of_a_model_of_ones_own(
    text: str, solution: Solution, tmp_path: Path
) -> None:
    own = render(solution, derived(loader.problem("polar_orbit")[0]), Given("x.toml", "my model.py"))
    assert "satsym latex polar_orbit" in text
    assert "satsym report x.toml --html report.html --derivation &#x27;my model.py&#x27;" in own
    assert "satsym latex &#x27;my model.py:polar_orbit&#x27;" in own
    assert "satsym derive" not in own, "its module is shipped"
    file = tmp_path / "x.toml"
    file.write_text('model = "generated/polar_orbit"\n', encoding="utf-8")
    whole = replace(solution, instance=replace(solution.instance, path=file))
    named = render(whole, None, Given("mine/x.toml", "mine/m.py", page="mine.html"))
    assert "<code>satsym derive mine/m.py --out mine/generated\n" in named
    assert "--html mine.html --derivation mine/m.py" in named
    assert "satsym latex" not in render(solution, None, Given("x.toml"))


@pytest.mark.usefixtures("without_pictures")
def test_other_values_are_told_beside_the_instance_and_in_the_commands_that_reproduce_it(solution: Solution) -> None:
    values = ("initial.r=1.05", "parameters.c1=a b")
    page = render(solution, None, Given("x.toml", values=values))
    assert "<p>Values that replace those in the file: initial.r=1.05, parameters.c1=a b.</p>" in page
    given = "x.toml --set initial.r=1.05 --set &#x27;parameters.c1=a b&#x27;"
    assert f"satsym solve {given} --plot" in page
    assert f"satsym report {given} --html" in page
    assert "Values that replace" not in render(solution, None, Given("x.toml"))


@pytest.mark.slow
def test_a_page_may_be_of_other_values_than_the_file_has(run: Run, tmp_path: Path) -> None:
    code, _, err = run("report", "double-integrator-energy", "--html", "page.html", "--set", "initial.nothing=1")
    assert code == 3
    assert "nothing" in err
    assert not (tmp_path / "page.html").exists()
    assert run("report", "double-integrator-energy", "--html", "page.html", "--set", "time.tf=2.5")[0] == 0
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert re.search(r"<dd>2\.5( s)?</dd>", text)


def test_sentences_become_html_with_their_formulas_and_numbers() -> None:
    made = prose(r"From~\eqref{a:b} of step~\ref{c}, with $x < 1$, a & b -- both", {"a:b": "(3)"})
    assert isinstance(made, Markup)
    assert made.startswith('From\N{NO-BREAK SPACE}<a href="#a:b">(3)</a> of step\N{NO-BREAK SPACE}, with <math')
    assert made.endswith("a &amp; b \N{EN DASH} both")


def test_derivation_files_are_executed_only_where_they_are_named(run: Run, tmp_path: Path) -> None:
    (tmp_path / "sled.py").write_text(SLED, encoding="utf-8")
    assert run("report", "soft-return")[0] == 2
    code, _, err = run("report", "soft-return", "--html", "page.html", "--derivation", "sled.py")
    assert code == 3
    assert "polar_orbit" in err
    assert not (tmp_path / "page.html").exists()


SLED = """
import sympy
from satsym.symbolic import FirstOrder, Variable
q = sympy.Symbol("q", real=True)
S = Variable("q", "q", "m")
PROBLEMS = (FirstOrder(name="sled", title="sled", rates={q: -q}, states=(S,), controls=(), parameters=()),)
"""


@pytest.mark.slow
def test_pictures_take_their_colours_from_the_page_and_know_no_others(solution: Solution) -> None:
    drawn = "".join(pictures(solution, load("en")))
    named = set(re.findall(r"var\(--([a-z]+)\)", drawn))
    assert {"ink", "line", "card", "blue", "vermilion"} <= named
    assert not re.findall(r"#[0-9a-fA-F]{6}\b", drawn)
    style = (PAGES / "page" / "report.css").read_text("utf-8") + (PAGES / "html" / "page.css").read_text("utf-8")
    assert named <= set(re.findall(r"--([a-z]+):", style))


def test_nothing_of_an_uncontrolled_motion_that_stays_near_is_cut(solution: Solution) -> None:
    drawn = str(motion(Scene.of(solution), load("en")))
    path = re.search(r'<path d="M([^"]*)" class="free">', drawn)
    assert path is not None
    places = [float(value) for value in re.findall(r"-?\d+\.\d", path[1])]
    assert 0.0 < min(places) < max(places) < SIDE


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("polar_orbit_ball", "The norm of the control is bounded"),
        ("return_above", "At all times, the motion satisfies the path constraint"),
        ("polar_orbit", "Each control is bounded"),
    ],
)
def test_the_page_states_what_controls_and_motion_obey(name: str, said: str) -> None:
    page = Derived(derived(stated(name)), load("en"), {}).render()
    assert said in page
    assert not re.search(r"\\[a-z]", page), "LaTeX that no browser shows"


@pytest.mark.slow
def test_long_equations_are_broken_into_lines_and_wide_matrices_are_small() -> None:
    """Paper cannot be scrolled."""
    page = Derived(derived(stated("shuttle")), load("en"), {}).render()
    hamiltonian = page[page.index("Hamiltonian") :]
    assert hamiltonian.index('columnalign="left"') < hamiltonian.index("</details>")
    (small,) = {int(size) for size in re.findall(r"font-size: (\d+)%", page)}
    assert 45 <= small < 100


def test_what_a_reader_looks_for_first_comes_first(solution: Solution) -> None:
    found = replace(solution, certificate=Certificate(Verdict.CERTIFIED, 0.0, 0.0, 0.0, 0.0, 1.0, None, ()))
    text = str(answer.glance(found, load("en")))
    assert [unescape(title) for title in re.findall(r"<dt>(.*?)</dt>", text)] == ["Cost", "Final time", "Certificate"]
    assert "<dd>0.000426589</dd>" in text
    assert str(overview(found, load("en"))).count("<svg ") == 1


def test_a_run_without_an_answer_says_first_why_and_that_it_has_no_certificate(solution: Solution) -> None:
    failed = replace(solution, status=Status.INFEASIBLE, certificate=None, message="the nearest control misses r by 2")
    text = str(answer.glance(failed, load("en")))
    assert re.findall(r"<dt>(.*?)</dt>", text) == ["Status", "Details", "Certificate"]
    assert "<dd>Infeasible</dd>" in text
    assert f"<dd>The nearest control misses r by 2; {Status.INFEASIBLE.advice}</dd>" in text
    assert "<dd>None, because no solution was found.</dd>" in text


def test_the_problem_states_the_equations_of_motion_and_links_to_their_step(text: str) -> None:
    problem = text.partition('<section id="problem">')[2].partition("</section>")[0]
    begin, _, end = problem.partition("subject to the equations of motion (step")
    assert "minimise" in begin
    assert '<a href="#polar_orbit:first_order">' in end[:100]
    assert "<math" in end
