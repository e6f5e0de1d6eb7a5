"""The gallery: every shipped instance by subject, and a page for each with problem, code, picture and certificate.

What a page shows is what the command line prints and draws. It is kept until the solvers, the output or the instance
change.
"""

import hashlib
import io
import json
import os
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from functools import wraps
from html import escape
from importlib import import_module
from importlib.util import find_spec
from itertools import chain, compress
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import wrap
from typing import Any
from unittest.mock import patch

import cards
from sphinx.application import Sphinx
from statements import about, statement

from satsym.report.display import raised, with_powers

COLOURS = r"(:root \{.*?\}\s*)(@media \(prefers-color-scheme: dark\) \{.*?\}\s*\})"
"""What a style sheet of a page begins with."""
WRITTEN = "<!-- Written by `make docs`: do not edit. -->\n"
HEAD = f"""{WRITTEN}# Gallery

Look for the example that is closest to your problem, and start from a copy of it. The gallery contains every shipped
instance, by subject. Each page shows the pictures, the problem, the code, and everything that the command prints,
including the certificate.
"""
COMMANDS = {
    "lqr": "geo-lqr uny-lqr uny-lqr-both lapan-roll-yaw-lqr",
    "analyse": "molniya itb-earth itb-earth-kicked itb-earth-escape gyrostat-equilibria gravity-gradient",
    "simulate": "lapan-classical",
    "compare": "lapan-coupling",
}
"""What is asked of instances that are not solved."""
FOUND = {"lqr": "regulator", "analyse": "analysis", "compare": "comparison"}
"""What commands without a certificate give."""
LONGEST = (
    "shuttle-heating its-thesis-return-two-sided ends-2-given-state reorientation transfer-fuel lapan-coupling "
    "goddard-pressure return-in-slot return-above goddard obstacle gravity-gradient shuttle cart-pole chain"
).split()
"""Begun first, so that no processor waits for another in the end."""
CODE = ("satsym.solvers", "satsym.analysis", "satsym.report.plots", "satsym.report.terminal", "satsym.report.page")
ASKED = (
    "satsym.solvers.solve",
    "satsym.analysis.comparison.compare",
    "satsym.analysis.regulator.feedback.designed",
    "satsym.analysis.subject.survey",
    "satsym.report.results.linear.attitudes",
)
"""Functions of an instance that take long."""
OWN = hashlib.blake2b(b"".join(Path(one).read_bytes() for one in (__file__, cards.__file__))).hexdigest()
"""Digest of what writes the pages."""
EXPLORED = ("transfer-fuel",)
"""Instances with an interactive page in addition, where plotly is installed; such a page is large."""
DRAWN = "--format svg --size page --no-title".split()
UNCONTROLLED = "The uncontrolled motion; no admissible control was found that reaches the final state."
EXPLORE = (
    "<a href='../_static/gallery/{}.html#explore'>Open the interactive page</a> of this example: a slider for the "
    "time, the values at the pointer, and the motion in space."
)
KEPT = "SATSYM_DOCS_KEPT"
"""Variable of the environment: set, it shows examples as they were kept, for those who write other pages."""
RESULTS = {
    "lqr": "The result is a regulator with its closed loop.",
    "analyse": "The result is an analysis of the motion.",
    "compare": "The result is a comparison of control laws.",
}
"""What commands without a certificate give, in a sentence."""
ELSEWHERE = {
    "optima.md": "Its optimum [is known](../optima.md) from another source.",
    "proved.md": "[What is proved](../proved.md#proved-optima) lists the result of its proof.",
}
"""Pages that treat examples, and what they have of one that they link to."""
COLUMNS = 96
"""Letters of a line of code on a page."""
BEHIND = re.compile(r"((?:[^#\"]|\"[^\"]*\")+)(# .*)")
"""What a line of a file says, and the comment behind it."""
SIZE, WHOLE = re.compile(r'<svg[^>]* width="([\d.]+)pt"'), 504.0
"""The width of a picture, and that of a page, in points."""
TAKEN = re.compile(r",\s+[\d.]+\s+m?s(?=\))")
"""How long solving took, which is another time each time."""


