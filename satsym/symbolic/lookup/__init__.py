"""Finding what was derived by its address, and working with it in the notation of a document."""
