"""LaTeX of what was derived."""
