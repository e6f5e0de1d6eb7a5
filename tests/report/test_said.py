"""What is said in Indonesian: all of it, with the same numbers, and nothing of it to programs."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable
from enum import Enum
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym import instance, kernels
from satsym.analysis.orbits.elements import Conic
from satsym.cli.app import program
from satsym.cli.help import texts
from satsym.report import plots, said
from satsym.report.said import counted, decimal, message, numbers, say, spoken, translations
from satsym.report.terminal.keys import keys_text
from satsym.solvers import simulate
from satsym.spec import ProblemSpec
from satsym.status import Status, Verdict
from satsym.symbolic.dimension_algebra import _TOLD
from tests.cli.test_cli import Run, case, run
from tests.support.said import ENGLISH, HOLE, anonymous, looked_up, refused, written
from tests.support.solved import solve

__all__ = ["case", "run"]

INDONESIAN = translations("id")
SAME = {
    *(
        "linear",
        "Venus",
        "Mars",
        "Uranus",
        "radial",
        "periapsis",
        "apoapsis",
        "parabola",
        "parameter",
        "minimum",
        "orbit",
        "model",
        "status",
    ),
    *("model <name>", "<name>, model <model>"),
}
"""Words of both languages."""


NAMES = re.compile(
    r"results/\S*|\S+\.(?:csv|json|npz|png)|derivations/\S+|satsym [^\n]*|\"[^\"]*\"|\[final\]|\w+(?:[.-]\w+)+"
)


def authored(spec: ProblemSpec) -> list[str]:
    variables = (*spec.states, *spec.controls, *spec.parameters, *spec.invariants, *spec.quantities)
    return [spec.title, *(v.meaning for v in variables)]


AUTHORED = {
    *(instance.load(name).title for name in instance.shipped()),
    *(text for name in kernels.shipped() for text in authored(kernels.load(name).spec)),
} - {""}
"""What authors of models and instances wrote."""


def test_every_text_that_is_looked_up_has_a_translation_with_the_same_places() -> None:
    assert len(looked_up()) > 80
    assert [text for text in looked_up() if text not in INDONESIAN] == []
    for english, text in INDONESIAN.items():
        places = [name for name in HOLE.findall(english) if name != "plural"]
        assert Counter(places) == Counter(HOLE.findall(text)), english
        assert text
        assert text != english or english in SAME, english


@pytest.mark.slow
def test_nothing_is_translated_that_is_nowhere_said() -> None:
    known = {*AUTHORED, *written(), *(one.value for one in EVERY), *(anonymous(text) for text in COMPOSED)}
    helping = said.group("id", "help")
    assert sorted(text for text in INDONESIAN.keys() - helping.keys() if anonymous(text) not in known) == []
    assert [
        text for text in helping if not any(map(said._pattern(text).fullmatch, HELP | {*COMPOSED, *looked_up()}))
    ] == []


MET_AT_NONE = ("no final time after the initial time satisfies", "the given final time <when> does not satisfy")
WEIGHTS = ("Q: missing; specify the weights of the states", "R: missing; specify the weights of the inputs")
MISPLACED = (("not after", "a later time"), ("too far from", "a time closer to t0"))
SIZED = "write <size> numbers (the diagonal) or <rows> rows of <each> numbers"
MISSHAPEN = ("the number of entries (<n>) is wrong, or single numbers are mixed with rows", "row <i> has <n> numbers")
UNSUPPORTED = (
    *("", ", an unevaluated derivative", ", which has no closed form", ", an unknown function"),
    *(", a value at another time", ", whose conditions do not cover all times", ", whose derivatives jump"),
)
UNDECIDED = ("the value of <a>", "the norm of a vector")
BETTER_THAN = ("whose states stay near it", "whose states stay near it and whose final time is near")
COMPOSED = (
    "the inputs <a> cannot control the mode s = <b>",
    *(f"give {which} tf_guess" for which in ("a", "another")),
    *(
        f"This extremal is strictly better than all other admissible motions {those}, however different their "
        "controls are "
        "(a strict strong local optimum)."
        for those in BETTER_THAN
    ),
    *(f"<a> contains <b>{what}" for what in UNSUPPORTED),
    "<a> contains the function <b>, which is not supported",
    "<a> is the condition <b>, but must be a number",
    *(
        f"no law is known for {what} on an interval where the minimum principle does not determine it"
        for what in UNDECIDED
    ),
    "the entries of the matrix are not known accurately enough to decide. Either <verdict>: <reason>; or "
    "<other>: <why>",
    *("1 arc", "<number> arcs", "1 arc of <count> steps", "<number> arcs of <count> steps"),
    "there is no published constant <a>",
    "the instance gives no numerical value for <a>",
    *("an integral", "a negation", "a product over an index", "a double sign", "a quantifier"),
    "the constraint of <name> by <value>",
    "<said_which> does not close: it has no period, and therefore neither a monodromy matrix nor multipliers.",
    *("A parabola", "A hyperbola", "A rectilinear orbit", "a number in <unit>"),
    *("structure <arcs>, from <said_origin>", "a table, [<name>]"),
    "estimated error <error> on <n> intervals, found by the direct search",
    *("<name> ends at its lower limit", "<name> ends at its upper limit"),
    *("continued from <begin> to <end> through <n> solutions", "continued from <begin> to <end> through <n> solution"),
    "<name>: there are no results in <folder>; write them with `satsym <command> <again> --plot`, or give "
    "their folder with --from",
    "[control] <key>: the model bounds its controls one by one; write <name> = [lower, upper], and so on",
    "bounds are <lower> and <upper>",
    "[control] <name>: the cost has no term in the square of this control, so it needs both bounds; write "
    "<again> = [lower, upper]",
    *(f"<place>: terminal inequality <name>: {when} it" for when in MET_AT_NONE),
    *(f"[lqr] {which}, or allowed deviations in [lqr.allowed]" for which in WEIGHTS),
    *(f"[time] <key>: <value> is {why} t0 = <start>; give {what}" for why, what in MISPLACED),
    *(
        f"[lqr] <name>: {what}; give <size> numbers (the diagonal) or <rows> rows of <each> numbers"
        for what in MISSHAPEN
    ),
    "[lqr] <key>: no control input remains; name at least one control",
    "[lqr] <key>: the model has no control <name>; available controls: <names>",
    "[classical] <key>: <value> are not both positive, so the loop would not be stable",
    *"Usage Options Commands [OPTIONS]".split(),
    *(f"<value> is not a valid {kind}." for kind in ("integer", "integer range", "float", "float range")),
    *("Missing argument <name>.", "Missing option <name>.", "Try '<command>' for help.", "one of <names>"),
    *(f"the expression {what}" for what in _TOLD.values()),
    "without <names>",
    *("COMMAND [ARGS]...", "Show this message and exit.", "Show the version and exit."),
)
"""What stands nowhere as it is said."""
HELP = {text for command in (program, *program.commands.values()) for text in texts(command)}
EVERY: tuple[Enum, ...] = (*Status, *Verdict, *Conic)


@pytest.mark.parametrize("word", EVERY, ids=str)
def test_every_status_and_verdict_has_a_word(word: Enum) -> None:
    with spoken("id"):
        assert message(word.value) == INDONESIAN[word.value]


@given(
    st.sampled_from(sorted(said.group("id", "messages"))),
    st.text("abc xyz", min_size=1, max_size=6).map(str.strip).filter(bool),
)
def test_a_text_that_was_filled_in_is_known_again(text: str, value: str) -> None:
    """Unless it is what another text says as well, filled in otherwise."""
    holes = {name: value if not name.startswith("said_") else "converged" for name in HOLE.findall(text)}
    english = say(text, **holes)
    with spoken("id"):
        wanted = say(text, **{name: message(part) for name, part in holes.items()})
        assert message(english) != english or text in SAME or wanted == english


MADE_OF_PARTS = {
    "<>: there are no results <>in <>; write them with `satsym <> <> --plot`, or give their folder with --from",
    "[time] <>: <> <> t0 = <>; give <>",
}
"""Refusals with texts among their values, which are translated as they are put together: see what is composed above."""


def test_no_refusal_stays_english() -> None:
    """With a name in each of its places, or a text that is translated where a place is a clause of its own."""
    assert len(refused()) > 400
    filled = {re.sub(r"(^|; |: )<>(?=$|;)", r"\1converged", text) for text in refused() - MADE_OF_PARTS}
    with spoken("id"):
        assert [text for text in filled if message(text.replace("<>", "X7")) == text.replace("<>", "X7")] == []


def test_all_titles_that_are_shipped_are_translated_and_meanings_of_the_satellites() -> None:
    own = {instance.load(name).title for name in instance.shipped()} | {
        text
        for name in ("polar_orbit", "two_body", "pitch_wheel", "hill", "roll_yaw")
        for text in authored(kernels.load(name).spec)
    }
    assert own - {""} - INDONESIAN.keys() == set()


def test_every_key_of_an_instance_file_is_explained_in_indonesian() -> None:
    with spoken("id"):
        listed = keys_text()
    assert not ENGLISH.search(NAMES.sub("", re.sub(r"\[[^]]*\]|^ {2}\S+|simulate --feedback", "", listed, flags=re.M)))
    heads, others = (re.findall(r"^\[.*", text, re.M) for text in (listed, keys_text()))
    assert heads == others != []
    assert re.findall(r"^  KEADAAN  \w", listed, re.M)


def test_english_is_what_is_written_and_what_nobody_translated_stays_whole() -> None:
    assert say("final value <value>", value=3) == "final value 3"
    assert message("converged") == "converged"
    assert (decimal("0.5 at 1.25"), numbers(["0.5", "1.5"])) == ("0.5 at 1.25", "0.5, 1.5")
    assert counted(2, "iteration") == "2 iterations"
    with spoken("id"):
        assert say("final value <value>", value=3) == "akhir 3"
        assert (decimal("0.5 at 1.25"), numbers(["0.5", "1.5"])) == ("0,5 at 1,25", "0,5; 1,5")
        assert counted(2, "iteration") == "2 iterasi"
        assert message("converged; nobody says this") == "converged; nobody says this"
        assert message("converged; certified") == "konvergen; tersertifikasi"
        arcs = message("structure free, wall, free (wall 0.3 long), from the search")
        assert arcs == "struktur bebas, wall, bebas (wall selama 0.3), dari pencarian langsung"


def test_a_language_that_nobody_wrote_is_refused_in_a_line(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    for arguments, variable in ((("models", "--lang", "xx"), ""), (("models",), "yy"), (("--help",), "zz")):
        monkeypatch.setenv(said.VARIABLE, variable)
        code, out, err = run(*arguments)
        assert (code, out) == (3, "")
        assert re.fullmatch(
            r'satsym: \S+: there is no translation into the language "..", ?.*\n'.replace('", ?', '"; '), err
        )


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        ("", ("solve", "nowhere.toml")),
        ("", ("solve", "soft-retrun")),
        ("", ("analyse", "nothing-like-it")),
        ("", ("solve", "soft-return", "--set", "initial.q=1")),
        ("", ("solve", "soft-return", "--set", "initial.r=[1,2]")),
        ("", ("solve", "soft-return", "--set", "initial.r=5 apples")),
        ("", ("solve", "soft-return", "--set", "initial.r=5 kg")),
        ("", ("solve", "itb-earth")),
        ('model = "polar_orbit"\n[initial]\nr = 1.0\n[time]\ntf = 1.0', ("solve", "x.toml")),
        ('model = "polar_orbit"\n[initial]\nq = 1.0\n[time]\ntf = 1.0', ("solve", "x.toml")),
        ('model = "polar_orbit"\n[initial\n', ("solve", "x.toml")),
        ('model = "polar_orbit"\n[time]\ntf = []\n', ("solve", "x.toml")),
        ('model = "../nothing"\n[initial]\nq = 1.0\n[time]\ntf = 1.0', ("solve", "x.toml")),
        ("", ("solve", "uny-lqr", "--set", "time.tf=-1")),
        ('model = "polar_orbitt"\n[initial]\nr = 1.0\n[time]\ntf = 1.0', ("solve", "x.toml")),
        ("", ("new", "My Model")),
        ("", ("latex", "polar_orbitt")),
        ("", ("lqr", "clohessy_wiltshire", "--set", "initial.x1=1")),
    ],
)
def test_what_newcomers_are_refused_is_said_in_indonesian_on_one_line(
    run: Run, tmp_path: Path, text: str, arguments: tuple[str, ...]
) -> None:
    (tmp_path / "x.toml").write_text(text, encoding="utf-8")
    english, other = (run(*arguments, "--lang", each) for each in ("en", "id"))
    assert (english[0], other[0]) == (3, 3)
    assert other[2].count("\n") == 1
    shown = NAMES.sub("", re.sub(r"`[^`]*`|\[\w+\](?: \w+)?|(?<=: )\w+:|bukan TOML yang sah: [^;]*", "", other[2]))
    assert not ENGLISH.search(shown), other[2]
    assert other[2] != english[2]


@pytest.mark.parametrize(
    ("english", "indonesian"),
    [
        ("k.py:3: 'Newton' is not defined; write `from m import Newton`", "tulislah `from m import Newton`"),
        ("k.py:3: Newton has no field 'rate'; did you mean \"rates\"?", "tidak mempunyai isian 'rate'"),
        (
            "k.py:3: write powers with **, as in x**3; ^ is not the power operator in Python",
            "^ bukan pangkat dalam Python",
        ),
        ("x.toml: [final] r: got a list of 2; give a number", "tertulis daftar dengan 2 isian"),
        ('x.toml: [final] r: got "a list of 2"; give a number', 'tertulis "a list of 2"'),
        ("l.toml:3: row 1: got a table; write an expression in quotes", "tertulis tabel"),
    ],
)
def test_mistakes_of_files_are_said_in_indonesian_and_what_they_hold_is_left(english: str, indonesian: str) -> None:
    with spoken("id"):
        said_so = message(english)
    assert indonesian in said_so
    assert not ENGLISH.search(NAMES.sub("", re.sub(r"`[^`]*`", "", said_so)))


@pytest.mark.parametrize(
    "arguments",
    [
        *("solve", "solve soft-return --bogus", "frobnicate", "plot soft-return --size huge"),
        *("solve soft-return other", "solve soft-return --steps many", "latex"),
    ],
)
def test_wrong_usage_is_said_in_indonesian(run: Run, arguments: str) -> None:
    english, other = (run(*arguments.split(), "--lang", each) for each in ("en", "id"))
    assert (english[0], other[0]) == (2, 2)
    assert other[2].splitlines()[-1].startswith("Galat: ")
    assert not ENGLISH.search(re.sub(r"'[^']*'|--\w+", "", other[2]))


@pytest.mark.parametrize("command", ["", *program.commands])
def test_the_help_is_indonesian_wherever_the_language_is_asked_for(run: Run, command: str) -> None:
    _, shown, _ = run(*command.split(), "--help", "--lang", "id")
    assert shown == run("--lang", "id", *command.split(), "--help")[1]
    names = re.compile(r"--\S+|^ .*satsym .*?(?=  |$)|(?:initial|final|control)\.\S+|\b[A-Z_]{2,}\b", re.MULTILINE)
    assert [line for line in NAMES.sub("", names.sub("", shown)).splitlines() if ENGLISH.search(line)] == []
    with spoken("id"):
        assert [text for text in HELP if text == said.explained(text)] == []


def test_one_run_leaves_its_language_to_no_other(run: Run) -> None:
    assert run("models", "--lang", "id")[0] == 0
    assert said.language() == "en"


def words(pages: dict) -> set[str]:
    from matplotlib.text import Text

    return {text.get_text() for page in pages.values() for text in page.findobj(Text) if text.get_text()}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["soft-return", "double-integrator-fuel"])
def test_pictures_speak_indonesian_with_decimal_commas(name: str) -> None:
    found = solve(instance.load(name))
    english = words(plots.figures(found))
    with spoken("id"):
        shown = words(plots.figures(found))
    texts = {text for text in INDONESIAN if text not in SAME}
    assert english & texts
    assert not shown & texts
    assert {"penyelesaian", "iterasi"} <= shown or "penyelesaian" in shown
    assert not [text for text in shown if re.search(r"\d\.\d", text)]


def test_a_picture_of_a_simulation_says_how_it_ends_in_indonesian() -> None:
    with spoken("id"):
        shown = words(plots.figures(simulate(instance.load("its-thesis"))))
    assert any(text.startswith("akhir ") for text in shown)
    assert not any(text.startswith("end ") for text in shown)


def alike(run: Callable[..., tuple[int, str, str]], *arguments: str) -> None:
    """Programs read the same whatever people speak."""
    english, other = (json.loads(run(*arguments, "--json", "--lang", each)[1]) for each in ("en", "id"))
    for found in (english, other):
        found.pop("wall_s", None)
    assert english == other


@pytest.mark.parametrize(
    "arguments", [("solve", "soft-return"), ("simulate", "its-thesis"), ("lqr", "uny-lqr"), ("models",), ("instances",)]
)
def test_programs_read_the_same_in_every_language(run: Run, arguments: tuple[str, ...]) -> None:
    alike(run, *arguments)


def test_files_are_the_same_in_every_language(run: Run, tmp_path: Path) -> None:
    for each in ("en", "id"):
        assert run("simulate", "its-thesis", "--lang", each, "--out", each)[0] == 0
    assert (tmp_path / "en" / "trajectory.csv").read_bytes() == (tmp_path / "id" / "trajectory.csv").read_bytes()
    assert (tmp_path / "en" / "result.json").read_bytes() == (tmp_path / "id" / "result.json").read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", "soft-return"),
        ("solve", "double-integrator-time", "--out", "there"),
        ("solve", "double-integrator-fuel", "--set", "time.tf=1.0"),
        ("simulate", "its-thesis"),
        ("simulate", "lapan-classical"),
        ("analyse", "itb-earth"),
        ("analyse", "itb-earth-escape"),
        ("analyse", "uny-lqr"),
        ("lqr", "geo-lqr"),
        ("compare", "lapan-classical", "lapan-minimum-time"),
        ("models", "polar_orbit"),
        ("models",),
        ("instances",),
        ("study", "soft-return", "--vary", "initial.r=1.05:1.1:2"),
    ],
    ids=" ".join,
)
def test_a_command_that_was_asked_for_indonesian_says_nothing_english(run: Run, arguments: tuple[str, ...]) -> None:
    _, shown, _ = run(*arguments, "--lang", "id")
    for text in sorted(AUTHORED - INDONESIAN.keys(), key=len, reverse=True):
        shown = shown.replace(text, "")
    lines = [line for line in shown.splitlines() if ENGLISH.search(NAMES.sub("", line))]
    assert lines == []
    assert shown != run(*arguments)[1]
