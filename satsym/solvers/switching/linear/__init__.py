"""Linear motions with bounded controls: the convex reachable set, and the global results that follow from it."""
