"""Results as plain text for people."""
