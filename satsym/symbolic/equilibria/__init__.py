"""Attitudes at which a body in orbit rests: all of them, exactly counted, classified, and followed over a parameter."""
