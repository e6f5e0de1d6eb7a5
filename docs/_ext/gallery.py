"""The shipped instances, each solved, with verdict and picture; kept until the solvers or the instance change."""

import json
import os
import re
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from html import escape
from multiprocessing import get_context
from pathlib import Path

from sphinx.application import Sphinx

COLOURS = r"(:root \{.*?\}\s*)(@media \(prefers-color-scheme: dark\) \{.*?\}\s*\})"
"""What a style sheet of a page begins with."""
HEAD = """<!-- Written by `make docs`: do not edit. -->
# Gallery

Shipped instances, each as `satsym solve NAME --plot` gives it (or `satsym simulate`, where there is no cost), with the
verdict of its certificate.
"""
OTHERS = frozenset(
    "lapan-coupling lapan-classical gyrostat-equilibria "
    "its-thesis-10-50 its-thesis-50-10 its-thesis-50-50 its-thesis-return-two-sided lapan-minimum-time-100s "
    "return-to-orbit-005 return-to-geo-wide hypersensitive-10000 itb-earth-kicked reorientation shuttle "
    "its-thesis-return".split()
)
"""Asked about by other commands than these, much like their neighbours, or by far the longest to certify."""

LONGEST = ("shuttle-heating", "goddard-pressure", "transfer-fuel", "cart-pole")
"""Begun first, so that no processor waits for another in the end."""


def shown(name: str, folder: Path) -> dict[str, str]:
    """What the page says of an instance; its picture is written into the folder."""
    from satsym import instance, source_files
    from satsym.report.display import number, unit_text
    from satsym.solution import Solution
    from satsym.solvers import simulate, solve

    case = instance.load(name)
    code = source_files.digest(["satsym.solvers", "satsym.report.plots", "satsym.report.page"])
    key, said, picture = f"{code} {source_files.digest_of(case.path)}", folder / f"{name}.json", folder / f"{name}.svg"
    if said.is_file() and picture.is_file() and (known := json.loads(said.read_text("utf-8")))["key"] == key:
        return known
    found = solve(case) if case.model.spec.has_cost else simulate(case)
    spec, verdict = case.model.spec, found.status.value
    if isinstance(found, Solution) and found.status.answered:
        cost = f"J = {number(spec.objective(found.objective), 8)} {unit_text(spec.objective_unit)}".rstrip()
        verdict = f"{cost}, {found.certificate.verdict.value}" if found.certificate else cost
    picture.write_text(drawn(found), "utf-8")
    known = {"key": key, "name": name, "title": case.title, "model": spec.name, "verdict": verdict}
    said.write_text(json.dumps(known), "utf-8")
    return known


def drawn(found: object) -> str:
    """The overview as SVG that is dark where its reader's pages are; nothing where there is no trajectory."""
    from importlib.resources import files

    from satsym.report.look import Look
    from satsym.report.page.pictures import themed
    from satsym.report.plots import pages, style
    from satsym.report.plots.scene import Scene

    with style.applied(Look(size="page", titled=False)):
        page = pages.overview(Scene.of(found))
        if page is None:
            return ""
        svg = style.rendered(style.finished(page), "svg").decode("utf-8")
    sheets = [files("satsym.report").joinpath(name).read_text("utf-8") for name in ("html/page.css", "page/report.css")]
    colours = "".join("".join(re.match(COLOURS, sheet, re.DOTALL).groups()) for sheet in sheets)
    element, inside = themed(svg).split(">", 1)
    return f"{element}><style>{colours}svg {{ fill: var(--ink); }}</style>{inside}"


def page(folder: Path) -> Iterator[str]:
    """The page, piece by piece."""
    from satsym import instance

    names = sorted((name for name in instance.shipped() if name not in OTHERS), key=lambda name: name not in LONGEST)
    workers = os.cpu_count() or 1
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command line does: threads cost more than they save
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        every = list(pool.map(shown, names, [folder] * len(names)))
    yield HEAD
    yield "```{raw} html\n<div class='gallery'>"
    for known in sorted(every, key=lambda known: known["model"]):
        name, model, title = known["name"], known["model"], escape(known["title"])
        image = f"<img src='_static/gallery/{name}.svg' alt='Path, states and controls of {name}' loading='lazy'>"
        yield (
            f"<figure>{image if (folder / f'{name}.svg').stat().st_size else ''}"
            f"<figcaption><code>{name}</code>, model <code>{model}</code>: {title}. "
            f"<b>{escape(known['verdict'])}</b></figcaption></figure>"
        )
    yield "</div>\n```"


def _write(app: Sphinx) -> None:
    folder = Path(app.srcdir, "_static", "gallery")
    folder.mkdir(parents=True, exist_ok=True)
    text = "\n".join(page(folder)) + "\n"
    path = Path(app.srcdir, "gallery.md")
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """As Sphinx wants it."""
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True}
