"""``satsym derive``: from derivation files to kernels and typeset derivations."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import click

from satsym.cli.help import command
from satsym.cli.names import checkout
from satsym.cli.options import place_option
from satsym.cli.output import Live, complain, emit, live, tell
from satsym.cli.requirements import refuse_other_versions
from satsym.report.said import say
from satsym.status import ExitCode

EXAMPLES = """\b
Examples:
  satsym derive                         all of derivations/ into generated/ (in a checkout)
  satsym derive --check                 check that generated/ agrees with derivations/
  satsym derive --fresh                 everything again, even what has not changed
  satsym derive my_model.py --out DIR   a file of your own; in an instance, write model = "DIR/NAME"

A derivation file is Python and is executed: derive only files that you trust."""

MAX_SECONDS = 900.0
"""Time limit of :mod:`satsym.report.artefacts`, stated once more because ``--help`` does not load that module."""


@command(epilog=EXAMPLES)
@click.argument("files", metavar="[FILE]...", nargs=-1)
@place_option("--out", metavar="DIR", help="Write to this folder instead of generated/ in the checkout.")
@click.option(
    "--check", is_flag=True, help="Write nothing; print what would change, and exit with 6 if anything would change."
)
@click.option("--fresh", is_flag=True, help="Derive everything again, even what has not changed.")
@click.option(
    "--max-seconds",
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="S",
    default=MAX_SECONDS,
    show_default=True,
    help="Time limit for the derivation of each problem, in seconds.",
)
def derive(files: tuple[str, ...], out: Path | None, check: bool, fresh: bool, max_seconds: float) -> ExitCode:
    """Derive kernels and LaTeX from derivation files.

    Writes NAME.py, NAME.tex and NAME.derivation.json for each problem in the FILEs or, without a FILE, for each
    problem that comes with satsym. NAME.derivation.json lists every equation; audits read it. Every step is checked
    by machine, and so is every generated function, before anything is written. A file is derived again only if the
    file or the code that derives it has changed; with --check, everything is derived. NAME.tex is always in English;
    `satsym latex NAME --lang id` writes it in Indonesian.
    """
    from satsym import source_files
    from satsym.report import artefacts
    from satsym.report.results.files import check_writable

    paths = [source_files.find(file) for file in files] if files else source_files.shipped()
    folder = out or _checked_in(paths)
    whole = not files and out is None
    if not check:
        check_writable(folder)
    with live() as line:
        if check:
            rendered = artefacts.render(paths, folder, _announcing(line), max_seconds)
            differences = artefacts.differences(rendered, folder, whole)
            return _compare(differences, folder, _command(files, out))
        renewed = artefacts.renew(paths, folder, _announcing(line), fresh=fresh, max_seconds=max_seconds)
    changed = {name: text for name, text in renewed.items() if text is not None and not _holds(folder / name, text)}
    artefacts.write(changed, folder)
    done = [f"{folder / name}  {say('written' if name in changed else 'unchanged')}" for name in renewed]
    if whole:
        done += _leftovers_removed(folder, renewed)
    tell("\n".join(done))
    return ExitCode.DONE


def _announcing(line: Live) -> Callable[[str], None]:
    return lambda name: line.show(say("derived <name> ...", name=name))


def _checked_in(paths: Sequence[Path]) -> Path:
    """Return the checkout's generated/, if the results of all these files belong there."""
    home = checkout()
    if home is None:
        raise click.UsageError("--out DIR is needed, because satsym does not run from a checkout.")
    for path in paths:
        if path.resolve().parent not in (home / "derivations", home / "derivations" / "examples"):
            raise click.UsageError(f"--out DIR is needed, because {path} is not in {home / 'derivations'}.")
    refuse_other_versions()
    return home / "generated"


def _command(files: Sequence[str], out: Path | None) -> str:
    return shlex.join(["satsym", "derive", *files, *(["--out", str(out)] if out else ())])


def _compare(differences: Sequence[str], folder: Path, command: str) -> ExitCode:
    if not differences:
        tell(say("<folder> agrees with the derivations", folder=folder))
        return ExitCode.DONE
    emit("".join(differences))
    complain(f"{folder} does not agree with the derivations; run: {command}")
    return ExitCode.STALE


def _holds(path: Path, text: str) -> bool:
    return path.is_file() and path.read_bytes() == text.encode()


def _leftovers_removed(folder: Path, rendered: Iterable[str]) -> list[str]:
    """Remove files that satsym wrote earlier and no derivation leads to any more; return a line for each."""
    from satsym.report.artefacts import KEPT, SIGNATURE, SUFFIXES

    lines = []
    for path in sorted(folder.iterdir()):
        if path.name.endswith(SUFFIXES) and path.name not in (*rendered, KEPT):
            ours = SIGNATURE in path.read_text("utf-8", "replace")
            if ours:
                path.unlink()
            said = (
                "removed, because no derivation produces this file"
                if ours
                else "was not written by satsym; remove this file, because no derivation produces it"
            )
            lines.append(f"{path}  {say(said)}")
    return lines
