"""Figures of the theory and of the tutorials, and the page of an audit; kept until the code or this file changes."""

import io
import os
import re
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from cards import HIGH as HIGH_CARD
from cards import LETTERS, WIDE
from gallery import KEPT, printed, themed
from sphinx.application import Sphinx

HIGH, LONG = 4.3, 7.6
"""Heights of a figure and of one with a line for each problem, in inches on a screen."""
DOCS = Path(__file__).parents[1]
TIMED = re.compile(r"^\| \[([\w-]+)\]\S+ \| ([\d.]+) \| ([\d.]+) \| ([^|]+) \|([^|]*)\|$", re.MULTILINE)
"""A line of the table of times: name, time, time with the certificate, time of the direct method, ratio."""


def bang_bang(page: Any, style: Any) -> None:
    """A switching function, and the control that follows from its sign."""
    import satsym

    found = satsym.solve("double-integrator-fuel")
    times = found.times
    above, below = page.subplots(2, 1, sharex=True)
    above.plot(times, found.lam["q_dot"], color=style.GREEN)
    for level in (-1.0, 1.0):
        above.axhline(level, color=style.GREY, linewidth=0.8, linestyle="--")
    above.set_ylabel("switching\nfunction")
    below.plot(times, found.u["u1"], color=style.BLUE)
    below.set_ylabel("control")
    below.set_xlabel("time [s]")
    for place in (above, below):
        for time in found.switching_times["u1"]:
            place.axvline(time, color=style.GREY, linewidth=0.8, linestyle=":")


def conjugate(page: Any, style: Any) -> None:
    """Extremals of the integral of (u^2 - x^2)/2 with x' = u from zero: x = a sin t, which meet again at pi."""
    import numpy as np

    place, times = page.subplots(), np.linspace(0.0, 1.25 * np.pi, 200)
    for size in np.linspace(-1.0, 1.0, 9):
        place.plot(times, size * np.sin(times), color=style.BLUE, linewidth=0.9)
    place.plot([0.0], [0.0], "o", color=style.GREEN)
    place.plot([np.pi], [0.0], "o", color=style.VERMILION)
    place.text(1.25 * np.pi, 1.12, "conjugate point", color=style.VERMILION, ha="right")
    place.set_ylim(-1.1, 1.35)
    place.set_xlabel("time")
    place.set_ylabel("state")


def constraint(page: Any, style: Any) -> None:
    """The problem of Bryson and Denham for three bounds: not reached, touched, and followed."""
    import satsym

    case, place = satsym.load("bryson-denham"), page.subplots()
    for bound, colour, name in (
        (0.3, style.GREEN, "not reached"),
        (0.2, style.BLUE, "touched"),
        (1 / 9, style.VERMILION, "followed"),
    ):
        found = satsym.solve(case.with_(parameters={"l": bound}))
        place.plot(found.times, found.x["x"], color=colour, label=f"bound {bound:.3g}: {name}")
        place.axhline(bound, color=colour, linewidth=0.8, linestyle="--")
    place.set_xlabel("time")
    place.set_ylabel("position")
    place.legend(loc="lower center", frameon=False, ncols=3, bbox_to_anchor=(0.5, 1.0))


def free_time(page: Any, style: Any) -> None:
    """Cost over the duration: pure effort falls for ever, a weight on time gives it a minimum."""
    import numpy as np

    import satsym

    place = page.subplots()
    start, rest = {"q": 1, "q_dot": 0}, {"q": 0, "q_dot": 0}
    spans = np.linspace(1.5, 6.0, 10)
    body = satsym.Instance.of("double_integrator_energy", initial=start, final=rest, tf=2.0)
    effort = np.array([satsym.solve(body.with_(tf=float(span))).objective for span in spans])
    place.plot(spans, effort, "o-", color=style.BLUE, label="effort alone")
    place.plot(spans, effort + 0.2 * spans, "o-", color=style.VERMILION, label="effort plus 0.2 per second")
    place.set_xlabel("final time [s]")
    place.set_ylabel("cost")
    place.legend(frameon=False)


def valley(page: Any, style: Any) -> None:
    """Cost of returns to the orbit over two initial values."""
    import numpy as np

    import satsym

    values = (0.9, 1.1, 11)
    with TemporaryDirectory() as out:
        found = satsym.study("return-to-orbit", out, vary={"initial.r": values, "initial.theta_dot": values})
        radii, rates, cost = (found[name] for name in ("initial.r", "initial.theta_dot", "objective"))
    place = page.subplots()
    place.tricontourf(np.asarray(radii), np.asarray(rates), np.asarray(cost), levels=14)
    place.set_xlabel("$r(t_0)$")
    place.set_ylabel(r"$\dot{\theta}(t_0)$")
    place.locator_params(nbins=4)


