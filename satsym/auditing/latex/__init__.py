"""Reading of mathematics as people typeset or type it: LaTeX, and plain notation. Nothing is ever evaluated."""
