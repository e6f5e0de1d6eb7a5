"""What follows where a fixed centre attracts: conics, the gradient of gravity, points of an orbit."""
