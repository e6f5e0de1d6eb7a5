"""Results as objects and files: written whole or not at all, read only if they are what they say."""
