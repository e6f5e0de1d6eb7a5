"""Installs satsym with the oldest versions that pyproject.toml allows, in an environment of its own, and tries it.

    python .ci/lowest.py [--if-reachable]

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


def constraints() -> list[str]:
    """``name==version`` for every dependency and for those of the extras that users install."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    wanted = [*project["dependencies"], *(one for extra in EXTRAS for one in project["optional-dependencies"][extra])]
    found = []
    for requirement in wanted:
        match = REQUIREMENT.match(requirement)
        if match is None:
            sys.exit(f"pyproject.toml: {requirement}: no lower bound; write name>=version")
        found.append(f"{match[1]}=={match[3]}")
    return found


def main() -> int:
    """Exit code of the first step that fails."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        venv.create(folder / "environment", with_pip=True)
        python = folder / "environment" / ("Scripts" if os.name == "nt" else "bin") / "python"
        pip = [str(python), "-m", "pip", "--disable-pip-version-check"]
        probe = [*pip, "download", "-qq", "--no-deps", "--dest", str(folder), "setuptools"]
        if "--if-reachable" in sys.argv and subprocess.run(probe, capture_output=True, check=False).returncode:
            print("oldest versions: no package index within reach, not tested", file=sys.stderr)
            return 0
        listed = constraints()
        (folder / "constraints.txt").write_text("\n".join(listed), encoding="utf-8")
        target = f"{ROOT}[{','.join(EXTRAS)}]"
        install = [
            *pip,
            "install",
            "-qq",
            "--no-compile",
            "--constraint",
            str(folder / "constraints.txt"),
            "--editable",
            target,
        ]
        if code := subprocess.run(install, check=False).returncode:
            return code
        listing = subprocess.run([*pip, "list", "--format", "json"], capture_output=True, text=True, check=True).stdout
        there = {each["name"].lower(): each["version"] for each in json.loads(listing)}
        for one in listed:
            name, version = one.split("==")
            if (there[name.lower()] + ".0.0").split(".")[:3] != (version + ".0.0").split(".")[:3]:
                print(f"{name}: {there[name.lower()]} is installed, not {version}", file=sys.stderr)
                return 1
        check = subprocess.run([str(python), str(ROOT / ".ci/lowest_check.py")], cwd=folder, check=False)
        print(f"oldest versions ({', '.join(listed)}): {'FAILED' if check.returncode else 'ok'}")
        return check.returncode


if __name__ == "__main__":
    sys.exit(main())
