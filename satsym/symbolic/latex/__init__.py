"""LaTeX of derived expressions and equations."""
