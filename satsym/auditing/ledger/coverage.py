"""Coverage of a document's text: which numbered items and which assertions have a row in the ledger.

The result is stored next to the ledger in ``contents.toml``, or ``NAME.contents.toml`` for a ledger of one file, with
the digest of the text. The value of each entry is the row that covers it, or ``none: `` and the reason why it needs no
row, or empty.
"""

from __future__ import annotations

import hashlib
import json
import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from pathlib import Path

from satsym.auditing.ledger import documents, schema
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.ledger.positions import Part
from satsym.auditing.ledger.schema import ContentsTable, WrongKey
from satsym.instance import files
from satsym.status import BadInput
from satsym.wording import printable

KINDS = ("formulas", "figures", "tables", "sections", "sentences")
NONE = "none: "
"""Prefix of the reason why an entry needs no row."""

_TELLING = 12
"""Number of characters that a quotation needs to identify the sentence that it is taken from."""
_REPEATED = 40
"""Number of characters from which a quotation is assigned to all sentences that contain it.

A shorter quotation is assigned to the first one only.
"""
_NEAR_CHARACTERS = 1000
"""Largest number of characters between the longest piece of a quotation and its other pieces."""
_NUMBER = r"[A-Z]?\d{1,2}(?:\.\d{1,3})*[a-e]?"
_FORMULA = re.compile(rf"(?:\\tag\{{\(?|(?<![\w)])\()({_NUMBER})[)}}]+[\s$.,;]*$")
_CITING = re.compile(r"(?:persamaan|pers\.?|equations?|eqs?\.|dan|and|sampai|to|[-\u2013])\s*$", re.IGNORECASE)
_CAPTION = re.compile(rf"(gambar|tabel|figure|fig\.|table)\s+({_NUMBER})(?!\w)(?=[.:]?\s*(?:[A-Z]|$))", re.IGNORECASE)
_CAPTIONS = {"g": "figure", "f": "figure", "t": "table"}
_CHAPTER = re.compile(r"(?:BAB|CHAPTER|Chapter)\s+([IVX]+|\d+)\b")
_ROMAN = re.compile(r"([IVX]+)\.\s+[A-Z]{3,}")
_LETTER = re.compile(r"([A-H])\.\s+[A-Z][a-z]+")
_DECIMAL = re.compile(r"(\d{1,2}(?:\.\d{1,2})+)\.?\s+[A-Z]")
_SENTENCE = re.compile(r"(?<=[.!?;])\s+(?=[A-Z•])|\s+(?=•)")
_MARKS = re.compile(r"<\|[^|<>]*\|>|\f")
_LAYOUT = re.compile(
    r"\\(?:text|math\w+|left|right|q?quad|d?frac|tag|dot|ddot|hat|bar|vec|(?:begin|end)\{\w+\})(?![a-z])"
)
_PROSE = re.compile(r"(?:[A-Za-z-]{2,}[, ]+)+[A-Za-z-]{2,}")
_ABOUT = re.compile(
    r"satel|orbit|sistem|system|kontrol|control|matri|eigen|grafi[ks]|curve|energ|biaya|cost|roda|wheel|torsi|torque|"
    r"metode|method|posisi|position|kecepatan|speed|velocit|gravit|hamilton|titik|state|program|waktu|time",
    re.IGNORECASE,
)
_ASSERTS = re.compile(
    r"\b(?:adalah|ialah|merupakan|yaitu|maka|sehingga|karena|jika|bila|akan|dapat|tidak|selalu|harus|memiliki|mempunyai|"
    r"memerlukan|menyebabkan|menghasilkan|menunjukkan|bernilai|bersifat|berupa|berada|sebesar|sama|lebih|di(?:peroleh|dapat"
    r"\w*)|(?:me|ber|ter|di)\w+|is|are|was|were|has|have|will|can|cannot|must|does|gives?|yields?|therefore|thus)\b",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Coverage:
    """Coverage of a text by the rows of a ledger, as computed from the text or as stored.

    Attributes
    ----------
    digest
        SHA-256 digest of the text.
    same
        Whether the stored coverage belongs to this text; ``None`` if none is stored.
    found
        Kind -> name of the entry -> the row that covers it, or ``none: `` with a reason, or empty.
    unquoted
        Keys of rows with pieces of their ``original`` that the text does not contain; empty without a text.
    """

    digest: str
    same: bool | None
    found: Mapping[str, Mapping[str, str]]
    unquoted: tuple[tuple[str, str], ...] = ()

    def counts(self, kind: str) -> tuple[int, int, int, int]:
        """Return the counts of all entries, of those with a row, of those that need no row, and of missing ones."""
        rows = list(self.found[kind].values())
        excused, missing = sum(row.startswith(NONE) for row in rows), rows.count("")
        return len(rows), len(rows) - excused - missing, excused, missing

    def missing(self, kind: str) -> list[str]:
        """Return the entries that have neither a row nor a reason why they need none."""
        return [name for name, row in self.found[kind].items() if not row]


def place(ledger: Ledger) -> Path:
    """Return the path of the file in which the coverage of a ledger is stored."""
    return documents.beside(ledger.path, "contents.toml")


def kept(ledger: Ledger) -> Coverage | None:
    """Return the stored coverage of a ledger, or ``None``; an entry whose row no longer exists counts as missing.

    Raises
    ------
    BadInput
        If a key is unknown or missing; the message contains file and line.
    """
    path = place(ledger)
    if not path.exists():
        return None
    part = Part(path, files.read(path), 0)
    try:
        table: ContentsTable = schema.table(part.tree, ContentsTable)
    except WrongKey as error:
        raise BadInput(f"{part.place(error.key if error.key in part.tree else '')}: {error}") from None
    known = {name for row in ledger.rows for name in (row.key, row.table.item, row.table.where)}
    found = {
        kind: {name: row if row.startswith(NONE) or row in known else "" for name, row in getattr(table, kind).items()}
        for kind in KINDS
    }
    return Coverage(table.text_digest, True, found)


def text_of(path: Path) -> str:
    """Return the text of a document, to measure the coverage.

    Raises
    ------
    BadInput
        If the file cannot be read.
    """
    try:
        found = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise BadInput(f"--text: {printable(str(path), 200)}: not UTF-8 text; save it as UTF-8") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a path"
        raise BadInput(f"--text: {printable(str(path), 200)}: cannot be read ({reason}); give a text file") from None
    if not found.strip():
        raise BadInput(f"--text: {printable(str(path), 200)}: contains no text; give the document's text")
    return found


def measured(ledger: Ledger, text: str) -> Coverage:
    """Return the coverage of a text by the rows of a ledger, completed by the stored coverage."""
    digest, before = hashlib.sha256(text.encode()).hexdigest(), kept(ledger)
    names = {kind: dict(_numbered(ledger, text, kind)) for kind in KINDS[:-1]}
    sentences, unquoted = _sentences(ledger, text)
    found = {**names, KINDS[-1]: sentences}
    if before is not None:
        for kind, entries in found.items():
            entries |= {name: row for name, row in before.found[kind].items() if entries.get(name) == ""}
    return Coverage(digest, None if before is None else before.digest == digest, found, tuple(unquoted))


def to_toml(coverage: Coverage) -> str:
    """Return the contents of the file in which a coverage is stored."""
    lines = [f"text_digest = {json.dumps(coverage.digest)}"]
    for kind in KINDS:
        lines += ["", f"[{kind}]"]
        lines += [f"{_quoted(name)} = {_quoted(row)}" for name, row in coverage.found[kind].items()]
    return "\n".join(lines) + "\n"


_quoted = partial(json.dumps, ensure_ascii=False)


def _numbered(ledger: Ledger, text: str, kind: str) -> Iterator[tuple[str, str]]:
    """Yield the numbered items of one kind by the names used in the ledger, with the row that covers each."""
    items = {row.table.item for row in ledger.rows}
    places = {**dict.fromkeys(items), **dict.fromkeys(row.table.where for row in ledger.rows)}
    for entry, names in _headed(text):
        if entry == kind == "sections":
            begins = re.compile(re.escape(names[0]) + r"(?![A-Za-z0-9])")
            yield names[0], next((each for each in places if begins.match(each)), "")
        elif entry == kind:
            own = next((name for name in names if name in items), "")
            yield own or names[0], own


def _headed(text: str) -> Iterator[tuple[str, list[str]]]:
    """Yield kind and possible names of each formula, caption and heading of a text, in order."""
    chapter, section, sign = "", "", ""
    for raw in text.splitlines():
        line = _MARKS.sub("", raw).strip(" #*\t")
        for pattern in (_CHAPTER, _ROMAN, _LETTER, _DECIMAL):
            heading = pattern.match(line)
            if heading:
                number = heading[1]
                if pattern is _CHAPTER:
                    chapter, section, sign = f"chapter {_arabic(number)}", "", ", "
                elif pattern is _ROMAN:
                    chapter, section, sign = f"section {number}", number, "."
                name = chapter if pattern in (_CHAPTER, _ROMAN) else f"section {number}"
                if pattern is _LETTER:
                    if not chapter:
                        continue
                    name = f"{chapter}{sign}{number}"
                yield "sections", [name]
        caption = _CAPTION.match(line)
        if caption:
            kind = _CAPTIONS[caption[1][0].lower()]
            yield f"{kind}s", _names(f"{kind} {caption[2]}", caption[2], f"{section} {kind} {caption[2]}", section)
        formula = _FORMULA.search(line)
        if formula and not _CITING.search(line[: formula.start()]):
            yield "formulas", _names(formula[1], formula[1], f"{section} ({formula[1]})", section)


def _names(plain: str, number: str, within: str, section: str) -> list[str]:
    """Return the possible names of a number; a number without a dot may start anew in each section."""
    return [within, plain] if section and "." not in number else [plain]


def _arabic(number: str) -> int:
    if number.isdigit():
        return int(number)
    values = [{"I": 1, "V": 5, "X": 10}[letter] for letter in number]
    return sum(-v if v < after else v for v, after in zip(values, [*values[1:], 0], strict=True))


def _sentences(ledger: Ledger, text: str) -> tuple[dict[str, str], list[tuple[str, str]]]:
    """Return the sentences that assert something, with the rows that quote them, and the quotations not found."""
    sentences = _SENTENCE.split(" ".join(re.sub(r"(?<=[a-z])-\n\s*(?=[a-z])", "", _MARKS.sub("\n", text)).split()))
    squashed = [_squashed(sentence) for sentence in sentences]
    ends = list(accumulate(map(len, squashed)))
    whole, quoted, unquoted = "".join(squashed), [(0, "")] * len(sentences), []
    for row in ledger.rows:
        pieces = [(_squashed(piece), piece) for piece in filter(None, map(str.strip, row.table.original.split("...")))]
        longest = max((sought for sought, _ in pieces), key=len, default="")
        anchors = _places(longest, whole)[: None if len(longest) >= _REPEATED else 1]
        for sought, piece in pieces:
            for at in _places(sought, whole):
                if any(abs(at - anchor) <= _NEAR_CHARACTERS for anchor in anchors):
                    for i, end in enumerate(ends):
                        if end > at and end - len(squashed[i]) < at + len(sought):
                            quoted[i] = max(quoted[i], (len(sought), row.key), key=lambda each: each[0])
            if sought not in whole and not _in_words(piece, whole):
                unquoted.append((row.key, piece))
    found: dict[str, str] = {}
    for sentence, own, (_, row_key) in zip(sentences, squashed, quoted, strict=True):
        if row_key or (_ABOUT.search(sentence) and _ASSERTS.search(sentence)):
            name = f"{hashlib.sha256(own.encode()).hexdigest()[:6]} {_opening(sentence)}"
            found[name] = found.get(name) or row_key
    return found, unquoted


def _places(sought: str, whole: str) -> list[int]:
    return [at.start() for at in re.finditer(re.escape(sought), whole)] if len(sought) >= _TELLING else []


def _in_words(piece: str, whole: str) -> bool:
    """Return whether the text contains the words of a quotation, whose formulas may be transcribed differently."""
    prose: list[str] = _PROSE.findall(piece)
    return bool(prose) and all(_squashed(words) in whole for words in prose)


def _opening(sentence: str) -> str:
    words = re.sub(r"[^\w\s.,()/=-]", "", unicodedata.normalize("NFKC", sentence)).split()
    return " ".join(words[:6])[:60]


def _squashed(text: str) -> str:
    """Return a text without what optical character recognition may change: breaks, spaces, accents, TeX commands."""
    plain = (
        unicodedata.normalize("NFKD", _LAYOUT.sub("", text))
        .casefold()
        .replace("≤", "<=")
        .replace("≥", ">=")
        .replace("\u2013", "-")
    )
    plain = re.sub(r"[\u0370-\u03ff]", lambda letter: _greek(letter[0]), plain)
    plain = re.sub(r"\\(le|ge)q?(?![a-z])", lambda sign: {"le": "<=", "ge": ">="}[sign[1]], plain)
    return re.sub(r"[^a-z0-9.,<>=+/()|\[\]-]", "", plain)


def _greek(letter: str) -> str:
    return unicodedata.name(letter, "").rsplit(" ", 1)[-1].lower().replace("lamda", "lambda")
