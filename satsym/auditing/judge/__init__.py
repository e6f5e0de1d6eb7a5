"""Judgement of rows by comparing what is printed with what is derived, in one module for each kind of row."""
