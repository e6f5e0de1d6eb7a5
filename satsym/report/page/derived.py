"""A derivation as a section: its statement, then each step with its rule, its equations and its checks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from satsym.report.display import unit_text
from satsym.report.html.markup import Markup, joined, math, prose, scrolled, tag
from satsym.report.latex import tex
from satsym.report.latex.document import SECTION_FROM, in_language
from satsym.report.latex.equations import Context, broken, width
from satsym.report.latex.rules import checked, listed_sources, rule
from satsym.report.latex.statement import admissible, conditions
from satsym.report.latex.steps import conclusion, groups_of, next_group
from satsym.report.page.answer import typeset as printed
from satsym.report.said import decimal
from satsym.report.terminal.table import figure
from satsym.report.texts import PHRASES, Texts
from satsym.spec import Variable
from satsym.symbolic.latex.products import Term
from satsym.symbolic.latex.typeset import Typesetter, matrices
from satsym.symbolic.principle.effort import cost_letter
from satsym.symbolic.principle.path.notation import rate

if TYPE_CHECKING:
    from satsym.symbolic import Derivation, Step

ROOM = 44.0
"""Width in em that an equation may take; on paper a wider one could not be scrolled."""

BETWEEN, FRACTIONS, SMALLEST_FONT = 1.0, 0.75, 0.45
"""Space between columns of a matrix in em, relative size of letters in its fractions, and smallest size of letters."""

_SIZED = re.compile(r"\\[bB]igg?[lrm]?(?![A-Za-z])")

OPEN = ("first_order", "hamiltonian", "control_law", "costate_equations")
"""Steps that are unfolded when the page is opened."""

_HEADS = ("words", "symbol"), ("words", "name"), ("words", "unit"), ("page", "value"), ("words", "meaning")

DEFINED = "declared"
"""First part of the addresses of definitions, as in ledgers."""


class Derived:
    """The section of one derivation on a page.

    Parameters
    ----------
    values
        Name of a parameter -> its value in the instance.
    units
        Name of a quantity -> the unit that the instance is shown in, where it is not that of the model.
    """

    def __init__(
        self, derivation: Derivation, texts: Texts, values: Mapping[str, float], units: Mapping[str, str] | None = None
    ) -> None:
        own = in_language(derivation, texts.language)
        self._derivation, self._texts, self._values, self._units = derivation, own, values, units or {}
        self._context = Context(derivation, own, Typesetter(derivation))
        self._numbers: dict[str, str] = {}
        self._ends: dict[str, tuple[str, str]] = {}

    def render(self) -> Markup:
        """Return the whole section."""
        kind = "problem" if self._derivation.problem else "model"
        return joined(tag("h3", self._texts.get("sections", kind)), self.statement(), self.steps())

    def statement(self) -> Markup:
        """Return what is minimised, what the model states, and its quantities, to be placed above the steps."""
        return joined(*self._statement())

    def constraints(self) -> dict[str, str]:
        """Return the symbol of each path constraint in LaTeX, by its name in words."""
        problem, typeset = self._derivation.problem, self._context.typeset
        stated = (problem.path_constraints or {}) if problem else {}
        return {name.replace("_", " "): typeset.tex(rate(name, 0)) for name in stated}

    def steps(self) -> Markup:
        """Return each step under the heading of its section.

        It must be called after the statement, whose equations it cites.
        """
        parts = [tag("h3", self._texts.get("sections", "motion"))]
        for number, step in enumerate(self._derivation.steps, 1):
            if step.name in SECTION_FROM:
                parts.append(tag("h3", self._texts.get("sections", SECTION_FROM[step.name])))
            parts.append(self._step(number, step))
        return joined(*parts)

    def _statement(self) -> Iterator[Markup]:
        problem, typeset, texts = self._derivation.problem, self._context.typeset, self._texts
        if problem is not None:
            terminal = not typeset.is_zero(problem.terminal_cost)
            task = ("maximise" if problem.maximise else "minimise") + (
                "" if len(problem.model.controls) > 1 else "_one"
            )
            controls = r",\, ".join(v.latex for v in problem.model.controls)
            yield tag("p", prose(texts.get("statement", task, controls=controls), {}))
            lead = "-" if problem.maximise else ""
            final = rf"{lead}S(\mathbf{{x}}(t_f), t_f) {lead or '+'} " if terminal else lead
            yield scrolled(math(rf"{cost_letter(problem.model)} = {final}\int_{{t_0}}^{{t_f}} L \, dt", block=True))
            yield tag("p", prose(texts.get("statement", "where_terminal" if terminal else "where"), {}))
            yield scrolled(math(f"L = {typeset.tex(problem.running_cost)}", block=True))
            if terminal:
                yield scrolled(math(f"S = {typeset.tex(problem.terminal_cost)}", block=True))
            yield from self._rates()
            sentence, limits = admissible(problem, texts)
            yield tag("p", prose(sentence, {}))
            yield from (scrolled(math(line, block=True)) for line in limits)
            for sentence, rows in conditions(self._derivation, texts, typeset):
                yield tag("p", prose(sentence, {}))
                yield from (scrolled(math(in_lines(row.left_tex, row.right, row.end), block=True)) for row in rows)
        for said in self._derivation.model.statement():
            fill = {"name": said.of.name, "title": texts.phrase(said.of.title)} if said.of else {}
            yield tag("p", prose(texts.get("statement", said.sentence, **fill), {}))
            for line in said.lines:
                left = line.left if isinstance(line.left, str) else typeset.symbol(line.left.name)
                left += rf"_{{\text{{{line.index}}}}}" if line.index else ""
                parts = r",\; ".join(typeset.tex(part) for part in line.components)
                right = rf"\left({parts}\right)^{{\mathsf{{T}}}}" if line.components else typeset.tex(line.right)
                yield scrolled(math(f"{left} = {right}", block=True))
        yield self._quantities()
        yield from self._definitions()

    def _rates(self) -> Iterator[Markup]:
        """Return the equations of motion that the cost is subject to, with a link to the step that has them."""
        if "first_order" not in self._derivation:
            return
        step, typeset = self._derivation.step("first_order"), self._context.typeset
        number = 1 + [one.name for one in self._derivation.steps].index(step.name)
        label = tex.label(self._context.address(step))
        sentence = self._texts.get(
            "statement", "subject_to" if len(step.equations) > 1 else "subject_to_one", step=label
        )
        yield tag("p", prose(sentence, {label: str(number)}))
        for e in step.equations:
            yield scrolled(math(in_lines(typeset.tex(e.lhs), typeset.terms(e.rhs)), block=True))

    def _definitions(self) -> Iterator[Markup]:
        """Return the named constants, numbered, since steps cite them."""
        name, typeset = self._derivation.name, self._context.typeset
        for k, one in enumerate(self._derivation.model.definitions):
            if not k:
                yield tag("p", prose(self._texts.get("statement", "definitions"), {}))
            symbol, latex = one.variable.symbol, one.variable.latex
            address = f"{name}:{DEFINED}.{symbol}"
            yield self._equation(address, in_lines(latex, typeset.terms(one.value)), 0.0)

    def _quantities(self) -> Markup:
        """Return a row for each quantity; a unit or a value that none of them has takes no column."""
        model, texts = self._derivation.model, self._texts
        heads = [tag("th", texts.get(*key), scope="col") for key in _HEADS]
        rows = [self._quantity(v) for vs in (model.states, model.controls, model.parameters) for v in vs]
        kept = [k for k, column in enumerate(zip(*(told for told, _ in rows), strict=True)) if any(column)]
        body = (tag("tr", *(cells[k] for k in kept)) for _, cells in rows)
        return scrolled(tag("table", tag("tr", *(heads[k] for k in kept)), *body, class_="facts"))

    def _quantity(self, v: Variable) -> tuple[tuple[bool, ...], tuple[Markup, ...]]:
        """Tell whether each cell says something, and return the cells."""
        value, said = self._values.get(v.symbol), self._texts.phrase(v.meaning)
        unit = unit_text(self._units.get(v.symbol, v.unit))
        return (True, True, bool(unit), value is not None, True), (
            tag("td", math(v.latex)),
            tag("th", tag("code", v.symbol), scope="row"),
            tag("td", unit),
            tag("td", "" if value is None else printed(decimal(figure(value, 10))), class_="number"),
            tag("td", said, lang=self._texts.language if self._texts.find(PHRASES, v.meaning) else "en"),
        )

    def _step(self, number: int, step: Step) -> Markup:
        """Return a step: heading, rule, equations, conclusions and checks."""
        texts, label = self._texts, tex.label(self._context.address(step))
        title = texts.get("titles", step.name)
        stated = prose(rule(self._context, step, self._sources(step)), self._numbers)
        self._numbers[label] = str(number)
        body: list[Markup] = []
        for place, (equations, conclusions) in enumerate(groups_of(step)):
            if place and equations:
                body.append(tag("p", prose(next_group(self._context, step, equations[0]), self._numbers)))
            body += [self._equation(*line) for line in self._lines(replace(step, equations=equations))]
            body += [tag("p", prose(conclusion(self._context, one), self._numbers)) for one in conclusions]
        checks = [tag("li", prose(checked(texts, check), {})) for check in step.checks]
        return tag(
            "details",
            tag("summary", tag("h4", f"{texts.get('words', 'step')} {number}. {title}")),
            tag("div", stated, class_="rule"),
            *body,
            tag("ul", *checks, class_="checks", aria_label=texts.get("page", "checked")),
            class_="step",
            id=label,
            open=step.name in OPEN,
        )

    def _equation(self, address: str, line: str, room: float) -> Markup:
        label = tex.label(address)
        small = room > ROOM and f"font-size: {max(SMALLEST_FONT, ROOM / room):.0%}"
        self._numbers[label] = f"({sum(name.startswith('(') for name in self._numbers.values()) + 1})"
        name = address.partition(":")[0]
        step = tex.label(f"{name}:{address.partition(':')[2].partition('.')[0]}")
        first, _ = self._ends.get(step, (label, label))
        self._ends[step] = (first, label)
        number = tag("a", self._numbers[label], href=f"#{label}", title=address)
        written = tag("div", scrolled(math(line, block=True)), style=small)
        return tag("div", written, number, class_="equation", id=label)

    def _lines(self, step: Step) -> Iterator[tuple[str, str, float]]:
        """Return address, LaTeX and width of each equation, with matrices in place of their entries."""
        named = matrices(self._derivation, step)
        entries = [e for one in named for e in one.equations]
        address, plain = self._context.address(step), self._context.typeset
        start, end = plain.at("t_0"), plain.at("t_f")
        states = {v.symbol for v in self._derivation.model.states}
        for one in named:
            columns = [[width(plain.tex(entry)) for entry in one.matrix.col(k)] for k in range(one.matrix.cols)]
            across = sum(FRACTIONS * max(column) + BETWEEN for column in columns)
            yield f"{address}.{one.prefix}", f"{one.prefix} = {plain.tex(one.matrix)}", across
        for e in step.equations:
            if e not in entries:
                given = step.name == "boundary_conditions" and e.name in states
                typeset = start if given else end if step.name.startswith("boundary") else plain
                left = typeset.tex(e.lhs)
                if typeset.is_zero(e.lhs) and step.name.endswith("stationarity"):
                    left = rf"0 = \frac{{\partial H}}{{\partial {typeset.symbol(e.name)}}}"
                written = f"{left} = {typeset.tex(e.rhs)}"
                long = width(written) > ROOM and not e.rhs.is_Matrix
                yield f"{address}.{e.name}", in_lines(left, typeset.terms(e.rhs)) if long else written, 0.0

    def _sources(self, step: Step) -> str:
        return listed_sources(self._texts, {name: self._source(name) for name in step.follows_from})

    def _source(self, name: str) -> str:
        if name == "definitions":
            if not self._derivation.model.definitions:
                return ""
            first, last = self._ends[tex.label(f"{self._derivation.name}:{DEFINED}")]
            numbers = rf"\eqref{{{first}}}" + (rf"\mbox{{--}}\eqref{{{last}}}" if first != last else "")
            return f"{self._texts.get('declared', name)}~{numbers}"
        label = tex.label(f"{self._derivation.name}:{name}")
        if label in self._ends:
            first, last = self._ends[label]
            return self._texts.get("references", "one" if first == last else "many", first=first, last=last, step=label)
        return self._texts.find("declared", name) or ""


def in_lines(left: str, terms: Sequence[Term], end: str = "") -> str:
    """Return an equation on as many lines as its width needs."""
    first, *others = broken(terms, ROOM - min(width(left), ROOM / 2.0))
    if not others:
        return f"{left} = {first} {end}".rstrip()
    lines = " \\\\ ".join([rf"{left} &= {first}", *(f"& {line}" for line in others)])
    unsized = _SIZED.sub("", lines)  # which may open on one line and close on another
    return rf"\begin{{split}} {unsized} {end} \end{{split}}"
