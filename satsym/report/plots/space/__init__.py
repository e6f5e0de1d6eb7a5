"""Drawing of paths and attitudes in space: views, conic sections, attitudes, and what surrounds a path."""
