"""Studies: one instance solved, simulated or regulated for many values of some of its numbers.

A :class:`~satsym.studies.asked.Study` states the rows. They are divided into chunks, which workers compute one by one
and whose results are saved as they arrive, so that no row is computed twice.
"""
