"""Installs satsym with the oldest or newest versions that pyproject.toml allows, apart, and tries it.

    python .ci/versions.py [oldest] [newest] [--if-reachable]

With --if-reachable an index that cannot be reached is no failure. Which versions these are is read, not typed.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
EXTRAS = ("fast", "control")
REQUIREMENT = re.compile(r"([A-Za-z0-9_.-]+)\s*(>=|==)\s*([0-9][0-9.]*[0-9])\s*(?:,.*)?\Z")


def wanted() -> list[tuple[str, str]]:
    """Name and lowest version of every dependency, and of those of the extras that users install."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    stated = [*project["dependencies"], *(one for extra in EXTRAS for one in project["optional-dependencies"][extra])]
    found = []
    for requirement in stated:
        match = REQUIREMENT.match(requirement)
        if match is None:
            sys.exit(f"pyproject.toml: {requirement}: no lower bound; write name>=version")
        found.append((match[1], match[3]))
    return found


def names() -> list[str]:
    """Names of them."""
    return [name for name, _ in wanted()]


def constraints() -> list[str]:
    """``name==version`` with the lowest version of each."""
    return [f"{name}=={version}" for name, version in wanted()]


def main() -> int:
    """Exit code of the first environment that fails."""
    asked = [word for word in sys.argv[1:] if not word.startswith("--")]
    if not asked or set(asked) - {"oldest", "newest"}:
        sys.exit(__doc__)
    if "--if-reachable" in sys.argv and not reachable():
        print(f"{' and '.join(asked)} versions: no package index within reach, not tested", file=sys.stderr)
        return 0
    return next((code for one in asked if (code := tried(one))), 0)


def reachable() -> bool:
    """Whether the package index that is configured answers."""
    with tempfile.TemporaryDirectory() as folder:
        probe = [sys.executable, "-m", "pip", "download", "-qq", "--no-deps", "--dest", folder, "setuptools"]
        return not subprocess.run(probe, capture_output=True, check=False).returncode


def tried(which: str) -> int:
    """Exit code of a round through satsym with these versions."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        venv.create(folder / "environment", with_pip=True)
        python = folder / "environment" / ("Scripts" if os.name == "nt" else "bin") / "python"
        pip = [str(python), "-m", "pip", "--disable-pip-version-check"]
        listed = constraints() if which == "oldest" else []
        (folder / "constraints.txt").write_text("\n".join(listed), encoding="utf-8")
        target = ["--constraint", str(folder / "constraints.txt"), "--editable", f"{ROOT}[{','.join(EXTRAS)}]"]
        if code := subprocess.run([*pip, "install", "-qq", "--no-compile", *target], check=False).returncode:
            return code
        listing = subprocess.run([*pip, "list", "--format", "json"], capture_output=True, text=True, check=True).stdout
        there = {each["name"].lower(): each["version"] for each in json.loads(listing)}
        for one in listed:
            name, version = one.split("==")
            if (there[name.lower()] + ".0.0").split(".")[:3] != (version + ".0.0").split(".")[:3]:
                print(f"{name}: {there[name.lower()]} is installed, not {version}", file=sys.stderr)
                return 1
        check = subprocess.run([str(python), str(ROOT / ".ci/versions_check.py")], cwd=folder, check=False)
        tested = ", ".join(f"{name}=={there[name.lower()]}" for name in names())
        print(f"{which} versions ({tested}): {'FAILED' if check.returncode else 'ok'}")
        return check.returncode


if __name__ == "__main__":
    sys.exit(main())
