"""The shipped instances, each solved, with verdict and picture; kept until the solvers or the instance change."""

import io
import json
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from html import escape
from multiprocessing import get_context
from pathlib import Path

from sphinx.application import Sphinx

HEAD = """<!-- Written by `make docs`: do not edit. -->
# Gallery

Shipped instances, each as `satsym solve NAME --plot` gives it (or `satsym simulate`, where there is no cost), with the
verdict of its certificate.
"""
OTHERS = frozenset(
    "lapan-coupling lapan-classical gyrostat-equilibria "
    "its-thesis-10-50 its-thesis-50-10 its-thesis-50-50 its-thesis-return-two-sided lapan-minimum-time-100s "
    "return-to-orbit-005 return-to-geo-wide hypersensitive-10000 itb-earth-kicked reorientation shuttle".split()
)
"""Asked about by other commands than these, much like their neighbours, or by far the longest to certify."""


def shown(name: str, folder: Path) -> dict[str, str]:
    """What the page says of an instance; its picture is written into the folder."""
    from satsym import instance, sources
    from satsym.report import plots
    from satsym.report.display import number, unit_text
    from satsym.report.look import Look
    from satsym.solution import Solution
    from satsym.solvers import simulate, solve

    case = instance.load(name)
    code = sources.digest(["satsym.solvers", "satsym.report.plots"])
    key, said, picture = f"{code} {sources.digest_of(case.path)}", folder / f"{name}.json", folder / f"{name}.png"
    if said.is_file() and picture.is_file() and (known := json.loads(said.read_text("utf-8")))["key"] == key:
        return known
    found = solve(case) if case.model.spec.has_cost else simulate(case)
    spec, verdict = case.model.spec, found.status.value
    if isinstance(found, Solution) and found.status.answered:
        cost = f"J = {number(spec.objective(found.objective), 8)} {unit_text(spec.objective_unit)}".rstrip()
        verdict = f"{cost}, {found.certificate.verdict.value}" if found.certificate else cost
    content = plots.pictures(found, Look(size="page", titled=False)).get("overview.png")
    stream = io.BytesIO()
    if content:
        content(stream)
    picture.write_bytes(stream.getvalue())
    known = {"key": key, "name": name, "title": case.title, "model": spec.name, "verdict": verdict}
    said.write_text(json.dumps(known), "utf-8")
    return known


def page(folder: Path) -> Iterator[str]:
    """The page, piece by piece."""
    from satsym import instance

    names = [name for name in instance.shipped() if name not in OTHERS]
    workers = os.cpu_count() or 1
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command line does: threads cost more than they save
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        every = list(pool.map(shown, names, [folder] * len(names)))
    yield HEAD
    models: dict[str, list[dict[str, str]]] = {}
    for known in every:
        models.setdefault(known["model"], []).append(known)
    for model in sorted(models):
        yield f"\n## {model}\n\n```{{raw}} html\n<div class='gallery'>"
        for known in models[model]:
            title, name = escape(known["title"]), known["name"]
            alt = f"Path, states and controls of {name}"
            yield (
                f"<figure><img src='_static/gallery/{name}.png' alt='{alt}' loading='lazy'>"
                f"<figcaption><code>{name}</code>: {title}. <b>{escape(known['verdict'])}</b></figcaption></figure>"
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
