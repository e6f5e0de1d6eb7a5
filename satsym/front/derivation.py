"""Derivations in Python: equations by address, kernels, LaTeX and HTML, in memory unless saved."""

from __future__ import annotations

import pickle
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from satsym.front.calls import in_one_line
from satsym.kernels.digest import sealed
from satsym.records import record
from satsym.status import BadInput
from satsym.wording import counted, shown

if TYPE_CHECKING:
    import sympy as sp

    from satsym import symbolic
    from satsym.kernels import Kernels
    from satsym.symbolic import Model, Problem
    from satsym.symbolic.latex.typeset import Typesetter
    from satsym.symbolic.model import Convention

SHOWN = ("first_order", "hamiltonian", "control_law", "costate_equations")
"""Steps of a derivation that notebooks show."""
KEPT = 32
"""Number of derivations that are cached."""


@dataclass(frozen=True)
class Equation:
    """A derived equation, which notebooks display as a formula.

    Attributes
    ----------
    address
        Address of the equation, ``model:step.equation``.
    lhs, rhs
        The two sides, as SymPy expressions; the right-hand side may be a matrix.
    latex
        The equation in LaTeX, in the notation of its derivation.
    """

    address: str
    lhs: sp.Expr
    rhs: sp.Expr
    latex: str

    def __repr__(self) -> str:
        return f"{self.address}: {self.lhs} = {self.rhs}"

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.latex}$"


@dataclass(frozen=True, eq=False, repr=False)
class Derivation:
    """The derivation of a problem, or of a model without a cost, with every step checked.

    Attributes
    ----------
    subject
        The problem or model from which it is derived.
    derived
        The steps of the derivation.
    source
        Name of the file that defines the problem, or the name that such a file would have.
    stating
        The files that define the problem, with digests of their contents.
    """

    subject: Problem | Model
    derived: symbolic.Derivation
    source: str
    stating: Mapping[Path, str] = field(default_factory=dict)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.subject, self.derived, self.source, self.stating)

    @property
    def name(self) -> str:
        """Return the name of the problem, or of the model if there is no cost."""
        return self.derived.name

    @property
    def title(self) -> str:
        """Return the title of the problem or model."""
        return self.derived.title

    @cached_property
    def kernels(self) -> Kernels:
        """Return the generated functions, which were compared with their expressions and are kept in memory only."""
        return self._generated[1]

    @cached_property
    def _generated(self) -> tuple[str, Kernels]:
        from satsym.report import artefacts
        from satsym.symbolic import loader
        from satsym.symbolic.convention import is_minimum
        from satsym.symbolic.time_limit import within

        if not is_minimum(self.derived):
            return derive(self, "minimum")._generated
        with loader.explained(), within(artefacts.MAX_SECONDS, self.name):
            return artefacts.generated(self.derived, self.source)

    @cached_property
    def _typeset(self) -> Typesetter:
        from satsym.symbolic.latex.typeset import Typesetter

        return Typesetter(self.derived)

    def __getitem__(self, address: str) -> Equation | sp.Expr | sp.Matrix | dict[str, Equation]:
        """Return the expression at an address.

        Parameters
        ----------
        address
            ``"step.equation"``, also with the model's name before it; ``"step"`` for all equations of a step, by name;
            ``"step.A"`` for a matrix whose entries are equations; ``"declared.name"`` for a declared quantity.

        Raises
        ------
        BadInput
            If there is no such address; the message suggests similar addresses.
        """
        from satsym.symbolic import Equation as DerivedEquation
        from satsym.symbolic.lookup import addresses

        model, _, rest = address.rpartition(":") if isinstance(address, str) else ("", "", "")
        if model not in ("", self.name) or not rest:
            raise BadInput(f'{shown(address)}: not in the derivation of {self.name}; write "step.equation"')
        if "." not in rest and rest in self.derived:
            return {e.name: self._equation(rest, e) for e in self.derived.step(rest).equations}
        found = addresses.resolve(self.derived, f"{self.name}:{rest}")
        if isinstance(found, DerivedEquation):
            return self._equation(rest.partition(".")[0], found)
        return found.matrix if isinstance(found, addresses.Family) else found

    def __iter__(self) -> Any:
        """Iterate over the addresses of all equations."""
        from satsym.symbolic.lookup import addresses

        return iter(addresses.addresses(self.derived))

    def __contains__(self, address: object) -> bool:
        try:
            return isinstance(address, str) and self[address] is not None
        except BadInput:
            return False

    def latex(self, lang: str = "en", *, fragment: bool = False) -> str:
        """Return a LaTeX document of the derivation, as ``satsym latex`` writes it.

        Parameters
        ----------
        lang
            Language of the document, one of :func:`satsym.report.texts.languages`.
        fragment
            Whether to leave out the preamble, for inclusion in another document.
        """
        from satsym.report.latex import document

        return document.render(self.derived, language=lang, standalone=not fragment)

    def save(self, folder: str | Path) -> list[Path]:
        """Write ``NAME.py``, ``NAME.tex`` and ``NAME.derivation.json`` as ``satsym derive --out`` does.

        Return their paths.

        Raises
        ------
        BadInput
            If the folder cannot be written to.
        """
        from satsym.report import artefacts
        from satsym.report.results.files import check_writable

        check_writable(Path(folder))
        module = sealed(self._generated[0], Path(folder), self.stating)
        recorded = artefacts.recorded_text(self.derived, Path(self.source), Path(folder), self.stating)
        texts = {f"{self.name}.py": module, f"{self.name}.tex": self.latex(), f"{self.name}{record.SUFFIX}": recorded}
        return artefacts.write(texts, Path(folder))

    def __repr__(self) -> str:
        steps = [(s.name, len(s.equations), len(s.checks)) for s in self.derived.steps]
        wide = max(len(name) for name, _, _ in steps)
        lines = [
            f"  {name:<{wide}}  {counted(some, 'equation')}, {counted(checks, 'check')}" for name, some, checks in steps
        ]
        return "\n".join([f"{self.name}: {self.title}", *lines])

    def _repr_latex_(self) -> str:
        return _display([line for name in SHOWN if name in self.derived for line in self._lines(name)])

    def _repr_html_(self) -> str:
        from satsym.report.texts import load

        texts = load("en")
        parts = [f"<p><strong>{escape(self.title)}</strong></p>"]
        for step in self.derived.steps:
            title = texts.find("titles", step.name) or step.name
            claims = ", ".join(f"{check.claim} ({check.error:.0e})" for check in step.checks)
            parts.append(
                f"<details><summary>{escape(title)}</summary>{escape(_display(self._lines(step.name)))}"
                f"<small>{escape(claims)}</small></details>"
            )
        return "\n".join(parts)

    def _lines(self, name: str) -> list[str]:
        """Return the equations of a step, with matrices in place of their entries."""
        from satsym.symbolic.latex.typeset import matrices

        step, tex = self.derived.step(name), self._typeset.tex
        named = matrices(self.derived, step)
        entries = [e for one in named for e in one.equations]
        return [f"{one.prefix} &= {tex(one.matrix)}" for one in named] + [
            f"{tex(e.lhs)} &= {tex(e.rhs)}" for e in step.equations if e not in entries
        ]

    def _equation(self, step: str, found: symbolic.Equation) -> Equation:
        formula = f"{self._typeset.tex(found.lhs)} = {self._typeset.tex(found.rhs)}"
        return Equation(f"{self.name}:{step}.{found.name}", found.lhs, found.rhs, formula)


