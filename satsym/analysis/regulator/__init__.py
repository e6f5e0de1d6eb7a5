"""Linear-quadratic regulators: Riccati equations, and motions under the gains."""
