"""Certificates of bang-bang and singular arcs: the extremal again, strict switching, the second variation."""
