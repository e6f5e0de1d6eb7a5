"""Ledgers: what documents print, read from TOML and checked."""
