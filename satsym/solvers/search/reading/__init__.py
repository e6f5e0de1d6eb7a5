"""From the motion of a programme to arcs and junctions, which Newton's method then makes exact."""
