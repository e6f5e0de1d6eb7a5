"""Many instances of one problem solved and certified together, as columns of arrays."""