def _display(lines: list[str]) -> str:
    body = r" \\ ".join(lines)
    return rf"$$\begin{{aligned}} {body} \end{{aligned}}$$"


Subject: TypeAlias = "Problem | Model | Derivation | str | Path"


@in_one_line
def derive(subject: Subject, convention: Convention | None = None) -> Derivation:
    """Derive everything that follows from a problem, or from a model without a cost.

    Parameters
    ----------
    subject
        A problem or model; the name of a shipped one; or ``"FILE.py"``, followed by ``:NAME`` if the file defines
        several. The file is Python and is executed.
    convention
        ``"minimum"`` or ``"maximum"``, the extremum of the Hamiltonian that the optimal control attains; by default the
        convention of the problem.

    Returns
    -------
    Derivation
        The derived equations by address, with generated functions, LaTeX and HTML.

    Raises
    ------
    BadInput
        If there is no such problem, or nothing can be derived from it, with one line that gives the reason.
    """
    from satsym.report import artefacts
    from satsym.symbolic import Model, Problem, loader
    from satsym.symbolic.convention import in_convention

    source, path = "", None
    stating: Mapping[Path, str] = {}
    if isinstance(subject, Derivation):
        source, stating, subject = subject.source, subject.stating, subject.subject
    elif isinstance(subject, str | Path):
        subject, path = loader.problem(str(subject))
        source, stating = artefacts.source_of(path), loader.stating(path)
    if not isinstance(subject, Problem | Model):
        raise BadInput(f"nothing can be derived from {shown(subject)}; give a Problem, a model, or the name of one")
    if convention not in (None, "minimum", "maximum"):
        raise BadInput(f'convention: {shown(convention)} is neither "minimum" nor "maximum"')
    chosen = in_convention(subject, convention)
    return _kept(chosen, source or f"{chosen.name}.py", path, stating)


_KEPT: OrderedDict[bytes, Derivation] = OrderedDict()
"""Cached derivations, by the complete definition of the problem, since tables in problems may have been changed."""


def _kept(subject: Problem | Model, source: str, path: Path | None, stating: Mapping[Path, str]) -> Derivation:
    from satsym import symbolic
    from satsym.report import artefacts
    from satsym.symbolic import loader
    from satsym.symbolic.time_limit import within

    key = pickle.dumps((subject, source, stating))
    if key not in _KEPT:
        with loader.explained(path, subject), within(artefacts.MAX_SECONDS, subject.name):
            _KEPT[key] = Derivation(subject, symbolic.derive(subject), source, stating)
        while len(_KEPT) > KEPT:
            _KEPT.popitem(last=False)
    _KEPT.move_to_end(key)
    return _KEPT[key]
