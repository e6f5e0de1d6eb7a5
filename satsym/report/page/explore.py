"""The interactive part of a page: sliders over time and over answers, with plotly included in the page."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.numbers import changed
from satsym.report.extra import library
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.page.explored import Answer, data
from satsym.report.results import sets, study_table
from satsym.report.results.set_list import STUDY
from satsym.report.results.studies import TRAJECTORIES
from satsym.report.said import decimal, say
from satsym.report.terminal.table import figure
from satsym.report.texts import Texts
from satsym.solution import Solution
from satsym.status import BadInput
from satsym.wording import printable

WORDS = {
    "path": "solution",
    "reference": "reference",
    "free": "uncontrolled",
    "other": "target orbit",
    "moving": "target",
    "burns": "burn",
    "target": "final condition",
    "passed": "waypoint",
    "inadmissible": "inadmissible",
    "origin": "origin",
    "body_called": "body",
    "torque": "torque",
    "fixed": "fixed axes",
    "axis": "body axis <number>",
    "magnified": "angles enlarged <times> times",
    "play": "Play",
    "pause": "Pause",
}
"""English words that the script shows."""


def explore(answers: Sequence[Answer], texts: Texts) -> Markup:
    """Return controls, places for pictures, and a table of values, all hidden where scripts do not run.

    Parameters
    ----------
    answers
        One, or those of a study, which have a slider of their own.
    """
    several = len(answers) > 1

    def slider(key: str, name: str, last: int) -> Markup:
        return joined(
            tag("label", texts.get("page", name), for_=key),
            tag("input", type="range", id=key, min="0", max=str(last), value="0", step="1" if last < 1000 else "any"),
        )

    controls = [
        tag("button", say(WORDS["play"]), type="button", id="explore-play", aria_pressed="false"),
        slider("explore-time", "time", 1000),
        tag("output", id="explore-stated", for_="explore-time"),
        *([slider("explore-answer", "which", len(answers) - 1)] if several else []),
        tag("output", id="explore-cost"),
    ]
    heads = [
        tag("th", texts.get(*key), scope="col")
        for key in (("words", "symbol"), ("page", "value"), ("words", "meaning"))
    ]
    table = tag(
        "table",
        tag("caption", texts.get("page", "reading")),
        tag("thead", tag("tr", *heads)),
        tag("tbody"),
        class_="facts",
    )
    return tag(
        "div",
        tag("p", texts.get("page", "explore_about")),
        tag("div", *controls, class_="controls"),
        tag("div", id="explore-scenes"),
        tag("div", id="explore-panels"),
        tag("div", id="explore-key"),
        tag("div", table, class_="wide", id="explore-reading", tabindex="0"),
        class_="explorer",
        hidden=True,
    )


def scripts(answers: Sequence[Answer]) -> Markup:
    """Return the data, the library and the script, for the end of a page.

    Raises
    ------
    BadInput
        If plotly is not installed.
    """
    offline = library("plotly.offline", "plotly", "interactive")
    words = {key: say(text) for key, text in WORDS.items()}
    content = json.dumps(
        data(answers) | {"words": words, "decimal": decimal(".")}, ensure_ascii=False, separators=(",", ":")
    )
    own = files("satsym.report").joinpath("page", "explore.js").read_text(encoding="utf-8")
    return joined(
        tag("script", Markup(content.replace("<", "\\u003c")), type="application/json", id="explore-data"),
        tag("script", Markup(offline.get_plotlyjs())),
        tag("script", Markup(own)),
    )


MOST_ANSWERS = 60
"""Largest number of solutions on a page; if there are more, they are selected evenly."""
ROUNDING = 1e-12
"""Relative difference up to which two numbers of an instance count as equal."""
ARRAYS = ("t", "x", "u", "lam")


def explored(solution: Solution, study: Path | None = None) -> list[Answer]:
    """Return the answer alone, or those of a study, in the order of the varied number if it is only one.

    Parameters
    ----------
    solution
        Of the page's own instance, which the study must vary.
    study
        A folder with its results.

    Raises
    ------
    BadInput
        If that is no study of this instance, or it kept no trajectories.
    """
    if study is None:
        return [Answer(solution)]
    place, instance = printable(str(study)), solution.instance
    listing = sets.read(study)
    said = json.loads(listing.result)
    if listing.command != STUDY or said.get("each") != "solve":
        raise BadInput(
            f"--study: {place} contains no study made by `satsym study`; write one with `satsym study X "
            "--trajectories --out DIR`"
        )
    if (said["model"], said["instance"]) != (instance.model.spec.name, instance.name):
        raise BadInput(f"--study: {place}: belongs to {printable(said['instance'])}, not to {instance.name}")
    kept = _trajectories(study, sorted(listing.listed))
    if not kept:
        raise BadInput(f"--study: {place}: contains no trajectories; run the study again with --trajectories")
    table = study_table.columns(study_table.path_of(study), lambda _: [*said["varied"], "objective"])
    settings = {name: float(value) for name, value in said.get("settings", {}).items()}
    found = []
    for row in _chosen(table, said["varied"], [row for row in kept if set(ARRAYS) <= kept[row].keys()]):
        values = {name: float(table[name][row]) for name in said["varied"]}
        label = ", ".join(f"{name} = {decimal(figure(value))}" for name, value in values.items())
        objective = instance.model.spec.objective(float(table["objective"][row]))
        case = changed(instance, settings | values)
        arrays = kept[row]
        varied = replace(
            solution,
            instance=case,
            objective=objective,
            times=arrays["t"],
            x=arrays["x"],
            u=arrays["u"],
            lam=arrays["lam"],
            switching_times=tuple(() for _ in arrays["u"]),
            certificate=None,
            events=(),
            history=(),
        )
        found.append(Answer(varied, label, _same(case, instance)))
    # the slider begins at the solution that the rest of the page is about, which need not be a case of the study
    return (
        found if any(one.own for one in found) else [Answer(solution, say("the solution of this page"), True), *found]
    )


def _same(one: Instance, other: Instance) -> bool:
    """Tell whether two instances of a model have the same numbers up to rounding."""

    def numbers(case: Instance) -> list[float]:
        ends = [value for value in case.final.values() if isinstance(value, float)]
        times = [case.t0, math.inf if case.tf is None else case.tf]
        return [*case.initial, *case.parameters, *ends, *times, *case.lower, *case.upper, case.max_norm]

    first, second = numbers(one), numbers(other)
    return len(first) == len(second) and bool(np.allclose(first, second, rtol=ROUNDING, atol=0.0))


def _trajectories(folder: Path, names: Sequence[str]) -> dict[int, dict[str, Array]]:
    """Return arrays by the number of their row."""
    beginning = TRAJECTORIES.partition("{")[0]
    wanted = [name for name in names if name.startswith(beginning)]
    found: dict[int, dict[str, Array]] = {}
    for content in sets.read(folder, wanted).contents.values() if wanted else ():
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            for key in arrays.files:
                row, _, name = key.partition(".")
                found.setdefault(int(row), {})[name] = arrays[key]
    return found


def _chosen(table: dict[str, Array], varied: Sequence[str], rows: Sequence[int]) -> list[int]:
    """Return the rows that are shown, in the order of the slider."""
    whole = [row for row in rows if all(math.isfinite(table[name][row]) for name in varied)]
    ordered = sorted(whole, key=lambda row: tuple(table[name][row] for name in varied))
    if len(ordered) <= MOST_ANSWERS:
        return ordered
    return [ordered[k] for k in np.linspace(0, len(ordered) - 1, MOST_ANSWERS).round().astype(int)]
