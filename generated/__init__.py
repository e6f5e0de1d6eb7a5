"""What the machine writes: kernels and typeset derivations, one pair of files a model.

``make derive`` writes them from ``derivations/`` and ``make check-derive`` fails where they differ, so
nothing here is edited by hand (this file apart). The modules import only ``math`` and ``numpy``.
"""
