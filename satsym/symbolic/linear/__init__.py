"""Linear models with constant coefficients: stability, structure, and the regulator."""
