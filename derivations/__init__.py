"""Models and ledgers: a file of physics for each family of models, and the ledgers of printed claims.

People write these files; ``satsym derive`` reads them and writes ``generated/``. A file states the position of the
satellite, the forces that act on it and the cost of the control. Importing it derives nothing.
"""
