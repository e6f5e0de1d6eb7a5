"""Linear systems: where they come from, their stability, ranks and spectra."""
