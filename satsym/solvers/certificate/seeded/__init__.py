"""Seeded starts: searches for one competitor, and extremals that are drawn where several minima are likely."""
