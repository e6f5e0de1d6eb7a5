"""An audit as one page: what falls and what stands, findings by weight, every row, and what rows are held against."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.auditing.causes import Finding, Weight
from satsym.report.findings.review import (
    IN_FULL,
    Review,
    brief,
    correction,
    fact,
    flat,
    is_mathematical,
    measured,
    recompute,
    title,
    where,
)
from satsym.report.html import derived
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.html.mathml import math
from satsym.report.latex import formula_tex
from satsym.report.texts import Texts, load

_CODE = re.compile(r"`([^`]*)`")
_REASON = re.compile(r"(?<=[:;] )\((\d+)\)")


def render(
    ledgers: Sequence[Ledger],
    judged: Mapping[str, Sequence[Judged]],
    language: str = "en",
    announce: Callable[[str], None] = lambda _: None,
) -> str:
    """A page that needs nothing but itself.

    Parameters
    ----------
    ledgers
        What the documents print.
    judged
        Key of a document -> its rows with their verdicts.
    language
        Of all but what the documents print and of what is measured.
    announce
        Told what takes its time.

    Returns
    -------
    str
        HTML that depends on nothing but the arguments.
    """
    texts = load(language)
    reviews = [Review(ledger, judged[ledger.document.key], texts) for ledger in ledgers]
    parts = [_Document(review) for review in reviews]
    wanted = {address for part in parts for row in part.rows for address in derived.addresses(row)}
    equations = derived.typeset(wanted, announce)
    body = [
        tag("a", texts.get("audit", "skip"), class_="skip", href="#findings"),
        tag(
            "header",
            tag("h1", title(reviews)),
            tag("p", texts.get("audit", "made"), class_="made"),
            _contents(texts, reviews),
        ),
        tag("aside", _overview(texts, reviews), aria_label=texts.get("audit", "legend")),
        _filters(texts, reviews),
        tag("main", *(part.section() for part in parts), _equations(texts, equations, parts), id="findings"),
    ]
    head = [
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", title(reviews)),
        tag("style", _file("page.css")),
    ]
    lines = [tag("head", *head), tag("body", *body, tag("script", _file("page.js")))]
    return f"<!doctype html>\n{tag('html', *lines, lang=language)}\n"


def _file(name: str) -> Markup:
    return Markup(files(__package__).joinpath(name).read_text(encoding="utf-8"))


class _Document:
    """The section of one document."""

    def __init__(self, review: Review) -> None:
        self._review, self._texts = review, review.texts
        self._language = review.ledger.document.language
        self._judged = {row.key: row for row in review.rows}
        self.rows = [row for row in review.ledger.rows if row.key in self._judged]
        self._read = {row.key: row for row in self.rows}
        self._anchors = {key: f"{review.key}.{anchor}" for key, anchor in _anchors(self._judged)}

    def section(self) -> Markup:
        """All that is said of it."""
        review = self._review
        title = tag("h2", review.ledger.document.title, lang=self._language)
        byline = [tag("p", self._word("by"), " ", review.byline, class_="byline")] if review.byline else []
        summary = tag("p", *(joined(self._sentence(text), " ") for text in review.summary), class_="summary")
        parts = [self._of_weight(weight, group) for weight, group in review.by_weight]
        nothing = [] if parts else [tag("p", self._word("nothing"))]
        return tag("section", title, *byline, summary, *parts, *nothing, self._all_rows(), id=review.key)

    def users(self, address: str) -> list[Markup]:
        """Links to the rows that are held against a derived thing."""
        return [self._link(row.key) for row in self.rows if address in derived.addresses(row)]

    def _of_weight(self, weight: Weight, group: Iterable[tuple[int, Finding]]) -> Markup:
        heading = tag("h3", self._texts.get("weights", weight.value))
        return tag("section", heading, *(self._finding(n, found) for n, found in group), class_="weight")

    def _finding(self, number: int, found: Finding) -> Markup:
        row = found.places[0]
        heading = tag("h4", f"{number}. ", self._review.places(found.places))
        summary = tag(
            "summary", heading, " ", self._verdict(row), " ", tag("span", *_formulas(brief(found)), ".", class_="brief")
        )
        facts = {**self._facts(row), "item": self._links(r.key for r in found.places) if len(found.places) > 1 else ""}
        facts |= {"spoils": self._links(r.key for r in found.spoiled), **self._sources(row.key)}
        evidence, command = recompute(row)
        facts |= {"evidence": "" if measured(row) else evidence, "recompute": tag("code", command)}
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
        """What is printed and what is so instead."""
        right = correction(row)
        return {
            "says": self._original(row),
            "about": "" if row.original else row.says,
            "claims" if row.kind == "claim" else "printed": self._printed(row),
            "in_fact": joined(*_formulas(fact(row))),
            "measured": measured(row),
            "right": _formula(formula_tex.read(right) if is_mathematical(row) else None, right) if right else "",
        }

    def _sources(self, key: str) -> dict[str, str]:
        """Links to what a row follows from, and to what it is held against."""
        row = self._read[key]
        against = [tag("a", _breakable(address), href=f"#{_slug(address)}") for address in derived.addresses(row)]
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
            tag("th", row.key, " ", tag("small", where(row)), scope="row"),
            tag("td", self._original(row), self._printed(row)),
            tag("td", self._verdict(row), " ", found),
            *(tag("td", links, data_label=self._word(key)) for key, links in self._sources(row.key).items()),
            id=self._anchors[row.key],
            data_document=self._review.key,
            data_weight=row.weight,
            data_verdict=row.verdict,
        )

    def _original(self, row: Judged) -> Markup:
        """The document's own words."""
        return tag("q", row.original, lang=self._language) if row.original else Markup()

    def _printed(self, row: Judged) -> Markup:
        """What is printed: mathematics, lines of a program, a table, or a proposition."""
        formula = self._review.formulas.get(row.key)
        if formula is None and row.kind == "table" and not isinstance(row.printed, str):
            lines = [[line] if isinstance(line, str) else line for line in row.printed]
            return tag("table", *(tag("tr", *(tag("td", flat(cell)) for cell in line)) for line in lines))
        if isinstance(row.printed, str):
            return _formula(formula, row.printed)
        return _formula(formula, "\n".join(map(flat, row.printed)))

    def _sentence(self, text: str) -> Markup:
        """A sentence of the summary: what it quotes in its own language, findings that it numbers as links."""
        quotes = {f'"{row.original}"': row.original for row in self._review.rows if row.original}
        pattern = "|".join(map(re.escape, sorted(quotes, key=len, reverse=True))) or "(?!)"
        pieces = []
        for k, piece in enumerate(re.split(f"({pattern})", text)):
            linked = [
                tag("a", f"({part})", href=f"#{self._finding_anchor(int(part))}") if j % 2 else joined(*_formulas(part))
                for j, part in enumerate(_REASON.split(piece))
            ]
            pieces += [tag("q", quotes[piece], lang=self._language)] if k % 2 else linked
        return joined(*pieces)

    def _verdict(self, row: Judged) -> Markup:
        return tag("b", self._texts.get("verdicts", row.verdict), class_=f"verdict {_slug(row.verdict)}")

    def _links(self, keys: Iterable[str]) -> Markup:
        return joined(*map(self._link, keys), by=", ")

    def _link(self, key: str) -> Markup:
        return tag("a", key, href=f"#{self._anchors[key]}") if key in self._anchors else joined(key)

    def _finding_anchor(self, number: int) -> str:
        return f"{self._review.key}.finding-{number}"

    def _word(self, key: str) -> str:
        return self._texts.get("audit", key)


