"""A proof on the page of a run and in LaTeX: whole, in each language, and only where it is asked for."""

from __future__ import annotations

import re
from functools import cache

import pytest

import satsym
from satsym.front.proving import Proof
from satsym.proof.record import Outcome
from satsym.report.latex.tex import escape
from satsym.report.page.run import Given, render
from tests.cli.test_cli import Run, run

__all__ = ["run"]


@cache
def solved() -> tuple[satsym.Solution, Proof]:
    solution = satsym.solve("double-integrator-fuel")
    return solution, solution.prove()


@pytest.mark.slow
def test_a_page_has_the_theorem_its_hypotheses_and_all_digits() -> None:
    solution, proof = solved()
    assert proof.status is Outcome.PROVED
    assert proof.theorem is not None
    assert proof.objective is not None
    page = render(solution.found, None, Given("double-integrator-fuel"), proof=proof)
    section = re.search(r'<section id="proof">(.*?)</section>', page, re.DOTALL)
    assert section is not None
    texts = [*proof.theorem.claims, proof.theorem.source, *(h.name[1:] for h in proof.hypotheses)]
    enclosures = [proof.objective, *proof.switching_times, *proof.costate_initial.values(), *proof.x_final.values()]
    for text in (*texts, *(v.centre for v in enclosures), *(v.radius for v in enclosures)):
        assert text in section[1], text
    assert "satsym prove double-integrator-fuel" in page
    assert '<section id="proof">' not in render(solution.found, None, Given("double-integrator-fuel"))


def test_latex_has_the_same_with_its_digits_in_groups() -> None:
    _, proof = solved()
    assert proof.objective is not None
    assert proof.theorem is not None
    text = proof.latex()
    assert r"\begin{document}" in text
    assert r"0.76393\,20225" in text
    plain = (
        text.replace("$H$", "H")
        .replace("$H_{uu}$", r"H\_uu")
        .replace("$10^{-6}$", "1e-06")
        .replace("$W(t_0)$", "W(t0)")
    )
    for said in (*proof.theorem.claims, *(h.shown.partition(" = ")[0] for h in proof.hypotheses)):
        assert escape(said)[1:] in plain
    assert r"$-1 \times" not in text
    assert r"\operatorname{diag}" in text, "W(t0) is a formula"
    assert all(rf"\texttt{{{number}}}" in text for number in proof.numbers.values())
    assert r"\begin{document}" not in proof.latex(fragment=True)
    assert r"0{,}76393\,20225" in proof.latex("id")
    assert "Teorema" in proof.latex("id")


def test_a_page_says_why_nothing_is_proved(run: Run, tmp_path) -> None:
    page = tmp_path / "page.html"
    code, _, _ = run("report", "fuller", "--html", str(page), "--prove", "--set", "time.tf=2.5")
    assert code in (0, 5)
    assert "chattering controls" in page.read_text()


@pytest.mark.slow
def test_the_command_typesets_what_it_proves(run: Run, tmp_path) -> None:
    code, out, _ = run("prove", "double-integrator-time", "--latex", str(tmp_path / "proof.tex"))
    assert code == 0
    assert "proof.tex" in out
    assert r"2.00000" in (tmp_path / "proof.tex").read_text()
