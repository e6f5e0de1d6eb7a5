"""Cold starts: initial guesses, and sequences of easier problems that lead to an extremal."""
