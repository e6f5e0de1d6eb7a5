"""The preamble of documents: packages, the layout of all pages, and the macros of steps."""

from __future__ import annotations

import re

from satsym.report.texts import Texts

PACKAGES = "amsmath, amssymb, array, booktabs, longtable, multicol, xcolor, tikz"
"""LaTeX packages that a document needs to include the body alone."""

SIZES = r"\DeclareMathSizes{10.95}{10.95}{9}{7} % an index may bear a dot"
"""Sizes of formulas and subscripts, instead of the usual 8 and 6 points."""

PREAMBLE = r"""\documentclass[11pt,a4paper]{article}
\ifdefined\pdfinfoomitdate % the same bytes whenever it is compiled
  \pdfinfoomitdate=1 \pdftrailerid{} \pdfsuppressptexinfo=-1
\fi
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage[<babel>]{babel}
\usepackage[expansion=false]{microtype}
\usepackage{amsmath,amssymb}
\usepackage{array,booktabs,longtable,multicol}
\usepackage[width=160mm,height=240mm]{geometry}
\usepackage{xcolor,tikz}
\usepackage[colorlinks,allcolors=blue!45!black]{hyperref}
\hypersetup{pdftitle={<title>},pdflang={<language>},pdfcreator={satsym}}
<sizes>
\setlength{\jot}{6pt}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 2pt}
\setlength{\emergencystretch}{5em}\tolerance=2000 \hbadness=3000
\AtBeginDocument{\abovedisplayshortskip=6pt plus 3pt}
\widowpenalty=10000 \clubpenalty=10000 \displaywidowpenalty=10000
\relpenalty=10000 \binoppenalty=5000 % a formula within a sentence stays on its line
"""

OWN = r"""% the hyphenation patterns that every TeX has are for English
\hyphenpenalty=10000
\AtBeginDocument{\renewcommand{\abstractname}{<abstract>}}
"""

MACROS = r"""\makeatletter
\@ifundefined{c@satsymstep}{\newcounter{satsymstep}\newcounter{satsymcheck}}{}
\setcounter{satsymstep}{0}\setcounter{satsymcheck}{0}
\def\theHsatsymstep{<name>.\arabic{satsymstep}}\def\theHsatsymcheck{<name>.check.\arabic{satsymcheck}}
% {label}{text}: a link where there are links
\def\satsymto#1#2{\@ifundefined{hyperref}{#2}{\hyperref[#1]{#2}}}
% {label}{title}: heading of a step, with a mark in the margin that leads to its checks
\def\satsymstep#1#2{\subsection*{\refstepcounter{satsymstep}\label{#1}%
  \@ifundefined{pdfbookmark}{}{\pdfbookmark[2]{<step> \thesatsymstep. #2}{#1}}%
  \llap{\satsymto{#1:checks}{\normalfont\footnotesize$\checkmark$}\enspace}<step>~\thesatsymstep\quad #2}}
% {label}{claims}: how a step was checked
\def\satsymchecked#1#2{\par\hangindent 2.2em\hangafter1\noindent\refstepcounter{satsymcheck}\label{#1:checks}%
  \hbox to 2.2em{\ref{#1}\hfil}#2}
% {back}{labels}: labels for things that share the number of an equation, counted back from the last one
\def\satsymalso#1#2{\par\skip@\lastskip\vskip-\skip@ % the space below stays the last thing
  \begingroup\addtocounter{equation}{-#1}%
  \protected@edef\@currentlabel{\theequation}\def\@currentHref{equation.\csname theHequation\endcsname}%
  \protected@edef\@currentHref{\@currentHref}%
  \@for\satsym@label:=#2\do{\label{\satsym@label}}\addtocounter{equation}{#1}\endgroup\vskip\skip@}
% {title}: on lines of like lengths
\def\satsymtitle#1{{\leftskip=0.05\linewidth plus 0.3\linewidth \rightskip=\leftskip \parfillskip=0pt \hbadness=10000
  \exhyphenpenalty=10000 \LARGE \spaceskip=\fontdimen2\font\relax #1\par}}
% {lines}: a new page unless there is room for as many on this one
\def\satsymroom#1{\par\penalty-100\begingroup\dimen@\pagegoal\advance\dimen@-\pagetotal
  \ifdim#1\baselineskip>\dimen@\ifdim\dimen@>\z@\vfil\fi\break\fi\endgroup}
% begins equations in columns at the same height
\def\satsymcolumns{\raggedcolumns\abovedisplayskip\z@\abovedisplayshortskip\z@\vspace*{-\baselineskip}}
% keeps a list on one page
\def\satsymtogether{\@itempenalty\@M\@beginparpenalty\@M\@endparpenalty\@M\itemsep0pt}
\makeatother
"""


