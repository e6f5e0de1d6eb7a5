"""Damaged results: sets of files whose list still agrees, so that what reads them must see the damage itself."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path


def signed(folder: Path) -> None:
    """Have the list of a set say what its files are now, as far as they are files."""
    place = folder / "result.json"
    result = json.loads(place.read_text(encoding="utf-8"))
    for name in result["files"]:
        if (folder / name).is_file():
            content = (folder / name).read_bytes()
            result["files"][name] = {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    place.write_text(json.dumps(result), encoding="utf-8")
