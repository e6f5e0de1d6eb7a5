"""A derivation as a LaTeX document: the statement of the problem, then every step with its rule and its equations.

The sentences are those of :mod:`satsym.report.texts`; every equation is printed from the derivation's own objects, and
carries its address as its label.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from satsym.report.latex import preamble, rules, tex
from satsym.report.latex.equations import Context, Row, Shown, display, numbers_of, row_of
from satsym.report.latex.preamble import cited
from satsym.report.latex.rules import listed_sources, rule
from satsym.report.latex.statement import statement
from satsym.report.latex.steps import costate_rows, shown
from satsym.report.texts import PHRASES, Texts, load
from satsym.symbolic import Derivation, Problem, Step
from satsym.symbolic import notation as n
from satsym.symbolic.convention import worded
from satsym.symbolic.latex.products import plain
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.model import symbols_of, translated
from satsym.symbolic.notation import TIME
from satsym.symbolic.principle.path.interior import named
from satsym.symbolic.principle.path.notation import holds_controls

SECTION_FROM = {"hamiltonian": "conditions", "stability": "structure", "lqr_hamiltonian": "regulator"}
"""Step that begins a section -> key of the section."""

_NAME = re.compile(r"(?<=\\mathrm\{)[a-z]\w*")
"""Pattern of a subscript that is the model's name of a part, or its first word."""


OF_TIME = ("openings", "boundary_value", "statement", "rules", "groups", "boundary", "conclusions", "claims")
"""Tables of texts whose formulas may contain time."""
OF_OLD_TIME = ("new units",)
_FORMULA = re.compile(r"\$[^$]*\$|\\\[.*?\\\]")
_TIME = re.compile(r"(?<![A-Za-z\\])t(?![A-Za-z])")


def render(derivation: Derivation, language: str = "en", standalone: bool = True) -> str:
    r"""Typeset a derivation.

    Parameters
    ----------
    derivation
        What was derived, with or without a cost.
    language
        Language of the sentences, and of titles and meanings as far as the derivation file has them in it.
    standalone
        Whether the result is a document, or a body for ``\input`` in one that has the packages (they are
        named in its first line).

    Returns
    -------
    str
        LaTeX that depends on nothing but the arguments.

    Raises
    ------
    BadInput
        If there are no texts in that language.
    MissingText
        If the language has no text for a step, its rule or one of its checks.
    """
    texts = in_language(derivation, language)
    composer, name = _Composer(derivation, texts), tex.label(derivation.name)
    body = "\n\n".join(composer.paragraphs())
    body = _NAME.sub(lambda found: texts.phrase(found[0]), body)
    body, works = cited(body, name, texts)
    source = f"% Written by satsym from the derivation of {name}. Do not edit.\n"
    macros, end = preamble.macros(name, texts), composer.appendices()
    if not standalone:
        return f"{source}% Needs the packages {preamble.PACKAGES}.\n{macros}\n{body}\n\n{end}\n\n{works}\n"
    own = texts.phrase(derivation.title)
    title = tex.worded(own, derivation.notation)
    head = (
        f"\\begin{{center}}\n  \\satsymtitle{{{title}}}\n  \\vspace{{1ex}}{tex.name(derivation.name)}\n"
        f"\\end{{center}}\n\\begin{{abstract}}\n{composer.abstract()}\n\\end{{abstract}}"
    )
    opening = preamble.preamble(texts, tex.bookmark(own))
    return (
        f"{source}{opening}{macros}\\begin{{document}}\n{head}\n\n{body}\n\n"
        f"\\appendix\n{end}\n\n{works}\n\\end{{document}}\n"
    )


def in_language(derivation: Derivation, language: str) -> Texts:
    """Return the texts of a language, with the sentences and words that the model adds."""
    model = derivation.model
    texts = load(language).with_own({**model.sentences().get(language, {}), PHRASES: translated(model, language)})
    time = derivation.notation[TIME.name]
    return texts if time == "t" else texts.with_own({table: _timed(texts.tables[table], time) for table in OF_TIME})


def _timed(table: Mapping[str, str], letter: str) -> dict[str, str]:
    """Return texts in whose formulas time has another letter, except those about the old time."""
    return {
        key: text if key in OF_OLD_TIME else _FORMULA.sub(lambda found: _TIME.sub(lambda _: letter, found[0]), text)
        for key, text in table.items()
    }


