"""Classical control laws of a single axis, and how well they follow a command."""
