"""How pictures are asked for, wherever a command draws: as which files, with or without titles."""

from __future__ import annotations

import io
import re
import zlib
from pathlib import Path

import pytest

from satsym.report import plots
from satsym.report.look import FORMATS, Look
from satsym.report.plots import style
from satsym.report.results.files import Content
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
        assert "add --plot" in err
    assert run("solve", "soft-return", "--plot", "--format", "jpg")[0] == 2
    assert list(tmp_path.iterdir()) == []


def written(pictures: dict[str, Content]) -> dict[str, bytes]:
    streams = {name: io.BytesIO() for name in pictures}
    for name, content in pictures.items():
        content(streams[name])
    return {name: stream.getvalue() for name, stream in streams.items()}


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
