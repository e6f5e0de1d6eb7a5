"""Derivations as data: the equations of a derivation, saved beside the generated module, and found by name."""
