"""Files loaded by path: only what the generator writes is accepted, and nothing of anything else ever runs."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from satsym.kernels import load
from satsym.kernels.checking import check
from satsym.kernels.digest import sealed
from satsym.kernels.loading import MOST_BYTES
from satsym.status import BadInput


@pytest.fixture(scope="module")
def legal(repository: Path) -> str:
    return (repository / "generated/polar_orbit.py").read_text(encoding="utf-8")


class Trap:
    """An expression that leaves a file behind where it runs."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "it_ran"
        self.code = f"__import__('pathlib').Path({str(self.file)!r}).touch()"


@pytest.fixture
def trap(tmp_path: Path) -> Trap:
    return Trap(tmp_path)


def refuse(folder: Path, text: str | bytes, trap: Trap) -> str:
    (folder / "hostile.py").write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(BadInput) as caught:
        load("./hostile", folder)
    assert not trap.file.exists()
    assert not [name for name in sys.modules if "hostile" in name]
    message = str(caught.value)
    assert message.isprintable()
    assert message.startswith('"./hostile": ')
    assert "satsym derive" in message
    return message


FIRST = "    sigma, omega, c1, c2, k1, k2, k3, k4 = p\n"  # ends the unpacking in the first function
STEP = "        h = t_end - t\n"  # a statement of a loop
STORE, STORE_MID, START = "    r_at[i] = ", "    r_mid[i] = ", "    r_at[0] = "
DEF = "def dynamics(t, x, u, p):\n"
ALLOCATE = "    if out is None:\n"
MAKE = (
    ALLOCATE
    + "        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))\n"
    + "        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))\n"
)

