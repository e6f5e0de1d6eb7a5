"""The worked examples of CONTRIBUTING, as it prints them."""

from __future__ import annotations

import re
from pathlib import Path

TEXT = Path(__file__).parents[2] / "CONTRIBUTING.md"


def example(section: str, language: str) -> str:
    """The block of code in this language below a heading."""
    part = TEXT.read_text("utf-8").partition(f"\n## {section}\n")[2].partition("\n## ")[0]
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", part, re.DOTALL | re.MULTILINE)
    return str(found)
