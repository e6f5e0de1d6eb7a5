"""Generated functions for many columns at once, compiled or on arrays, and steps of the canonical equations."""
