"""A derivation as a document: it compiles, says everything in every language, and is the same every time."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import get_args

import pytest
from sympy import Matrix, Symbol, cos, sin, sqrt, tan

import satsym.symbolic
from satsym.report.latex import tex
from satsym.report.latex.document import render
from satsym.report.latex.equations import width
from satsym.report.latex.preamble import SIZES
from satsym.report.texts import MissingText, languages, load
from satsym.spec import ControlSetKind
from satsym.status import BadInput
from satsym.symbolic import Derivation, FirstOrder, Newton, Problem, Variable, symbols_of, t
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.switching.phase_plane import phase_plane
from tests.support import derived as shared

NASTY = r"100 % of a_b & {c} #1 $x$ ~ ^ \input{x} <“q”> -- 'é' α Ω 日 € 10⁻³"
needs_tex = pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex to compile with")


def variables(*names: str) -> tuple[Variable, ...]:
    return tuple(Variable(name.replace("\\", ""), name, meaning=NASTY) for name in names)


def double_integrator() -> Problem:
    states, controls = variables("place", "speed"), variables("push")
    (place, speed), (push,) = symbols_of(states), symbols_of(controls)
    model = FirstOrder(
        name="cart", title=NASTY, states=states, controls=controls, parameters=(), rates={place: speed, speed: push}
    )
    return Problem(name="double_integrator", title=NASTY, model=model, running_cost=1 + push**2 / 2)


def cartesian() -> Problem:
    """Newton's law with a ball of controls, a terminal constraint and no terminal cost."""
    states, controls, parameters = variables("x1", "x2", "v1", "v2"), variables("w1", "w2"), variables(r"\mu")
    x1, x2, v1, v2 = symbols_of(states)
    thrust, (mu,) = Matrix(symbols_of(controls)), symbols_of(parameters)
    place = Matrix([x1, x2])
    model = Newton(
        name="cartesian",
        title="Two bodies",
        states=states,
        controls=controls,
        parameters=parameters,
        coordinates={x1: v1, x2: v2},
        directions={"e_1": Matrix([1, 0]), "e_2": Matrix([0, 1])},
        position=place,
        forces={"gravity_&": -mu / sqrt(x1**2 + x2**2) ** 3 * place, "thrust": thrust},
    )
    return Problem(
        name="cartesian",
        title="Two bodies",
        model=model,
        running_cost=thrust.dot(thrust) / 2,
        terminal_constraints=(x1 * v2 - x2 * v1 - 1, x1**2 + x2**2 - 1),
        control_set="ball",
    )


def long_equations() -> Problem:
    """Motion about an oblate planet: everything that can be too wide is, and time is explicit."""
    states = variables("r", r"\theta", r"\varphi", "v", "a", "b")
    controls, parameters = variables("w1", "w2", "w3"), variables(r"\mu", "J", "R")
    r, _, phi, v, a, b = symbols_of(states)
    w1, w2, w3 = symbols_of(controls)
    mu, j2, radius = symbols_of(parameters)
    oblate = 3 * mu * j2 * radius**2 / (2 * r**4)
    rates = (
        v,
        a,
        b,
        r * b**2 + r * a**2 * cos(phi) ** 2 - mu / r**2 - oblate * (1 - 3 * sin(phi) ** 2) + w1 * cos(2 * t),
        2 * a * b * tan(phi) - 2 * v * a / r + w2 / (r * cos(phi)),
        -2 * v * b / r - a**2 * sin(phi) * cos(phi) - 2 * oblate / r * sin(phi) * cos(phi) + w3 / r,
    )
    model = FirstOrder(
        name="oblate",
        title="Motion about an oblate planet",
        states=states,
        controls=controls,
        parameters=parameters,
        rates=dict(zip(symbols_of(states), rates, strict=True)),
    )
    cost = (w1**2 + w2**2 + w3**2) / 2
    return Problem(name="oblate", title="Long", model=model, running_cost=cost, control_set="box")


MADE = (double_integrator, cartesian, long_equations)
OWN = (*(f.__name__ for f in MADE), "cart")


@cache
def derived(name: str) -> Derivation:
    if name == "cart":
        return shared.derived(double_integrator().model)
    made = {f.__name__: f for f in MADE}
    return shared.derived(made[name]()) if name in made else shared.shipped(name)


