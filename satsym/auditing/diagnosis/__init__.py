"""Diagnosis of a wrong formula: the smallest edit that corrects it, or otherwise the term that it lacks."""