# name: (text in a legal module, what stands there instead); RUN is an expression with a side effect
ATTACKS = {
    # the module
    "a statement": ("\n\nMODEL", "\n\nRUN\n\nMODEL"),
    "a statement after all": (None, "RUN\n"),
    "another import": ("import math\n", "import math, os\n"),
    "an import under a false name": ("import math\n", "import os as math\n"),
    "a submodule": ("import numpy as np", "import numpy.ctypeslib as np"),
    "a star import": ("import math\n", "from math import *\n"),
    "a late import": (None, "import os\n"),
    "an import in a function": (FIRST, FIRST + "    import os\n"),
    "no import": ("import math\n", ""),
    "a future": ('"""\n\nimport math', '"""\nfrom __future__ import annotations\n\nimport math'),
    "no docstring": ("import math\n", 'import math\n"""text"""\n'),
    "another constant": (None, "G = 1.0\n"),
    "a constant that runs": (None, "G = RUN\n"),
    "a call as MODEL": ("MODEL = {", "MODEL = dict(format=1) or {"),
    "MODEL that runs": ("'format': 1", "'format': RUN or 1"),
    "MODEL with a key that runs": ("'format': 1", "'format': 1, RUN: 1"),
    "MODEL unpacked": ("'format': 1", "**RUN"),
    "MODEL with an f-string": ("'polar_orbit'", 'f"{RUN}"'),
    "MODEL with terminal escapes": ("'polar_orbit'", r"'polar\x1b[2J'"),
    "MODEL with a huge number": ("'default': 1.0", "'default': 9999999999"),
    "MODEL with infinity": ("'default': 1.0", "'default': 1e999"),
    "MODEL with a name that is none": ("'symbol': 'r'", "'symbol': 'r; import os'"),
    "MODEL with text for a number": ("'default': 1.0", "'default': '1.0'"),
    "MODEL with truth for a number": ("'default': 1.0", "'default': True"),
    "MODEL with a number for text": ("'latex': 'r'", "'latex': 1"),
    "MODEL with other fields": ("'format': 1", "'format': 1, 'more': 1"),
    "MODEL of another format": ("'format': 1", "'format': 2"),
    "MODEL with a name that is a number": ("'name': 'polar_orbit'", "'name': 1"),
    "MODEL with another control set": ("'control_set': 'box'", "'control_set': 'torus'"),
    "MODEL that contradicts itself": ("'has_cost': True", "'has_cost': False"),
    "MODEL with two states of one name": ("'symbol': 'r_dot'", "'symbol': 'r'"),
    "MODEL twice": (None, "MODEL = {}\n"),
    "a class": (None, "class A:\n    RUN\n"),
    "a coroutine": (DEF, "async " + DEF),
    "a function of another name": (None, 'def helper(t):\n    """."""\n    return t\n'),
    "a builtin's name": (None, 'def range(t):\n    """."""\n    return t\n'),
    "a function twice": (None, DEF + '    """."""\n    return (1.0, 1.0, 1.0, 1.0)\n'),
    "a function left out": ("def position(", "def positions("),
    "a batch form of a loop": (None, 'def forward_batch(times):\n    """."""\n    return times\n'),
    # what surrounds a body
    "a decorator": (DEF, "@RUN\n" + DEF),
    "a default": (DEF, "def dynamics(t, x, u, p=RUN):\n"),
    "a default of out": ("u, p, out=None)", "u, p, out=RUN)"),
    "a keyword default": (DEF, "def dynamics(t, x, u, p, *, k=RUN):\n"),
    "an annotation": (DEF, "def dynamics(t: RUN, x, u, p):\n"),
    "a result's annotation": (DEF, "def dynamics(t, x, u, p) -> RUN:\n"),
    "other arguments": (DEF, "def dynamics(t, x, u, p, q):\n"),
    "any arguments": (DEF, "def dynamics(*args, **kwargs):\n"),
    "positional arguments": (DEF, "def dynamics(t, x, u, p, /):\n"),
    # statements
    "an expression": (FIRST, FIRST + "    RUN\n"),
    "print": (FIRST, FIRST + "    print(r)\n"),
    "a function inside": (FIRST, FIRST + "    def f(): RUN\n"),
    "a class inside": (FIRST, FIRST + "    class A: RUN\n"),
    "while": (FIRST, FIRST + "    while r < r:\n        r = r\n"),
    "with": (FIRST, FIRST + "    with RUN:\n        pass\n"),
    "try": (FIRST, FIRST + "    try:\n        new = r\n    except RUN:\n        new = r\n"),
    "raise": (FIRST, FIRST + "    raise RUN\n"),
    "assert": (FIRST, FIRST + "    assert RUN\n"),
    "delete": (FIRST, FIRST + "    del r\n"),
    "global": (FIRST, FIRST + "    global MODEL\n"),
    "if": (FIRST, FIRST + "    if RUN:\n        new = 1.0/r\n"),
    "match": (FIRST, FIRST + "    match r:\n        case _:\n            new = r\n"),
    "yield": (FIRST, FIRST + "    yield r\n"),
    "an early return": (FIRST, FIRST + "    return r\n"),
    "an annotated assignment": (FIRST, FIRST + "    new: RUN = 1.0/r\n"),
    "an augmented assignment": (FIRST, FIRST + "    new += r\n"),
    "an assignment to two": (FIRST, FIRST + "    new = two = 1.0/r\n"),
    "an assignment to an attribute": (FIRST, FIRST + "    np.pi = r\n"),
    "an assignment to an argument's element": (FIRST, FIRST + "    x[0] = r\n"),
    "a starred target": ("r, r_dot, theta, theta_dot = x\n", "r, *theta = x\n"),
    "too few targets": ("r, r_dot, theta, theta_dot = x\n", "r, r_dot, theta = x\n"),
    "a nested target": ("r, r_dot, theta, theta_dot = x\n", "r, r_dot, theta, (a, b) = x\n"),
    "no result": ("    return 0.5*c1*u1*u1 + 0.5*c2*u2*u2\n", "    w = 1.0\n"),
    "a result of another shape": ("    return 0.5*c1*u1*u1 + 0.5*c2*u2*u2\n", "    return (r, r)\n"),
    "a loop in a pointwise function": (FIRST, FIRST + "    for i in range(9):\n        new = r\n"),
    # names
    "math as a name": (FIRST, FIRST + "    math = 1.0\n"),
    "np as a name": ("r, r_dot, theta, theta_dot = x\n", "r, r_dot, theta, np = x\n"),
    "len as a name": (STEP, STEP + "        len = 1.0\n"),
    "a dunder name": (FIRST, FIRST + "    __builtins__ = 1.0\n"),
    "an argument as a name": (FIRST, FIRST + "    p = 1.0\n"),
    "a sequence as a number": (STEP, STEP + "        r_at = 1.0\n"),
    "the index as a number": (STEP, STEP + "        i = 1.0\n"),
    "a name before its value": (FIRST, FIRST + "    w_99 = w_98\n"),
    "a name of the loop after it": ("    return total\n", "    return h\n"),
    "a name outside ASCII": (FIRST, FIRST + "    \u03bb = 1.0\n"),
    # expressions
    "a call": (FIRST, FIRST + "    new = RUN\n"),
    "a builtin": (FIRST, FIRST + "    new = eval('1.0')\n"),
    "a function of the file": (FIRST, FIRST + "    new = dynamics(t, x, u, p)\n"),
    "a private attribute": (FIRST, FIRST + "    new = math.__loader__\n"),
    "a way to the globals": (FIRST, FIRST + "    new = math.sin.__self__\n"),
    "an attribute of a number": (FIRST, FIRST + "    new = r.real\n"),
    "another function of math": (FIRST, FIRST + "    new = math.factorial(r)\n"),
    "another function of np": (FIRST, FIRST + "    new = np.load('x', allow_pickle=True)\n"),
    "np in a function of floats": (FIRST, FIRST + "    new = np.sin(r)\n"),
    "another number of arguments": (FIRST, FIRST + "    new = math.sin(r, r)\n"),
    "a keyword": (FIRST, FIRST + "    new = math.sin(x=r)\n"),
    "starred arguments": (FIRST, FIRST + "    new = math.sin(*x)\n"),
    "a function as a value": (FIRST, FIRST + "    new = math.sin\n"),
    "a call of a call": (FIRST, FIRST + "    new = math.sin(r)(r)\n"),
    "a whole number": (FIRST, FIRST + "    new = 2*r\n"),
    "a huge power": (FIRST, FIRST + "    new = 9**9**9\n"),
    "a huge shift": (FIRST, FIRST + "    new = 1 << 10**9\n"),
    "a huge text": (FIRST, FIRST + "    new = 'a'*10**9\n"),
    "a huge literal": (FIRST, FIRST + f"    new = 0x{'f' * 9999}\n"),
    "a huge literal as an index": (STORE, f"    r_at[0x{'f' * 9999}] = "),
    "a huge tuple": (FIRST, FIRST + "    new = x*999999999\n"),
    "bytes": (FIRST, FIRST + "    new = b'a'\n"),
    "an imaginary number": (FIRST, FIRST + "    new = 1j\n"),
    "truth": (FIRST, FIRST + "    new = True\n"),
    "nothing": (FIRST, FIRST + "    new = None\n"),
    "a list": (FIRST, FIRST + "    new = [r]\n"),
    "a tuple": (FIRST, FIRST + "    new = (r, r)\n"),
    "a dictionary": (FIRST, FIRST + "    new = {RUN: RUN}\n"),
    "a lambda": (FIRST, FIRST + "    new = (lambda: RUN)()\n"),
    "a comprehension": (FIRST, FIRST + "    new = [RUN for _ in x]\n"),
    "a generator": (FIRST, FIRST + "    new = (RUN for _ in x)\n"),
    "a walrus": (FIRST, FIRST + "    new = (w := 1.0)\n"),
    "an f-string": (FIRST, FIRST + '    new = f"{RUN}"\n'),
    "an f-string as an index": (STORE, '    r_at[f"{RUN}" "\\n"] = '),
    "and": (FIRST, FIRST + "    new = r and RUN\n"),
    "a comparison": (FIRST, FIRST + "    new = r < r\n"),
    "a chain of comparisons": (FIRST, FIRST + "    new = r if r < r < r else r\n"),
    "a condition that runs": (FIRST, FIRST + "    new = r if RUN else r\n"),
    "matrix product": (FIRST, FIRST + "    new = r @ r\n"),
    "a subscript": (FIRST, FIRST + "    new = x[0]\n"),
    # loops: an index outside would be a write anywhere in memory once compiled
    "an index far outside": (STORE, "    r_at[i + 100000] = "),
    "an index one too far": (STORE_MID, "    r_mid[i + 1] = "),
    "an index before the first": (START, "    r_at[-7] = "),
    "a midpoint outside the loop": (START, "    r_mid[0] = "),
    "a slice": (STORE, "    r_at[:] = "),
    "an index that runs": (STORE, "    r_at[RUN] = "),
    "more steps": ("range(steps)", "range(steps + 9)"),
    "other steps": ("len(times) - 1", "len(times) + 1"),
    "a long loop": ("range(steps)", "range(1000000000)"),
    "no end": ("for i in range(steps)", "for i in iter(int, 1)"),
    "a loop in a loop": (STEP, STEP + "        for j in range(steps):\n            w_99 = h\n"),
    "a second loop": ("    return total\n", "    for i in range(steps):\n        w = r\n    return total\n"),
    "else after a loop": (
        "    return total\n",
        "    for _ in range(9):\n        pass\n    else:\n        w = RUN\n    return total\n",
    ),
    "break": (STEP, STEP + "        break\n"),
    # the batch form
    "another condition": (ALLOCATE, "    if RUN:\n"),
    "a result stored before it is made": (ALLOCATE, "    out[0] = r_dot\n" + ALLOCATE),
    "a result made twice": ("    out[3] = ", MAKE + "    out[3] = "),
    "the shape as a number": (ALLOCATE, "    shape = 1.0\n" + ALLOCATE),
    "a larger result": ("np.empty((4, *shape)", "np.empty((400000000, *shape)"),
    "another type": ("np.result_type(float, t, x, u, *p)", "RUN"),
    "an entry outside": ("    out[3] = ", "    out[4] = "),
    "an entry that is none": ("    out[3] = ", "    out[True] = "),
    "an entry left out": ("    out[2] = theta_dot\n", ""),
    "a part of the result": ("    out[3] = ", "    out[...] = "),
    "zeros that are no zeros": ("    out[...] = 0.0\n", "    out[...] = 1.0\n"),
    "zeros in the end": ("    out[0, 1] = 1.0\n", "    out[0, 1] = 1.0\n    out[...] = 0.0\n"),
    "an array that is changed": ("    out[3] = ", "    x[3] = "),
}


