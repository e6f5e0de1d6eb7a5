"""Motions under a given control or law, one or many at once."""
