"""Showing what was derived and computed: LaTeX, and the texts of rules and messages in each language."""
