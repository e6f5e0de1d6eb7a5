"""Structures of switching problems without an initial guess, recognised in regularised problems."""
