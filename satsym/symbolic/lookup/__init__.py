"""Lookup of derived expressions by their addresses, and work with them in the notation of a document."""