@pytest.mark.slow
@pytest.mark.parametrize("attack", ATTACKS)
def test_what_the_generator_does_not_write_is_refused_and_never_runs(
    attack: str, legal: str, tmp_path: Path, trap: Trap
):
    place, instead = ATTACKS[attack]
    instead = instead.replace("RUN", trap.code)
    assert place is None or place in legal
    refuse(tmp_path, f"{legal}\n\n{instead}" if place is None else legal.replace(place, instead, 1), trap)


def test_a_refusal_names_file_line_and_reason(legal: str, tmp_path: Path, trap: Trap):
    text = legal.replace(FIRST, FIRST + "    while True:\n        pass\n", 1)
    line = text[: text.index("while True")].count("\n") + 1
    message = refuse(tmp_path, text, trap)
    assert f'"./hostile": line {line} has a statement of an unsupported kind (While); ' in message


DEEP = 5000
NESTED = {
    "parentheses": "(" * DEEP + "1.0" + ")" * DEEP,
    "brackets": "[" * DEEP + "]" * DEEP,
    "signs": "-" * 10**5 + "1.0",
    "terms": "+".join(["r"] * 10**5),
    "powers": "**".join(["r"] * DEEP),
    "conditions": "r if r < r else " * DEEP + "r",
    "calls": "math.sin(" * 150 + "r" + ")" * 150,
    "attributes": "r" + ".r" * 10**5,
    "subscripts": "r" + "[r]" * 10**5,
    "lambdas": "lambda: " * DEEP + "r",
    "negations": "not " * 10**5 + "r",
    "awaits": "await " * DEEP + "r",
    "f-strings": "f'{" * 50 + "r" + "}'" * 50,
}


