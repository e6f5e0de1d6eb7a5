"""The page of one run of ``satsym report``."""

from __future__ import annotations

import io
import math
import re
import shlex
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.instance.files import text as text_of
from satsym.instance.shown import spec_of
from satsym.proof.record import Proof
from satsym.report import plots
from satsym.report.display import norm_text, radical, raised, unit_text, with_powers
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.look import Look
from satsym.report.page import answer
from satsym.report.page.answer import proof as section
from satsym.report.page.explore import explore, scripts
from satsym.report.page.explored import Answer
from satsym.report.page.motion import motion
from satsym.report.plots import style
from satsym.report.plots.scene import Scene
from satsym.report.results.files import Content
from satsym.report.results.objects import file_of, time_unit
from satsym.report.said import decimal, message, say, spoken
from satsym.report.terminal.table import figure
from satsym.report.texts import Texts, load
from satsym.solution import Solution
from satsym.version import __version__

if TYPE_CHECKING:
    from satsym.report.page.derived import Derived
    from satsym.symbolic import Derivation


WITHOUT_SCRIPTS = Markup('#explore, [href="#explore"] { display: none; }')
"""Style that hides parts of the page that need scripts."""

DIGITS = 10
"""Number of significant digits of given numbers."""


@dataclass(frozen=True)
class Given:
    """The command line of a run.

    Attributes
    ----------
    subject
        What the instance was called.
    stated
        The file that states the model, where it is none that is shipped.
    values
        Other values of its numbers, each as ``KEY=VALUE``.
    interactive
        Options that made the page interactive, as they were given.
    page
        The file that the page is written to.
    """

    subject: str
    stated: str = ""
    values: Sequence[str] = ()
    interactive: str = ""
    page: str = "report.html"


def render(
    solution: Solution,
    derivation: Derivation | None,
    given: Given,
    language: str = "en",
    explored: Sequence[Answer] = (),
    proof: Proof | None = None,
) -> str:
    """Return the run as a self-contained page.

    Parameters
    ----------
    derivation
        Of the instance's model; ``None`` where it is not at hand.
    given
        What was asked for.
    language
        Of the page; what authors of models wrote stays as it is.
    explored
        Answers that a script shows besides, with sliders over time and over the answers; none on a page without
        scripts.
    proof
        That was asked for beside the answer.

    Returns
    -------
    str
        HTML that depends on nothing but the arguments.
    """
    with spoken(language):
        return _rendered(solution, derivation, given, language, explored, proof)


def _rendered(
    solution: Solution,
    derivation: Derivation | None,
    given: Given,
    language: str,
    explored: Sequence[Answer],
    proof: Proof | None,
) -> str:
    texts, instance = load(language), solution.instance
    authored = instance.title or instance.model.spec.title or instance.name
    said = say(authored)
    title = raised(with_powers(said))
    parts = _sections(solution, derivation, given, texts, explored, proof)
    shown = {name: part for name, part in parts.items() if part}
    links = [tag("li", tag("a", texts.get("page", name), href=f"#{name}")) for name in shown]
    sections = [tag("section", tag("h2", texts.get("page", name)), part, id=name) for name, part in shown.items()]
    found = solution.certificate
    verdict = (
        tag("b", message(found.verdict.value), class_=f"verdict {found.verdict.value.split()[0]}")
        if found
        else Markup()
    )
    body = [
        tag("a", texts.get("page", "skip"), class_="skip", href="#answer"),
        tag(
            "header",
            tag("h1", title, lang="en" if said == authored else language),
            tag("p", texts.get("page", "about", name=instance.name, model=instance.model.spec.name), " ", verdict),
            tag("nav", tag("ul", *links), aria_label=texts.get("page", "contents")),
        ),
        tag("main", _glance(solution, texts), *sections),
        scripts(explored) if explored else Markup(),
    ]
    head = [
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", title),
        tag("style", _file("html", "page.css"), _file("page", "report.css")),
        tag("noscript", tag("style", WITHOUT_SCRIPTS)) if explored else Markup(),
    ]
    return f"<!doctype html>\n{tag('html', tag('head', *head), tag('body', *body), lang=language)}\n"


def _glance(solution: Solution, texts: Texts) -> Markup:
    """Return what a reader looks for first: cost, final time, verdict, and the overview of the motion."""
    drawn = overview(solution, texts)
    return tag("div", answer.glance(solution, texts), drawn, class_="glance")


