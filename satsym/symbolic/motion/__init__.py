"""What follows from a motion: the reference, conserved quantities, outputs; and where a fixed centre attracts."""
