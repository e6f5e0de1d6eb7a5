"""Proofs by ball arithmetic that an extremal exists, is unique near by, and is a strict local minimum.

:mod:`satsym.proof.proving` is the story on one page. Solvers only say where to look; nothing that they claim is used.
"""
