"""Printed letters with index, dots, hat and star, each of which has a name in the language of ledgers."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from satsym.formula.reading import MAX_NAME, NAME

_DOTS = ("", "dot", "ddot", "dddot", "ddddot")
_ACCENTS = {name: name for name in ("hat", "bar", "tilde", "check", "breve")} | {"under": "underline"}
_RAISED = {"star": "*", "prime": r"{\prime}", "plus": "+", "minus": "-", "max": r"{\max}", "min": r"{\min}"}
_STYLES = {"vector": "mathbf", "cal": "mathcal", "tt": "mathtt"}
_OF_INDICES = re.compile(r"[()\[\]<>.;!?]|/(?![0-9])|\\\\(?:to|[lg]e|in|.*arrow|langle|rangle)(?![a-z])")
"""Pattern of the signs in an index that its name does not show."""
GREEK = frozenset(
    "alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi pi rho varrho sigma "
    "varsigma tau upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell hbar "
    "imath jmath varpi varGamma varDelta varTheta varLambda varXi varPi varSigma varUpsilon varPhi varPsi "
    "varOmega".split()
)
"""Letters that are printed by a macro."""


@dataclass(frozen=True)
class Letter:
    """A letter as it is printed.

    ``base`` is the letter itself (``x``, ``omega``, ``varphi``), ``style`` is ``cal`` or ``vector`` for script and bold
    letters, ``index`` is the subscript, ``marks`` are other decorations (``hat``, ``star``, ``max``), ``dots`` is the
    order of the time derivative, and ``before`` is a sign of variation before the letter.
    """

    base: str
    style: str = ""
    index: str = ""
    dots: int = 0
    marks: tuple[str, ...] = ()
    before: str = ""
    foot: str = field(default="", compare=False)
    """The subscript in LaTeX."""

    @property
    def name(self) -> str:
        """Name in the language of ledgers, the same for letters that look the same."""
        stem = self.base
        if self.index:
            stem += self.index if self.index[0].isdigit() and "_" not in stem and len(stem) == 1 else f"_{self.index}"
        name = "_".join(filter(None, [self.before, stem, self.style, *self.marks]))
        if self.dots and "_" in name:  # lambda_r_dot would be a letter with the index r_dot
            name = f"{'d' * self.dots}_{name}"
        elif self.dots:
            name = f"{name}_{_DOTS[self.dots]}"
        return name[:MAX_NAME].rstrip("_")

    @property
    def latex(self) -> str:
        """The letter in LaTeX."""
        found = _in_tex(self.base)
        for style in filter(None, self.style.split("_")):
            found = rf"\{_STYLES[style]}{{{found}}}"
        for mark in self.marks:
            if mark in _ACCENTS:
                found = rf"\{_ACCENTS[mark]}{{{found}}}"
        if self.dots:
            found = rf"\{_DOTS[self.dots]}{{{found}}}" if len(found) > 1 else rf"\{_DOTS[self.dots]} {found}"
        foot = self.foot or ",".join(_in_tex(part) for part in self.index.split("_") if part)
        if foot:
            found += f"_{foot}" if len(foot) == 1 else f"_{{{foot}}}"
        raised = [_RAISED.get(mark, rf"{{\mathrm{{{mark}}}}}") for mark in self.marks if mark not in _ACCENTS]
        if raised:
            found += f"^{''.join(raised)}" if len(raised) == 1 else f"^{{{' '.join(raised)}}}"
        if "norm" in self.marks:
            found = rf"|{replace(self, marks=tuple(m for m in self.marks if m != 'norm'), style='vector').latex}|"
        return rf"\{self.before} {found}" if self.before else found

    @property
    def still(self) -> Letter:
        """The letter without dots."""
        return replace(self, dots=0)

    @property
    def bold(self) -> bool:
        """Whether the letter is typeset as a vector."""
        return "vector" in self.style

    @property
    def signs(self) -> str:
        """Brackets and arrows in the index, which the name does not show."""
        return "".join(_OF_INDICES.findall(self.foot))

    def dotted(self, times: int = 1) -> Letter | None:
        """Return the time derivative of the letter; ``None`` above the fourth order."""
        return replace(self, dots=self.dots + times) if self.dots + times < len(_DOTS) else None

    @property
    def plain(self) -> Letter:
        """The letter with only its index and dots."""
        return replace(self, style="", marks=())


def of_word(word: str) -> Letter:
    """Return the letter of a name in plain notation, such as ``x_ddot``, ``lambda_x``, ``u1_star`` or ``d_x``."""
    dots, rest = 0, word
    for count in (2, 1):
        if rest.startswith(f"{'d' * count}_") and len(rest) > count + 1:
            dots, rest = count, rest[count + 1 :]
            break
    for count in range(len(_DOTS) - 1, 0, -1):
        for joint in ("_", ""):
            ending = f"{joint}{_DOTS[count]}"
            if rest.endswith(ending) and len(rest) > len(ending):
                return replace(of_word(rest[: -len(ending)]), dots=dots + count)
    marks: tuple[str, ...] = ()
    while (match := re.search(r"_(star|hat|bar|tilde|prime)\Z", rest)) is not None:
        marks, rest = (match[1], *marks), rest[: match.start()]
    base, _, index = rest.partition("_")
    digits = re.fullmatch(r"([A-Za-z]+?)([0-9]+)", base)
    if digits:
        base, index = digits[1], "_".join(filter(None, [digits[2], index]))
    return Letter(base, index=index, dots=dots, marks=marks)


def _in_tex(word: str) -> str:
    """Return a letter or word in LaTeX."""
    if word in GREEK:
        return rf"\{word}"
    return word if len(word) == 1 or word.isdigit() else rf"\mathrm{{{word}}}"


def is_name(text: str) -> bool:
    """Return whether a text may be used as a name."""
    return len(text) <= MAX_NAME and NAME.match(text) is not None


def cleaned(text: str) -> str:
    """Return an index as part of a name, with single underscores between words and numbers."""
    return "_".join(re.findall(r"[A-Za-z0-9]+", text))
