r"""Literature that texts may cite as ``\cite{key}``."""

from __future__ import annotations

import re

from satsym.report.texts import Texts

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
"""Key -> what is printed, with places for words of the language of the document."""

_CITED = re.compile(r"\\cite\{([^}]*)\}")
_WORD = re.compile(r"<(\w+)>")


def cited(body: str, name: str, texts: Texts) -> tuple[str, str]:
    """The body with keys that are those of its document alone, and the list of what it cites, in that order."""
    keys = list(dict.fromkeys(key for keys in _CITED.findall(body) for key in keys.split(",")))
    works = [_WORD.sub(lambda at: texts.get("words", at[1]), WORKS[key]) for key in keys]
    items = [rf"\bibitem{{{name}:{key}}} {work}" for key, work in zip(keys, works, strict=True)]

    def here(found: re.Match[str]) -> str:
        return rf"\cite{{{','.join(f'{name}:{key}' for key in sorted(found[1].split(','), key=keys.index))}}}"

    own = _CITED.sub(here, body)
    listed = "\n".join([r"\begin{thebibliography}{9}\samepage", *items, r"\end{thebibliography}"])
    return own, listed if items else ""
