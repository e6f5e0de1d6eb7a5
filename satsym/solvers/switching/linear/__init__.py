"""Linear motions with bounded controls: the convex set of ends that are reached, and what follows from it."""
