"""Where the checkout is, for commands that care."""

from __future__ import annotations

from pathlib import Path

import satsym


def checkout() -> Path | None:
    """The folder that holds derivations/ and generated/ as people edit them; ``None`` where satsym is installed."""
    home = Path(satsym.__file__).resolve().parent.parent
    return home if (home / "pyproject.toml").is_file() and (home / "derivations").is_dir() else None
