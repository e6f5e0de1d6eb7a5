"""Pictures of an example: the overview for its page, and one panel of it for its card in the gallery."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

CARD = "-card"
"""What follows the name of an instance in that of its card."""
OVER_TIME = "catalyst", "chain"
"""Instances whose first state over time tells more than it does over the second."""
WIDE, HIGH = 3.5, 2.8
"""Width and height of a card, whose ratio counts."""
LETTERS = 0.34
"""Width of a card as a fraction of a page; the smaller it is, the larger letters are on the card."""


def of_motion(case: Any, folder: Path) -> dict[str, str]:
    """Pictures of what ``solve`` or ``simulate`` saved: the end of their names, and SVG; none without a trajectory."""
    from satsym.report.look import Look
    from satsym.report.plots import pages, style
    from satsym.report.plots.scene import Scene
    from satsym.report.results import trajectory

    scene = Scene.of(trajectory.read(case, folder)[0])
    if not scene.drawable:
        return {}
    with style.applied(Look(("svg",), titled=False, size="page")):
        drawn = {"": pages.overview(scene), CARD: _card(scene)}
        return {part: _svg(style.finished(page)) for part, page in drawn.items()}


def written(case: Any, folder: Path) -> dict[str, str]:
    """Pictures that a command wrote, the most telling one first, and a card."""
    found = sorted(folder.glob("*.svg"), key=lambda path: path.stem not in ("overview", "orbit", "responses"))
    texts = {path.stem: path.read_text("utf-8") for path in found}
    names = ["", *(f"-{name}" for name in list(texts)[1:])]
    panels = {"orbit": _conic, "equilibria": _attitudes, "eigenvalues": _loops, "comparison": _compared}
    panel = next((panels[name] for name in panels if name in texts), None)
    card = _alone(panel, case) if panel else next(iter(texts.values()))
    return dict(zip(names, texts.values(), strict=True)) | {CARD: card}


def _alone(panel: Callable[[Any, Any], None], case: Any) -> str:
    """One panel on a card of its own, so that its words are as large as on any other card."""
    from satsym.report.look import Look
    from satsym.report.plots import style

    with style.applied(Look(("svg",), titled=False, size="page")):
        page = _empty()
        panel(page.subplots(), case)
        return _svg(style.finished(page))


def _conic(axes: Any, case: Any) -> None:
    """An orbit from where it shows best."""
    from satsym.analysis.subject import survey
    from satsym.report import display
    from satsym.report.plots.space import conics, views

    drawn = conics.Drawn.of(survey(case))
    unit = display.length_unit(v.unit for v in case.model.spec.states)
    conics.panel(axes, drawn, views.views([drawn.curve], ("$x$", "$y$", "$z$"))[0], unit)


def _attitudes(axes: Any, case: Any) -> None:
    """The equilibria of an attitude over a parameter."""
    from satsym.report.plots import systems
    from satsym.report.results.linear import attitudes

    found = attitudes(case)
    unit = next(v.unit for v in case.model.spec.parameters if v.symbol == found.parameter)
    systems.angles(axes, found, unit)


def _loops(axes: Any, case: Any) -> None:
    """The eigenvalues of a regulator, without notes."""
    from satsym.analysis.regulator.feedback import designed
    from satsym.report.plots import plane

    plane.loops(axes, designed(case), with_notes=False)
    if axes.get_xscale() == "linear":
        axes.locator_params(nbins=5)


def _compared(axes: Any, case: Any) -> None:
    """The first quantity of all cases of a comparison."""
    from satsym.analysis import comparison
    from satsym.report.plots import comparison as plots

    plots.panel(axes, [one for one in comparison.compare([case]) if one.answered])


def _empty() -> Any:
    from satsym.report.plots import style

    return style.figure(LETTERS * style.WIDTH, LETTERS * style.WIDTH * HIGH / WIDE)


def _card(scene: Any) -> Any:
    """The path in space, the attitude, the path in a phase plane, or else the first state over time."""
    from satsym.report.plots import phase_planes, scenes, series, style
    from satsym.report.plots.panels import small_multiples
    from satsym.report.plots.space import attitudes

    page = _empty()
    if (shown := scenes.Orbit.of(scene)) is not None:
        scenes.in_space(page.subplots(), shown, shown.views[0])
    elif (turning := attitudes.Attitude.of(scene)) is not None and turning.complete:
        attitudes.on_sphere(page.subplots(), turning)
    elif scene.instance.name not in OVER_TIME and (planes := phase_planes.of(scene)):
        phase_planes.draw(page.subplots(), planes[0])
    else:
        small_multiples(page, scene, [(series.states(scene)[0], style.STATE)], 1)
    return page


def _svg(page: Any) -> str:
    from satsym.report.plots import style

    return style.rendered(page, "svg").decode("utf-8")
