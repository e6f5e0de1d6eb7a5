"""Reports of what was derived and computed: terminal, pages, pictures, LaTeX, and the texts in each language."""
