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


def _put_right(app: Sphinx, failed: Exception | None) -> None:
    pages = (path for path in Path(app.outdir).rglob("*.html") if "_static" not in path.parts)
    for path in pages if failed is None else ():
        text = path.read_text(encoding="utf-8")
        for before, after in PUT_RIGHT.items():
            text = text.replace(before, after)
        path.write_text(text, encoding="utf-8")


def _set(app: Sphinx, page: nodes.document, name: str) -> None:
    """Keep short code on one line, so that options do not break at their hyphens, and typeset dashes and percents."""
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
