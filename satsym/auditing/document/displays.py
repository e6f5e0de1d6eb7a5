"""The displayed formulas of a document, each with number, section and position, and the macros of the document."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from satsym.auditing.document.macros import Definitions, enter_macros, with_environments
from satsym.status import BadInput
from satsym.wording import printable

MAX_BYTES = 5_000_000
"""Number of bytes that a document, with all files that it includes, may have."""
MOST_DISPLAYS = 3000
_MOST_FILES = 200
_MARKDOWN = (".md", ".markdown", ".qmd", ".rmd", ".txt")
_COMMENT = re.compile(r"(?<!\\)%[^\n]*")
_VERBATIM = re.compile(r"\\begin\{(verbatim\*?|lstlisting|comment|minted)\}.*?\\end\{\1\}", re.DOTALL)
_CODE = re.compile(
    r"^[ \t]*(?P<rail>```+|~~~+)(?P<kept> *\{?math\b)?.*?^[ \t]*(?P=rail)[^\n]*$|(?<![`}])`[^`\n]+`(?!`)",
    re.DOTALL | re.MULTILINE,
)
"""Pattern of code in Markdown.

Blocks of mathematics match too, so that the end of one is not taken for the beginning of the next.
"""
_QUOTE = re.compile(r"(?:(?<=\n\n)|(?<=\A)|(?<=\n))(?:[ \t]{0,3}>)+(?=[^\n]*(?:\n[ \t]{0,3}>|\n\n|\n?\Z))")
_INPUT = re.compile(r"\\(?:input|include|subfile)\s*\{([^{}\n]{1,300})\}")
_NUMBERED = "equation|align|gather|multline|eqnarray|flalign|alignat|IEEEeqnarray|dmath"
_OPENING = re.compile(
    rf"(?P<env>\\begin\{{(?P<name>(?:{_NUMBERED})\*?|displaymath|math)\}})|(?P<brackets>\\\[)|(?P<dollars>(?<!\\)\$\$)"
    r"|^[ \t]*(?P<fence>```+|:::+) *\{?math\}?[^\n]*\n(?P<options>(?:[ \t]*:[a-z-]+:[^\n]*\n)*)",
    re.MULTILINE,
)
_SECTION = re.compile(
    r"\\(chapter|section|subsection)(\*?)\s*\{([^{}\n]{0,200})|^(#{1,3}) +([^\n]{1,200})$", re.MULTILINE
)
_PACKAGES = re.compile(r"\\usepackage\s*(?:\[[^\]\n]{0,200}\])?\s*\{([^{}\n]{1,300})\}")
_LABEL, _TAG = re.compile(r"\\label\s*\{([^{}\n]{1,100})\}"), re.compile(r"\\tag\*?\s*\{([^{}\n]{1,40})\}")
_REFERENCE = re.compile(r"(?:\\(?:eq|c|C|auto)?ref\s*\{|\{eq\}`)([^{}`\n]{1,100})[}`]")
_OPTION = re.compile(r":(?:label|name):[ \t]*(\S{1,100})")
_UNNUMBERED = re.compile(r"\\(?:nonumber|notag)\b")
_CONTINUES = re.compile(r"[\s&{}]*(?:[-+=]|\\(?:quad|qquad|times|cdot|equiv)\b)")
_OPEN_END = re.compile(
    r"(?:[-+=]|\\(?:quad|times|cdot)|\\sum(?:[_^](?:\{[^{}]*\}|\\?\w+))*)(?:[\s&]|\\nonumber|\\notag|\\qquad)*\Z"
)
"""Pattern of the end of a line after which an equation continues on the next line."""
_FOLLOWS = re.compile(r"[\s&]*=(?=\s*[^\s=])")
"""Pattern of the sign at the beginning of a display that continues the one before it."""
_RELATION = re.compile(r"[=<>]|\\(?:[lg]eq?|neq?|approx|in|to|equiv|sim|propto)\b")
_GROUP = re.compile(r"\{[^{}]*\}")
_INDENT = 80
r"""Number of characters before a display that are examined.

