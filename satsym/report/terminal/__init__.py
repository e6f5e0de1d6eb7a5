"""What results say to people, as plain text."""