def compiled(text: str, folder: Path) -> str:
    """The log of the run after which another one would change nothing, the third at the latest."""
    (folder / "it.tex").write_text(text, encoding="utf-8")
    before = None
    for draft in (["-draftmode"], [], []):
        command = ["pdflatex", *draft, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "it.tex"]
        done = subprocess.run(command, cwd=folder, capture_output=True, check=False, stdin=subprocess.DEVNULL)
        assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
        references = (folder / "it.aux").read_bytes()
        if references == before:
            break
        before = references
    return (folder / "it.log").read_text(encoding="utf-8", errors="replace")


COMPLAINT = re.compile(
    r"(?:Over|Under)full \\[hv]box.*|^(?!Package: ).*[Ww]arning.*|Missing character.*|.*undefined.*", re.M
)


def assert_clean(log: str) -> None:
    assert COMPLAINT.findall(log) == []


def filled(pdf: Path) -> list[float]:
    """How much of each page but the last is filled, from its top to its lowest line of text."""
    boxes = subprocess.run(["pdftotext", "-bbox", pdf, "-"], capture_output=True, check=True, text=True).stdout
    pages = [sorted(float(y) for y in re.findall(r'yMax="([\d.]+)"', page)) for page in boxes.split("<page ")[1:]]
    height, foot = 240 * 72 / 25.4, 30  # of the text, and what parts it from the number of the page
    return [1 - (ys[-1] - foot - max(y for y in ys if y < ys[-1] - foot / 2)) / height for ys in pages[:-1]]


@needs_tex
@pytest.mark.slow
@pytest.mark.parametrize("language", languages())
def test_what_is_typeset_compiles_within_its_margins_and_every_reference_leads_somewhere(
    language: str, whole: bool, tmp_path: Path
) -> None:
    drawn = shared.drawn()[languages().index(language) :: len(languages())]  # each in one language
    names = [*OWN, *(shared.names() if whole else drawn)]
    preamble, _, _ = render(derived(names[0]), language).partition("\\begin{document}")
    bodies = [f"\\typeout{{{name}}}\n{render(derived(name), language, standalone=False)}" for name in names]
    text = f"{preamble}\\begin{{document}}\n" + "\n\\clearpage\n".join(bodies) + "\\end{document}\n"
    assert_clean(compiled(text, tmp_path))


@needs_tex
@pytest.mark.slow
@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize(
    "name", [OWN[0], *(pytest.param(name, marks=pytest.mark.study) for name in (*OWN[1:], *shared.names()))]
)
def test_document_compiles_by_itself(name: str, language: str, tmp_path: Path) -> None:
    assert_clean(compiled(render(derived(name), language), tmp_path))
    if shutil.which("pdftotext"):
        assert min(filled(tmp_path / "it.pdf"), default=1) > 0.7


@needs_tex
@pytest.mark.slow
def test_compiled_twice_a_document_has_the_same_bytes_title_and_bookmarks(tmp_path: Path) -> None:
    text, folders = render(derived("double_integrator_energy")), (tmp_path / "one", tmp_path / "two")
    for folder in folders:
        folder.mkdir()
        compiled(text, folder)
    one, two = ((folder / "it.pdf").read_bytes() for folder in folders)
    assert one == two
    marks = (folders[0] / "it.out").read_text(encoding="utf-8")
    assert len(derived("double_integrator_energy").steps) < marks.count("BOOKMARK")
    assert f"pdftitle={{{tex.escape(derived('double_integrator_energy').title)}}}" in text


@needs_tex
@pytest.mark.slow
def test_two_fragments_share_a_document_without_hyperref(tmp_path: Path) -> None:
    fragments = [render(derived(name), standalone=False) for name in ("cartesian", "double_integrator")]
    packages = re.search(r"Needs the packages (.*)\.\n", fragments[0])[1]
    preamble = f"\\documentclass[11pt]{{article}}\\usepackage{{{packages.replace(' ', '')}}}\n"
    margins = "\\usepackage[T1]{fontenc}\\usepackage[width=160mm]{geometry}\n"
    body = "\n".join(fragments)
    text = (
        f"{preamble}{margins}\\begin{{document}}\n{body}\n\\eqref{{cartesian:linearisation.A_x1_v2}}\\end{{document}}"
    )
    assert_clean(compiled(text, tmp_path))


