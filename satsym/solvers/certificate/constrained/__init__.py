"""Certificates of extremals with arcs on the boundaries of path constraints."""
