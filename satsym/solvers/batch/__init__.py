"""Solution and certification of many instances of one problem at once, with one column of arrays for each instance."""