def _contents(texts: Texts, reviews: Sequence[Review]) -> Markup:
    """Links to the sections."""
    links = [(review.key, review.key) for review in reviews] + [("derived", texts.get("audit", "derived"))]
    entries = [tag("li", tag("a", name, href=f"#{anchor}")) for anchor, name in links]
    return tag("nav", tag("ul", *entries), aria_label=texts.get("audit", "contents"))


def _overview(texts: Texts, reviews: Sequence[Review]) -> Markup:
    """How many rows have each verdict, and what verdicts and weights mean."""
    head = [texts.get("audit", "verdict"), *(review.key for review in reviews)]
    rows = [
        tag(
            "tr",
            tag("th", texts.get("verdicts", verdict), scope="row"),
            *(tag("td", str(review.counts.get(verdict, 0))) for review in reviews),
        )
        for verdict in VERDICTS
        if any(verdict in review.counts for review in reviews)
    ]
    heading = tag("thead", tag("tr", *(tag("th", name, scope="col") for name in head)))
    caption = texts.get("audit", "verdict_counts")
    table = tag("table", tag("caption", caption), heading, tag("tbody", *rows), class_="counts")
    meanings = [(texts.get("verdicts", v), texts.get("verdict_meanings", v)) for v in VERDICTS]
    meanings += [(texts.get("weights", w.value), texts.get("weight_meanings", w.value)) for w in Weight]
    pairs = [Markup(tag("dt", name) + tag("dd", meaning)) for name, meaning in meanings]
    summary = tag("summary", texts.get("audit", "legend"))
    scrolled = tag("div", table, class_="wide", tabindex="0", role="region", aria_label=caption)
    return tag("details", summary, scrolled, tag("dl", *pairs), class_="legend")


