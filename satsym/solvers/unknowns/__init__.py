"""Free quantities of an instance besides its end: initial states, the initial time and parameters."""
