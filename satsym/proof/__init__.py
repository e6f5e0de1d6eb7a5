"""Proofs by ball arithmetic that an extremal exists, is locally unique, and is a strict local minimum.

:mod:`satsym.proof.proving` has the whole proof on one page. The answer of a solver only says where to look; nothing
that it claims is used.
"""
