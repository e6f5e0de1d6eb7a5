"""Certificates of bang-bang and singular arcs: repeated integration, strict switching, second variation."""
