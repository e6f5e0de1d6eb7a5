"""Being stopped and not being heard: exit codes stay, nothing is half-written, and there is no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from satsym.cli.stopping import STOP_INTERVAL, Terminated, terminable
from tests.cli.test_cli import INSTANCE, Run, case, one_line, program, run

__all__ = ["case", "run"]

ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}


def shell(command: str, folder: Path) -> tuple[int, str]:
    """Exit code of satsym at the head of a shell command, and all that reaches stderr."""
    text = f'set -o pipefail; "{sys.executable}" -m satsym {command}'
    done = subprocess.run(
        ["bash", "-c", text], cwd=folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL, capture_output=True, check=False
    )
    return done.returncode, done.stderr.decode()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("--help | (exec <&-; sleep 1)", 141),
        ("solve --help | (exec <&-; sleep 1)", 141),
        ("models | (exec <&-; sleep 1)", 141),
        ("solve nothing 2>/dev/full", 3),
        ("slove 2>/dev/full", 2),
        ("solve nothing 2>&-", 3),
        ("models >&-", 0),
    ],
)
def test_who_does_not_listen_changes_no_exit_code(tmp_path: Path, command: str, code: int) -> None:
    assert shell(command, tmp_path) == (code, "")


@pytest.mark.parametrize("command", ["models", "--help", "models --help", "--version"])
def test_a_full_stdout_is_told_in_a_line(tmp_path: Path, command: str) -> None:
    code, err = shell(f"{command} >/dev/full", tmp_path)
    assert code == 3
    assert err == "satsym: the standard output cannot be written (No space left on device); redirect it\n"


FINE = INSTANCE.replace("tf = 1.0", "tf = 1.0\n[solver]\nsteps = 200000\nmethod = 'sweep'\ntolerance = 1e-300")


@pytest.mark.parametrize(("sign", "code", "word"), [("SIGTERM", 143, "terminated"), ("SIGINT", 130, "interrupted")])
def test_a_signal_ends_a_run_with_one_line_and_no_file(tmp_path: Path, sign: str, code: int, word: str) -> None:
    (tmp_path / "case.toml").write_text(FINE, encoding="utf-8")
    command = [sys.executable, "-c", STARTED, "solve", "case.toml", "--out", "there"]
    pipe = subprocess.PIPE
    with (
        interruptible(),
        subprocess.Popen(command, cwd=tmp_path, env=ENVIRONMENT, stdout=pipe, stderr=pipe) as going,
    ):
        assert going.stdout is not None
        assert going.stdout.readline() == b"solving\n"
        time.sleep(0.2)
        going.send_signal(getattr(signal, sign))
        try:
            _, err = going.communicate(timeout=60)
        finally:
            going.kill()  # or one that went on would be waited for without end
    assert (going.returncode, err.decode()) == (code, f"satsym: {word}\n")
    assert not (tmp_path / "there").exists()


STARTED = """
import sys
import satsym.solvers
from satsym.cli import main
real = satsym.solvers.solve
def solve(*arguments, **options):
    print("solving", flush=True)
    while True:
        real(*arguments, **options)
satsym.solvers.solve = solve
sys.exit(main())
"""


@contextmanager
def interruptible() -> Iterator[None]:
    """With SIGINT heard, also where the tests themselves run in the background, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(("sign", "error"), [(signal.SIGTERM, Terminated), (signal.SIGINT, KeyboardInterrupt)])
def test_a_stop_that_comes_within_a_finaliser_is_not_lost(
    sign: signal.Signals, error: type[BaseException], capfd: pytest.CaptureFixture[str]
) -> None:
    class Careless:
        def __del__(self) -> None:
            signal.raise_signal(sign)

    def working() -> None:
        with interruptible(), terminable():
            del [Careless()][0]
            time.sleep(30.0)

    with pytest.raises(error):
        working()
    assert capfd.readouterr().err == ""


def test_a_stop_that_a_library_swallows_comes_again(capfd: pytest.CaptureFixture[str]) -> None:
    def working() -> None:
        with interruptible(), terminable():
            try:
                signal.raise_signal(signal.SIGTERM)
            except Terminated:
                sys.excepthook(*sys.exc_info())  # as PyErr_Print does
            time.sleep(30.0)

    began = time.monotonic()
    with pytest.raises(Terminated):
        working()
    assert time.monotonic() - began < 15.0
    assert capfd.readouterr().err == ""


def test_cleaning_up_after_a_stop_is_not_stopped() -> None:
    cleaned: list[bool] = []

    def tidy() -> None:
        with suppress(OSError):
            raise OSError
        time.sleep(4 * STOP_INTERVAL)
        cleaned.append(True)

    def working() -> None:
        with interruptible(), terminable():
            try:
                signal.raise_signal(signal.SIGTERM)
            finally:
                tidy()

    with pytest.raises(Terminated):
        working()
    assert cleaned


def test_what_a_library_raises_when_it_is_stopped_is_the_stop(
    run: Run, case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def careless(*_: object, **__: object) -> None:
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            raise ValueError("seek of closed file")

    monkeypatch.setattr("satsym.solvers.solve", careless)
    assert run("solve", case) == (143, "", "satsym: terminated\n")


@pytest.mark.parametrize("command", ["solve case.toml --out", "plot soft-return --from", "plot soft-return --out"])
def test_an_empty_name_of_a_folder_is_refused(run: Run, case: Path, command: str) -> None:
    code, out, err = run(*command.split(), "")
    assert (code, out) == (3, "")
    assert one_line(err)
    assert "the name is empty" in err
    assert list(case.parent.iterdir()) == [case]


@pytest.mark.parametrize("command", ["latex polar_orbit -o", "audit its_thesis --latex", "derive --out"])
def test_an_empty_name_of_a_file_is_refused(run: Run, command: str) -> None:
    assert run(*command.split(), "")[:2] == (3, "")


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder in which not even root can write")
def test_a_folder_in_which_nobody_can_write_is_3() -> None:
    done = program("solve", "its-thesis", "--out", "/proc/self/results")
    assert (done.returncode, done.stdout) == (3, "")
    assert one_line(done.stderr)


def test_writing_that_is_denied_late_is_3_and_leaves_nothing(
    run: Run, case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def denied(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("satsym.report.results.sets.store", denied)
    code, out, err = run("solve", case, "--out", "there")
    assert (code, out) == (3, "")
    assert one_line(err)
    assert "cannot be written (Permission denied)" in err
    assert list((tmp_path / "there").iterdir()) == []


def test_warnings_of_libraries_do_not_reach_the_user(tmp_path: Path) -> None:
    code = (
        "import sys, warnings, satsym.solvers\n"
        "satsym.solvers.solve = lambda *_, **__: warnings.warn('raw', RuntimeWarning) or sys.exit(7)\n"
        "from satsym.cli import main\n"
        "main()\n"
    )
    for asked, said in (([], ""), (["-W", "always"], "RuntimeWarning: raw")):
        command = [sys.executable, *asked, "-c", code, "solve", "its-thesis"]
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
        assert done.returncode == 7
        assert said in done.stderr
        assert bool(said) == bool(done.stderr)