def command_of(name: str, has_cost: bool) -> str:
    """What is asked of an instance."""
    asked = (command for command, names in COMMANDS.items() if name in names.split())
    return next(asked, "solve" if has_cost else "simulate")


def shown(name: str, folder: Path) -> dict[str, Any]:
    """What the page says of an instance; its pictures are written into the folder."""
    from satsym import instance, source_files

    case = instance.load(name)
    command = command_of(name, case.model.spec.has_cost)
    key = f"{command} {source_files.digest(list(CODE))} {OWN} {source_files.digest_of(case.path)}"
    explored = name in EXPLORED and explorable()
    key += " interactive" if explored else ""
    said = folder / f"{name}.json"
    if said.is_file():
        known = json.loads(said.read_text("utf-8"))
        if known["key"] == key or os.environ.get(KEPT):
            return known
    with TemporaryDirectory() as out, once():
        motion = command in ("solve", "simulate")
        text = printed([command, name, "--out", out, *(() if motion else ("--plot", *DRAWN))])
        pictures = cards.of_motion(case, Path(out)) if motion else cards.written(case, Path(out))
        result = json.loads(Path(out, "result.json").read_text("utf-8"))
        uncontrolled = motion and not pictures
        if uncontrolled:  # the picture shows what makes a solution impossible
            printed(["simulate", name, "--out", out])
            pictures = cards.of_motion(case, Path(out))
        if explored:
            printed(["report", name, "--interactive", "--html", str(folder / f"{name}.html")])
    for part, svg in pictures.items():
        (folder / f"{name}{part}.svg").write_text(themed(svg), "utf-8")
    known = {
        "key": key,
        "name": name,
        "title": case.title,
        "model": case.model.spec.name,
        "source": case.model.spec.source,
        "command": command,
        "text": text,
        "verdict": verdict(result),
        "file": case.path.read_text("utf-8").strip(),
        "pictures": [part for part in pictures if part != cards.CARD],
        "uncontrolled": uncontrolled,
        "explored": explored,
    }
    said.write_text(json.dumps(known), "utf-8")
    return known


@contextmanager
def once() -> Iterator[None]:
    """Compute what takes long but once for a page, although its command, its report and its card all ask for it."""
    places = [name.rpartition(".") for name in ASKED]
    functions = [getattr(import_module(module), function) for module, _, function in places]  # all, before any changes
    with ExitStack() as stack:
        for name, function in zip(ASKED, functions, strict=True):
            stack.enter_context(patch(name, _remembered(function)))
        yield


