"""satsym derives, solves, certifies and typesets satellite optimal control problems.

Importing it imports nothing else: the parts are modules of their own, see CONTRIBUTING.md for the map.
"""

__version__ = "0.2.0"
