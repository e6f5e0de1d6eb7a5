"""From a cold start to an extremal: initial guesses, and paths of easier problems."""