@pytest.mark.parametrize("construct", NESTED)
def test_deep_nesting_is_refused_without_a_crash(construct: str, legal: str, tmp_path: Path, trap: Trap):
    deep = legal.replace(FIRST, FIRST + f"    new = {NESTED[construct]}\n", 1)
    if construct == "calls":  # legal, as deep as Python allows parentheses to be
        check(deep)
    else:
        refuse(tmp_path, deep, trap)
    refuse(tmp_path, legal.replace("'format': 1", f"'format': {NESTED[construct]}", 1), trap)


def test_deep_blocks_are_refused_without_a_crash(legal: str, tmp_path: Path, trap: Trap):
    for body in (
        "".join(" " * (4 + k) + "if r < r:\n" for k in range(90)) + " " * 99 + "r = r\n",
        "    if r < r:\n        r = r\n" + "    elif r < r:\n        r = r\n" * 10**4,
    ):
        refuse(tmp_path, legal.replace(FIRST, FIRST + body, 1), trap)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\n",
        b'"""text"""',
        b"\0",
        b"import math\0",
        b"\xff\xfe\x00",
        "\ufeff'''text'''".encode(),
        "'''text\ud800'''".encode("utf-8", "surrogatepass"),
        b"# coding: utf-7\n+AAo-import os\n",
        b"\x1b[2J = 1",
        b"(" * 10**6,
        b"x = 1\n" * (MOST_BYTES // 6 + 1),
        b"\\" * 10**5,
        b"'''" + b"\\d" * 10**5 + b"'''",
        b"9" * 10**5,
    ],
    ids=range(15),
)
def test_files_that_are_no_module_at_all_are_refused(data: bytes, tmp_path: Path, trap: Trap):
    refuse(tmp_path, data, trap)


