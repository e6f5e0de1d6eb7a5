"""Ledgers: TOML files that list what a document prints; they are read and checked here."""
