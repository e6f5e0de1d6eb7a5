"""A derivation as a LaTeX document: what it starts from, then every step with its rule and its equations.

The sentences are those of :mod:`satsym.report.texts`; every equation is printed from the derivation's own
objects, and carries its address as its label.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from satsym.report.latex import boundary_value, checks, preamble, tex
from satsym.report.latex.context import Context, Shown, numbers_of
from satsym.report.latex.references import cited
from satsym.report.latex.rules import listed_sources, rule
from satsym.report.latex.statement import statement
from satsym.report.latex.steps import shown
from satsym.report.texts import PHRASES, Texts, load
from satsym.symbolic import Derivation, Step
from satsym.symbolic.convention import worded
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.model import translated
from satsym.symbolic.notation import TIME
from satsym.symbolic.principle.path.notation import holds_controls

SECTION_FROM = {"hamiltonian": "conditions", "stability": "structure", "lqr_hamiltonian": "regulator"}
"""Steps that begin a new section."""

_NAME = re.compile(r"(?<=\\mathrm\{)[a-z]\w*")
"""At the foot of a symbol: what the model calls a part of it, or the first word of that."""


OF_TIME = ("openings", "boundary_value", "statement", "rules", "groups", "boundary", "conclusions", "claims")
"""Tables of texts in whose formulas time may stand."""
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
    """The texts of a language, with what the model brings: its kind's sentences, its own words."""
    model = derivation.model
    texts = load(language).with_own({**model.sentences().get(language, {}), PHRASES: translated(model, language)})
    time = derivation.notation[TIME.name]
    return texts if time == "t" else texts.with_own({table: _timed(texts.tables[table], time) for table in OF_TIME})


def _timed(table: Mapping[str, str], letter: str) -> dict[str, str]:
    """Texts in whose formulas time has another letter, but for those of the old time."""
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
        """What each section does."""
        places = {self._examined(key): self._place(key) for key in (*self._sections, "checks")}
        return " ".join(self._texts.get("abstract", key, section=place) for key, place in places.items())

    def _examined(self, section: str) -> str:
        """The key of what a section is said to do: that on structure may be about less."""
        if section == "motion":
            first = self._derivation.steps[0]
            return "motion, stated" if (first.name, first.rule) == ("first_order", "given") else section
        examined = [step for step in ("controllability", "observability") if step in self._derivation]
        return section if section != "structure" or len(examined) == 2 else "".join(examined) or "stability"

    def paragraphs(self) -> list[str]:
        """Everything from the statement to what it leads to."""
        done = [self._section(self._sections[0]), *self._declared.paragraphs]
        done.append(self._section("motion"))
        for step in self._derivation.steps:
            if step.name in SECTION_FROM:
                done += self._opening(SECTION_FROM[step.name])
            done.append(self._step(step))
        if self._derivation.problem:
            done += [self._section("boundary_value"), *boundary_value.collected(self._context)]
        return done

    def appendices(self) -> str:
        """How all steps were checked, and equations that are too many for the place of their step."""
        listed = f"{self._section('checks')}\n{checks.listed(self._derivation, self._texts)}"
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
        """The head of a section, and what it builds on."""
        problem = self._derivation.problem
        yield self._section(key)
        opening = "stability" if self._examined(key) == "stability" else key
        yield self._texts.get("openings", worded(opening, problem) if problem else opening)

    def _step(self, step: Step) -> str:
        """Heading, rule, equations, what they come to; the sources are the steps before this one."""
        title = self._title(step)
        stated = rule(self._context, step, self._sources(step))
        self._shown[step.name] = shown(self._context, step)
        heading = rf"\satsymstep{{{tex.label(self._context.address(step))}}}{{{title}}}"
        further = [found for key in (step.name, *step.kinds) if (found := self._texts.find("further", key))]
        return "\n".join((heading, stated, self._shown[step.name].body, *self._while(step), *further))

    def _title(self, step: Step) -> str:
        """The title of a step, in its form for a single control where there is one."""
        alone = len(self._derivation.model.controls) == 1
        found = self._texts.find("titles", f"{step.name}, one control") if alone else None
        return found or self._texts.get("titles", step.name)

    def _while(self, step: Step) -> list[str]:
        """What is said of a step that leaves path constraints out."""
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
        """A step that was shown, or else a declared thing, in words and with its numbers."""
        if name in self._shown:
            first, last = tex.label(self._shown[name].first), tex.label(self._shown[name].last)
            step = tex.label(f"{self._derivation.name}:{name}")
            return self._texts.get("references", "one" if first == last else "many", first=first, last=last, step=step)
        if name == "definitions" and name not in self._declared.ends:
            return ""
        ends = self._declared.ends.get(name)
        return self._texts.get("declared", name) + (f"~{numbers_of(*ends)}" if ends else "")
