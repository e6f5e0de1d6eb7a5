"""Motions that a solution is compared with: other starts of the direct search and randomly drawn controls."""
