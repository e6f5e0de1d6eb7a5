"""What is wrong with a printed formula: the smallest edit that puts it right, or what it lacks."""
