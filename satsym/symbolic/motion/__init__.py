"""What follows from a motion whatever its kind: the reference, conserved quantities, outputs."""
