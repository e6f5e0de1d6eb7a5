"""What a solution is compared with: neighbours, other starts of the search, and controls that are drawn."""