def _sections(
    solution: Solution,
    derivation: Derivation | None,
    given: Given,
    texts: Texts,
    explored: Sequence[Answer],
    proof: Proof | None,
) -> dict[str, Markup]:
    scene = Scene.of(solution)
    spec = scene.spec
    parts = [answer.facts(solution, texts)]
    if scene.drawable:
        parts += [answer.states(solution, texts), answer.controls(solution, texts)]
    certificate = solution.certificate
    derived = _derived(solution, derivation, texts)
    return {
        "problem": problem(solution.instance, derived, given.values, texts),
        "answer": joined(*parts),
        "explore": explore(explored, texts) if explored else Markup(),
        "motion": motion(scene, texts, bool(explored)) if scene.drawable else Markup(),
        "pictures": joined(*pictures(solution, texts)),
        "certificate": answer.certificate(certificate, spec, texts) if certificate else Markup(),
        "proof": section(proof, texts) if proof else Markup(),
        "derivation": _derivation(derived, texts),
        "reproduce": _commands(solution, derivation, given, texts, proof is not None),
    }


def _derived(solution: Solution, derivation: Derivation | None, texts: Texts) -> Derived | None:
    """Return the derivation with the numbers of the instance."""
    if derivation is None:
        return None
    from satsym.report.page.derived import Derived

    spec, values = spec_of(solution.instance), solution.instance.parameters
    units = {v.symbol: v.unit for v in (*spec.states, *spec.controls, *spec.parameters)}
    return Derived(derivation, texts, dict(zip(spec.parameter_names, values, strict=True)), units)


def _derivation(derived: Derived | None, texts: Texts) -> Markup:
    if derived is None:
        return tag("p", texts.get("page", "no_derivation"))
    return joined(tag("p", texts.get("page", "derivation_about")), derived.steps())


def _commands(solution: Solution, derivation: Derivation | None, given: Given, texts: Texts, proved: bool) -> Markup:
    stated, instance = given.stated, solution.instance
    model = instance.model.spec.name
    name = shlex.join([given.subject, *(part for value in given.values for part in ("--set", value))])
    again = f" --derivation {shlex.quote(stated)}" if stated else ""
    again += given.interactive and f" {given.interactive}"
    again += " --prove" if proved else ""
    lines = _derive(instance, given)
    lines += [f"satsym solve {name} --plot", f"satsym report {name} --html {shlex.quote(given.page)}{again}"]
    lines += [f"satsym prove {name}"] if proved else []
    if derivation is not None:
        lines.append(f"satsym latex {shlex.quote(f'{stated}:{model}') if stated else model}")
    about = texts.get("page", "reproduce_about", version=__version__)
    return joined(tag("p", about), tag("pre", tag("code", "\n".join(lines)), tabindex="0"))


def _derive(instance: Instance, given: Given) -> list[str]:
    """Return the command that writes the module which the instance file names by its path; none for a shipped one."""
    if not given.stated or file_of(instance) is None:
        return []
    model = str(tomllib.loads(text_of(instance.path)).get("model", ""))
    folder = Path(given.subject).parent / Path(model).parent
    return [f"satsym derive {shlex.quote(given.stated)} --out {shlex.quote(str(folder))}"] if "/" in model else []


def _file(room: str, name: str) -> Markup:
    return Markup(files("satsym.report").joinpath(room, name).read_text(encoding="utf-8"))


_NAMED = re.compile(r'(\bid="|href="#|url\(#)')

_BEFORE = re.compile(r"^.*?(?=<svg)", re.DOTALL)

_ABOUT = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)

_COLOURS = {
    **dict.fromkeys((style.INK.lower(), "#000000"), "ink"),
    **dict.fromkeys((style.SOFT.lower(), style.GREY.lower(), "#777777", "#9a9a9a"), "faint"),
    style.PALE_GREY.lower(): "line",
    "#ffffff": "card",
    **{
        getattr(style, name).lower(): name.lower()
        for name in ("BLUE", "VERMILION", "GREEN", "PURPLE", "HATCH", "ALARM", "GLOBE", "RIM")
    },
}
"""Colours of a picture -> the page's colours for light or dark backgrounds."""

_COLOUR = re.compile("|".join(_COLOURS))

OVERVIEW = "overview"
"""The name of the picture that repeats the others."""


def overview(solution: Solution, texts: Texts) -> Markup:
    """Return a figure with path, states and controls; empty without a trajectory."""
    drawn = plots.overview(solution, Look(("svg",), titled=False))
    return _figure(OVERVIEW, drawn, texts) if drawn else Markup()


def pictures(solution: Solution, texts: Texts) -> list[Markup]:
    """Return a figure for each picture except the overview."""
    drawn = plots.pictures(solution, Look(("svg",), titled=False))
    named = {file.removesuffix(".svg"): content for file, content in drawn.items()}
    return [_figure(name, content, texts) for name, content in named.items() if name != OVERVIEW]


def _figure(name: str, content: Content, texts: Texts) -> Markup:
    stream = io.BytesIO()
    content(stream)
    said = texts.get("pictures", name)
    drawing = _inline(stream.getvalue().decode("utf-8"), name, said)
    return tag("figure", drawing, tag("figcaption", said), class_="picture")