@needs_tex
@pytest.mark.slow
def test_widths_are_estimated_as_tex_measures_them(tmp_path: Path) -> None:
    derivation = derived("long_equations")
    typeset = Typesetter(derivation)
    formulas = [typeset.tex(side) for s in derivation.steps for e in s.equations for side in (e.lhs, e.rhs)]
    wide = [f for f in dict.fromkeys(formulas) if width(f) > 8]
    measure = "".join(rf"\setbox0\hbox{{$\displaystyle {f}$}}\typeout{{width=\the\wd0}}" + "\n" for f in wide)
    head = f"\\documentclass[11pt]{{article}}\\usepackage{{amsmath}}{SIZES}\n"
    text = rf"{head}\begin{{document}}{measure}x\end{{document}}"
    points = [float(p) for p in re.findall(r"^width=([\d.]+)pt", compiled(text, tmp_path), re.MULTILINE)]
    ratios = [width(f) / (p / 10.95) for f, p in zip(wide, points, strict=True)]
    assert 0.97 < min(ratios) <= max(ratios) < 1.4


@pytest.mark.slow
@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", shared.each(*OWN))
def test_every_equation_has_one_label_and_every_reference_a_label(name: str, language: str) -> None:
    derivation, text = derived(name), render(derived(name), language)
    labels = re.findall(r"\\label\{([^}]*)\}", text) + re.findall(r"\\satsymstep\{([^}]*)\}", text)
    labels += [label for group in re.findall(r"\\satsymalso\{\d+\}\{([^}]*)\}", text) for label in group.split(",")]
    labels = [label for label in labels if not label.startswith(("#", "\\"))]
    assert len(labels) == len(set(labels))
    assert {f"{derivation.name}:{s.name}.{e.name}" for s in derivation.steps for e in s.equations} <= set(labels)
    assert set(re.findall(r"\\(?:eq)?ref\{([^}#]*)\}", text)) <= set(labels)
    assert not re.search(r"<\w+>", re.sub(r"%.*", "", text))  # a place that nothing was filled into


@pytest.mark.slow
@pytest.mark.parametrize("file", ["double_integrator", pytest.param("polar_orbit", marks=pytest.mark.study)])
def test_rendering_is_byte_identical_for_every_hash_seed(file: str) -> None:
    code = (
        "import sys; from satsym.symbolic import derive, loader; from satsym.report.latex.document import render\n"
        f"sys.stdout.reconfigure(encoding='utf-8'); (problem, *_) = loader.load(loader.find('{file}'))\n"
        "print(render(derive(problem)))"
    )
    texts = set()
    for seed in ("0", "1"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, check=True)
        texts.add(done.stdout)
    assert len(texts) == 1


def test_no_page_of_the_table_has_one_quantity_of_a_group_alone() -> None:
    table = render(shared.shipped("polar_orbit")).partition(r"\endfoot")[2].partition(r"\end{longtable}")[0]
    groups = [part.strip().splitlines() for part in table.split(r"\addlinespace")]
    ends = [[re.search(r"\\\\(\*?)$", line)[1] for line in lines] for lines in groups]
    assert ends[0] == ["*", "*", "", "*", ""]
    assert all(each == ["*", ""] for each in ends if len(each) == 2)
    rows = [end for group in ends for end in group]
    assert rows[-4:] == ["*", "*", "*", ""]


def test_a_unit_that_no_quantity_has_takes_no_column() -> None:
    plain, physical = (render(shared.shipped(name)) for name in ("bryson_denham", "polar_orbit"))
    assert r"Symbol & Name & Default & Meaning \\" in plain
    assert r"\multicolumn{4}{@{}l}{\textit{States}}" in plain
    assert r"Symbol & Name & Unit & Default & Meaning \\" in physical


def test_what_leads_to_something_is_not_the_last_line_of_a_page() -> None:
    text = render(shared.shipped("polar_orbit"))
    assert re.search(r"\n\\satsymroom\{\d+\}\nThe quantities are as follows", text)
    assert "step by step:\\nopagebreak\n" in text
    assert r"\begin{thebibliography}{9}\samepage" in text


def test_works_are_listed_in_the_order_in_which_they_are_cited() -> None:
    text = render(shared.shipped("polar_orbit"))
    cited = [key for keys in re.findall(r"\\cite\{([^}]*)\}", text) for key in keys.split(",")]
    assert re.findall(r"\\bibitem\{([^}]*)\}", text) == list(dict.fromkeys(cited)) != sorted(cited)
    assert "Bryson and Y" in text
    assert "Bryson dan Y" in render(shared.shipped("polar_orbit"), "id")


def test_what_bounds_of_controls_leave_as_it_is_is_not_shown_again() -> None:
    text = render(shared.shipped("inspection"))
    assert "inspection:mixed_costates" not in text
    assert r"$\Gamma_{4}$ contain no state, the costate equations do not change" in text