def test_code_behind_a_false_encoding_stays_a_comment(legal: str, tmp_path: Path, trap: Trap):
    hidden = "".join(f"+{'AAo'}-{trap.code}")
    (tmp_path / "sly.py").write_text(sealed(f"# coding: utf-7\n#{hidden}\n{legal}"), encoding="utf-8")
    load("./sly", tmp_path).dynamics(0.0, (1.0, 0.0, 0.0, 1.0), (0.0, 0.0), (1.0,) * 8)
    assert not trap.file.exists()


def test_a_checked_module_has_no_builtins_but_those_it_needs(legal: str, tmp_path: Path):
    (tmp_path / "mine.py").write_text(legal, encoding="utf-8")
    names = load("./mine", tmp_path).dynamics.__globals__
    assert set(names["__builtins__"]) == {"float", "len", "range"}
    assert {name for name in names if name[0] != "_"} == set(load("./mine", tmp_path).functions) | {"math", "np"}


@pytest.fixture
def house(tmp_path: Path, legal: str) -> Path:
    """A folder with an inner one for the instance, and files that it may and may not reach."""
    inner = tmp_path / "inner"
    inner.mkdir()
    for path in (tmp_path / "secret.py", inner / "mine.py"):
        path.write_text(legal, encoding="utf-8")
    return inner


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        ("../secret", "lies outside"),
        ("../inner/../secret", "lies outside"),
        ("link", "lies outside"),
        ("./link", "lies outside"),
        ("folder/secret", "lies outside"),
        ("/etc/passwd", "absolute"),
        ("./mine.py", "leave out"),
        (
            "mine.py",
            ": leave out the ending .py; a model is a module written by `satsym derive`, not a derivation file",
        ),
        ("./missing", "no such file"),
        ("./circle", "no such file"),
        ("./broken", "no such file"),
        ("./mine/mine", "no such file"),
        ("./a_folder", "not a file"),
        ("./pipe", "not a file"),
        ("./Mine", "lower-case letter"),
        ("./", "lower-case letter"),
        ("./mi\nne", "lower-case letter"),
        ("./mi\0ne", "lower-case letter"),
        ("mi\0ne/mine", "no such file"),
        ("./" + "a" * 5000, "lower-case letter"),
        ("a" * 5000 + "/a", "no such file"),
        ("", "not a shipped model"),
        ("mi\nne", "not a shipped model"),
        ("__init__", "not a shipped model"),
        ("Polar_orbit", "not a shipped model"),
    ],
)
def test_names_and_paths_that_lead_elsewhere_are_refused_in_one_line(house: Path, model: str, reason: str):
    outside = house.parent
    (house / "link.py").symlink_to(outside / "secret.py")
    (house / "folder").symlink_to(outside)
    (house / "circle.py").symlink_to(house / "circle.py")
    (house / "broken.py").symlink_to(house / "gone.py")
    (house / "a_folder.py").mkdir()
    os.mkfifo(house / "pipe.py")
    with pytest.raises(BadInput, match=reason) as caught:
        load(model, house)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 250


def test_a_derivation_file_in_place_of_its_module_is_refused_with_what_derives_it(
    house: Path, monkeypatch: pytest.MonkeyPatch
):
    stated = 'from satsym.symbolic import Problem\nmodel = FirstOrder(name="sir")\nProblem(\n    name="plague")\n'
    (house / "epidemic.py").write_text(stated, encoding="utf-8")
    (house / "bare.py").write_text("import satsym.symbolic as s\n", encoding="utf-8")
    monkeypatch.chdir(house.parent)
    for model, file, wanted in (("epidemic", "epidemic", "plague"), ("./bare", "bare", "bare")):
        with pytest.raises(BadInput) as caught:
            load(model, house)
        command = f"satsym derive {house.name}/{file}.py --out {house.name}/generated"
        assert f'this is a derivation file; run `{command}` and write "generated/{wanted}"' in str(caught.value)


def test_a_link_within_the_folder_is_followed(house: Path):
    (house / "other.py").symlink_to(house / "mine.py")
    assert load("./other", house).spec == load("./mine", house).spec
