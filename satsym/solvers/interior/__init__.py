"""Points on the way that are passed at free times: the times are searched, then found exactly with arcs and jumps."""
