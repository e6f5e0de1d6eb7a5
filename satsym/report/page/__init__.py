"""One run as one self-contained page: the derivation, the instance, the answer and its certificate."""
