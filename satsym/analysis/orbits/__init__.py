"""Orbits in a central force: the closed form, elements, the monodromy matrix and stability."""
