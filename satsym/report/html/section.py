"""The section of one document: its summary, its findings, and all its rows with their links."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import msgspec

from satsym import user_cache
from satsym.auditing import Judged, cache
from satsym.auditing.causes import Finding, Weight
from satsym.auditing.latex.writing import in_latex
from satsym.auditing.ledger.contents import Row, calls_in
from satsym.formula.tree import Equality, Text, grid
from satsym.formula.values import Matrix
from satsym.formula.writing import GREEK
from satsym.records import record, shelf
from satsym.report.display import raised, with_raised_units
from satsym.report.findings.review import (
    IN_FULL,
    ListedReview,
    correction,
    flat,
    is_mathematical,
    measured,
    recompute,
    where,
)
from satsym.report.html.markup import Markup, joined, math, tag
from satsym.report.html.tested import mathematics
from satsym.report.latex import formula_tex

if TYPE_CHECKING:
    from satsym.symbolic import Derivation


_CODE = re.compile(r"`([^`]*)`")
_POINT = re.compile(r"((?:section|bagian) [0-9IVX.]+) (\d+)((?:, .+)?)$")
_ATOM = r"(?:[A-Za-z]\w*|\d+)(?:(?:\*\*|\^)(?:-?\d+|\([^()\s]*\)))?"
_BARE = re.compile(rf"(?<![\w`.*/^])-?{_ATOM}(?:[*/]{_ATOM})*(?![\w(*^/])")
_SPECIAL = re.compile(r"[*^]|_d?dot\b|_\w+/|/\w+_")
_UNITS = frozenset("m s g N km kg cm dyn min h deg rad A J W V kelvin".split())
"""Names that are units where they stand in a product after a number."""
_UNSET = re.compile(r"\\(?:mathrm|text)\{([A-Z])((?:\\?_[a-z]+\d*)+)\}")
_REASON = re.compile(r"(?:^|(?<=[:;] ))\((\d+)\)(?= )")


class PageReview(ListedReview):
    """A review whose places are written out, since pages give the command for each of them."""

    def placed(self, name: str) -> str:
        """Return the name of a place, with a numbered point of a section as such."""
        return _POINT.sub(rf"\1, {self.texts.get('audit', 'point')} \2\3", super().placed(name))


class Section:
    """The section on one document."""

    def __init__(self, review: PageReview) -> None:
        self._review, self._texts = review, review.texts
        self._language = review.ledger.document.language
        self._is_foreign = self._language != review.texts.language
        self._judged = {row.key: row for row in review.rows}
        self.rows = [row for row in review.ledger.rows if row.key in self._judged]
        self._read = {row.key: row for row in self.rows}
        self._anchors = {key: f"{review.key}.{anchor}" for key, anchor in _anchors(self._judged)}

    def render(self) -> Markup:
        """Return the whole section."""
        review = self._review
        title = tag("h2", review.ledger.document.title, lang=self._language)
        byline = [tag("p", self._word("by"), " ", review.byline, class_="byline")] if review.byline else []
        sentences = (self._summarised(*said) for said in review.summary_points)
        summary = tag("div", *sentences, self._chart(), class_="summary")
        if self._is_foreign and any(row.original for row in review.rows):
            byline.append(tag("p", self._word("quoted"), class_="byline"))
        parts = [self._of_weight(weight, group) for weight, group in review.by_weight]
        nothing = [] if parts else [tag("p", self._word("nothing"))]
        return tag("section", title, *byline, summary, *parts, *nothing, self._all_rows(), id=review.key)

    def _summarised(self, sentence: str, points: Iterable[str]) -> Markup:
        """Return a sentence of the summary, whose points, if it has several, are a list."""
        listed = [tag("li", self._sentence(point)) for point in points]
        return Markup(tag("p", self._sentence(sentence)) + (tag("ul", *listed) if listed else ""))

    def _chart(self) -> Markup:
        """Return a table with bars of how many rows of each kind are right, wrong and open."""
        names = [self._word(key) for key in ("of_kind", "stands", "falls_here", "open_here")]
        head = tag("tr", *(tag("th", name, scope="col") for name in names), tag("td", ""))
        lines = []
        for name, *counts in self._review.chart:
            widths = [f"width: {100.0 * count / sum(counts):.1f}%" for count in counts]
            classes = ("stands", "falls", "open")
            bars = [tag("span", "", class_=c, style=w) for c, w, n in zip(classes, widths, counts, strict=True) if n]
            cells = [tag("td", str(count)) for count in counts]
            lines.append(tag("tr", tag("th", name, scope="row"), *cells, tag("td", *bars, class_="bar")))
        caption = tag("caption", self._word("chart"))
        table = tag("table", caption, tag("thead", head), tag("tbody", *lines), class_="chart")
        return Markup(
            table + tag("p", tag("small", self._review.items_that_hold)) if self._review.items_that_hold else table
        )

    def users(self, address: str) -> list[Markup]:
        """Return links to the rows that are compared with a derived expression."""
        return [self._link(row.key) for row in self.rows if address in addresses(row)]

    def _of_weight(self, weight: Weight, group: Iterable[tuple[int, Finding]]) -> Markup:
        heading = tag("h3", self._texts.get("weights", weight.value))
        return tag("section", heading, *(self._finding(n, found) for n, found in group), class_="weight")

    def _finding(self, number: int, found: Finding) -> Markup:
        row = found.places[0]
        heading = tag("h4", f"{number}. ", self._review.places(found.places))
        said = [*([self._original(row), " "] if row.original else []), *_formulas(self._review.brief(found)), "."]
        summary = tag("summary", heading, " ", self._verdict(row), " ", tag("span", *said, class_="brief"))
        facts = {
            **self._facts(row),
            "places": self._links(r.key for r in found.places) if len(found.places) > 1 else "",
        }
        facts |= {"spoils": self._links(r.key for r in found.spoiled), **self._sources(row.key)}
        evidence, command = recompute(row)
        facts |= {"recompute": tag("code", command), "code": self._code(row, evidence)}
        return tag(
            "details",
            summary,
            self._list(facts),
            class_="finding",
            id=self._finding_anchor(number),
            open=found.weight in IN_FULL,
            data_document=self._review.key,
            data_weight=found.weight.value,
            data_verdict=row.verdict,
        )

    def _facts(self, row: Judged) -> dict[str, str]:
        """Return the printed content and what is true instead."""
        right = correction(row)
        derived = _formula(formula_tex.read(right) if is_mathematical(row) else None, right) if right else Markup()
        printed = Markup() if row.kind == "claim" else self._printed(row)
        beside = bool(printed and right and row.by_formula)
        stands = tag("small", f" ({self._review.placed(where(row))})") if where(row) else Markup()
        words = "" if row.by_formula else self._review.in_words(row)
        return {
            "says": Markup(self._original(row) + stands) if row.original else Markup(),
            "about": self._about(row) if row.says and (self._is_foreign or not row.original) else "",
            "printed": "" if beside else printed,
            "in_fact": self._beside(row, printed, derived) if beside else joined(*_formulas(self._review.fact(row))),
            "measured": joined(*_formulas(words, raised)) if words and measured(row) else "",
            "tested": self._tested(row) if not words and row.derived else "",
            "chosen": self._review.chosen(row),
            "right": "" if beside else derived,
        }

    def _tested(self, row: Judged) -> Markup:
        """Return the proposition that was tested as mathematics; empty where it has no usual form."""
        tex = "" if row.by_formula or row.kind != "claim" else mathematics(flat(row.printed))
        return scrolled(math(tex, block=True)) if tex else Markup()

    def _beside(self, row: Judged, printed: Markup, right: Markup) -> Markup:
        """Return the printed content, the derived one, and their difference, side by side."""
        parts = {"printed": printed, "right": right, "difference": joined(*_formulas(self._review.fact(row)))}
        pairs = (tag("div", tag("dt", self._word(key)), tag("dd", part)) for key, part in parts.items())
        return tag("dl", *pairs, class_="compared")

    def _about(self, row: Judged) -> Markup:
        """Return the subject of a row, marked as English on a page in another language if it is."""
        return tag("span", row.says, lang=False if self._review.translated(row) else "en")

    def _sources(self, key: str) -> dict[str, str]:
        """Return links to the sources of a row, and to the expressions it is compared with."""
        row = self._read[key]
        against = [tag("a", breakable(address), href=f"#{slug(address)}") for address in addresses(row)]
        named = dict.fromkeys([*row.uses, *(row.claims.rows if row.claims else ())])
        return {"follows_from": self._links(named), "held_against": joined(*against, by=", ")}

    def _list(self, facts: Mapping[str, str]) -> Markup:
        pairs = [tag("dt", self._word(key)) + tag("dd", value) for key, value in facts.items() if value]
        return tag("dl", *map(Markup, pairs))

    def _all_rows(self) -> Markup:
        heading = self._texts.get("audit", "rows_of", document=self._review.key)
        names = ("item", "printed", "verdict", "follows_from", "held_against")
        head = tag("tr", *(tag("th", self._word(name), scope="col") for name in names))
        table = tag("table", tag("thead", head), tag("tbody", *map(self._row, self._review.rows)), class_="rows")
        return tag("details", tag("summary", tag("h3", heading)), table, class_="all")

    def _row(self, row: Judged) -> Markup:
        number = self._review.number_of.get(row.key)
        found = tag("a", f"{self._word('finding')} {number}", href=f"#{self._finding_anchor(number)}") if number else ""
        return tag(
            "tr",
            tag("th", self._review.placed(row.key), " ", tag("small", self._review.placed(where(row))), scope="row"),
            tag("td", self._original(row) or self._about(row) if row.kind == "claim" else self._printed(row)),
            tag("td", self._verdict(row), " ", found),
            *(tag("td", links, data_label=self._word(key)) for key, links in self._sources(row.key).items()),
            id=self._anchors[row.key],
            data_document=self._review.key,
            data_weight=row.weight,
            data_verdict=row.verdict,
        )

    def _code(self, row: Judged, evidence: str) -> Markup:
        """Return the proposition that was tested and the measured values as code, folded away."""
        tested = self._printed(row) if row.kind == "claim" else Markup()
        if not tested and (row.by_formula or not evidence):
            return Markup()
        return tag("details", tag("summary", self._word("claims")), tested, tag("code", evidence), class_="code")

    def _original(self, row: Judged) -> Markup:
        """Return the document's own words."""
        return tag("q", row.original, lang=self._language) if row.original else Markup()

    def _printed(self, row: Judged) -> Markup:
        """Return the printed content: mathematics, program lines, a table, or a proposition."""
        formula = self._review.formulas.get(row.key)
        if formula is None and row.kind == "table" and not isinstance(row.printed, str):
            lines = [[line] if isinstance(line, str) else line for line in row.printed]
            return tag("table", *(tag("tr", *(tag("td", flat(cell)) for cell in line)) for line in lines))
        if isinstance(row.printed, str):
            return _formula(formula, row.printed)
        return _formula(formula, "\n".join(map(flat, row.printed)))

    def _sentence(self, text: str) -> Markup:
        """Return a sentence of the summary, with quotes in their own language and findings as links."""
        quotes = {f'"{row.original}"': row.original for row in self._review.rows if row.original}
        meant = {f'"{row.original}"': row.says for row in self._review.rows if row.original}
        pattern = "|".join(map(re.escape, sorted(quotes, key=len, reverse=True))) or "(?!)"
        pieces = []
        for k, piece in enumerate(re.split(f"({pattern})", text)):
            linked = [
                tag("a", f"({part})", href=f"#{self._finding_anchor(int(part))}") if j % 2 else joined(*_formulas(part))
                for j, part in enumerate(_REASON.split(piece))
            ]
            said = self._is_foreign and meant.get(piece, "")
            pieces += [tag("q", quotes[piece], lang=self._language, title=said or False)] if k % 2 else linked
        return joined(*pieces)

    def _verdict(self, row: Judged) -> Markup:
        return tag("b", self._texts.get("verdicts", row.verdict), class_=f"verdict {slug(row.verdict)}")

    def _links(self, keys: Iterable[str]) -> Markup:
        return joined(*map(self._link, keys), by=", ")

    def _link(self, key: str) -> Markup:
        named = self._review.placed(key)
        return tag("a", named, href=f"#{self._anchors[key]}") if key in self._anchors else joined(named)

    def _finding_anchor(self, number: int) -> str:
        return f"{self._review.key}-finding-{number}"

    def _word(self, key: str) -> str:
        return self._texts.get("audit", key)


