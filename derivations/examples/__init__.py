"""Problems of the literature whose optima are known, as anyone would state theirs."""
