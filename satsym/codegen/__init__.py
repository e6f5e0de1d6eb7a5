"""Generation of fast source text from a derivation: one expression graph, printed in a scalar and a batch form."""
