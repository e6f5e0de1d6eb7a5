"""Documents that people write, LaTeX or Markdown: their displays found, read, and drafted as a ledger."""
