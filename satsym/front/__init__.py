"""The Python interface: instances, solutions and derivations, with everything that the command line can do.

It may call every floor, and no floor imports it. :mod:`satsym` exports its names, each loaded at first use.
"""
