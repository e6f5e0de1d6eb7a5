"""From a derivation to fast source text: one expression graph, printed in a scalar and in a batch form."""