def _filters(texts: Texts, reviews: Sequence[Review]) -> Markup:
    """Choices of what is shown, for browsers that run the script."""
    choices: dict[str, dict[str, str]] = {
        "document": {review.key: review.key for review in reviews},
        "weight": {weight.value: texts.get("weights", weight.value) for weight in Weight},
        "verdict": {verdict: texts.get("verdicts", verdict) for verdict in VERDICTS},
    }
    selects = []
    for name, options in choices.items():
        entries = [tag("option", texts.get("audit", "all"), value="")]
        entries += [tag("option", shown, value=value) for value, shown in options.items()]
        selects.append(tag("label", texts.get("audit", name), " ", tag("select", *entries, name=name)))
    buttons = [tag("button", texts.get("audit", f"{way}_all"), type="button", name=way) for way in ("open", "close")]
    one, _, many = texts.get("audit", "shown").partition("|")
    count = tag("output", data_one=one, data_many=many or one)
    return tag("form", *selects, *buttons, count, id="filters", hidden=True, aria_label=texts.get("audit", "filters"))


def _equations(texts: Texts, found: Mapping[str, derived.Derived], documents: Sequence[_Document]) -> Markup:
    """What the rows are held against."""
    parts = [tag("h2", texts.get("audit", "derived")), tag("p", texts.get("audit", "derived_about"))]
    last = ""
    for address, equation in found.items():
        if equation.title != last:
            last = equation.title
            parts.append(tag("h3", last, " ", tag("code", address.partition(":")[0]), lang="en"))
        step = address.partition(":")[2].partition(".")[0]
        said = texts.find("titles", step) or texts.get("audit", "stated")
        links = joined(*(link for document in documents for link in document.users(address)), by=", ")
        used = tag("p", texts.get("audit", "used_by"), ": ", links)
        heading = tag("h4", said, " ", tag("code", _breakable(address)))
        parts.append(tag("div", heading, _scrolled(math(equation.tex, block=True)), used, id=_slug(address)))
    return tag("section", *parts, id="derived")


def _formula(formula: formula_tex.Printed | None, text: str) -> Markup:
    """A formula typeset, anything else as it stands."""
    if formula is not None:
        return _scrolled(math(formula_tex.formula(formula), block=True))
    return tag("pre", tag("code", text)) if "\n" in text else tag("code", text)


def _scrolled(formula: Markup) -> Markup:
    return tag("div", formula, class_="wide")


def _formulas(text: str) -> Iterator[Markup]:
    """A sentence whose formulas, between backquotes, are typeset."""
    for k, piece in enumerate(_CODE.split(text)):
        tex = formula_tex.inline(piece) if k % 2 else None
        yield math(tex) if tex else tag("code", piece) if k % 2 else joined(piece)


def _anchors(keys: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Each key with a name of its own that an address may end with."""
    taken: set[str] = set()
    for key in keys:
        name = base = _slug(key)
        number = 1
        while name in taken:
            number += 1
            name = f"{base}--{number}"
        taken.add(name)
        yield key, name


def _breakable(address: str) -> Markup:
    """An address that a line may end in after its signs."""
    return joined(*re.split(r"(?<=[:._])", address), by="<wbr>")


def _slug(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.:]+", "-", text).strip("-") or "-"
