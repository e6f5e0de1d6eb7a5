"""The classical laws of one axis, and how well they follow a command."""
