"""Proofs in Python."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

from satsym import solution, solvers
from satsym.front import html
from satsym.front.calls import in_one_line, single_threaded
from satsym.front.instance import Instance, as_case
from satsym.instance import Instance as Case
from satsym.proof import record
from satsym.proof.proving import prove as prove_found
from satsym.proof.record import check_digits
from satsym.report.results.files import to_json
from satsym.report.terminal.proof import proof_text


class Proof(record.Proof):
    """A proof that a solution is a strict local minimum, or the point at which the attempt ended."""

    def to_json(self) -> str:
        """Return the JSON text that ``satsym prove --json`` prints."""
        return to_json(self.to_dict())

    def latex(self, lang: str = "en", *, fragment: bool = False) -> str:
        """Return a LaTeX document of the proof, as ``satsym prove --latex`` writes it.

        Parameters
        ----------
        lang
            Language of the document.
        fragment
            Whether to leave out the preamble, for inclusion in another document.
        """
        from satsym.report.latex.proof import render

        return render(self, lang, standalone=not fragment)

    def __repr__(self) -> str:
        return proof_text(self)

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(proof_text(self))}</pre>"


def proved(case: Case, find: Callable[[], solution.Solution], digits: int) -> Proof:
    """Prove that the solution that a function finds for an instance is a strict local minimum."""
    check_digits(digits)
    made = prove_found(case, find, digits)
    return Proof(**{f.name: getattr(made, f.name) for f in fields(made)})


@single_threaded()
@in_one_line
def prove(instance: Instance | str | Path, digits: int = 20, **options: Any) -> Proof:
    """Solve an instance and prove that the solution is a strict local minimum.

    Parameters
    ----------
    instance
        An instance, or the name or path of one, which is then loaded.
    digits
        Significant digits of the enclosures, from 6 to 60.
    options
        Options of the table [solver], which override those of the instance.

    Returns
    -------
    Proof
        The proof; if nothing is proved, ``status`` and ``reason`` say why.

    Raises
    ------
    BadInput
        If the instance cannot be used, with a one-line message that says what is wrong, where, and what to do.

    Examples
    --------
    ::

        proof = satsym.prove("return-to-orbit")
        proof.status, proof.objective.text, proof.costate_initial["r"].text
    """
    case = as_case(instance)
    case = case.with_(solver=options) if options else case
    return proved(case.case, lambda: solvers.solve(case.case), digits)
