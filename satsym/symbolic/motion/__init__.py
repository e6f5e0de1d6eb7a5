"""What follows from a motion whatever its kind: rates, the reference, conserved quantities, outputs."""
