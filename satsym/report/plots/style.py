"""The style of pictures, and their output as files: the same bytes for the same result on the same versions."""

from __future__ import annotations

import hashlib
import io
import re
import textwrap
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from satsym.arrays import Array
from satsym.report.look import HIGHEST, SCREEN, SHEETS, WIDTH, Look, Sheet
from satsym.report.results import files
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's palette for all kinds of colour vision; lines also differ in dashes and width
BLUE, VERMILION, GREEN, PURPLE = "#0072B2", "#D55E00", "#009E73", "#A6508A"
SKY = "#56B4E9"
"""Light blue of the same palette, for dark backgrounds."""
INK, SOFT, GREY, PALE_GREY, ALARM = "#222222", "#555555", "#8A8A8A", "#E4E4E4", "#B00020"
HATCH = "#A6A6A6"
SHADE = 0.12
STATE, CONTROL, COSTATE, INVARIANT = BLUE, VERMILION, GREEN, PURPLE

REFERENCE: dict[str, Any] = {"color": INK, "linewidth": 1.1, "linestyle": (0, (5, 3)), "zorder": 2.1}
FREE: dict[str, Any] = {"color": GREY, "linewidth": 1.1, "linestyle": "-", "zorder": 2.0}
MAIN: dict[str, Any] = {"linewidth": 2.0, "zorder": 3.0}
START: dict[str, Any] = {"marker": "o", "markersize": 6.5, "linestyle": "none", "zorder": 4.0, "clip_on": False}
END: dict[str, Any] = {"marker": "s", "markersize": 6.0, "linestyle": "none", "zorder": 4.0, "clip_on": False}
TARGET: dict[str, Any] = {
    "marker": "o",
    "markersize": 11.0,
    "markerfacecolor": "none",
    "markeredgecolor": INK,
    "markeredgewidth": 1.2,
    "linestyle": "none",
    "zorder": 3.9,
    "clip_on": False,
}
FORBIDDEN: dict[str, Any] = {
    "facecolor": "none",
    "edgecolor": HATCH,
    "hatch": "////",
    "linewidth": 0.0,
    "zorder": 1.2,
}
BOUND: dict[str, Any] = {"color": "#777777", "linewidth": 0.9, "zorder": 1.9}
BURN: dict[str, Any] = {"color": VERMILION, "linewidth": 3.4, "zorder": 3.1, "solid_capstyle": "butt"}
PASSED: dict[str, Any] = {
    "marker": "D",
    "markersize": 6.5,
    "markerfacecolor": "white",
    "markeredgecolor": INK,
    "markeredgewidth": 1.2,
    "linestyle": "none",
    "zorder": 4.1,
}
OTHER: dict[str, Any] = PASSED | {"marker": "^", "markersize": 8.0}
CURVE: dict[str, Any] = {"color": PURPLE, "linewidth": 1.2, "linestyle": "--", "zorder": 2.2}
GLOBE, RIM = "#C9D8E6", "#7D93A8"
BODY: dict[str, Any] = {"facecolor": GLOBE, "edgecolor": RIM, "linewidth": 0.8, "zorder": 1.5}
SWITCHING: dict[str, Any] = {"linewidth": 0.8, "linestyle": ":", "zorder": 1.8}
ORIGIN: dict[str, Any] = {"marker": "+", "markersize": 11.0, "color": INK, "linestyle": "none", "markeredgewidth": 1.2}
ARROW: dict[str, Any] = {
    "color": VERMILION,
    "angles": "xy",
    "scale_units": "xy",
    "scale": 1.0,
    "width": 0.0045,
    "headwidth": 4.2,
    "headlength": 5.0,
    "headaxislength": 4.4,
    "minlength": 0.0,
    "zorder": 2.6,
}

GRID = 241
"""Number of points along each axis of the grid for forbidden regions."""
MARGIN = 1.3
"""Space beside a panel for its ticks and label, in inches on a screen."""
TITLE = 9.5
"""Size of the title of a panel, in points on a screen."""
NARROWEST = 3.0
"""Smallest width of a panel with its margin on a page of fixed height, in inches on a screen."""
HINTED = 1.1
"""Factor by which letters on a coarse pixel grid may be wider than their outlines."""
FEWEST = 12
"""Smallest number of letters to which a line of a title is shortened."""
SHORTEST = 0.8
"""Smallest width available above a panel for its title, in inches on a screen."""
DPI = 160
_SCALED: tuple[Any, ...] = tuple(
    "font.size axes.labelsize axes.titlesize axes.titlepad xtick.labelsize ytick.labelsize legend.fontsize".split()
)
"""Settings of matplotlib that are given in points and scaled with the page."""
_UNDATED: dict[str, dict[str, None]] = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
_RC: dict[Any, Any] = {
    "font.size": 10.5,
    "mathtext.fontset": "cm",
    "axes.labelsize": 11.0,
    "axes.titlesize": TITLE,
    "axes.titlecolor": "#555555",
    "axes.titlelocation": "left",
    "axes.titlepad": 5.0,
    "axes.edgecolor": "#9A9A9A",
    "axes.linewidth": 0.8,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "axes.formatter.useoffset": False,
    "grid.color": PALE_GREY,
    "grid.linewidth": 0.7,
    "xtick.color": "#9A9A9A",
    "ytick.color": "#9A9A9A",
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 9.5,
    "ytick.labelsize": 9.5,
    "legend.frameon": False,
    "legend.fontsize": 10.0,
    "legend.handlelength": 2.2,
    "legend.columnspacing": 1.6,
    "hatch.color": HATCH,
    "hatch.linewidth": 0.7,
    "lines.solid_capstyle": "round",
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.06,
    "figure.dpi": DPI,
    "savefig.dpi": "figure",
    "savefig.facecolor": "white",
    # publishers refuse fonts of type 3; names of shapes that are drawn anew each time would differ
    "pdf.fonttype": 42,
    "svg.hashsalt": "satsym",
}