def times(page: Any, style: Any) -> None:
    """Processor times of satsym and of a direct method, as the page of known optima lists them."""
    place, listed = page.subplots(), TIMED.findall((DOCS / "optima.md").read_text("utf-8"))
    rows = sorted(listed, key=lambda row: float(row[1]), reverse=True)
    names, ours, certified = ([row[k] for row in rows] for k in range(3))
    theirs = [(float(row[3]), k) for k, row in enumerate(rows) if row[4].strip()]
    place.plot([float(one) for one in ours], names, "o", color=style.BLUE, label="satsym")
    place.plot(
        [float(one) for one in certified], names, "o", color=style.BLUE, fillstyle="none", label="with certificate"
    )
    place.plot(*zip(*theirs, strict=True), "s", color=style.VERMILION, label="direct method")
    place.set_xscale("log")
    place.set_xlim(0.02, 1000.0)
    missing = [k for k, row in enumerate(rows) if not row[4].strip()]
    place.plot([700.0] * len(missing), missing, "x", color=style.VERMILION)
    place.set_xlabel("processor time [s]")
    place.grid(axis="y", linewidth=0.4)
    place.legend(loc="lower center", frameon=False, ncols=3, bbox_to_anchor=(0.5, 1.0))


def sled() -> str:
    """The picture of the tutorial's own system."""
    import sympy

    import satsym

    q, v, a, k = sympy.symbols("q v a k", real=True)
    motion = satsym.FirstOrder(
        name="sled_motion",
        title="A sled with drag",
        states=(satsym.Variable("q", "q", "m"), satsym.Variable("v", "v", "m/s")),
        controls=(satsym.Variable("a", "a", "m/s**2"),),
        parameters=(satsym.Variable("k", "k", "1/m", default=0.1),),
        rates={q: v, v: a - k * v**2},
    )
    effort = satsym.Problem(name="sled", title="Sled", model=motion, running_cost=a**2 / 2, control_set="box")
    push = satsym.Instance.of(effort, initial={q: 0, v: 0}, final={q: 1, v: 0}, tf=2.2, control={a: [-1.2, 1.2]})
    return _overview(satsym.solve(push).found)


def study(*options: str) -> str:
    """The picture of a study with these options."""
    with TemporaryDirectory() as out:
        printed(["study", "return-to-orbit", *options, "--out", out])
        drawn = Path(out, "drawn")
        printed(["plot", out, "--format", "svg", "--size", "page", "--no-title", "--out", str(drawn)])
        return (drawn / "overview.svg").read_text("utf-8")


def _overview(found: Any) -> str:
    from satsym.report import plots
    from satsym.report.look import Look

    stream = io.BytesIO()
    plots.pictures(found, Look(("svg",), titled=False, size="page"))["overview.svg"](stream)
    return stream.getvalue().decode("utf-8")


def _drawn(draw: Callable[[Any, Any], None], high: float = HIGH, share: float = 1.0) -> str:
    from satsym.report.look import Look
    from satsym.report.plots import style

    with style.applied(Look(("svg",), titled=False, size="page")):
        page = style.figure(share * style.WIDTH, high)
        draw(page, style)
        return style.rendered(style.finished(page), "svg").decode("utf-8")


def _carded(draw: Callable[[Any, Any], None]) -> str:
    """A figure as small as a card of the gallery, with letters as large as on those."""
    from satsym.report.plots import style

    return _drawn(draw, LETTERS * style.WIDTH * HIGH_CARD / WIDE, LETTERS)


FIGURES: dict[str, Callable[[], str]] = {
    "bang_bang": lambda: _drawn(bang_bang),
    "conjugate": lambda: _drawn(conjugate),
    "constraint": lambda: _drawn(constraint),
    "free_time": lambda: _drawn(free_time),
    "times": lambda: _drawn(times, LONG),
    "conjugate-card": lambda: _carded(conjugate),
    "map-card": lambda: _carded(valley),
    "sled": sled,
    "study": lambda: study(*"--vary initial.r=0.95:1.15:9".split()),  # as the tutorial has it, and the sample as well
    "map": lambda: study(*"--vary initial.r=0.9:1.1:11 --vary initial.theta_dot=0.9:1.1:11".split()),
    "sample": lambda: study(
        *"--sample 500 --normal initial.r=1.1,0.02 --normal initial.theta_dot=0.9,0.02 --seed 1".split()
    ),
}


AUDITED = "its_paper"
"""The document whose audit is shown as a page: that of the five that takes least time."""


def _audit(folder: Path) -> None:
    printed(["audit", AUDITED, "--html", str(folder / f"{AUDITED}.html")])


def _keep(name: str, folder: Path) -> None:
    (folder / f"{name}.svg").write_text(themed(FIGURES[name]()), "utf-8")


def begin(app: Sphinx, work: Any) -> None:
    """Draw the figures that are not kept, and write the page of an audit."""
    from satsym import source_files

    folder = Path(app.srcdir, "_static", "figures")
    folder.mkdir(parents=True, exist_ok=True)
    code = source_files.digest(["satsym.solvers", "satsym.report.plots", "satsym.auditing", "satsym.report.html"])
    key = f"{code} {source_files.digest_of(Path(__file__))} {source_files.digest_of(DOCS / 'optima.md')}"
    kept = folder / "key"
    if kept.is_file() and (kept.read_text("utf-8") == key or os.environ.get(KEPT)):
        return
    jobs = [(_audit, (folder,)), *((_keep, (name, folder)) for name in FIGURES)]
    work.begin(jobs, lambda _: kept.write_text(key, "utf-8"))
