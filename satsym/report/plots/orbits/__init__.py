"""Pictures of paths in space, of conics and of points in the plane."""
