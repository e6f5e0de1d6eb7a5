"""A derivation as a LaTeX document: what it starts from, then every step with its rule, equations and checks.

The sentences are those of :mod:`satsym.report.texts`; every equation is printed from the derivation's own
objects, and carries its address as its label.
"""

from __future__ import annotations

from satsym.report.latex import tex
from satsym.report.latex.statement import statement
from satsym.report.latex.steps import Context, Shown, conclusion, numbers_of, quantities, shown
from satsym.report.texts import Texts, load
from satsym.symbolic import Check, Derivation, Step
from satsym.symbolic.checks import DIGITS, POINTS
from satsym.symbolic.latex.typeset import Typesetter

PACKAGES = "amsmath, amssymb, array, booktabs, longtable, xcolor"
"""What a document needs that takes in the body alone."""

PREAMBLE = r"""\documentclass[11pt,a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage{microtype}
\usepackage{amsmath,amssymb}
\usepackage{array,booktabs,longtable}
\usepackage[width=160mm,height=240mm]{geometry}
\usepackage{xcolor}
\usepackage[colorlinks,allcolors=blue!45!black]{hyperref}
\setlength{\jot}{5pt}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 2pt}
\setlength{\emergencystretch}{3em}
\widowpenalty=10000 \clubpenalty=10000 \displaywidowpenalty=10000 \postdisplaypenalty=10000
"""

UNHYPHENATED = r"""% the hyphenation patterns that every TeX has are for English
\hyphenpenalty=10000 \tolerance=2000 \hbadness=3000
"""

MACROS = r"""\makeatletter
\@ifundefined{c@satsymstep}{\newcounter{satsymstep}}{\setcounter{satsymstep}{0}}
\def\theHsatsymstep{<name>.\arabic{satsymstep}}
% {label}{title}: heading of a step
\def\satsymstep#1#2{\subsection*{\refstepcounter{satsymstep}\label{#1}<step>~\thesatsymstep\quad #2}}
% {back}{labels}: labels for things that share the number of an equation, counted back from the last one
\def\satsymalso#1#2{\begingroup\addtocounter{equation}{-#1}%
  \protected@edef\@currentlabel{\theequation}\def\@currentHref{equation.\csname theHequation\endcsname}%
  \protected@edef\@currentHref{\@currentHref}%
  \@for\satsym@label:=#2\do{\label{\satsym@label}}\addtocounter{equation}{#1}\endgroup}
% {claims}: how a step was checked
\def\satsymchecks#1{\par\nobreak{\footnotesize\noindent\color{black!55}#1\par}}
% keeps a list on one page
\def\satsymtogether{\@itempenalty\@M\@beginparpenalty\@M\@endparpenalty\@M\itemsep0pt}
\makeatother
"""

SECTION_FROM = {"hamiltonian": "conditions", "stability": "structure", "lqr_hamiltonian": "regulator"}
"""Steps that begin a new section."""

BY_INSPECTION = frozenset({"declared", "dimensions agree"})
"""Claims that are checked term by term, not by calculation."""


def render(derivation: Derivation, language: str = "en", standalone: bool = True) -> str:
    r"""Typeset a derivation.

    Parameters
    ----------
    derivation
        What was derived, with or without a cost.
    language
        Language of the sentences; titles and meanings stay as the derivation file has them.
    standalone
        Whether the result is a document, or a body for ``\input`` in one that has the packages (they are
        named in its first line).

    Returns
    -------
    str
        LaTeX that depends on nothing but the arguments.

    Raises
    ------
    BadInput
        If there are no texts in that language.
    MissingText
        If the language has no text for a step, its rule or one of its checks.
    """
    texts = load(language).with_own(derivation.model.sentences().get(language, {}))
    body = "\n\n".join(_Composer(derivation, texts).paragraphs()) + "\n"
    macros = MACROS.replace("<name>", tex.label(derivation.name)).replace("<step>", texts.get("words", "step"))
    source = f"% Written by satsym from the derivation of {tex.label(derivation.name)}. Do not edit.\n"
    if not standalone:
        return f"{source}% Needs the packages {PACKAGES}.\n{macros}\n{body}"
    title = (
        f"\\begin{{center}}\n  {{\\LARGE {tex.escape(derivation.title)}\\par}}\n"
        f"  \\vspace{{1ex}}{tex.name(derivation.name)}\n\\end{{center}}"
    )
    hyphens = "" if language == "en" else UNHYPHENATED
    return f"{source}{PREAMBLE}{hyphens}{macros}\\begin{{document}}\n{title}\n\n{body}\\end{{document}}\n"


class _Composer:
    def __init__(self, derivation: Derivation, texts: Texts) -> None:
        self._derivation, self._texts = derivation, texts
        self._context = Context(derivation, texts, Typesetter(derivation))
        self._declared = statement(derivation, texts, self._context.typeset)
        self._shown: dict[str, Shown] = {}

    def paragraphs(self) -> list[str]:
        """Everything between title and end."""
        kind = "problem" if self._derivation.problem else "model"
        label = tex.label(f"{self._derivation.name}:statement")
        done = [
            rf"{self._section(kind)}\label{{{label}}}",
            *self._declared.paragraphs,
            self._texts.get("statement", "about", statement=label),
            self._section("motion"),
        ]
        for step in self._derivation.steps:
            if step.name in SECTION_FROM:
                done.append(self._section(SECTION_FROM[step.name]))
            done.append(self._step(step))
        return done

    def _section(self, key: str) -> str:
        return rf"\section{{{self._texts.get('sections', key)}}}"

    def _step(self, step: Step) -> str:
        """Heading, rule, equations, checks; the sources are the steps before this one."""
        title = self._texts.get("titles", step.name)
        fill = {"sources": self._sources(step), "quantities": quantities(self._context, step)}
        rule = self._texts.get("rules", step.rule, **fill)
        self._shown[step.name] = shown(self._context, step)
        heading = rf"\satsymstep{{{tex.label(self._context.address(step))}}}{{{title}}}"
        said = [conclusion(self._context, c) for c in step.conclusions]
        return "\n".join((heading, rule, self._shown[step.name].body, *said, self._checks(step)))

    def _sources(self, step: Step) -> str:
        named = (self._source(name) for name in step.follows_from)
        return self._texts.listed([text for text in named if text])

    def _source(self, name: str) -> str:
        """A step that was shown, or else a declared thing, in words and with its numbers."""
        if name in self._shown:
            first, last = tex.label(self._shown[name].first), tex.label(self._shown[name].last)
            step = tex.label(f"{self._derivation.name}:{name}")
            return self._texts.get("references", "one" if first == last else "many", first=first, last=last, step=step)
        if name == "definitions" and name not in self._declared.ends:
            return ""
        ends = self._declared.ends.get(name)
        return self._texts.get("declared", name) + (f"~{numbers_of(*ends)}" if ends else "")

    def _checks(self, step: Step) -> str:
        checks = "\n".join(rf"  $\checkmark$~{checked(self._texts, check)}" for check in step.checks)
        return f"\\satsymchecks{{%\n{checks}}}"


def checked(texts: Texts, check: Check) -> str:
    """What was found true, and how; not the measured deviation, which is noise, but its limit."""
    method = "inspection" if check.claim in BY_INSPECTION else "numeric" if check.limit else "exact"
    how = texts.get("methods", method, points=str(POINTS), digits=str(DIGITS), limit=tex.number(check.limit))
    return f"{texts.get('claims', check.claim)} ({how})."
