"""An audit as one page: conclusions, findings by weight, every row, and the equations it is compared with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.auditing.causes import Weight
from satsym.records import shelf
from satsym.report.findings.review import Review, title
from satsym.report.html import section
from satsym.report.html.markup import Markup, joined, math, tag
from satsym.report.html.section import PageReview, Section, breakable, scrolled, slug
from satsym.report.texts import Texts, load


def render(
    ledgers: Sequence[Ledger],
    judged: Mapping[str, Sequence[Judged]],
    language: str = "en",
    announce: Callable[[str], None] = lambda _: None,
) -> str:
    """Return the audit as a self-contained page.

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
    reviews = [PageReview.of(ledger, judged[ledger.document.key], texts) for ledger in ledgers]
    parts = [Section(review) for review in reviews]
    equations: dict[str, section.Derived] = {}
    for ledger, part in zip(ledgers, parts, strict=True):
        with shelf.opened(ledger.folder):
            named = {address for row in part.rows for address in section.addresses(row)}
            equations |= section.typeset(named - equations.keys(), announce)
    equations = dict(sorted(equations.items()))
    body = [
        tag("a", texts.get("audit", "skip"), class_="skip", href="#all-findings"),
        tag(
            "header",
            tag("h1", title(reviews)),
            tag("p", texts.get("audit", "made"), class_="made"),
            _contents(texts, reviews),
        ),
        _filters(texts, reviews),
        tag("main", *(part.render() for part in parts), _equations(texts, equations, parts), id="all-findings"),
        tag("aside", _overview(texts, reviews), id="all-verdicts", aria_label=texts.get("audit", "legend")),
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


def _contents(texts: Texts, reviews: Sequence[Review]) -> Markup:
    """Return links to the sections."""
    links = [(review.key, review.key) for review in reviews] + [
        ("derived-equations", texts.get("audit", "derived")),
        ("all-verdicts", texts.get("audit", "legend")),
    ]
    entries = [tag("li", tag("a", name, href=f"#{anchor}")) for anchor, name in links]
    return tag("nav", tag("ul", *entries), aria_label=texts.get("audit", "contents"))


def _overview(texts: Texts, reviews: Sequence[Review]) -> Markup:
    """Return the number of rows with each verdict, and the meaning of verdicts and weights."""
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
    """Return the choices of rows to show, for browsers that run the script."""
    choices: dict[str, dict[str, str]] = {
        "document": {review.key: review.key for review in reviews},
        "weight": {weight.value: texts.get("weights", weight.value) for weight in Weight},
        "verdict": {verdict: texts.get("verdicts", verdict) for verdict in VERDICTS},
    }
    selects = []
    for name, options in choices.items():
        if len(options) < 2:
            continue  # a choice between one document
        entries = [tag("option", texts.get("audit", "all"), value="")]
        entries += [tag("option", shown, value=value) for value, shown in options.items()]
        selects.append(tag("label", texts.get("audit", name), " ", tag("select", *entries, name=name)))
    buttons = [tag("button", texts.get("audit", f"{way}_all"), type="button", name=way) for way in ("open", "close")]
    one, _, many = texts.get("audit", "shown").partition("|")
    count = tag("output", data_one=one, data_many=many or one)
    return tag(
        "form", *selects, *buttons, count, id="filter-form", hidden=True, aria_label=texts.get("audit", "filters")
    )


def _equations(texts: Texts, found: Mapping[str, section.Derived], documents: Sequence[Section]) -> Markup:
    """Return the derived equations with which the rows are compared."""
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
        heading = tag("h4", said, " ", tag("code", breakable(address)))
        parts.append(tag("div", heading, scrolled(math(equation.tex, block=True)), used, id=slug(address)))
    return tag("section", *parts, id="derived-equations")
