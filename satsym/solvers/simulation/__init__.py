"""Simulation of motions under a given control or control law, one or many at once."""
