"""Accuracy of collocation: defect corrections, finer meshes, and nodes that follow the jumps of a control law."""
