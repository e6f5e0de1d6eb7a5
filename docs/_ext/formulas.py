"""Formulas as MathML, which browsers show without scripts."""

from docutils import nodes
from sphinx.application import Sphinx

from satsym.report.html.markup import math


def _inline(translator, node: nodes.math) -> None:
    translator.body.append(math(node.astext()))
    raise nodes.SkipNode


def _block(translator, node: nodes.math_block) -> None:
    translator.body.append(f'<div class="wide" tabindex="0">{math(node.astext(), block=True)}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension with Sphinx."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True}