_LOOK: ContextVar[Look] = ContextVar("look", default=SCREEN)
"""The look of the page while a style is applied."""
_LETTERS: ContextVar[float] = ContextVar("letters", default=1.0)
"""Size of letters of the page that was begun last, relative to a screen."""
_BEGUN: WeakKeyDictionary[Figure, float] = WeakKeyDictionary()
"""Page -> size of its letters, relative to a screen."""


@contextmanager
def applied(look: Look = SCREEN) -> Iterator[None]:
    """Draw in this style within this context, whatever the user's matplotlibrc says."""
    import logging

    # what they log, such as fonts that are looked for, would else go to stderr where nobody listens
    for library in ("matplotlib", "fontTools"):
        logging.getLogger(library).addHandler(logging.NullHandler())
    import matplotlib

    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_RC)
        # a title may be in any script; a box in its place is no news to whoever reads it
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        before = _LOOK.set(look)
        try:
            yield
        finally:
            _LOOK.reset(before)


def with_titles() -> bool:
    """Tell whether pages have titles."""
    return _LOOK.get().titled


def sheet() -> Sheet:
    """Return the dimensions of the requested page size."""
    return SHEETS[_LOOK.get().size]


def across(panels: int) -> int:
    """Return a number of panels side by side, or as many as fit."""
    return min(panels, sheet().across)


