"""One printed formula against all that a model's derivation establishes: is it right, and if not, what is wrong."""
