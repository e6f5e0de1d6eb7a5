"""What an instance leaves free besides its end."""
