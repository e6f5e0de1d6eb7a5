"""Notebooks as pages: each cell with what it ends with, as a notebook shows that."""

import ast
import io
import json
import re
from pathlib import Path
from pprint import pformat
from typing import Any

from gallery import put, themed
from sphinx.application import Sphinx

NOTEBOOKS = ("notebook", "notebook_class", "notebook_system", "notebook_study")


def page(path: Path) -> str:
    """The page of a notebook, whose cells are executed in order."""
    cells = json.loads(path.read_text("utf-8"))["cells"]
    known: dict[str, object] = {}
    parts = ["<!-- Written by `make docs`: do not edit. -->"]
    for cell in cells:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts += [f"```python\n{source}\n```", shown(source, known)]
    parts.append(f"This page is a notebook; to run it, download {{download}}`{path.name} <{path.name}>`.")
    return "\n\n".join(filter(None, parts)) + "\n"


def shown(source: str, known: dict[str, object]) -> str:
    """What a cell ends with."""
    *before, last = ast.parse(source).body
    exec(compile(ast.Module(before, []), "notebook", "exec"), known)  # noqa: S102 - our own notebooks
    if not isinstance(last, ast.Expr):
        exec(compile(ast.Module([last], []), "notebook", "exec"), known)  # noqa: S102
        return ""
    value = eval(compile(ast.Expression(last.value), "notebook", "eval"), known)  # noqa: S307
    if hasattr(value, "savefig"):
        return drawn(value)
    if hasattr(value, "_repr_html_"):
        return f"```{{raw}} html\n<div class='cell wide' tabindex='0'>{value._repr_html_()}</div>\n```"
    if hasattr(value, "_repr_latex_"):
        tex = value._repr_latex_().strip("$").removeprefix(r"\displaystyle ")
        return f"$$\n{in_one_row(tex)}\n$$"
    return "" if value is None else f"```text\n{value if isinstance(value, str) else pformat(value, width=100)}\n```"


def in_one_row(tex: str) -> str:
    """A formula without the alignment that it does not need, and with names as MathML has them."""
    alone = re.fullmatch(r"\\begin\{aligned\}(.*)\\end\{aligned\}", tex, re.DOTALL)
    if alone and r"\\" not in alone[1]:
        tex = alone[1].replace("&", "", 1).strip()
    return re.sub(r"\\text\{[^}]*\}", lambda words: words[0].replace(r"\_", "_"), tex)


def drawn(figure: Any) -> str:
    """A figure, dark where its reader's pages are."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    svg = themed(stream.getvalue())
    label = "The figure that this cell ends with"
    return f"```{{raw}} html\n<figure class='example' role='img' aria-label='{label}'>{svg}</figure>\n```"


def begin(app: Sphinx, work: Any) -> None:
    """Execute the notebooks."""
    folder = Path(app.srcdir)
    jobs = [(page, (folder / f"{name}.ipynb",)) for name in NOTEBOOKS]

    def done(pages: list[str]) -> None:
        for name, text in zip(NOTEBOOKS, pages, strict=True):
            put(folder / f"{name}.md", text)

    work.begin(jobs, done)