def test_bodies_are_named_in_the_language_of_the_document() -> None:
    text = render(shared.shipped("pitch_wheel"), "id")
    assert r"\mathrm{roda}" in text
    assert r"\mathrm{wheel}" not in text
    assert r"\mathrm{wheel}" in render(shared.shipped("pitch_wheel"))


def test_measured_noise_is_not_printed() -> None:
    derivation = derived("double_integrator")
    noisy = tuple(replace(s, checks=tuple(replace(c, error=c.error * 1.7) for c in s.checks)) for s in derivation.steps)
    assert render(replace(derivation, steps=noisy)) == render(derivation)


def test_what_people_write_is_escaped() -> None:
    assert tex.escape(r"a_b & 50 % {x} #1 $ ~ ^ \input <>") == (
        r"a\_b \& 50 \% \{x\} \#1 \$ \textasciitilde{} \textasciicircum{} \textbackslash{}input "
        r"\textless{}\textgreater{}"
    )
    assert tex.escape("é ö ß ž") == "é ö ß ž"
    assert tex.escape("α Ω Ο") == r"\ensuremath{\alpha} \ensuremath{\Omega} \texttt{U+039F}"
    assert tex.escape("日\n\t\x07x\x00") == r"\texttt{U+65E5} x"
    assert tex.escape("a pole at -E, well-known") == r"a pole at \ensuremath{-}E, well-known"
    assert tex.escape("--- – “x”") == r"-{}-{}- \textendash{} ``x''"


def test_names_of_axes_and_variables_within_words_are_set_as_in_formulas() -> None:
    notation = {"xi": r"\xi", "l": r"\ell"}
    assert tex.worded("rate of xi", notation) == r"rate of~$\xi$"
    assert tex.worded("sumbu x benda (l, x)", notation) == r"sumbu~$x$ benda~($\ell$, $x$)".replace(", $", ",~$")
    assert tex.worded("a pole at -E, well-known", {}) == r"a pole at~$-E$, well-known"
    assert tex.worded("I, a_b and the body's mass 1", {}) == tex.escape("I, a_b and the body's mass") + "~1"


def test_units_and_numbers_are_set_as_people_write_them() -> None:
    assert tex.unit("km**3/s**2") == r"$\mathrm{km^{3}/s^{2}}$"
    assert tex.unit("kg*m^2") == r"$\mathrm{kg\,m^{2}}$"
    assert tex.unit("rad/V/s") == r"$\mathrm{rad/(V\,s)}$"
    assert tex.unit("ohm") == r"$\mathrm{\Omega}$"
    assert tex.number(1 / 9) == "$1/9$"
    assert tex.unit("1") == tex.number(None) == "--"
    assert tex.unit("50 $ per _") == r"\texttt{50 \$ per \_}"
    assert [tex.number(x) for x in (1.0, -0.25, 398600.4418, 1e-15, 2.5e20, 14076539e9)] == [
        "$1$",
        "$-0.25$",
        "$398600.4418$",
        "$10^{-15}$",
        r"$2.5 \times 10^{20}$",
        r"$1.4076539 \times 10^{16}$",
    ]


def test_languages_have_the_same_keys_and_places_to_fill_in() -> None:
    english = load("en")
    assert {"en", "id"} <= set(languages())
    for language in languages():
        texts = load(language)
        assert {t: set(keys) for t, keys in texts.tables.items()} == {
            t: set(keys) for t, keys in english.tables.items()
        }
        for table, keys in texts.tables.items():
            for key, text in keys.items():
                assert text.strip() or key == "comma"
                assert set(re.findall(r"<\w+>", text)) == set(re.findall(r"<\w+>", english.tables[table][key]))


@cache
def all_calls() -> tuple[ast.Call, ...]:
    """Calls of functions by their names in the derivation engine."""
    files = sorted(Path(satsym.symbolic.__file__).parent.rglob("*.py"))
    nodes = (node for path in files for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    return tuple(node for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name))


def calls(function: str) -> list[ast.Call]:
    """Those of one function."""
    return [call for call in all_calls() if call.func.id == function]


def written(node: ast.expr) -> list[str]:
    """Texts that an argument can be, as far as they are written there."""
    if isinstance(node, ast.Constant):
        return [node.value]
    if isinstance(node, ast.JoinedStr):
        (start, _) = node.values
        assert isinstance(start, ast.Constant)
        return [f"{start.value}{kind}" for kind in get_args(ControlSetKind)]
    return []