def preamble(texts: Texts, title: str) -> str:
    """Write the preamble up to the macros, in a language, for a document with this title in LaTeX."""
    fill = {"babel": texts.get("words", "babel"), "language": texts.language, "title": title}
    own = "" if texts.language == "en" else OWN
    fill["sizes"] = SIZES
    fill["abstract"] = texts.get("words", "abstract")
    return re.sub("<([a-z]+)>", lambda hole: fill[hole[1]], PREAMBLE + own)


def macros(name: str, texts: Texts) -> str:
    """Write the macros of steps, for a document of that name."""
    return MACROS.replace("<name>", name).replace("<step>", texts.get("words", "step"))


WORKS = {
    "pontryagin": r"L.~S. Pontryagin, V.~G. Boltyanskii, R.~V. Gamkrelidze<comma><and> E.~F. Mishchenko, "
    r"\emph{The Mathematical Theory of Optimal Processes}, Interscience, New York, 1962.",
    "bryson": r"A.~E. Bryson <and> Y.-C. Ho, \emph{Applied Optimal Control}, Hemisphere, Washington, 1975.",
    "hartl": r"R.~F. Hartl, S.~P. Sethi<comma><and> R.~G. Vickson, ``A survey of the maximum principles for optimal "
    r"control problems with state constraints'', \emph{SIAM Review} \textbf{37} (1995), 181--218.",
    "kelley": r"H.~J. Kelley, R.~E. Kopp<comma><and> H.~G. Moyer, ``Singular extremals'', <in> G.~Leitmann (ed.), "
    r"\emph{Topics in Optimization}, Academic Press, New York, 1967, 63--101.",
    "lawden": r"D.~F. Lawden, \emph{Optimal Trajectories for Space Navigation}, Butterworths, London, 1963.",
    "kalman": r"R.~E. Kalman, ``Contributions to the theory of optimal control'', "
    r"\emph{Bolet\'in de la Sociedad Matem\'atica Mexicana} \textbf{5} (1960), 102--119.",
    "kailath": r"T. Kailath, \emph{Linear Systems}, Prentice-Hall, Englewood Cliffs, 1980.",
    "gantmacher": r"F.~R. Gantmacher, \emph{The Theory of Matrices}, Chelsea, New York, 1959.",
    "battin": r"R.~H. Battin, \emph{An Introduction to the Mathematics and Methods of Astrodynamics}, "
    r"AIAA, Reston, 1999.",
    "hughes": r"P.~C. Hughes, \emph{Spacecraft Attitude Dynamics}, Wiley, New York, 1986.",
    "kane": r"T.~R. Kane <and> D.~A. Levinson, \emph{Dynamics: Theory and Applications}, McGraw-Hill, New York, 1985.",
}
"""Keys -> cited works, with placeholders for words in the language of the document."""

_CITED = re.compile(r"\\cite\{([^}]*)\}")
_WORD = re.compile(r"<(\w+)>")


def cited(body: str, name: str, texts: Texts) -> tuple[str, str]:
    """Return the body with keys that are unique to its document, and the list of its citations in order."""
    keys = list(dict.fromkeys(key for keys in _CITED.findall(body) for key in keys.split(",")))
    works = [_WORD.sub(lambda at: texts.get("words", at[1]), WORKS[key]) for key in keys]
    items = [rf"\bibitem{{{name}:{key}}} {work}" for key, work in zip(keys, works, strict=True)]

    def here(found: re.Match[str]) -> str:
        return rf"\cite{{{','.join(f'{name}:{key}' for key in sorted(found[1].split(','), key=keys.index))}}}"

    own = _CITED.sub(here, body)
    listed = "\n".join([r"\begin{thebibliography}{9}\samepage", *items, r"\end{thebibliography}"])
    return own, listed if items else ""
