"""Orbits about one centre of attraction: the closed form, integrators held against it, elements and stability."""
