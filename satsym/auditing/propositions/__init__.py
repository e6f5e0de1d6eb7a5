"""Propositions: claims that are read from the language of ledgers and found true, false or undecided."""
