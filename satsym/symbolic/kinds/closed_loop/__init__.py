"""A linear law that follows a command: small motions about rest, transfer functions, critical damping, answers."""