class _Composer:
    def __init__(self, derivation: Derivation, texts: Texts) -> None:
        self._derivation, self._texts = derivation, texts
        comma = texts.get("words", "point") != "."
        self._context = Context(derivation, texts, Typesetter(derivation, comma=comma))
        self._declared = statement(derivation, texts, self._context.typeset)
        self._shown: dict[str, Shown] = {}
        kind = "problem" if derivation.problem else "model"
        starts = {SECTION_FROM[step.name]: step.name for step in derivation.steps if step.name in SECTION_FROM}
        self._sections = [kind, "motion", *starts, *(["boundary_value"] if derivation.problem else [])]

    def abstract(self) -> str:
        """Write what each section does."""
        places = {self._examined(key): self._place(key) for key in (*self._sections, "checks")}
        return " ".join(self._texts.get("abstract", key, section=place) for key, place in places.items())

    def _examined(self, section: str) -> str:
        """Return the key of a section's summary; the one on structure may cover less."""
        if section == "motion":
            first = self._derivation.steps[0]
            return "motion, stated" if (first.name, first.rule) == ("first_order", "given") else section
        examined = [step for step in ("controllability", "observability") if step in self._derivation]
        return section if section != "structure" or len(examined) == 2 else "".join(examined) or "stability"

    def paragraphs(self) -> list[str]:
        """Write everything from the statement to the results."""
        done = [self._section(self._sections[0]), *self._declared.paragraphs]
        done.append(self._section("motion"))
        for step in self._derivation.steps:
            if step.name in SECTION_FROM:
                done += self._opening(SECTION_FROM[step.name])
            done.append(self._step(step))
        if self._derivation.problem:
            done += [self._section("boundary_value"), *collected(self._context)]
        return done

    def appendices(self) -> str:
        """Write the checks of all steps, and equations that are too many for the place of their step."""
        listed = f"{self._section('checks')}\n{rules.listed(self._derivation, self._texts)}"
        apart = "\n".join(one.appendix for one in self._shown.values() if one.appendix)
        if not apart:
            return listed
        opening = self._texts.get("openings", "subexpressions")
        return f"{listed}\n\n{self._section('subexpressions')}\n{opening}\n{apart}"

    def _place(self, section: str) -> str:
        return tex.label(f"{self._derivation.name}:section.{section}")

    def _section(self, key: str) -> str:
        heading = key if self._examined(key) != "stability" else "stability"
        return rf"\section{{{self._texts.get('sections', heading)}}}\label{{{self._place(key)}}}"

    def _opening(self, key: str) -> Iterator[str]:
        """Write the heading of a section, and the sections that it uses."""
        problem = self._derivation.problem
        yield self._section(key)
        opening = "stability" if self._examined(key) == "stability" else key
        yield self._texts.get("openings", worded(opening, problem) if problem else opening)

    def _step(self, step: Step) -> str:
        """Write a step: heading, rule, equations and conclusions; its sources are earlier steps."""
        title = self._title(step)
        stated = rule(self._context, step, self._sources(step))
        self._shown[step.name] = shown(self._context, step)
        heading = rf"\satsymstep{{{tex.label(self._context.address(step))}}}{{{title}}}"
        further = [found for key in (step.name, *step.kinds) if (found := self._texts.find("further", key))]
        return "\n".join((heading, stated, self._shown[step.name].body, *self._while(step), *further))

    def _title(self, step: Step) -> str:
        """Return the title of a step, in its form for a single control where there is one."""
        alone = len(self._derivation.model.controls) == 1
        found = self._texts.find("titles", f"{step.name}, one control") if alone else None
        return found or self._texts.get("titles", step.name)

    def _while(self, step: Step) -> list[str]:
        """Write the remark on a step that leaves path constraints out."""
        problem = self._derivation.problem
        if problem is None or not problem.path_constraints:
            return []
        if step.name == "control_law" and holds_controls(problem):
            held = tex.label(f"{self._derivation.name}:mixed_constraints")
            return [self._texts.get("groups", "held", step=rf"\ref{{{held}}}")]
        return [self._texts.get("groups", "unconstrained")] if step.name == "least_effort" else []

    def _sources(self, step: Step) -> str:
        return listed_sources(self._texts, {name: self._source(name) for name in step.follows_from})

    def _source(self, name: str) -> str:
        """Name a source of a step, a shown step or a declaration, with its equation numbers."""
        if name in self._shown:
            first, last = tex.label(self._shown[name].first), tex.label(self._shown[name].last)
            step = tex.label(f"{self._derivation.name}:{name}")
            return self._texts.get("references", "one" if first == last else "many", first=first, last=last, step=step)
        if name == "definitions" and name not in self._declared.ends:
            return ""
        ends = self._declared.ends.get(name)
        return self._texts.get("declared", name) + (f"~{numbers_of(*ends)}" if ends else "")


