"""What is asked along the way: inequalities on states and controls, and points that are passed at free times."""
