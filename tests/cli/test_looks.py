"""How pictures are asked for, wherever a command draws: as which files, with or without titles."""

from __future__ import annotations

import io
import json
import re
import zlib
from pathlib import Path

import pytest

from satsym.instance.files import SHIPPED
from satsym.report import plots
from satsym.report.look import FORMATS, SIZES, Look
from satsym.report.plots import style
from satsym.report.results.files import Content
from satsym.status import BadInput
from tests.cli.test_cli import Run, case, run

__all__ = ["case", "run"]

DRAWING = (
    "analyse clohessy_wiltshire",
    "lqr double_integrator_energy",
    "compare lapan-classical",
    "simulate its-thesis",
)


@pytest.mark.slow
@pytest.mark.parametrize("command", DRAWING)
def test_pictures_of_every_kind_of_file_come_with_any_command_that_draws(
    run: Run, tmp_path: Path, command: str
) -> None:
    code, _, err = run(*command.split(), "--plot", "--out", "there", "--format", "svg", "--format", "pdf")
    assert (code, err) == (0, "")
    drawn = {path.name for path in (tmp_path / "there").iterdir() if path.suffix[1:] in FORMATS}
    names = {name.partition(".")[0] for name in drawn}
    assert names
    assert drawn == {f"{name}.{kind}" for name in names for kind in ("pdf", "svg")}
    for name in names:
        page = (tmp_path / "there" / f"{name}.pdf").read_bytes()
        streams = [zlib.decompress(s) for s in re.findall(rb"stream\r?\n(x.*?)endstream", page, re.DOTALL)]
        assert b"/Type3" not in page + b"".join(streams)
        assert b"/CIDFontType2" in page + b"".join(streams)


def test_how_pictures_look_is_refused_where_none_are_drawn(run: Run, tmp_path: Path) -> None:
    for look in (("--format", "pdf"), ("--no-title",)):
        code, out, err = run("solve", "soft-return", *look)
        assert (code, out) == (2, "")
        assert "require --plot" in err
    assert run("solve", "soft-return", "--plot", "--format", "jpg")[0] == 2
    assert list(tmp_path.iterdir()) == []


def test_a_page_is_as_wide_as_its_place_and_a_column_has_panels_below_each_other() -> None:
    from satsym import instance
    from satsym.solvers import simulate

    found = simulate(instance.load("its-thesis"))
    wide = {size: plots.figures(found, Look(size=size))["states"] for size in SIZES}
    assert [round(page.get_figwidth(), 2) for page in wide.values()] == [10.0, 7.0, 3.5, 13.33]
    assert wide["slide"].get_figheight() <= 7.5
    lefts = {
        size: {round(axes.get_subplotspec().colspan.start, 2) for axes in page.axes} for size, page in wide.items()
    }
    assert lefts == {"screen": {0, 1}, "page": {0, 1}, "column": {0}, "slide": {0, 1}}
    with pytest.raises(BadInput, match='did you mean "column"'):
        Look(size="columns")


def test_a_result_names_the_file_of_its_instance_and_what_that_held(run: Run, tmp_path: Path) -> None:
    text = (SHIPPED / "its-thesis.toml").read_bytes()
    (tmp_path / "mine.toml").write_bytes(text)
    (tmp_path / "other.toml").write_bytes(text + b"# a remark\n")
    first, second = (json.loads(run("simulate", f"{n}.toml", "--json")[1])["instance_file"] for n in ("mine", "other"))
    assert (first["name"], second["name"]) == ("mine.toml", "other.toml")
    assert first["digest"] != second["digest"]


def written(pictures: dict[str, Content]) -> dict[str, bytes]:
    streams = {name: io.BytesIO() for name in pictures}
    for name, content in pictures.items():
        content(streams[name])
    return {name: stream.getvalue() for name, stream in streams.items()}


def test_names_of_clip_paths_do_not_depend_on_digits_that_are_not_written() -> None:
    """What a path is clipped by stays; paths that are clipped alike have one name, others have others."""
    square = '<clipPath id="p{}"><rect x="{}" y="2.000000" width="3.000000" height="4.000000"/></clipPath>'
    drawn = '<path clip-path="url(#p{})"/>'
    once, again, moved = (
        style.clips_named((square.format(name, x) + drawn.format(name)).encode())
        for name, x in (("1a", "1.000000"), ("2b", "1.000000"), ("1a", "1.000001"))
    )
    assert once == again != moved
    name = re.search(rb'id="(\w+)"', once)
    assert name
    assert once.endswith(b'<path clip-path="url(#' + name[1] + b')"/>')


@pytest.mark.slow
def test_a_page_without_title_has_none_is_the_same_when_drawn_again_and_leaves_no_style_behind() -> None:
    from satsym import instance
    from satsym.solvers import simulate

    found = simulate(instance.load("its-thesis"))
    for titled in (True, False):
        first, again = (written(plots.pictures(found, Look(("svg",), titled))) for _ in range(2))
        assert first == again
        assert style.with_titles()
        pages = plots.figures(found, Look(titled=titled))
        assert {page.get_suptitle() for page in pages.values()} == ({found.instance.title, ""} if titled else {""})


@pytest.mark.parametrize("size", SIZES)
def test_what_stands_above_a_panel_never_overlaps(size: str) -> None:
    """Meaning on the left, switching times or the end on the right; Indonesian is the longer language."""
    from satsym import instance
    from satsym.report.said import spoken
    from tests.support.solved import solve

    found = solve(instance.load("return-to-orbit-005"))
    with spoken("id"):
        pages = plots.figures(found, Look(size=size))
    for name in ("controls", "costates", "states"):
        pages[name].draw_without_rendering()
        for axes in pages[name].axes:
            left, right = (text.get_window_extent() for text in (axes._left_title, axes._right_title))
            assert left.width > 0.0
            assert left.x1 < right.x0, (name, axes.get_ylabel())


@pytest.mark.slow
def test_nothing_is_cut_off_in_a_column() -> None:
    """Titles, labels and legends of pictures with long ones, in the language that is longer."""
    from satsym import instance
    from satsym.analysis.comparison import compare
    from satsym.analysis.regulator.feedback import designed
    from satsym.analysis.subject import survey
    from satsym.report.plots import comparison, plane, responses
    from satsym.report.plots.space import conics
    from satsym.report.said import spoken

    orbit, design = survey(instance.load("molniya")), designed(instance.load("geo-lqr"))
    cases = compare([instance.load("lapan-classical"), instance.load("lapan-minimum-time")], lambda _: None)
    with spoken("id"), style.applied(Look(size="column")):
        pages = [each(orbit) for each in (conics.page, plane.of_point, plane.of_multipliers)]
        pages += [responses.reach(design, instance.load("geo-lqr")), comparison.page(cases)]
        for page in pages:
            style.finished(page).draw_without_rendering()
            whole = page.bbox
            for axes in page.axes:
                shown = [axes._left_title, axes.xaxis.label, *page.legends]
                for box in (one.get_window_extent() for one in shown):
                    assert whole.x0 <= box.x0, axes.get_title(loc="left")
                    assert box.x1 <= whole.x1, axes.get_title(loc="left")
