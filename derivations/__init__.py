"""What people write: the physics of each model, one file a family, and the ledgers of printed claims.

A file says where the satellite is, which forces act and what the control costs; ``satsym derive`` does
the rest and writes ``generated/``. Reading a file derives nothing.
"""
