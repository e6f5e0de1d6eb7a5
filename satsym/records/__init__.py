"""Derivations as data: what a derivation establishes, kept beside what was generated from it, and found by name."""
