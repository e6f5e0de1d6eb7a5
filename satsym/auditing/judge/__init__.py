"""Judging rows: what is printed against what is derived, one file a kind."""
