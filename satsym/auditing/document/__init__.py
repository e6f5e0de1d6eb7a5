"""Documents in LaTeX or Markdown: their displayed formulas are found, read, and drafted as a ledger."""