def _remembered(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of the instance of a page that is computed at the first call; calls within it are of other ones."""
    found: list[Any] = []
    within: list[bool] = []

    @wraps(function)
    def asked(*arguments: Any, **named: Any) -> Any:
        if within:
            return function(*arguments, **named)
        if not found:
            within.append(True)
            try:
                found.append(function(*arguments, **named))
            finally:
                within.clear()
        return found[0]

    return asked


def printed(arguments: list[str]) -> str:
    """What a command prints to a terminal of 80 columns, without the time it took and the files it wrote."""
    from satsym import cli

    os.environ |= {"COLUMNS": "80", "NO_COLOR": "1"}
    with redirect_stdout(io.StringIO()) as stream, redirect_stderr(io.StringIO()):  # progress would look like a warning
        cli.main(arguments)
    return TAKEN.sub("", stream.getvalue().partition("\n  written to ")[0]).rstrip()


def explorable() -> bool:
    """Whether interactive pages can be written."""
    return find_spec("plotly") is not None


def verdict(result: dict) -> str:
    """A line on what came of it."""
    if result.get("certificate"):
        return result["certificate"]["verdict"]
    return FOUND.get(result["command"], result["status"])


def themed(svg: str) -> str:
    """A picture that is dark where its reader's pages are."""
    from importlib.resources import files

    from satsym.report.page import run

    sheets = [files("satsym.report").joinpath(name).read_text("utf-8") for name in ("html/page.css", "page/report.css")]
    colours = "".join("".join(re.match(COLOURS, sheet, re.DOTALL).groups()) for sheet in sheets)
    element, inside = run.themed(svg).split(">", 1)
    return f"{element}><style>{colours}svg {{ fill: var(--ink); }}</style>{inside}"


def page(known: dict[str, Any], others: list[dict[str, Any]], root: Path) -> str:
    """The page of one instance, with links to those before and after it in the overview."""
    from satsym import instance

    name, model = known["name"], known["model"]
    case = instance.load(name)
    stated = statement(case, known["command"], root / "generated")
    alone = "--lang id" if known["command"] in ("lqr", "analyse", "compare") else "--json"
    python = {"solve": "solution = satsym.solve", "simulate": "motion = satsym.simulate", "lqr": "gain = satsym.lqr"}
    call = python.get(known["command"], "found = satsym.analyse")
    code = f'import satsym\n\n{call}("{name}")' + ("\nsolution.plot()" if known["command"] == "solve" else "")
    run = f"satsym {known['command']} {name}"
    parts = [
        f"---\norphan: true\n---\n\n{WRITTEN}# {titled(known)}\n",
        f"{introduced(known, root / 'docs')}\n",
        *(f"{picture(known, part, root)}\n" for part in known["pictures"]),
        f"## Problem\n\n{about(root / known['source'])}\n\n{stated}{quantities(case)}",
        f"The instance `{name}` provides the numerical values:\n\n```toml\n{narrow(known['file'])}\n```\n",
        f"## How to run it\n\n```sh\n{run} --plot\n{run} {alone}\n```\n",
        f"```python\n{code}\n```\n" if known["command"] != "compare" else "",
        f"## What it prints\n\n```text\n{known['text']}\n```\n",
        f"## Derivation\n\nEvery step is typeset in {{download}}`{model}.tex <../../generated/{model}.tex>`; "
        f"`satsym latex {model}` writes this file; the physics is stated in "
        f"{{download}}`{known['source']} <../../{known['source']}>`.\n",
        following(known, others),
    ]
    return "\n".join(filter(None, parts))


def introduced(known: dict[str, Any], docs: Path) -> str:
    """What the page shows, what came of it, and where else the example is treated."""
    name = known["name"]
    said = RESULTS.get(known["command"]) or f"The result is *{known['verdict']}*."
    elsewhere = [
        sentence for page, sentence in ELSEWHERE.items() if f"(gallery/{name}.md)" in (docs / page).read_text("utf-8")
    ]
    return " ".join(
        [f"An example of the [gallery](../gallery.md): `satsym {known['command']} {name}`.", said, *elsewhere]
    )


def following(known: dict[str, Any], others: list[dict[str, Any]]) -> str:
    """Links to the examples before and after one, and to what helps to change it."""
    at = [one["name"] for one in others].index(known["name"])
    beside = [("Previous", at - 1), ("Next", at + 1)]
    linked = [
        f"- {word} example: [{titled(others[k])}]({others[k]['name']}.md)" for word, k in beside if 0 <= k < len(others)
    ]
    copied = f"- To change this example, copy it with `satsym new my_case --instance {known['name']}`"
    return "\n".join(["## Next\n", f"{copied}; [its keys](../instances.md) are those of all instances.", *linked, ""])


def narrow(text: str) -> str:
    """A file whose comments are broken anew, so that none of their lines runs out of a page."""
    lines: list[str] = []
    for line in text.splitlines():
        if lines and lines[-1].startswith("# ") and line.startswith("# ") and not line.startswith("# - "):
            lines[-1] += f" {line[1:].strip()}"
        else:
            lines.append(line)
    return "\n".join(chain.from_iterable(map(broken, lines)))


def broken(line: str) -> list[str]:
    """The lines that a line of a file becomes: a comment behind what has no room for it goes before that."""
    if line.startswith("# "):
        return wrap(line, COLUMNS, subsequent_indent="#   " if line.startswith("# - ") else "# ")
    if len(line) > COLUMNS and (behind := BEHIND.match(line)):
        return [*wrap(behind[2], COLUMNS, subsequent_indent="# "), behind[1].rstrip()]
    return [line]


def quantities(case: Any) -> str:
    """A table of the states, controls and parameters of an instance, without empty columns."""
    from satsym.instance.shown import spec_of
    from satsym.report.display import number, unit_text

    spec = spec_of(case)
    stated = [(v, role, "") for role, found in (("state", spec.states), ("control", spec.controls)) for v in found]
    given = zip(spec.parameters, case.parameters, strict=True)
    stated += [(v, "parameter", number(value, 10)) for v, value in given]
    rows = [(f"${v.latex}$", f"`{v.symbol}`", role, v.meaning, value, unit_text(v.unit)) for v, role, value in stated]
    kept = [any(column) for column in zip(*rows, strict=True)]
    lines = [("symbol", "name", "role", "meaning", "value", "unit"), ("---",) * len(kept), *rows]
    return "\n".join(f"| {' | '.join(compress(line, kept))} |" for line in lines) + "\n\n"


def titled(known: dict[str, Any]) -> str:
    """The title of an instance, with the signs that it has in print."""
    return raised(with_powers(known["title"])).replace("<=", "≤").replace(">=", "≥")


def picture(known: dict[str, Any], part: str, root: Path) -> str:
    """The element that shows one of its pictures, as wide as it was drawn: the letters of all have one size."""
    name, title = known["name"], escape(titled(known))
    drawn = SIZE.search((root / "docs" / "_static" / "gallery" / f"{name}{part}.svg").read_text("utf-8"))
    share = min(1.0, float(drawn[1]) / WHOLE)
    wide = f" style='--drawn: {share:.0%}'" if share < 1.0 else ""
    said = f"Picture of {title}" if not part else f"{part[1:].capitalize()}: {title}"
    image = f"<img src='../_static/gallery/{name}{part}.svg' alt='{said}' loading='lazy'{wide}>"
    words = UNCONTROLLED if known["uncontrolled"] else EXPLORE.format(name) if known["explored"] else ""
    caption = f"<figcaption>{words}</figcaption>" if words else ""
    return f"```{{raw}} html\n<figure class='example'>{image}{caption}</figure>\n```\n"


def card(known: dict[str, Any]) -> str:
    """An example in the overview."""
    name, title = known["name"], escape(titled(known))
    image = f"<img src='_static/gallery/{name}{cards.CARD}.svg' alt='' loading='lazy'>" if known["pictures"] else ""
    return (
        f"<figure><a href='gallery/{name}.html'>{image}<figcaption>{title}</figcaption></a>"
        f"<p><code>{name}</code> {escape(known['verdict'])}</p></figure>"
    )


def overview(every: dict[str, dict[str, Any]]) -> Iterator[str]:
    """The page of all, piece by piece."""
    from satsym.report.terminal.listing import INSTANCES, by_subject

    yield HEAD
    for subject, names in by_subject(every, INSTANCES).items():
        yield f"## {subject}\n\n```{{raw}} html\n<div class='gallery'>"
        yield from (card(every[name]) for name in names)
        yield "</div>\n```\n"


def begin(app: Sphinx, work: Any) -> None:
    """Solve and draw the instances that are not kept, and write their pages and the overview."""
    from satsym import instance
    from satsym.report.terminal.listing import INSTANCES, by_subject

    source = Path(app.srcdir)
    folder, pages = source / "_static" / "gallery", source / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    pages.mkdir(exist_ok=True)
    if explorable():
        app.tags.add("interactive")  # for the front page
    names = sorted(instance.shipped(), key=lambda name: LONGEST.index(name) if name in LONGEST else len(LONGEST))

    def done(found: list[dict[str, Any]]) -> None:
        every = {known["name"]: known for known in found}
        ordered = [every[name] for names in by_subject(every, INSTANCES).values() for name in names]
        for name, known in every.items():
            put(pages / f"{name}.md", page(known, ordered, source.parent))
        for path in pages.glob("*.md"):
            if path.stem not in every:
                path.unlink()
        put(source / "gallery.md", "\n".join(overview(every)))

    work.begin([(shown, (name, folder)) for name in names], done)


def put(path: Path, text: str) -> None:
    """Write a file, unless it says so already."""
    text = text.rstrip() + "\n"
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
