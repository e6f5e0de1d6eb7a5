"""What the theme leaves out for people who hear a page or have no mouse."""

from pathlib import Path

from sphinx.application import Sphinx

PUT_RIGHT = {
    '<p class="caption" role="heading">': '<p class="caption" role="heading" aria-level="2">',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="Pages">',
    '<aside class="toc-drawer': '<aside aria-label="On this page" class="toc-drawer',
    "<pre>": '<pre tabindex="0">',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
}


def _put_right(app: Sphinx, failed: Exception | None) -> None:
    for path in Path(app.outdir).rglob("*.html") if failed is None else ():
        text = path.read_text(encoding="utf-8")
        for before, after in PUT_RIGHT.items():
            text = text.replace(before, after)
        path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension with Sphinx."""
    app.connect("build-finished", _put_right)
    return {"parallel_read_safe": True}
