"""Control-affine problems in a box: bang-bang, three-level and singular arcs with exact switching times."""