def themed(svg: str) -> str:
    """Return the element ``svg`` alone, with the colours that the style sheets of a page define."""
    body = _ABOUT.sub("", _BEFORE.sub("", svg)).strip()
    return _COLOUR.sub(lambda found: f"var(--{_COLOURS[found[0]]})", body)


def _inline(svg: str, name: str, said: str) -> Markup:
    """Return the element alone, with unique names, and with a description for readers who do not see it."""
    body = _NAMED.sub(rf"\g<1>{name}-", themed(svg))
    return Markup(body.replace("<svg ", str(tag("svg", role="img", aria_label=said))[: -len("></svg>")] + " ", 1))


def problem(instance: Instance, statement: Derived | None, values: Sequence[str], texts: Texts) -> Markup:
    """Return the section on the problem: cost, ends of the motion, and bounds of the controls.

    Parameters
    ----------
    statement
        The derivation of the model.
    values
        What stands in place of numbers of the file, each as ``KEY=VALUE``.
    """
    symbols, limits = answer.symbols_of(instance), _constraints(instance)
    marks = statement.constraints() if statement else {}
    if statement:
        limits = [(texts.get("words", "symbol").lower(), *limits[0]), *((row[0], *row) for row in limits[1:])]
    return joined(
        statement.statement() if statement else "",
        tag("h3", texts.get("page", "instance")),
        answer.table(texts.get("page", "conditions"), _conditions(instance, texts), symbols),
        answer.table(texts.get("page", "admissible"), rows, symbols)
        if len(rows := _admissible(instance)) > 1
        else tag("p", texts.get("page", "unbounded")),
        answer.table(texts.get("page", "constraints"), limits, marks) if len(limits) > 1 else "",
        tag("p", _times(instance, texts)),
        _instance_file(instance, values, texts),
    )


def _conditions(instance: Instance, texts: Texts) -> list[tuple[str, ...]]:
    """Return a table with a row for each state: its initial value and its final condition."""
    rows: list[tuple[str, ...]] = [
        (say("state"), say("initial"), say("final"), say("unit"), texts.get("words", "meaning").lower())
    ]
    free = {unknown.name for unknown in instance.free}
    for variable, initial in zip(spec_of(instance).states, instance.initial, strict=True):
        name = variable.symbol
        begin = say("free") if name in free else figure(initial, DIGITS)
        rows.append((name, begin, _final(instance, name), variable.unit, say(variable.meaning)))
    return rows


def _final(instance: Instance, name: str) -> str:
    """Return the condition on a state at the end."""
    if name in instance.ranges:
        lower, upper = (figure(end, DIGITS) if math.isfinite(end) else say("free") for end in instance.ranges[name])
        return f"[{lower}, {upper}]"
    value = instance.final.get(name)
    if value is None:
        return say("free")
    return message(value) if isinstance(value, str) else figure(value, DIGITS)


def _admissible(instance: Instance) -> list[tuple[str, ...]]:
    """Return a table with a row for each bound of controls."""
    spec = spec_of(instance)
    rows: list[tuple[str, ...]] = [(say("control"), say("lower bound"), say("upper bound"), say("unit"))]
    for variable, *bounds in zip(spec.controls, instance.lower, instance.upper, strict=True):
        if any(map(math.isfinite, bounds)):
            rows.append((variable.symbol, *(figure(b) if math.isfinite(b) else "" for b in bounds), variable.unit))
    for norm in instance.bounded_norms:
        lower = figure(norm.lower) if norm.lower else ""
        named = radical(norm_text([spec.control_names[i] for i in norm.places]))
        rows.append((named, lower, figure(norm.upper), spec.controls[norm.places[0]].unit))
    return rows


def _constraints(instance: Instance) -> list[tuple[str, ...]]:
    """Return a table with a row for each path constraint: its name in pictures and results, and its upper bound."""
    names = stated_constraints(spec_of(instance))
    return [(say("path constraint"), say("upper bound")), *((name.replace("_", " "), "0") for name in names)]


def _times(instance: Instance, texts: Texts) -> str:
    unit = unit_text(time_unit(spec_of(instance)) or "1")

    def said(time: float) -> str:
        return f"{decimal(figure(time, DIGITS))} {unit}".rstrip()

    if instance.tf is None:
        return texts.get("page", "until_free", begin=said(instance.t0))
    return texts.get("page", "between", begin=said(instance.t0), end=said(instance.tf))


def _instance_file(instance: Instance, values: Sequence[str], texts: Texts) -> Markup:
    """Return the instance file as it was read, and the numbers that replaced its own."""
    file = file_of(instance)
    if file is None:
        return Markup()
    about = texts.get("page", "file", name=file["name"], digest=file["digest"])
    text = tag("pre", tag("code", text_of(instance.path)), tabindex="0")
    instead = texts.get("page", "instead", values=", ".join(values))
    return joined(tag("details", tag("summary", about), text), tag("p", instead) if values else Markup())
