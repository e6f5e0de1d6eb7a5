"""Claims as propositions: read from the ledger's safe language, and found true, false or undecided."""
