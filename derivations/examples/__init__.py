"""Problems from the literature with known optima, stated as a user would state them."""
