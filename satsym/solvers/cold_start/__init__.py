"""From nothing to an extremal: initial guesses, and paths of easier problems."""