def _formula(formula: formula_tex.Printed | None, text: str) -> Markup:
    """Return a formula as mathematics, any other content as text."""
    if formula is not None:
        return scrolled(math(formula_tex.formula(formula), block=True))
    return tag("pre", tag("code", text)) if "\n" in text else tag("code", text)


def scrolled(formula: Markup) -> Markup:
    """Return a formula that may be wider than the page, with a scroll bar."""
    return tag("div", formula, class_="wide")


def _formulas(text: str, written: Callable[[str], str] = with_raised_units) -> Iterator[Markup]:
    """Return a sentence whose formulas, between backquotes, are typeset, and whose other parts are written so."""
    for k, piece in enumerate(_CODE.split(text)):
        tex = formula_tex.inline(piece) if k % 2 else None
        if k % 2:
            yield math(tex) if tex else tag("code", piece)
        else:
            yield from _with_bare_formulas(piece, written)


def _with_bare_formulas(text: str, written: Callable[[str], str]) -> Iterator[Markup]:
    """Return words with the products and powers among them typeset, which authors need not put in backquotes."""
    end = 0
    for found in _BARE.finditer(text):
        names = set(re.findall(r"[A-Za-z]\w*", found[0]))
        alone = found[0] in GREEK
        if not (alone or _SPECIAL.search(found[0])) or names & _UNITS or not names:
            continue
        tex = formula_tex.inline(found[0].replace("^", "**"))
        if tex:
            yield joined(written(text[end : found.start()]))
            yield math(tex)
            end = found.end()
    yield joined(written(text[end:]))


