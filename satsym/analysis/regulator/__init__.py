"""Linear-quadratic regulators: Riccati equations, and the motions under their gains."""
