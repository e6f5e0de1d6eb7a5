"""Commands about the machine that satsym runs on: its shell, its installation and its speed; one file each."""
