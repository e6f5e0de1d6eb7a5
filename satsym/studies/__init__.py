"""Studies: one instance solved, simulated or regulated for many values of some of its numbers.

What is asked is a :class:`~satsym.studies.asked.Study`. Its rows are cut into chunks, which workers compute one by one
and whose results are kept as they come, so that what has been computed is never computed again.
"""
