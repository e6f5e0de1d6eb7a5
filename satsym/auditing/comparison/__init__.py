"""What is printed against what is derived: names and addresses, and plans that say when the two agree."""