@pytest.mark.parametrize("language", languages())
def test_every_rule_claim_and_title_that_the_engine_can_use_has_a_text(language: str) -> None:
    texts = load(language)
    claims = [
        c
        for f in ("Check", "compare", "identity", "never_below", "positive")
        for call in calls(f)
        for c in written(call.args[0])
    ]
    rules = [rule for call in calls("Step") for rule in written(call.args[1])]
    titles = [name for call in calls("Step") for name in written(call.args[0])]
    assert len(claims) > 15
    assert len(rules) > 15
    for table, keys in (("claims", claims), ("rules", rules), ("titles", titles)):
        for key in keys:
            texts.get(table, key)


def test_a_rule_claim_or_step_without_a_text_is_named() -> None:
    derivation = derived("double_integrator")
    first, *rest = derivation.steps
    strange = {
        'there is no text for "magic" in [rules]': replace(first, rule="magic"),
        'there is no text for "so I am told" in [claims]': replace(
            first, checks=(replace(first.checks[0], claim="so I am told"),)
        ),
        'there is no text for "leap" in [titles]': replace(first, name="leap"),
    }
    for message, step in strange.items():
        with pytest.raises(MissingText, match=re.escape(f"en.toml: {message}")):
            render(replace(derivation, steps=(step, *rest)))


def test_a_language_without_texts_is_bad_input() -> None:
    with pytest.raises(BadInput, match='there is no translation into the language "xx"; there are en, id'):
        render(derived("double_integrator"), language="xx")


def test_beside_a_variable_j_the_cost_functional_has_another_letter() -> None:
    other, plain = render(derived("long_equations"), "en"), render(derived("double_integrator"), "en")
    assert r"\mathcal{C} = \int" in re.sub(r"[ &]+", " ", other)
    assert not re.search(r"(?<![A-Za-z])J =", re.sub(r"[ &]+", " ", other))
    assert r"J = \int" in re.sub(r"[ &]+", " ", plain)
    assert r"\mathcal{C}" not in plain


def test_appendices_stand_before_the_references() -> None:
    text = render(shared.shipped("polar_orbit"))
    assert 0 < text.index("\\appendix") < text.index(r"\section{Checks}") < text.index(r"\begin{thebibliography}")


def test_a_linearisation_says_where_it_divides_by_a_norm_that_vanishes() -> None:
    said = shared.shipped("transfer_fuel").step("linearisation").conclusions
    assert [one.key for one in said] == ["divided by a norm"]
    assert r"$B$ contains a division by $\sqrt{T_r^{2} + T_\theta^{2}}$, which vanishes where" in render(
        shared.shipped("transfer_fuel")
    )
    assert shared.shipped("polar_orbit").step("linearisation").conclusions == ()


def test_what_ranks_mean_is_said_after_each_input_and_output() -> None:
    text = render(shared.shipped("clohessy_wiltshire"))
    step = text.partition(r"}{Controllability}")[2].partition(r"}{Observability}")[0]
    places = [
        step.index(said)
        for said in ("the model is controllable", "For the input $u_1$ alone", "has dimension $3$ of $4$")
    ]
    assert places == sorted(places)
    assert places[-1] < step.index("For the input $u_2$ alone") < step.index("controllable from the input $u_2$ alone")


def test_the_phase_plane_of_least_time_leads_to_the_target_along_the_curve() -> None:
    derivation = shared.shipped("pitch_minimum_time")
    plane = phase_plane(derivation)
    assert plane is not None
    curve = derivation.equation("switching_curve.curve").rhs
    ones = {s: 0 if s.name.startswith("target") else -1 if s.name.endswith("_min") else 1 for s in curve.free_symbols}
    for q, v in plane.curve:
        assert float(curve.xreplace({**ones, Symbol(plane.rate, real=True): v})) == pytest.approx(q)
    for first, second in plane.trajectories:
        assert first[-1] == second[0]
        assert float(curve.xreplace({**ones, Symbol(plane.rate, real=True): second[0][1]})) == pytest.approx(
            second[0][0]
        )
        assert second[-1] == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.slow
def test_bodies_are_typeset_as_matrices_whose_longer_entries_an_appendix_has() -> None:
    text = render(shared.shipped("gimballed_wheel"))
    body, _, appendix = text.partition("\\appendix")
    assert r"W^{\mathrm{wheel}} = \left(\begin{array}" in re.sub(r"&|  +", "", body).replace("}  =", "} =")
    assert r"\label{gimballed_wheel:kane.part_1}" in appendix
    assert r"\label{gimballed_wheel:kane.M}" in body
    assert r"\begin{multicols}{2}" in appendix
