"""Kinds of models: what each may state, and its steps."""
