"""Functions that sympy lacks: minimisers over control sets, roots of slopes, and functions of time stated piecewise."""