def columns(panels: int, wanted: int, row: float, rest: float = 1.2) -> int:
    """Return how many panels to put side by side: the wanted number, or more on a page of limited height.

    Parameters
    ----------
    row, rest
        Height of a row of panels, and of what is not panels, in inches on a screen.
    """
    asked, wanted = sheet(), across(wanted)
    if asked.highest >= HIGHEST:
        return wanted

    def letters(columns: int) -> float:
        tall, wide = (rest + row * -(-panels // columns)) / asked.highest, NARROWEST * columns / asked.width
        return min(1.0 / tall, 1.0 / wide, asked.letters)

    return max(range(min(wanted, panels), panels + 1), key=letters)


def points(size: float) -> float:
    """Return the size of letters that have so many points on a screen."""
    return size * _LETTERS.get()


def on_screen(page: Figure) -> float:
    """Return the width of a page on a screen, in inches, for its size of letters."""
    return float(page.get_figwidth()) / _BEGUN[page]


def room(page: Figure, columns: float) -> float:
    """Return the inches on a screen above a panel, where so many are side by side."""
    return max(SHORTEST, on_screen(page) / columns - MARGIN)


def length(text: str, size: float) -> float:
    """Return the inches on a screen of a line of text, in letters of so many points."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    formula = text.replace(r"\$", "").count("$") > 1
    width, _, _ = text_to_path.get_text_width_height_descent(text, FontProperties(size=size), ismath=formula)
    return HINTED * float(width) / 72.0


def figure(width: float, height: float) -> Figure:
    """Return an empty figure that lays itself out; without pyplot, hence no window and no global state.

    Where a page cannot be as high as required, letters are smaller.

    Parameters
    ----------
    width, height
        In inches on a screen.
    """
    import matplotlib
    from matplotlib.figure import Figure

    asked = sheet()
    letters = min(asked.letters, asked.highest / height)
    wide = asked.width if asked.across == 1 else min(width / WIDTH, 1.0) * asked.width
    matplotlib.rcParams.update({name: _RC[name] * letters for name in _SCALED})
    page = Figure(figsize=(wide, height * letters), layout="constrained")
    _BEGUN[page] = letters
    _LETTERS.set(letters)
    return page


def titled(title: str, width: float, height: float) -> Figure:
    """Return a figure under a title of at most two lines, or without one if none is wanted."""
    page = figure(width, height)
    if not with_titles():
        return page
    letters = int(9.8 * on_screen(page))
    page.suptitle(
        textwrap.fill(say(title), letters, max_lines=2, placeholder="\N{HORIZONTAL ELLIPSIS}"),
        x=0.012,
        ha="left",
        fontsize=points(11.5),
        fontweight="bold",
        parse_math=False,
    )
    return page


def hatch(axes: Axes, across: Array, up: Array, field: Array) -> None:
    """Hatch where a field at given places is positive, with its edge; where it is not a number nothing is drawn."""
    import numpy as np

    if not (np.nan_to_num(field) > 0.0).any():
        return
    inside = axes.contourf(across, up, field, levels=[0.0, np.inf], colors="none", hatches=[FORBIDDEN["hatch"]])
    inside.set(zorder=FORBIDDEN["zorder"], edgecolor=FORBIDDEN["edgecolor"], linewidth=0.0)
    if (field < 0.0).any():
        edge = axes.contour(across, up, field, levels=[0.0], colors=[BOUND["color"]], linewidths=[BOUND["linewidth"]])
        edge.set(zorder=BOUND["zorder"])


def finished(page: Figure) -> Figure:
    """Return a figure whose ticks carry their power of ten, and whose lines fit its size."""
    from matplotlib.ticker import ScalarFormatter

    from satsym.report.plots.powers import WithPowers

    _LETTERS.set(_BEGUN[page])
    for axes in page.axes:
        _fit(page, axes)
        for axis in (axes.xaxis, axes.yaxis):
            if type(axis.get_major_formatter()) is ScalarFormatter:
                axis.set_major_formatter(WithPowers())
        for line in axes.lines:
            line.set_linewidth(points(line.get_linewidth()))
            line.set_markersize(points(line.get_markersize()))
    return page


def _fit(page: Figure, axes: Axes) -> None:
    """Break the texts above and below a panel into lines that fit."""
    place = axes.get_subplotspec()
    if place is None or axes.figure is not page:
        return
    wide = room(page, place.get_gridspec().ncols / len(place.colspan))
    axes.set_xlabel(broken(axes.get_xlabel(), wide, _RC["axes.labelsize"]))
    if not axes.get_title(loc="right"):
        axes.set_title(broken(axes.get_title(loc="left"), wide, TITLE))


def broken(text: str, wide: float, size: float = TITLE, most: int | None = None) -> str:
    """Break text into lines that fit; text beyond the allowed number of lines is left out.

    Formulas with spaces are kept whole, with the text around them.

    Parameters
    ----------
    wide
        In inches on a screen.
    size
        Of its letters there, in points.
    most
        Lines, for text of a single line.
    """
    if re.search(r"\$[^$ ]* [^$]*\$", text):
        return text
    return "\n".join(_lines(_MEASURED.sub(_FIXED, line), wide, size, most) for line in text.splitlines())


_MEASURED = re.compile(r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹]) (?=\S)|(?<=×) ")
"""A space within a number with its power of ten, or between a number and its unit."""
_FIXED = "\N{NO-BREAK SPACE}"


def _lines(line: str, wide: float, size: float, most: int | None) -> str:
    """Break a line that is too long; formulas are longer as text than they look."""
    long = length(line, size)
    if long <= wide:
        return line
    dots, letters = "\N{HORIZONTAL ELLIPSIS}", max(FEWEST, int(len(line) * wide / long))
    while True:
        filled = textwrap.fill(line, letters, break_long_words=False, max_lines=most, placeholder=dots)
        if letters <= FEWEST or all(length(each, size) <= wide for each in filled.splitlines()):
            return filled if most is not None else _balanced(line, letters, filled)
        letters -= 1


def _balanced(line: str, letters: int, filled: str) -> str:
    """Return a broken line with no more lines than before, but of similar lengths."""
    for fewer in range(letters - 1, FEWEST, -1):
        found = textwrap.fill(line, fewer, break_long_words=False)
        if found.count("\n") > filled.count("\n") or max(map(len, found.splitlines())) > letters:
            break
        filled = found
    return filled


def contents(name: str, page: Figure) -> dict[str, files.Content]:
    """Map file names to the contents of a figure in each requested format."""
    finished(page)
    return {f"{name}.{kind}": files.binary(rendered(page, kind)) for kind in _LOOK.get().formats}


def rendered(page: Figure, kind: str) -> bytes:
    """Return a figure as the content of a file format, such as ``png``, without a date, for comparisons."""
    if (engine := page.get_layout_engine()) is not None:
        # laid out here, once; savefig alone would draw the whole figure a second time to that end
        engine.execute(page)
        page.set_layout_engine("none")
    content = io.BytesIO()
    page.savefig(content, format=kind, metadata=_UNDATED.get(kind, {}))
    return clips_named(content.getvalue()) if kind == "svg" else content.getvalue()


_CLIP = re.compile(rb'<clipPath id="(\w+)">(.*?)</clipPath>', re.DOTALL)


def clips_named(svg: bytes) -> bytes:
    """Return a picture whose clip paths are named after their coordinates as written.

    Matplotlib names them after all digits, the last of which depend on where in memory the layout's variables lie.
    """
    names = {
        old: b"p" + hashlib.blake2b(inside, digest_size=5).hexdigest().encode() for old, inside in _CLIP.findall(svg)
    }
    if not names:
        return svg
    known = re.compile(rb'((?:id="|url\(#))(' + b"|".join(names) + rb")(?=[\")])")
    return known.sub(lambda found: found[1] + names[found[2]], svg)