In Markdown, brackets ``\[`` after other text on the line are escaped brackets and do not begin a display.
"""
_NEAR_CHARACTERS = 400
"""Number of characters before a display that are searched for references to other equations."""


@dataclass(frozen=True)
class Display:
    """A displayed formula: LaTeX, position, number or label, section, and labels that the text before it refers to."""

    text: str
    start: int
    place: str
    item: str
    label: str
    section: str
    refers: tuple[str, ...]
    columns: str = ""
    """Name of the environment if it has columns separated by ``&``, otherwise empty."""


@dataclass
class Source(Definitions):
    """A document with all files that it includes, as one text."""

    path: Path = Path()
    text: str = ""
    _starts: list[tuple[int, Path, int]] = field(default_factory=list)
    """Start of each piece of a file in the text: position in the text, file, and line in the file."""

    def place(self, at: int) -> str:
        """Return file and line of a character of the text."""
        start, path, line = self._starts[bisect_right(self._starts, at, key=lambda entry: entry[0]) - 1]
        return f"{printable(str(path), 200)}:{line + self.text.count(chr(10), start, at)}"


def read(path: Path) -> Source:
    """Read a document, and the files in its folder that it includes.

    Raises
    ------
    BadInput
        If the document is not text, is too large, or is a PDF file.
    """
    source = Source(path=path)
    home = path.parent.resolve()
    _include(source, path, home, ())
    _blank_out(source)
    for package in sorted({name.strip() for names in _PACKAGES.findall(source.text) for name in names.split(",")}):
        file = home / f"{package}.sty"
        if file.resolve().is_relative_to(home) and file.is_file():
            enter_macros(source, _COMMENT.sub("", _content(file)), None)
    source.text = enter_macros(source, source.text, source.place)
    source.text, moved = with_environments(source, source.text)
    source._starts = [(moved(start), path, line) for start, path, line in source._starts]
    return source


def displays(source: Source) -> Iterator[Display]:
    """Yield all displayed formulas in order; of a display with several equations, each equation by itself."""
    text = source.text
    sections = list(_sections(text))
    within = r"\numberwithin{equation}{section}" in text.replace(" ", "")
    chapters = bool(re.search(r"\\documentclass[^{]*\{(?:report|book)\}", text))
    counted, heading = 0, ""
    seen: set[str] = set()
    markdown = source.path.suffix.lower() in _MARKDOWN
    for found, (match, body) in enumerate(_blocks(text, markdown)):
        if found >= MOST_DISPLAYS:
            raise BadInput(
                f"{source.place(match.start())}: the document has more than {MOST_DISPLAYS} displayed formulas; "
                "split the document"
            )
        environment, start = match["name"] or "", match.end()
        k = bisect_right(sections, match.start(), key=lambda entry: entry[0]) - 1
        number, title = sections[k][1:] if k >= 0 else ("", "")
        head = number.partition(".")[0] if within or chapters else ""
        if head != heading:
            counted, heading = 0, head
        numbered = bool(environment) and not environment.endswith("*") and "math" not in environment[1:]
        refers = tuple(_REFERENCE.findall(text, max(0, match.start() - _NEAR_CHARACTERS), match.start()))
        for row_start, row in _equations(body, environment):
            label = _LABEL.search(row) or _OPTION.search(match["options"] or "")
            tag = _TAG.search(row)
            item = ""
            if tag:
                item = tag[1].strip("() ")
            elif label and label.re is _OPTION:
                item = label[1]
            elif numbered and not _UNNUMBERED.search(row):
                counted += 1
                item = f"{head}.{counted}" if head else str(counted)
            line = source.place(start + row_start + len(row) - len(row.lstrip()))
            item = item or f"line {line.rpartition(':')[2]}"
            while item in seen:
                item += "'"
            seen.add(item)
            if follows := _FOLLOWS.match(row):
                row_start, row = row_start + follows.end(), row[follows.end() :]
            section = f"section {number} {title}".replace("  ", " ").strip() if title or number else ""
            yield Display(
                row,
                start + row_start,
                line,
                item,
                label[1] if label else "",
                section,
                refers,
                _columns(environment) or ("split" if match["fence"] and "&" in row else ""),
            )


def _blocks(text: str, markdown: bool) -> Iterator[tuple[re.Match[str], str]]:
    """Yield the match of the beginning and the content of each display.

    In linear time even if a display is not closed.
    """
    nearest: dict[str, tuple[int, int]] = {}
    position = 0
    while opening := _OPENING.search(text, position):
        position = opening.end()
        kind = next(kind for kind in ("env", "brackets", "dollars", "fence") if opening[kind] is not None)
        closing = {
            "env": re.escape(opening[0].replace("begin", "end", 1)),
            "brackets": r"\\\]",
            "dollars": r"(?<!\\)\$\$",
            "fence": rf"(?m:^[ \t]*{opening['fence']}[ \t]*$)",
        }[kind]
        if nearest.get(closing, (-1, 0))[0] < position:
            found = re.compile(closing).search(text, position)
            nearest[closing] = found.span() if found else (len(text), len(text))
        begin, end = nearest[closing]
        before = text[max(0, opening.start() - _INDENT) : opening.start()].rpartition("\n")[2]
        escaped = markdown and kind == "brackets" and before.strip()
        if begin < len(text) and not escaped:
            yield opening, text[position:begin]
            position = end


def _columns(environment: str) -> str:
    """Return the name without star of an environment that has columns, otherwise an empty string."""
    name = environment.rstrip("*")
    return name if name.startswith(("align", "flalign", "eqnarray", "IEEE")) else ""


def _include(source: Source, path: Path, home: Path, asking: tuple[Path, ...]) -> None:
    content = _content(path)
    if len(source.text) + len(content) > MAX_BYTES or len(source._starts) > 2 * _MOST_FILES:
        raise BadInput(
            f"{printable(str(path), 200)}: the document has more than {MAX_BYTES:,} bytes or {_MOST_FILES} files; "
            "split it"
        )
    clean = _COMMENT.sub(lambda m: " " * len(m[0]), content) if path.suffix.lower() not in _MARKDOWN else content
    position, line = 0, 1
    for match in _INPUT.finditer(clean):
        source._starts.append((len(source.text), path, line))
        source.text += content[position : match.end()]
        line += content.count("\n", position, match.end())
        position = match.end()
        wanted = match[1].strip()
        other = home / (wanted if Path(wanted).suffix else f"{wanted}.tex")
        try:
            inside = other.resolve().is_relative_to(home) and other.is_file()
        except (OSError, ValueError, RuntimeError):
            inside = False
        if not inside or other in asking or other == path:
            why = f"\\input{{{printable(wanted)}}} is not in the folder of the document, or includes itself"
            source.unread.append((source.place(len(source.text) - 1), why))
        else:
            _include(source, other, home, (*asking, path))
    source._starts.append((len(source.text), path, line))
    source.text += content[position:]


def _content(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise BadInput(f"{printable(str(path), 200)}: the document has more than {MAX_BYTES:,} bytes; split it")
        raw = path.read_bytes()
    except (OSError, ValueError) as error:
        raise BadInput(f"{printable(str(path), 200)}: cannot be read ({printable(str(error))})") from None
    if raw.startswith(b"%PDF") or path.suffix.lower() == ".pdf":
        raise BadInput(
            f"{printable(str(path), 200)}: PDF files cannot be read; give the LaTeX or Markdown source of the document"
        )
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise BadInput(f"{printable(str(path), 200)}:{line}: not UTF-8 text; save it as UTF-8") from None


def _blank_out(source: Source) -> None:
    """Replace comments and verbatim text by spaces."""
    if source.path.suffix.lower() in _MARKDOWN:
        source.text = _QUOTE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source.text)
    patterns = (_CODE,) if source.path.suffix.lower() in _MARKDOWN else (_VERBATIM, _COMMENT)
    for pattern in patterns:
        source.text = pattern.sub(_blank, source.text)


def _blank(match: re.Match[str]) -> str:
    return match[0] if match.groupdict().get("kept") else re.sub(r"[^\n]", " ", match[0])


def _sections(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield position, number and title of each section."""
    numbers = [0, 0, 0]
    for match in _SECTION.finditer(text):
        level = ("chapter", "section", "subsection").index(match[1]) if match[1] else len(match[4]) - 1
        if not match[2]:
            numbers[level] += 1
            numbers[level + 1 :] = [0] * (2 - level)
        shown = [str(n) for n in numbers[: level + 1]]
        while shown and shown[0] == "0":
            shown = shown[1:]
        yield match.start(), ".".join(shown), (match[3] or match[5] or "").strip()


def _equations(body: str, environment: str) -> Iterator[tuple[int, str]]:
    """Yield the equations of a display with their positions; a continuation line belongs to the equation before it."""
    if environment.startswith(("alignat", "IEEEeqnarray")):
        skipped = re.match(r"\s*\{[^{}]*\}", body)
        begin = skipped.end() if skipped else 0
    else:
        begin = 0
    single = environment.startswith(("equation", "multline", "dmath", "displaymath", "math")) or not environment
    if single:
        yield begin, body[begin:]
        return
    depth, start = 0, begin
    rows: list[tuple[int, int]] = []
    for match in re.finditer(r"\\\\(?:\[[^\]\n]{0,20}\])?|\\begin\b|\\end\b|\\.|[{}]", body[begin:], re.DOTALL):
        word = match[0]
        depth += (word in ("\\begin", "{")) - (word in ("\\end", "}"))
        if word.startswith("\\\\") and depth == 0:
            rows.append((start, begin + match.start()))
            start = begin + match.end()
    rows.append((start, len(body)))
    joined: list[tuple[int, int]] = []
    for a, b in rows:
        if joined and _belongs(body[slice(*joined[-1])], body[a:b]):
            joined[-1] = joined[-1][0], b
        elif body[a:b].strip():
            joined.append((a, b))
    yield from ((a, body[a:b]) for a, b in joined)


def _belongs(before: str, row: str) -> bool:
    """Return whether a line of a display continues the equation of the line before it."""
    if not row.strip() or _OPEN_END.search(before):
        return bool(row.strip())
    relation = _RELATION.search(_GROUP.sub("", row))
    if _CONTINUES.match(row):
        begins = re.match(r"[\s&{}]*(?:=|\\equiv)", row)
        return relation is None or bool(begins) or not before.lstrip().startswith("&")
    return relation is None and row.lstrip().startswith("&") and _RELATION.search(before) is not None
