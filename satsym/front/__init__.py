"""The Python interface: instances, solutions and derivations, with everything that the command line can do.

This package may import every other package, and none of them imports it. :mod:`satsym` exports its names, each loaded
at first use.
"""