ON_BOUNDARY = (
    *("boundary_control", "control_rates", "constraint_multiplier", "constrained_costates", "junction_conditions"),
    *("mixed_constraints", "mixed_costates"),
)
"""Steps on arcs on which a path constraint is active."""
SINGULAR = ("singular_arcs", "generalised_legendre_clebsch")
"""Steps on singular arcs."""
DEFINING = ("switching_function", "control_parts")
"""Steps that define the symbols of control laws."""


def collected(context: Context) -> Iterator[str]:
    """Write the conditions along the trajectory, at its start and at its end."""
    derivation, texts = context.derivation, context.texts
    problem = derivation.problem
    assert problem is not None

    def said(key: str, **fill: str) -> str:
        return texts.get("boundary_value", key, **fill)

    motion, costates, law = (derivation.step(name) for name in ("state_equations", "costate_equations", "control_law"))
    along = [*(row_of(context, motion, e) for e in motion.equations), *costate_rows(context, costates)]
    yield said("multipliers" if problem.end_conditions else "unknowns") + "\n" + _shown(along)
    yield said("control") + "\n" + _shown([*(row_of(context, law, e) for e in law.equations), *_parts(context, law)])
    steps = [
        rf"\ref{{{tex.label(context.address(derivation.step(name)))}}}" for name in ON_BOUNDARY if name in derivation
    ]
    if steps and _constrained(problem):
        yield said("aside", steps=texts.listed(steps))
    if arc := _singular(context):
        yield said("singular", step=arc)
    if "interior_conditions" in derivation:
        passed = derivation.step("interior_conditions")
        address = tex.label(context.address(passed))
        key = "interior" if len(problem.interior) > 1 else "interior_one"
        yield said(key, step=rf"\ref{{{address}}}") + "\n" + _shown(_passing(context, passed))
    ends = derivation.step("boundary_conditions")
    states = symbols_of(derivation.model.states)
    yield said("start") + "\n" + _shown(_at(context, ends, "t_0", [s.name for s in states]))
    multipliers = [n.costate_of(s).name for s in states]
    either, end = _at(context, ends, "t_f", multipliers), context.typeset.at("t_f")
    given = [
        plain(
            rf"{end.symbol(s.name)} = {end.symbol(n.target(s).name)}"
            rf" \quad\text{{{texts.get('words', 'or')}}}\quad {row.left_tex}"
        )
        for s, row in zip(states, either, strict=True)
    ]
    yield (
        said("end", step=rf"\ref{{{tex.label(context.address(ends))}}}")
        + "\n"
        + _shown([replace(row, left=left) for row, left in zip(either, given, strict=True)])
    )
    others = [e.name for e in ends.equations if e.name not in {*multipliers, *(s.name for s in states), "final_time"}]
    if others:
        yield said("constraints") + "\n" + _shown(_at(context, ends, "t_f", others))
    yield said("final_time") + "\n" + _shown(_at(context, ends, "t_f", ["final_time"]))


def _parts(context: Context, law: Step) -> list[Row]:
    """Return the step whose symbols the law contains: switching functions, or the parts of H."""
    derivation = context.derivation
    within = set[Any]().union(*(e.rhs.free_symbols for e in law.equations))
    steps = [derivation.step(name) for name in DEFINING if name in derivation]
    return [row_of(context, step, e) for step in steps for e in step.equations if e.lhs in within]


def _singular(context: Context) -> str:
    """Return the step that states controls on singular arcs, if such arcs may be optimal."""
    derivation = context.derivation
    found = [step for name in SINGULAR if name in derivation for step in (derivation.step(name),)]
    keys = [c.key.partition(",")[0] for step in found for c in step.conclusions]
    stated = keys.count("singular arc") > keys.count("Legendre-Clebsch violated")
    return rf"\ref{{{tex.label(context.address(found[0]))}}}" if stated else ""


def _constrained(problem: Problem) -> bool:
    """Tell whether there is a path constraint; bounds beside points on the way are part of the law."""
    return bool(problem.path_constraints)


def _passing(context: Context, step: Step) -> list[Row]:
    """Write the conditions at points on the way, and their effects on costates and H."""
    problem = context.derivation.problem
    assert problem is not None
    stated = set(named(problem))
    return [replace(row_of(context, step, e), end="= 0" if e.name in stated else "") for e in step.equations]


def _at(context: Context, step: Step, time: str, names: list[str]) -> list[Row]:
    """Write the equations with some names, at a time."""
    typeset = context.typeset.at(time)
    return [row_of(context, step, e, typeset=typeset) for e in step.equations if e.name in names]


def _shown(rows: list[Row]) -> str:
    return display([replace(row, again=True) for row in rows])
