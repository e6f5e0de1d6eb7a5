"""Numbers with bounds of their errors: arithmetic of generated code, derivatives, exact numbers, validated steps."""
