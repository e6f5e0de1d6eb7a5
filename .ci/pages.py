"""Look at pages with axe in the system's Chromium: those of the documentation, and the report of a run.

Exit code 1 where anything keeps people from using them. Skipped with a line where there is no Chromium.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BUILT = Path(__file__).parents[1] / "docs" / "_build" / "html"
PAGES = (
    "index start howto theory gallery gallery/transfer-fuel instances models glossary documents comparison asked "
    "conditions constraints notebook notebook_class notebook_system notebook_study models_without_cost studies "
    "developers reference/commands "
    "reference/python tutorials/judge tutorials/return tutorials/own_system tutorials/study proved optima audit "
    "architecture gallery/molniya gallery/uny-lqr"
)
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
QUIET = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
).split()


def violations(page: object, source: Path) -> list[str]:
    """What axe finds on a page with all of it opened."""
    from axe_playwright_python.sync_playwright import Axe

    page.goto(source.as_uri())
    page.evaluate("document.querySelectorAll('details').forEach(part => part.open = true)")
    found = Axe().run(page).response["violations"]
    return [f"{each['id']}: {each['help']}, as in {each['nodes'][0]['html'][:120]}" for each in found]


def main() -> int:
    """Check all pages; the exit code."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        print("pages: not looked at, for there is no Chromium here")
        return 0
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as started:
        sources = [BUILT / f"{name}.html" for name in PAGES.split()]
        for language in ("en", "id"):
            sources.append(Path(folder, f"report-{language}.html"))
            explored = ["--interactive"] if language == "en" else []
            command = [sys.executable, "-m", "satsym", "report", "soft-return", "--lang", language, *explored]
            subprocess.run([*command, "--html", sources[-1]], check=True, capture_output=True)
        found = 0
        engine = started.chromium.launch(executable_path=browser, args=QUIET)
        for scheme in ("light", "dark"):
            page = engine.new_context(color_scheme=scheme).new_page()
            for source in sources:
                for line in violations(page, source):
                    found += 1
                    print(f"{source.stem} ({scheme}): {line}")
        engine.close()
    print(f"pages: {len(sources)} looked at, light and dark, {found} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
