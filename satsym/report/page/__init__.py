"""One run as one page that needs nothing but itself: the derivation, the instance, the answer and its certificate."""
