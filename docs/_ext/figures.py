"""Figures of the theory and of the tutorials, drawn from solutions; kept until the solvers or this file change."""

import io
import os
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from gallery import KEPT, printed, themed
from sphinx.application import Sphinx

HIGH = 4.3
"""Height of a figure, in inches on a screen."""


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
    place.text(np.pi, 0.8, "conjugate point", color=style.VERMILION, ha="center")
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


def _drawn(draw: Callable[[Any, Any], None]) -> str:
    from satsym.report.look import Look
    from satsym.report.plots import style

    with style.applied(Look(("svg",), titled=False, size="page")):
        page = style.figure(style.WIDTH, HIGH)
        draw(page, style)
        return style.rendered(style.finished(page), "svg").decode("utf-8")


FIGURES: dict[str, Callable[[], str]] = {
    "bang_bang": lambda: _drawn(bang_bang),
    "conjugate": lambda: _drawn(conjugate),
    "constraint": lambda: _drawn(constraint),
    "free_time": lambda: _drawn(free_time),
    "sled": sled,
    "study": lambda: study(*"--vary initial.r=0.95:1.15:9".split()),  # as the tutorial has it, and the sample as well
    "map": lambda: study(*"--vary initial.r=0.9:1.1:11 --vary initial.theta_dot=0.9:1.1:11".split()),
    "sample": lambda: study(
        *"--sample 500 --normal initial.r=1.1,0.02 --normal initial.theta_dot=0.9,0.02 --seed 1".split()
    ),
}


def _keep(name: str, folder: Path) -> None:
    (folder / f"{name}.svg").write_text(themed(FIGURES[name]()), "utf-8")


def begin(app: Sphinx, work: Any) -> None:
    """Draw the figures that are not kept."""
    from satsym import source_files

    folder = Path(app.srcdir, "_static", "figures")
    folder.mkdir(parents=True, exist_ok=True)
    code = source_files.digest(["satsym.solvers", "satsym.report.plots"])
    key = f"{code} {source_files.digest_of(Path(__file__))}"
    kept = folder / "key"
    if kept.is_file() and (kept.read_text("utf-8") == key or os.environ.get(KEPT)):
        return
    work.begin([(_keep, (name, folder)) for name in FIGURES], lambda _: kept.write_text(key, "utf-8"))
