"""`satsym read`: displays found with number, section and place; a ledger drafted, confirmed, read again and judged."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing import audit
from satsym.auditing.document import displays
from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.tokens import Unread, tokens
from satsym.cli import main
from satsym.formula.writing import written

PAPER = r"""
\documentclass{article}
\newcommand{\thd}{\dot\theta}
\newcommand{\half}[1]{\frac{1}{2}#1}
\begin{document}
\section{Motion}
\begin{equation}\label{eq:radial} % a comment with $$ in it
\ddot r - r\thd^2 = -\frac{\mu}{r^2} + u_1,
\end{equation}
\begin{align}
r\ddot\theta + 2\dot r\thd &= u_2, \label{eq:t}\\
\dot x_1 &= x_2, \nonumber\\
\dot x_4 &= -\frac{2x_2x_4 + u_2}{x_1}.
\end{align}
\subsection{Control}
\begin{equation}\label{eq:H}
H = \half{(c_1u_1^2 + c_2u_2^2)} + \lambda_1x_2 + \lambda_2\left(x_1x_4^2-\frac{\mu}{x_1^2}+u_1\right)
+\lambda_3x_4 + \lambda_4\frac{u_2-2x_2x_4}{x_1}
\end{equation}
From \eqref{eq:H},
\[ \dot\lambda_2 = -\lambda_1 + \frac{2\lambda_4 x_4}{x_1} \]
\begin{equation} J = \int_0^{T} L \end{equation}
\input{more}
\end{document}
"""
MORE = "\\begin{equation*} u_1^* = -\\frac{\\lambda_2}{c_1} \\end{equation*}\n"


@pytest.fixture
def paper(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "more.tex").write_text(MORE)
    path = tmp_path / "paper.tex"
    path.write_text(PAPER)
    return path


def test_displays_have_number_label_section_and_place(paper: Path) -> None:
    source = displays.read(paper)
    found = [(d.item, d.label, d.section, d.place.rpartition("/")[2]) for d in displays.displays(source)]
    motion, control = "section 1 Motion", "section 1.1 Control"
    assert found == [
        ("1", "eq:radial", motion, "paper.tex:7"),
        ("2", "eq:t", motion, "paper.tex:11"),
        ("line 12", "", motion, "paper.tex:12"),
        ("3", "", motion, "paper.tex:13"),
        ("4", "eq:H", control, "paper.tex:16"),
        ("line 21", "", control, "paper.tex:21"),
        ("5", "", control, "paper.tex:22"),
        ("line 1", "", control, "more.tex:1"),
    ]
    assert set(source.macros) == {"thd", "half"}


def test_displays_that_macros_begin_and_end_are_found_at_their_lines(tmp_path: Path) -> None:
    path = tmp_path / "short.tex"
    begins = r"\newcommand{\be}{\begin{equation}}" + "\n" + r"\def\ee{\end{equation}}" + "\n"
    path.write_text(begins + "\\be\nx = a \\ee\n\\input{part}\n\\be = b + \\beta \\ee\n")
    (tmp_path / "part.tex").write_text("\n\\be y = b \\ee\n")
    found = list(displays.displays(displays.read(path)))
    assert [display.text.strip() for display in found] == ["x = a", "y = b", r"b + \beta"]
    assert [display.place.rpartition("/")[2] for display in found] == ["short.tex:4", "part.tex:2", "short.tex:6"]


def test_a_draft_is_judged_and_confirmed_rows_are_kept(paper: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["read", "paper.tex", "--model", "polar_orbit"]) == 0
    out = capsys.readouterr().out
    assert "7 ledger rows drafted, 0 confirmed rows kept" in out
    assert "paper.tex:22: not read: integrals without a differential" in out
    ledger = paper.with_suffix(".ledger.toml")
    found = {row.key: row.verdict for row in audit(auditing.read(ledger))}
    assert [key for key, verdict in found.items() if verdict != "confirmed"] == ["3"]
    text = ledger.read_text()
    head, first, *others = text.split("[[row]]\n")
    confirmed = first.replace("draft = true\n", "").replace('kind = "equation"', 'kind = "equation"\nsays = "Newton"')
    ledger.write_text("[[row]]\n".join([head, confirmed, *others]))
    paper.write_text(PAPER.replace(r"\dot x_1 &= x_2, \nonumber\\", ""))
    assert main(["read", "paper.tex"]) == 0
    assert "5 ledger rows drafted, 1 confirmed rows kept" in capsys.readouterr().out
    again = ledger.read_text()
    assert 'says = "Newton"' in again
    assert again.count("draft = true\n") == 5


def test_the_rate_of_a_state_without_a_velocity_is_a_letter_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rate = r"\dot\beta = \frac{e (e + \cos f)}{1 + e^2 + 2 e \cos f} \dot f"
    Path("orbit.tex").write_text(rf"\begin{{equation}} {rate} \end{{equation}}")
    assert main(["read", "orbit.tex", "--model", "velocity_frame"]) == 0
    assert [row.verdict for row in audit(auditing.read(tmp_path / "orbit.ledger.toml"))] == ["confirmed"]


def test_rates_of_states_are_what_the_equations_of_motion_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("orbit.tex").write_text(r"\begin{equation} r^2 \dot f = h \end{equation}")
    assert main(["read", "orbit.tex", "--model", "velocity_frame"]) == 0
    path = tmp_path / "orbit.ledger.toml"
    assert [row.verdict for row in audit(auditing.read(path))] == ["confirmed"]
    path.write_text(path.read_text().replace('printed = "h"', 'printed = "2*h"'))
    assert [row.verdict for row in audit(auditing.read(path))] != ["confirmed"]


def test_displays_of_myst_have_their_labels_as_items(tmp_path: Path) -> None:
    path = tmp_path / "notes.md"
    path.write_text(
        "# Hill\n\nSee {eq}`out`.\n\n:::{math}\n:label: out\n\\ddot z = -n^2 z\n:::\n\n```{math}\n\\dot z = 0\n```\n"
    )
    found = [(d.item, d.label, d.text.strip(), d.refers) for d in displays.displays(displays.read(path))]
    assert found == [("out", "out", r"\ddot z = -n^2 z", ("out",)), ("line 11", "", r"\dot z = 0", ("out",))]


def test_no_display_of_markdown_is_lost_and_no_bracket_is_one(tmp_path: Path) -> None:
    path = tmp_path / "notes.md"
    blocks = [f"```{{math}}\nx_{k} &= {k} \\\\ &= {k}\n```\n" for k in range(4)]
    listed = "1. So\n\n   ```math\n   y = 1\n   ```\n"
    path.write_text("\n".join([*blocks, listed, "| mass \\[kg\\] | 3 |\n", "> $$z =\n> 2$$\n"]))
    found = [(d.text.split()[0], d.columns) for d in displays.displays(displays.read(path))]
    assert found == [*((f"x_{k}", "split") for k in range(4)), ("y", ""), ("z", "")]
    assert "kg" not in "".join(d.text for d in displays.displays(displays.read(path)))
    assert all(">" not in d.text for d in displays.displays(displays.read(path)))


@pytest.mark.parametrize(
    ("body", "texts"),
    [
        (r"J &= \sum_{k=0}^N \\ & (a_k + b)", 1),
        (r"& -1 \le u \\ & -2 \le v", 2),
        (r"a &= b \\ &- c", 1),
        (r"a &= b \\ & c = d", 2),
    ],
)
def test_lines_that_go_on_are_one_display(tmp_path: Path, body: str, texts: int) -> None:
    path = tmp_path / "paper.tex"
    path.write_text(rf"\begin{{align}} {body} \end{{align}}")
    assert len(list(displays.displays(displays.read(path)))) == texts


def test_markdown_is_read_too(tmp_path: Path) -> None:
    path = tmp_path / "notes.md"
    path.write_text("# Hill\n\n$$\\ddot z = n^2 z$$\n\n```\n$$not = this$$\n```\n\nand `$$nor = that$$`\n")
    assert main(["read", str(path), "--model", "hill"]) == 0
    ledger = auditing.read(path.with_suffix(".ledger.toml"))
    assert [row.derived for row in audit(ledger)] == ["z_ddot = -n**2*z"]


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("paper.pdf", b"%PDF-1.7", "PDF files cannot be read"),
        ("paper.tex", b"%PDF-1.7", "PDF files cannot be read"),
        ("paper.tex", b"line\n\xff\xfe$$x=1$$", "paper.tex:2: not UTF-8 text"),
        ("paper.tex", b"$" * 6_000_000, "the document has more than 5,000,000 bytes"),
    ],
)
def test_what_is_no_document_is_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, content: bytes, reason: str
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    assert main(["read", str(path), "--model", "hill"]) == 3
    err = capsys.readouterr().err
    assert reason in err
    assert err.count("\n") == 1


MACROS = [
    (r"\newcommand{\v}[2][x]{#1_{#2}}", r"\v{2} = \v[y]{3}", "x2 = y3"),
    (
        r"\newcommand*\pd[3][]{\frac{\partial^{#1} #2}{\partial #3^{#1}}}",
        r"\pd{f}{x} = \pd[2]{f}{x}",
        "diff(f, x) = diff(diff(f, x), x)",
    ),
    (r"\providecommand*{\R}{R}", r"\R = 3", "R = 3"),
    (r"\def\x#1#2{\dot #1_#2}", r"\x{a}{b} = 3", "d_a_b = 3"),
    (r"\let\eps\varepsilon \let\E=\eta", r"\eps = \E", "varepsilon = eta"),
    (r"\DeclareMathOperator*{\argmin}{arg\,min}", r"u = \argmin_u J", "u = argmin(J, u)"),
    (r"\DeclareMathOperator{\sn}{sn}", r"\sn(u) = 3", "sn(u) = 3"),
    (
        r"\DeclarePairedDelimiter{\size}{\lvert}{\rvert}",
        r"\size{x} = \size*{y} + \size[\Big]{z}",
        "abs(x) = abs(y) + abs(z)",
    ),
    (r"\NewDocumentCommand{\q}{O{a} m}{#1_{#2}}", r"\q{b} = \q[c]{b}", "a_b = c_b"),
    (r"\def\f(#1,#2){#1 #2}", r"\f(a,b) = 3", r"the definition of \f is not supported"),
    (r"\NewDocumentCommand{\q}{m o}{#1}", r"\q{b} = 3", r"the definition of \q is not supported"),
]


@pytest.mark.parametrize(("definition", "formula", "meant"), MACROS)
def test_a_macro_is_read_as_it_is_defined_or_refused_where_it_stands(
    tmp_path: Path, definition: str, formula: str, meant: str
) -> None:
    path = tmp_path / "paper.tex"
    path.write_text(f"{definition}\n\n\\[ {formula} \\]\n")
    source = displays.read(path)
    (display,) = displays.displays(source)
    assert display.place.endswith(":3")
    assert _understood(source, display) == (meant, display.place)


def _understood(source: displays.Source, display: displays.Display) -> tuple[str, str]:
    try:
        found = read(tokens(display.text, source.macros, display.start), display.text, display.start)
    except Unread as error:
        return error.message, source.place(error.at)
    return "; ".join(map(written, found.statements)), display.place


HOSTILE = [
    (r"\newcommand{\a}{\a\a}$$\a = 1$$", "nested too deeply"),
    (
        r"\newcommand{\a}{xxxxxxxxxx}\newcommand{\b}{" + r"\a" * 200 + r"}\newcommand{\c}{" + r"\b" * 200 + "}$$\\c$$",
        "more than",
    ),
    ("$$" + "{" * 5000 + "x" + "}" * 5000 + "$$", ""),
    ("$$" + "(" * 200 + "x" + ")" * 200 + "$$", "nested more than"),
    ("$$" + r"\sin" * 2000 + "x = 1$$", "nested more than"),
    ("$$" + r"\sum_i " * 1500 + "x_i = 1$$", "nested more than"),
    (r"$$x^{x^{x^x}} = 1$$", "exponents of several letters"),
    (r"$$\begin{pmatrix}1&2\\3\end{pmatrix} = A$$", "all rows of a matrix must have the same length"),
    (r"\input{../../etc/passwd}", "is not in the folder"),
    (r"\input{paper}", "includes itself"),
    (r"$$\csname x\endcsname = 1$$", "is not supported here"),
    ("$$x = " + "1" * 15000 + "$$", "more than 30 digits"),
]


@pytest.mark.parametrize(("text", "reason"), HOSTILE)
def test_hostile_latex_is_listed_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, reason: str
) -> None:
    path = tmp_path / "paper.tex"
    path.write_text(text + "\n$$\\ddot\\zeta = -\\omega^2\\zeta$$\n")
    assert main(["read", str(path), "--model", "hill"]) == 0
    out = capsys.readouterr().out
    assert "not read" in out
    assert reason in out
    assert "paper.tex:1: " in out
    assert "holds = \"subs('hill:first_order.zeta_dot" in path.with_suffix(".ledger.toml").read_text()
