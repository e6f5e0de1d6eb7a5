"""The set of admissible controls, where a control meets its bounds, and laws that are regularised."""