def _anchors(keys: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Map each key to a unique anchor."""
    taken: set[str] = set()
    for key in keys:
        name = base = slug(key)
        number = 1
        while name in taken:
            number += 1
            name = f"{base}--{number}"
        taken.add(name)
        yield key, name


def breakable(address: str) -> Markup:
    """Return an address that may be broken across lines after its signs."""
    return joined(*re.split(r"(?<=[:._])", address), by="<wbr>")


def slug(text: str) -> str:
    """Return a text in the form of an anchor."""
    return re.sub(r"[^A-Za-z0-9_.:]+", "-", text).strip("-") or "-"


class Derived(msgspec.Struct, frozen=True):
    """A derived expression: the title of its derivation, and its LaTeX."""

    title: str
    tex: str


def addresses(row: Row) -> list[str]:
    """Return the addresses of the expressions that a row is compared with."""
    if isinstance(row.holds, Text):
        return [row.holds.value]
    named = [call.arguments[0] for call in calls_in(row.holds) if call.function == "at"]
    return list(dict.fromkeys(argument.value for argument in named if isinstance(argument, Text)))


def typeset(wanted: Iterable[str], announce: Callable[[str], None] = lambda _: None) -> dict[str, Derived]:
    """Typeset the expressions at some addresses, in their order."""
    path = user_cache.folder("audit") / f"derived-{cache.program((__name__,))}.json"
    try:
        known = msgspec.json.decode(user_cache.read(path), type=dict[str, Derived])
    except (ValueError, msgspec.MsgspecError):
        known = {}
    own = {address for address in wanted if not shelf.is_shipped(address.partition(":")[0])}
    found = {address: known.get(address) or _typeset(address, announce) for address in sorted({*wanted} - own)}
    if own:
        return dict(sorted((found | {address: _of_record(address) for address in own}).items()))
    if found.keys() - known.keys():
        user_cache.write(path, msgspec.json.encode(dict(sorted({**known, **found}.items()))))
    return found


def _typeset(address: str, announce: Callable[[str], None]) -> Derived:
    from satsym.symbolic.latex.typeset import Typesetter
    from satsym.symbolic.lookup import library

    name = address.partition(":")[0]
    announce(f"typesetting {name} ...")
    derivation = library.derivation(name)
    return Derived(derivation.title, _tex(derivation, address, Typesetter(derivation)))


def _of_record(address: str) -> Derived:
    """Return a recorded equation of a model whose file is not executed."""
    record_ = shelf.find(address.partition(":")[0])
    write = in_latex({name: entry.latex for name, entry in record_.names.items() if entry.latex})
    found = record.look_up(record_, address)
    if isinstance(found, record.Equated):
        right = grid(found.rhs.rows) if isinstance(found.rhs, Matrix) else found.rhs
        return Derived(record_.title, write(Equality(found.lhs, right)))
    value = write(grid(found.entries) if isinstance(found, record.Family) else found)
    return Derived(record_.title, f"{formula_tex.symbol(address.rpartition('.')[2])} = {value}")


def _with_indices(name: re.Match[str]) -> str:
    """Return a name such as H_u1_u1 with the variables that it is differentiated by as indices."""
    variables = name[2].replace("\\", "").split("_")[1:]
    return rf"{name[1]}_{{{' '.join(map(formula_tex.symbol, variables))}}}"


def _tex(derivation: Derivation, address: str, typesetter: Any) -> str:
    from satsym.symbolic.derivation import Equation
    from satsym.symbolic.lookup import addresses as naming

    found = naming.resolve(derivation, address)
    if isinstance(found, Equation):
        left = _UNSET.sub(_with_indices, typesetter.tex(found.lhs))
        return f"{left} = {typesetter.tex(found.rhs)}"
    name = address.rpartition(".")[2]
    value = typesetter.tex(found.matrix if isinstance(found, naming.Family) else found)
    return f"{formula_tex.symbol(name)} = {value}"
