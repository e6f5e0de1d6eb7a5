"""Derivations and audits as LaTeX documents."""
