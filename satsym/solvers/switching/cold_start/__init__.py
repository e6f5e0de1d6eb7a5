"""Where structures come from when nothing is known: regularised problems, drawn controls, saturated starts."""
