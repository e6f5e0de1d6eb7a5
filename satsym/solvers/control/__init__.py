"""Admissible controls: when a control reaches or leaves bounds, jumps of control laws, and regularised laws."""
