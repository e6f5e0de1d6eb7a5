"""Linear systems: linearisation, stability, ranks, spectra and Routh arrays."""
