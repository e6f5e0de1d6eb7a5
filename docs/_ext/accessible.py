"""What the theme leaves out for people who hear a page or have no mouse, and what it breaks that belongs together."""

import re
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

PUT_RIGHT = {
    '<p class="caption" role="heading">': '<p class="caption" role="heading" aria-level="2">',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="Pages">',
    '<aside class="toc-drawer': '<aside aria-label="On this page" class="toc-drawer',
    "<pre>": '<pre tabindex="0">',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
}

PERCENT, OPTION = re.compile(r"(?<=\d) (?=%)"), re.compile(r"(?<!\S)--(?=[a-z])")
"""The space before a sign of percent, and the hyphens of an option, where no line breaks."""
SHORT = 32
"""Most letters of a piece of code that stays on one line."""
COLUMNS, MANY, WORDS = 3, 6, 28
"""Least number of columns, number that never fits a phone, and letters of a cell from which it does not fit."""


def _put_right(app: Sphinx, failed: Exception | None) -> None:
    pages = (path for path in Path(app.outdir).rglob("*.html") if "_static" not in path.parts)
    for path in pages if failed is None else ():
        text = path.read_text(encoding="utf-8")
        for before, after in PUT_RIGHT.items():
            text = text.replace(before, after)
        path.write_text(text, encoding="utf-8")


def _without_last(table: nodes.table) -> None:
    """Leave out the last column of a glossary, which is for those who write texts."""
    table.next_node(nodes.tgroup)["cols"] -= 1
    for column in (list(table.findall(nodes.colspec))[-1], *(row[-1] for row in table.findall(nodes.row))):
        column.parent.remove(column)


def _stack(table: nodes.table) -> None:
    """Write the head of each column into its cells, for phones, which show the cells of a row below one another."""
    head, body = table.next_node(nodes.thead), table.next_node(nodes.tbody)
    columns = [entry.astext() for entry in head.findall(nodes.entry)] if head else []
    if len(columns) < COLUMNS:
        return
    cells = [list(zip(columns, row.children, strict=True)) for row in body.findall(nodes.row)]
    if len(columns) < MANY and max(len(cell.astext()) for row in cells for _, cell in row[1:]) < WORDS:
        table["classes"].append("narrow")
        return
    table["classes"].append("stacked")
    for _, cell in (pair for row in cells for pair in row[1:]):
        cell["classes"] += [] if cell.astext().strip() else ["nothing"]
    for column, cell in (pair for row in cells for pair in row[1:] if pair[1].children):
        cell[0].insert(0, nodes.inline("", column, classes=["column"]))


def _set(app: Sphinx, page: nodes.document, name: str) -> None:
    """Keep short code on one line, so that options do not break at their hyphens, and typeset dashes and percents."""
    for table in page.findall(nodes.table):
        if name.startswith("glossary"):
            _without_last(table)
        _stack(table)
    for code in page.findall(nodes.literal):
        if len(code.astext()) <= SHORT:
            code["classes"].append("short")
    for block in page.findall(nodes.literal_block):
        if (text := block.astext()) == block.rawsource != text.rstrip():  # examples for doctest end with an empty line
            block.rawsource = text.rstrip()
            block[:] = [nodes.Text(text.rstrip())]
    for text in list(page.findall(nodes.Text)):
        if text.astext() == " -- ":  # before what autodoc says of a parameter
            text.parent.replace(text, nodes.Text(" \N{EN DASH} "))
        elif not isinstance(text.parent, (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block)):
            whole = OPTION.sub("-\N{WORD JOINER}-\N{WORD JOINER}", PERCENT.sub("\N{NO-BREAK SPACE}", text))
            if whole != text:
                text.parent.replace(text, nodes.Text(whole))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension with Sphinx."""
    app.connect("doctree-resolved", _set)
    app.connect("build-finished", _put_right)
    return {"parallel_read_safe": True}
