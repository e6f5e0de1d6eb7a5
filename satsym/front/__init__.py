"""What users meet in Python: instances, solutions and derivations with everything the command line does with them.

It may call every floor and none knows of it. :mod:`satsym` itself hands out its names, each when it is first used.
"""
